"""The batch behind ``gymnasium.make_vec``: each environment does what a single one does."""

from __future__ import annotations

import copy
import gc
import os
import pickle
import signal
import subprocess
import sys
import time
import warnings
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.error import ResetNeeded
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, SyncVectorEnv
from gymnasium.wrappers.vector import RecordEpisodeStatistics

import auvgym
from auvgym import ActionError
from auvgym.envs import AUVDynamic2DEnv
from auvgym.registration import ENVIRONMENTS
from auvgym.vector import AUVVectorEnv
from auvgym.vector.seeds import EpisodeSeeds

every_id = pytest.mark.parametrize("env_id", list(ENVIRONMENTS))
MODES = [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP]
COUNT = 5
# Short episodes, so that many end.
HURRY = {"time_factor": 1.0}


def batch(env_id: str = "AUVDynamic2D-v0", count: int = COUNT, **settings: Any) -> Any:
    return gymnasium.make_vec(env_id, num_envs=count, **settings)


def one_by_one(env_id: str, mode: AutoresetMode, **settings: Any) -> SyncVectorEnv:
    def make() -> Any:
        return gymnasium.make(env_id, **settings).unwrapped

    return SyncVectorEnv([make] * COUNT, autoreset_mode=mode)


def actions(envs: Any, step: int) -> Any:
    shape = envs.action_space.shape
    drawn = np.random.default_rng(step).uniform(-1, 1, shape)
    drawn[:, 0] = abs(drawn[:, 0])  # ahead, so that episodes end soon
    return drawn.astype(np.float32)


def same(one: Any, other: Any, where: str = "") -> None:
    """Fail unless both have the same keys, and the same bytes under each."""
    if isinstance(one, dict):
        assert set(one) == set(other), where
        for key in one:
            same(one[key], other[key], f"{where}.{key}")
    elif isinstance(one, (tuple, list)):
        assert len(one) == len(other), where
        for index, (left, right) in enumerate(zip(one, other, strict=True)):
            same(left, right, f"{where}[{index}]")
    elif isinstance(one, np.ndarray) and one.dtype == object:
        same(one.tolist(), other.tolist(), where)
    elif isinstance(one, np.ndarray):
        assert one.shape == other.shape, where
        assert np.array_equal(one, other), where
    else:
        assert one == other, where


def flown(envs: Any, steps: int, first: int = 0) -> list[Any]:
    return [copy.deepcopy(envs.step(actions(envs, step))) for step in range(first, first + steps)]


# --- what it is -----------------------------------------------------------------------------------


@every_id
def test_make_vec_gives_the_batch(env_id: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        envs = gymnasium.make_vec(f"auvgym:{env_id}", num_envs=3)
    assert isinstance(envs, AUVVectorEnv)
    single = gymnasium.make(env_id)
    assert envs.single_observation_space == single.observation_space
    assert envs.single_action_space == single.action_space
    assert envs.observation_space.shape == (3, *single.observation_space.shape)
    assert envs.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP
    assert env_id in repr(envs)
    observations, _ = envs.reset(seed=1)
    assert observations in envs.observation_space
    assert observations.dtype == np.float32


def test_the_registration_can_be_written_down() -> None:
    spec = gymnasium.spec("AUVDynamic3D-v0")
    again = type(spec).from_json(spec.to_json())
    assert again.vector_entry_point == spec.vector_entry_point
    assert gymnasium.make_vec(again, num_envs=2).num_envs == 2


def test_what_is_no_environment_is_no_entry_point() -> None:
    with pytest.raises(AttributeError, match="Nonsense"):
        gymnasium.envs.registration.load_env_creator("auvgym.vector.entry:Nonsense")


# --- a batch is its environments ------------------------------------------------------------------


@every_id
@pytest.mark.parametrize("mode", MODES)
def test_environments_do_what_they_do_alone(env_id: str, mode: AutoresetMode) -> None:
    expected = one_by_one(env_id, mode, **HURRY)
    envs = batch(env_id, autoreset_mode=mode, threads=2, **HURRY)
    same(envs.reset(seed=7), expected.reset(seed=7))
    ends = 0
    for step in range(60):
        one, other = envs.step(actions(envs, step)), expected.step(actions(envs, step))
        same(one, other, f"step {step}")
        ends += one[2].sum()
    assert ends > 1
    same(envs.reset(), expected.reset())
    same(envs.reset(seed=[3, None, 1, 2, 3]), expected.reset(seed=[3, None, 1, 2, 3]))
    same(envs.step(actions(envs, 0)), expected.step(actions(envs, 0)))


@pytest.mark.parametrize("env_id", ["AUVDynamic2D-v0", "AUVThreat3D-v0"])
def test_whatever_the_number_of_threads(env_id: str) -> None:
    seen = []
    for threads in (1, 2, 3):
        envs = batch(env_id, autoreset_mode="SameStep", threads=threads, **HURRY)
        assert envs.threads == threads
        seen.append([envs.reset(seed=2), flown(envs, 40)])
    same(seen[0], seen[1])
    same(seen[0], seen[2])


def test_a_scenario_and_its_mission() -> None:
    settings = {"scenario": "afhh-1", "mission": 1}
    expected = one_by_one("AUVStatic3D-v0", AutoresetMode.NEXT_STEP, **settings)
    envs = batch("AUVStatic3D-v0", **settings)
    same(envs.reset(seed=1), expected.reset(seed=1))
    same(envs.step(actions(envs, 1)), expected.step(actions(envs, 1)))


def test_without_autoreset_a_mask_begins_again() -> None:
    mode = AutoresetMode.DISABLED
    envs, expected = (
        batch(autoreset_mode=mode, **HURRY),
        one_by_one("AUVDynamic2D-v0", mode, **HURRY),
    )
    same(envs.reset(seed=4), expected.reset(seed=4))
    ends = 0
    for step in range(60):
        one, other = envs.step(actions(envs, step)), expected.step(actions(envs, step))
        same(one, other)
        if one[2].any():
            ends += 1
            with pytest.raises(ResetNeeded, match="environments"):
                envs.step(actions(envs, step))
            mask = one[2]
            same(
                envs.reset(options={"reset_mask": np.repeat(mask, 2)[::2]}),  # not contiguous
                expected.reset(options={"reset_mask": mask.copy()}),
            )
    assert ends > 2


def test_episodes_by_their_seed() -> None:
    envs, single = batch(), gymnasium.make("AUVDynamic2D-v0")
    observations, infos = envs.reset(options={"episode_seed": [5, 6, 5, 2**64 - 1, 8]})
    assert infos["episode_seed"].tolist() == [5, 6, 5, 2**64 - 1, 8]
    for index, seed in enumerate([5, 6]):
        assert np.array_equal(observations[index], single.reset(options={"episode_seed": seed})[0])
    observations, _ = envs.reset(options={"episode_seed": 6})
    assert (observations == observations[0]).all()


def test_seeds_drawn_in_blocks_are_those_drawn_one_by_one() -> None:
    seeds, alone = EpisodeSeeds(2), seeding.np_random(3)[0]
    seeds.seed([3, 4], np.arange(2))
    other = seeds.next[1]
    for _ in range(300):
        assert seeds.next[0] == alone.integers(0, 2**63)
        seeds.used(np.array([0]))
    assert seeds.next[1] == other


# --- what comes back is the caller's --------------------------------------------------------------


def test_nothing_that_was_returned_changes_later() -> None:
    envs = batch(autoreset_mode="SameStep", **HURRY)
    returned = [envs.reset(seed=0)]
    returned += [envs.step(actions(envs, step)) for step in range(30)]
    kept = copy.deepcopy(returned)
    assert any("final_obs" in step[-1] for step in returned)
    flown(envs, 30)
    same(returned, kept)


def test_nor_does_writing_into_it_change_the_batch() -> None:
    envs, other = batch(**HURRY), batch(**HURRY)
    envs.reset(seed=0), other.reset(seed=0)
    for step in range(40):
        expected = copy.deepcopy(other.step(actions(envs, step)))
        result = envs.step(actions(envs, step))
        same(result, expected)
        for array in (*result[:4], *result[4].values()):
            array[:] = 1


# --- what is wrong is said ------------------------------------------------------------------------


def test_a_wrong_action_names_its_environment_and_moves_nothing() -> None:
    envs, other = batch(), batch()
    envs.reset(seed=0), other.reset(seed=0)
    wrong = np.zeros((COUNT, 2), np.float32)
    wrong[3, 1] = np.nan
    with pytest.raises(ActionError, match=r"environment 3: action\[1\] = NaN"):
        envs.step(wrong)
    for bad, message in [
        (np.full((COUNT, 2), 1.5), "environment 0: .* 1.5"),
        (np.zeros(COUNT), r"shape \(5,\): must be \(5, 2\)"),
        (np.zeros((COUNT, 2), bool), "not bool"),
        ([[0, 0], [0]], "numbers"),
        (np.full((COUNT, 2), 1e300), "inf"),
    ]:
        with pytest.raises(ActionError, match=message):
            envs.step(bad)
    same(envs.step(actions(envs, 0)), other.step(actions(envs, 0)))


def test_the_action_of_a_step_that_begins_an_episode_does_not_count() -> None:
    envs = batch(count=1, **HURRY)
    envs.reset(seed=0)
    while not envs.step(actions(envs, 0))[2][0]:
        pass
    _, rewards, ended, _, infos = envs.step([[np.nan, 9.0]])
    assert (rewards[0], ended[0], infos["time_s"][0]) == (0.0, False, 0.0)
    assert infos["_episode_seed"][0]


@pytest.mark.parametrize(
    ("settings", "error", "message"),
    [
        ({"nonsense": 1}, TypeError, "nonsense"),
        ({"render_mode": "human"}, ValueError, "rgb_array"),
        ({"threads": 0}, ValueError, "threads = 0"),
        ({"autoreset_mode": "sometimes"}, ValueError, "sometimes"),
        ({"difficulty": "absurd"}, ValueError, "absurd"),
    ],
)
def test_wrong_settings(settings: dict[str, Any], error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        batch(**settings)


def test_wrong_numbers_and_seeds() -> None:
    with pytest.raises(ValueError, match="num_envs = 0"):
        batch(count=0)
    envs = batch()
    with pytest.raises(ResetNeeded):
        envs.step(np.zeros((COUNT, 2)))
    with pytest.raises(ResetNeeded):
        envs.reset(options={"reset_mask": np.arange(COUNT) == 0})
    for arguments, message in [
        ({"seed": [1, 2]}, "seed has 2 entries"),
        ({"seed": [-1] * COUNT}, "seed = -1"),
        ({"options": {"episode_seed": "x" * COUNT}}, "episode_seed = 'x'"),
        ({"options": {"nonsense": 1}}, "nonsense"),
        ({"options": {"reset_mask": [True] * COUNT}}, "reset_mask"),
        ({"options": {"reset_mask": np.zeros(COUNT, bool)}}, "true somewhere"),
    ]:
        with pytest.raises(ValueError, match=message):
            envs.reset(**arguments)


def test_a_class_that_steps_in_its_own_way_is_refused() -> None:
    class Bonus(AUVDynamic2DEnv):
        def step(self, action: Any) -> Any:
            return super().step(action)

    with pytest.raises(TypeError, match=r"Bonus has a step\(\)"):
        AUVVectorEnv(Bonus, 2)


@pytest.mark.parametrize("begun", [False, True])
def test_whatever_the_engine_is_asked_it_answers_or_raises(begun: bool) -> None:
    envs = batch(count=3, autoreset_mode="SameStep")
    if begun:
        envs.reset(seed=0)
    engine: Any = envs._batch
    indices = [np.array(these, np.int64) for these in ([], [0], [-1], [3], [2**62], [-(2**63)])]
    masks = [np.ones(count, bool) for count in (2, 3, 4)] + [np.ones(6, bool)[::2], "x"]
    seeds = [np.zeros(count, np.uint64) for count in (2, 3)]
    actions = [np.full(shape, np.nan, np.float32) for shape in ((3, 2), (2, 2), (3, 3), (0, 2))]
    calls: list[tuple[Any, tuple[Any, ...]]] = [
        *((engine.infos, (some, last)) for some in [*indices, None] for last in (False, True)),
        *((engine.last_observations, (some,)) for some in indices),
        *((engine.info, (False, mask)) for mask in masks),
        *((engine.step, (action, some)) for action in actions for some in seeds),
        *((engine.episode, (index,)) for index in (3, -1, 2**70)),
    ]

    def refused(call: Any, arguments: tuple[Any, ...]) -> bool:
        try:
            call(*arguments)
        except Exception:  # a panic is none
            return True
        return False

    assert len(calls) // 2 < sum(refused(*call) for call in calls) < len(calls)


# --- copies, processes, signals -------------------------------------------------------------------


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("clone", [copy.deepcopy, lambda envs: pickle.loads(pickle.dumps(envs))])
def test_copies_go_on_identically(mode: AutoresetMode, clone: Any) -> None:
    envs = batch("AUVThreat3D-v0", autoreset_mode=mode, **HURRY)
    same(clone(envs).reset(seed=1), envs.reset(seed=1))
    for first in (0, 13, 26):
        other = clone(envs)
        same(flown(other, 13, first), flown(envs, 13, first))
        assert other.members[2].episode.seed == envs.members[2].episode.seed


def test_works_in_a_fork() -> None:
    envs = batch(threads=2, **HURRY)
    envs.reset(seed=0)
    flown(envs, 5)
    expected = copy.deepcopy(envs)
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        os.write(write, envs.step(actions(envs, 5))[0].tobytes())
        os._exit(0)
    os.close(write)
    with os.fdopen(read, "rb") as pipe:
        told = pipe.read()
    assert os.waitpid(child, 0)[1] == 0
    assert told == expected.step(actions(envs, 5))[0].tobytes()
    assert told == envs.step(actions(envs, 5))[0].tobytes()


def test_ctrl_c_is_heard_within_a_second() -> None:
    code = (
        "import gymnasium, auvgym\n"
        "envs = gymnasium.make_vec('AUVDynamic3D-v0', num_envs=8192, threads=1)\n"
        "print('ready', flush=True)\n"
        "try:\n"
        "    while True: envs.reset()\n"
        "except KeyboardInterrupt:\n"
        "    print('stopped', flush=True)\n"
        "try: envs.step(envs.action_space.sample())\n"
        "except gymnasium.error.ResetNeeded: print('needs a reset')\n"
    )
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    assert process.stdout.readline() == "ready\n"
    time.sleep(1.5)
    asked = time.monotonic()
    process.send_signal(signal.SIGINT)
    assert process.stdout.readline() == "stopped\n"
    assert time.monotonic() - asked < 1.0
    assert process.communicate()[0] == "needs a reset\n"


def test_memory_of_4096_environments() -> None:
    code = (
        "import gymnasium, auvgym, resource\n"
        "before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss\n"
        "envs = gymnasium.make_vec('AUVDynamic3D-v0', num_envs=4096)\n"
        "envs.reset(seed=0)\n"
        "for _ in range(3): envs.step(envs.action_space.sample())\n"
        "print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)\n"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert int(run.stdout) < 500_000  # kB


# --- the environments one by one ------------------------------------------------------------------


def test_policies_fly_a_member() -> None:
    envs, single = batch("AUVDynamic3D-v0", count=2), gymnasium.make("AUVDynamic3D-v0")
    policy, alone = auvgym.policies.make("sonar-rule"), auvgym.policies.make("sonar-rule")
    observations, infos = envs.reset(seed=[3, 3])
    observation, info = single.reset(seed=3)
    policy.reset(envs.members[1]), alone.reset(single)
    for _ in range(10):
        both = np.stack([policy.act(observations[1], infos)] * 2)
        observation, *_, info = single.step(alone.act(observation, info))
        observations, *_, infos = envs.step(both)
        assert np.array_equal(observations[1], observation)


def test_members() -> None:
    envs = batch()
    envs.reset(seed=0)
    member = envs.members[2]
    assert member.unwrapped is member
    assert member.world.dimensions == 2
    assert (
        member.observation_layout == gymnasium.make("AUVDynamic2D-v0").unwrapped.observation_layout
    )
    assert envs.call("action_for", [5e3, 9e3, 0.0])[2].shape == (2,)
    with pytest.raises(ValueError, match="shape"):
        member.action_for([1.0])
    member.charge(evaluations=7, replans=1)
    infos = envs.step(np.zeros((COUNT, 2)))[4]
    assert infos["evaluations"].tolist() == [0, 0, 7, 0, 0]
    assert envs.get_attr("dimensions") == (2,) * COUNT
    envs.set_attr("note", ["a", "b", "c", "d", "e"])
    assert envs.get_attr("note") == ("a", "b", "c", "d", "e")
    assert member.spec.id == "AUVDynamic2D-v0"
    assert not hasattr(member, "nonsense")
    with pytest.raises(AttributeError, match="of its own"):
        member.reset()


def test_trails_are_kept_when_asked_for() -> None:
    for record in (False, True):
        envs = batch(record=record)
        envs.reset(seed=0)
        flown(envs, 3)
        assert (len(envs.members[0].episode.trail) > 1) is record
        assert len(envs.members[0].episode.actions) == (3 if record else 0)


def test_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    pytest.importorskip("pygame")
    envs, single = batch(count=2, render_mode="rgb_array"), None
    envs.reset(seed=0)
    flown(envs, 2)
    frames = envs.render()
    single = gymnasium.make("AUVDynamic2D-v0", render_mode="rgb_array")
    single.reset(seed=1)
    for step in range(2):
        single.step(actions(envs, step)[1])
    assert np.array_equal(frames[1], single.render())
    envs.close()


def test_gymnasiums_own_wrappers_fit() -> None:
    envs = RecordEpisodeStatistics(batch(**HURRY))
    envs.reset(seed=0)
    lengths = [infos["episode"]["l"] for *_, infos in flown(envs, 40) if "episode" in infos]
    assert lengths
    gc.collect()
