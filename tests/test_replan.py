"""Re-plan mode: a planner's path is flown, and actions say when to plan anew."""

from __future__ import annotations

import copy
import os
import pickle
import re
import signal
import subprocess
import sys
import time
import warnings
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode, SyncVectorEnv
from replan_episodes import make, settings

import auvgym
from auvgym import ActionError, PlanningError
from auvgym.registration import ENVIRONMENTS

every_id = pytest.mark.parametrize("env_id", list(ENVIRONMENTS))


def drawn(step: int, count: int) -> Any:
    return np.random.default_rng(step).choice(4, count, p=[0.7, 0.1, 0.1, 0.1])


# --- what it is -----------------------------------------------------------------------------------


@every_id
def test_gymnasiums_checker_has_nothing_to_say(env_id: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = make(env_id)
        check_env(env.unwrapped, skip_render_check=True)
    assert env.action_space == gymnasium.spaces.Discrete(4)
    layout = env.unwrapped.observation_layout
    waypoint = gymnasium.make(env_id).unwrapped
    assert list(layout)[: len(waypoint.observation_layout)] == list(waypoint.observation_layout)
    assert max(block.stop for block in layout.values()) == env.observation_space.shape[0]


@every_id
def test_the_vehicle_sees_the_same_in_either_mode(env_id: str) -> None:
    seen = [one.reset(seed=4)[0] for one in (make(env_id), gymnasium.make(env_id))]
    assert np.array_equal(seen[0][: len(seen[1])], seen[1])


@every_id
def test_the_same_seed_gives_the_same_bytes(env_id: str) -> None:
    one, other = make(env_id), make(env_id)
    assert str(one.reset(seed=2)) == str(other.reset(seed=2))
    for step in range(12):
        found = [env.step(int(drawn(step, 1)[0])) for env in (one, other)]
        assert found[0][0].tobytes() == found[1][0].tobytes()
        assert found[0][1:] == found[1][1:]
        if found[0][2]:
            break


def test_by_default_it_is_astar_on_the_grid_of_astar_replan() -> None:
    default = gymnasium.make("AUVDynamic2D-v0", action_mode="replan")
    said = make(planner_parameters={"spacing_m": 500.0}, planning_s=600)
    default.reset(seed=1)
    said.reset(seed=1)
    for action in (0, 3, 1):
        assert default.step(action)[4] == said.step(action)[4]
    assert said.unwrapped.episode.info()["planning_s"] == 600.0 + 120.0


@pytest.mark.parametrize(
    ("planner", "env_id", "parameters"),
    [
        ("lfhh", "AUVDynamic2D-v0", {"generations": 5}),
        ("rrt-star", "AUVDynamic3D-v0", {"max_evaluations": 2000}),
        ("iifds", "AUVThreat3D-v0", {}),
        ("rmpso", "AUVHarbor2D-v0", {"generations": 3}),
        ("visibility", "AUVHarbor2D-v0", {}),
        ("afhh", "AUVStatic3D-v0", {"generations": 3, "population": 20}),
    ],
)
def test_whoever_fits_the_world_may_plan(
    planner: str, env_id: str, parameters: dict[str, Any]
) -> None:
    env = make(env_id, planner=planner, planner_parameters=parameters)
    _, info = env.reset(seed=3)
    assert info["evaluations"] > 0
    assert env.unwrapped.plan.shape[1] == 3
    for action in (0, 1, 2, 3):
        _, _, ended, _, info = env.step(action)
        if ended:
            break
    assert info["replans"] >= 1


# --- what planning costs --------------------------------------------------------------------------


@pytest.mark.parametrize(("action", "seconds"), [(1, 120.0), (2, 300.0), (3, 600.0)])
def test_planning_is_paid_for(action: int, seconds: float) -> None:
    env = make()
    core = env.unwrapped
    _, begun = env.reset(seed=1)
    start = core.episode.position
    assert (begun["planning_s"], begun["replans"]) == (0.0, 0)
    _, reward, _, _, info = env.step(action)
    assert (info["planning_s"], info["replans"]) == (seconds, 1)
    assert info["evaluations"] > begun["evaluations"]
    trail, ticks = core.episode.trail, int(seconds / core.episode.tick_s)
    assert np.linalg.norm(trail[: ticks + 1] - start, axis=1).max() < 150.0
    moved = (begun["distance_to_goal_m"] - info["distance_to_goal_m"]) / 39_000.0
    paid = 0.75 * info["time_s"] / core.episode.time_limit_s
    assert reward == pytest.approx(moved - paid, abs=0.01)
    assert info["energy_j"] > 20.0 * seconds


def test_a_number_is_that_of_the_full_window() -> None:
    env = make(planning_s=1000, windows=[0.1, 0.4])
    env.reset(seed=1)
    infos = [env.step(action)[4] for action in (1, 2, 3)]
    # In whole ticks of 15 s: 105, 405 and 1005 s.
    paid = np.diff([0.0, *(info["planning_s"] for info in infos)])
    assert paid.tolist() == [105.0, 405.0, 1005.0]


def test_time_by_evaluations() -> None:
    env = make(seconds_per_evaluation=0.25)
    _, begun = env.reset(seed=1)
    info = env.step(3)[4]
    seconds = 0.25 * (info["evaluations"] - begun["evaluations"])
    assert info["planning_s"] == 15.0 * np.ceil(seconds / 15.0)


def test_the_delays_are_seen() -> None:
    env = make(planning_s=[150, 450, 900])
    observation, _ = env.reset(seed=1)
    block = observation[env.unwrapped.observation_layout["planning_delay"]]
    tenth = 0.1 * env.unwrapped.episode.time_limit_s
    assert block == pytest.approx(np.array([150, 450, 900]) / tenth)


def test_a_plan_that_finds_no_way_is_not_taken() -> None:
    astar = {"spacing_m": 1000.0, "inflation_m": 9000.0}
    env = make(planner_parameters=astar)
    _, info = env.reset(seed=1)
    assert not info["plan_feasible"]
    before = env.unwrapped.plan
    info = env.step(3)[4]
    assert (info["failed_plans"], info["planning_s"]) == (1, 600.0)
    assert np.array_equal(env.unwrapped.plan, before)


# --- what a trigger sees --------------------------------------------------------------------------


def test_a_change_of_the_map_is_seen_in_the_blocks_of_the_plan() -> None:
    env = make()
    core = env.unwrapped
    observation, info = env.reset(seed=3)
    layout = core.observation_layout

    def blocks() -> dict[str, Any]:
        return {name: observation[where] for name, where in layout.items()}

    now = blocks()
    assert not now["plan_error"].any()
    assert now["plan_loss"] == 0.0
    assert not now["plan_age"].any()
    length = np.linalg.norm(np.diff(core.plan, axis=0), axis=1).sum()
    assert now["plan_left"][0] == pytest.approx(length / core.episode.straight_distance_m)
    while not info["map_changed"]:
        observation, _, _, _, info = env.step(0)
    now = blocks()
    assert now["plan_changes"] == 0.25
    assert now["plan_error"].any()
    assert now["plan_age"] == pytest.approx(
        [
            info["path_length_m"] / core.episode.straight_distance_m,
            info["time_s"] / core.episode.time_limit_s,
        ]
    )
    observation, _, _, _, info = env.step(3)
    if not info["map_changed"]:
        assert blocks()["plan_changes"] == 0.0
        assert not blocks()["plan_error"].any()


def test_a_conflict_is_where_the_plan_meets_something_solid() -> None:
    """Where the observation puts it, and with nothing before it."""
    env = make()
    core, found = env.unwrapped, 0
    for seed in range(8):
        observation, info = env.reset(seed=seed)
        while info["outcome"] == "running":
            conflict = observation[core.observation_layout["plan_conflict"]][0]
            place = core.episode.position
            leg = observation[core.observation_layout["plan_leg"]]
            if conflict > 0.7:  # within the next leg, which is straight
                far = (1.0 - conflict) * 5000.0
                forward = np.array(core.world.goal - place)[:2]
                forward /= np.linalg.norm(forward)
                left = np.array([-forward[1], forward[0]])
                direction = np.append(leg[0] * forward + leg[1] * left, 0.0)
                if far < leg[2] * 2000.0 - 200.0:
                    along = np.linspace(0.0, far - 30.0, 50)[:, None]
                    assert core.world.clearance(place + along * direction).min() > 0.0
                    there = place + far * direction
                    assert core.world.clearance(there) < 110.0
                    found += 1
            observation, _, _, _, info = env.step(0)
    assert found > 3


@pytest.mark.parametrize("env_id", ["AUVDynamic2D-v0", "AUVDynamic3D-v0"])
def test_the_page_has_every_block_of_the_plan(env_id: str) -> None:
    core = make(env_id).unwrapped
    page = (Path(__file__).parents[1] / "docs" / "environments.md").read_text(encoding="utf-8")
    rows = re.findall(
        r"^\| ([\d-]+) \| ([\d-]+) \| (\w+) \| (\S+) \.\. (\S+) \|", page, re.MULTILINE
    )
    told = {row[2]: row[core.dimensions - 2].split("-") for row in rows}
    layout = {name: where for name, where in core.observation_layout.items() if name in told}
    assert list(layout) == list(core.observation_layout)[-len(told) :]
    assert {name: slice(int(told[name][0]), int(told[name][-1]) + 1) for name in told} == layout
    for row in rows:
        assert np.all(core.observation_space.low[layout[row[2]]] == float(row[3]))
        assert np.all(core.observation_space.high[layout[row[2]]] == float(row[4]))


# --- batches and copies ---------------------------------------------------------------------------


@every_id
@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP])
def test_a_batch_does_what_environments_do_alone(env_id: str, mode: AutoresetMode) -> None:
    hurry = settings(env_id) | {"time_factor": 1.0}
    expected = SyncVectorEnv(
        [lambda: gymnasium.make(env_id, **hurry).unwrapped] * 3, autoreset_mode=mode
    )
    envs = gymnasium.make_vec(env_id, num_envs=3, threads=2, autoreset_mode=mode, **hurry)
    assert envs.single_action_space == gymnasium.spaces.Discrete(4)
    _same(envs.reset(seed=7), expected.reset(seed=7))
    for step in range(30):
        _same(envs.step(drawn(step, 3)), expected.step(drawn(step, 3)))


def _same(one: Any, other: Any) -> None:
    if isinstance(one, dict):
        assert set(one) == set(other)
        for key in one:
            _same(one[key], other[key])
    elif isinstance(one, (tuple, list)):
        for left, right in zip(one, other, strict=True):
            _same(left, right)
    elif isinstance(one, np.ndarray) and one.dtype == object:
        _same(one.tolist(), other.tolist())
    else:
        assert np.array_equal(one, other)


@pytest.mark.parametrize("clone", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])
def test_copies_go_on_identically(clone: Any) -> None:
    env, envs = make(), gymnasium.make_vec("AUVDynamic2D-v0", num_envs=3, **settings())
    env.reset(seed=1)
    envs.reset(seed=1)
    for step in range(9):
        env.step(int(drawn(step, 1)[0]))
        envs.step(drawn(step, 3))
    one, many = clone(env), clone(envs)
    for step in range(9, 15):
        _same(one.step(int(drawn(step, 1)[0])), env.step(int(drawn(step, 1)[0])))
        _same(many.step(drawn(step, 3)), envs.step(drawn(step, 3)))


def test_sb3_takes_it() -> None:
    pytest.importorskip("stable_baselines3")
    envs = auvgym.sb3.make_vec_env("AUVDynamic2D-v0", n_envs=4, seed=1, **settings())
    envs.reset()
    ended: list[dict[str, Any]] = []
    for step in range(60):
        observations, _, _, infos = envs.step(drawn(step, 4))
        assert observations.shape == (4, 85)
        ended += [info for info in infos if info]
    assert ended
    assert all(info["planning_s"] >= 0.0 for info in ended)


@pytest.mark.skipif(os.name != "posix", reason="sends SIGINT")
@pytest.mark.parametrize(
    "ask",
    [
        "env = gymnasium.make('AUVDynamic3D-v0', **settings); env.reset",
        "env = gymnasium.make_vec('AUVDynamic3D-v0', num_envs=4, threads=1, **settings); env.reset",
        "env = gymnasium.make_vec('AUVDynamic3D-v0', num_envs=4, threads=2, **settings); env.reset",
    ],
)
def test_ctrl_c_stops_planning_within_a_second(ask: str) -> None:
    made, reset = ask.split("; ")
    code = (
        "import gymnasium, auvgym\n"
        "slow = {'max_evaluations': 100_000_000, 'stop': 'exhaust'}\n"
        "settings = {'action_mode': 'replan', 'planner': 'lfhh', 'planner_parameters': slow}\n"
        f"{made}\n"
        "print('ready', flush=True)\n"
        f"try: {reset}(seed=1)\n"
        "except KeyboardInterrupt: print('stopped', flush=True)\n"
    )
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    assert process.stdout.readline() == "ready\n"
    time.sleep(0.7)
    asked = time.monotonic()
    process.send_signal(signal.SIGINT)
    assert process.stdout.readline() == "stopped\n"
    assert time.monotonic() - asked < 1.0
    assert process.wait() == 0


# --- what is wrong is said ------------------------------------------------------------------------


@pytest.mark.parametrize("action", [4, -1, 0.5, np.nan, "1", None, [0, 1], [[1], [2]], True])
def test_a_wrong_action_is_named_and_changes_nothing(action: Any) -> None:
    env = make()
    _, before = env.reset(seed=1)
    with pytest.raises(ActionError, match=r"0 \(go on\)"):
        env.unwrapped.step(action)
    assert env.unwrapped.episode.info() | {"episode_seed": before["episode_seed"]} == before


def test_a_wrong_action_of_a_batch_names_its_environment() -> None:
    envs = gymnasium.make_vec("AUVDynamic2D-v0", num_envs=3, **settings())
    envs.reset(seed=1)
    with pytest.raises(ActionError, match="environment 1: action = 7"):
        envs.step([0, 7, 0])
    with pytest.raises(ActionError, match=r"must be \(3,\)"):
        envs.step(np.zeros((3, 2)))


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"planner": "astr"}, "did you mean"),
        ({"planner": "maklink-dijkstra", "planner_parameters": {"nodes": 3}}, "nodes"),
        ({"planner": "ompl:rrtstar"}, "outside the engine"),
        ({"planner_parameters": {"spacing_m": -1.0}}, "spacing_m"),
        ({"planner_parameters": 3}, "planner_parameters = 3"),
        ({"windows": [0.5, 0.2]}, "windows"),
        ({"windows": 0.2}, "windows"),
        ({"planning_s": [1, 2]}, "planning_s"),
        ({"planning_s": -1}, "planning_s"),
        ({"planning_s": float("nan")}, "planning_s"),
        ({"seconds_per_evaluation": -1.0}, "seconds_per_evaluation"),
        ({"seconds_per_evaluation": 1.0, "planning_s": 1.0}, "seconds_per_evaluation"),
    ],
)
def test_wrong_settings_are_named_when_it_is_made(wrong: dict[str, Any], message: str) -> None:
    with pytest.raises(PlanningError, match=message):
        make(**wrong)


def test_settings_of_the_other_mode_are_refused() -> None:
    with pytest.raises(ValueError, match="planner is for action_mode='replan'"):
        gymnasium.make("AUVDynamic2D-v0", planner="astar")
    with pytest.raises(ValueError, match="action_mode = 'plan'"):
        gymnasium.make("AUVDynamic2D-v0", action_mode="plan")
    env = make()
    env.reset(seed=1)
    with pytest.raises(ValueError, match="the plan does"):
        env.unwrapped.action_for([0.0, 0.0, 0.0])
    with pytest.raises(PlanningError, match="MAKLINK"):
        make("AUVDynamic3D-v0", planner="visibility", planner_parameters={})
