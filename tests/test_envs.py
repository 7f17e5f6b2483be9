"""Environments: whatever is registered keeps Gymnasium's contract and its own specification."""

from __future__ import annotations

import copy
import importlib
import inspect
import pickle
import re
import warnings
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.error import ResetNeeded
from gymnasium.utils.env_checker import check_env
from hypothesis import given, settings
from hypothesis import strategies as st
from small_worlds import DEPTH, disc, open_water, wall

import auvgym
from auvgym import ActionError, Scenario, policies
from auvgym.envs import AUVEnv
from auvgym.registration import ENVIRONMENTS

IDS = list(ENVIRONMENTS)
INFO = {
    "time_s": float,
    "energy_j": float,
    "path_length_m": float,
    "min_clearance_m": float,
    "distance_to_goal_m": float,
    "evaluations": int,
    "replans": int,
    "map_changes": int,
    "map_changed": bool,
    "is_success": bool,
    "outcome": str,
}
FAILURES = {"collision", "out_of_bounds", "energy", "timeout"}
# Path length between map changes, m: in a tank, where none are usual, a thousandth.
EVERY_M = {env_id: 6.0 if env_id == "AUVStatic3D-v0" else 6_000.0 for env_id in IDS}

# Settings that a family refuses: its map never changes, and its current is a jet.
REFUSED = {
    "AUVThreat3D-v0": {
        "peaks",
        "ring_ratio",
        "vortices",
        "change_every_m",
        "vortex_drift_mps",
        "variant",
    },
    "AUVHarbor2D-v0": {
        "peaks",
        "ring_ratio",
        "vortices",
        "change_every_m",
        "vortex_drift_mps",
        "variant",
    },
}

# Settings that one family alone knows.
ONLY_IN = {"vessels": "AUVHarbor2D-v0", "manoeuvres": "AUVThreat3D-v0"}

every_id = pytest.mark.parametrize("env_id", IDS)
both_dimensions = pytest.mark.parametrize("dimensions", [2, 3])


def environment_class(env_id: str) -> type[AUVEnv]:
    module, _, name = ENVIRONMENTS[env_id].partition(":")
    found: type[AUVEnv] = getattr(importlib.import_module(module), name)
    return found


def make(env_id: str, **settings: Any) -> Any:
    """An environment as users get it, with all of Gymnasium's wrappers."""
    return gymnasium.make(f"auvgym:{env_id}", **settings)


def known(env_id: str, **settings: Any) -> dict[str, Any]:
    """Those of the settings that the environment's family does not refuse."""
    refused = REFUSED.get(env_id, set())
    return {name: value for name, value in settings.items() if name not in refused}


def bare(dimensions: int = 2, **settings: Any) -> AUVEnv:
    return environment_class(f"AUVDynamic{dimensions}D-v0")(**settings)


def in_open_water(dimensions: int = 2, **parts: Any) -> AUVEnv:
    env = bare(dimensions, scenario=Scenario.from_dict(open_water(dimensions, **parts)))
    env.reset(seed=0)
    return env


def fly(env: Any, steps: int, seed: int = 0) -> list[Any]:
    """Step with random actions, beginning again after each end; everything that came back."""
    random, width = np.random.default_rng(seed), env.action_space.shape
    seen: list[Any] = []
    for _ in range(steps):
        action = random.uniform(-1, 1, width).astype(np.float32)
        observation, reward, terminated, truncated, info = env.step(action)
        seen.append((observation.tobytes(), reward, terminated, truncated, info))
        if terminated or truncated:
            observation, info = env.reset()
            seen.append((observation.tobytes(), info))
    return seen


def to_goal(env: Any) -> np.ndarray[Any, Any]:
    core = env.unwrapped
    action: np.ndarray[Any, Any] = core.action_for(core.world.goal)
    return action


# --- Gymnasium's contract ----------------------------------------------------------------------


@every_id
def test_gymnasiums_checker_has_nothing_to_say(env_id: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(make(env_id).unwrapped, skip_render_check=True)


@every_id
def test_nor_has_it_about_frames(env_id: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    pytest.importorskip("pygame")
    env = make(env_id, render_mode="rgb_array")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(env.unwrapped)
    env.close()


@every_id
def test_stable_baselines_checker_has_nothing_to_say(env_id: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # whatever its own dependencies have to say on import
        checker = pytest.importorskip("stable_baselines3.common.env_checker")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        checker.check_env(make(env_id), warn=True)
        checker.check_env(environment_class(env_id)(), warn=True)


@every_id
def test_the_same_seed_gives_the_same_bytes(env_id: str) -> None:
    one, other = make(env_id), environment_class(env_id)()
    for seed in (0, 1, 2**31):
        first, second = one.reset(seed=seed), other.reset(seed=seed)
        assert first[0].tobytes() == second[0].tobytes()
        assert first[1] == second[1]
        assert fly(one, 40) == fly(other, 40)


@every_id
def test_different_seeds_differ(env_id: str) -> None:
    env = make(env_id)
    observations = [env.reset(seed=seed)[0].tobytes() for seed in range(10)]
    observations += [env.reset()[0].tobytes() for _ in range(10)]
    assert len(set(observations)) == 20


@every_id
def test_what_is_returned_belongs_to_the_caller(env_id: str) -> None:
    env = make(env_id)
    first, info = env.reset(seed=0)
    kept, told = first.copy(), dict(info)
    action = np.full(env.action_space.shape, 0.5, np.float32)
    env.step(action)
    assert np.array_equal(first, kept)
    assert info == told
    action[:] = 9.0
    assert np.all(env.unwrapped.episode.actions == 0.5)


@every_id
@pytest.mark.parametrize("difficulty", ["easy", "hard"])
@settings(max_examples=12, deadline=None)
@given(seed=st.integers(0, 2**32), flown=st.integers(0, 2**32), bold=st.booleans())
def test_observations_stay_in_their_space(
    env_id: str, difficulty: str, seed: int, flown: int, bold: bool
) -> None:
    moving = known(env_id, obstacle_speed_mps=0.5, vortex_drift_mps=0.5)
    env = environment_class(env_id)(difficulty=difficulty, **moving)
    random, space = np.random.default_rng(flown), env.observation_space
    observation, _ = env.reset(seed=seed)
    for _ in range(60):
        assert space.contains(observation), np.argwhere(
            ~((observation >= space.low) & (observation <= space.high))  # type: ignore[attr-defined]
        )
        action = random.uniform(-1, 1, env.dimensions).astype(np.float32)
        if bold:
            action = np.sign(action)
        observation, reward, terminated, truncated, _ = env.step(action)
        assert np.isfinite(reward)
        assert not truncated
        if terminated:
            break
    assert space.contains(observation)


# --- the specification -------------------------------------------------------------------------


@every_id
def test_the_layout_covers_the_whole_vector(env_id: str) -> None:
    env = environment_class(env_id)()
    (length,) = env.observation_space.shape  # type: ignore[misc]
    covered = [i for block in env.observation_layout.values() for i in range(length)[block]]
    assert covered == list(range(length))
    assert env.sonar_directions.shape == (len(range(length)[env.observation_layout["sonar"]]), 3)
    np.testing.assert_allclose(np.linalg.norm(env.sonar_directions, axis=1), 1)


@every_id
def test_the_docstring_is_the_specification(env_id: str) -> None:
    env = environment_class(env_id)()
    text = inspect.cleandoc(type(env).__doc__ or "")
    parts = re.split(r"^## (.+)$", text, flags=re.MULTILINE)
    sections = dict(zip(parts[1::2], parts[2::2], strict=True))
    assert set(sections) >= {
        "Description",
        "Action space",
        "Observation space",
        "Reward",
        "Starting state",
        "Episode end",
        "Info",
        "Arguments",
        "Version history",
    }

    (entries,), (length,) = env.action_space.shape, env.observation_space.shape  # type: ignore[misc]
    assert f"Box(-1, 1, ({entries},), float32)" in sections["Action space"]
    assert env.action_space == gymnasium.spaces.Box(-1, 1, (entries,), np.float32)
    rows = re.findall(r"^\| (\d+) \|", sections["Action space"], flags=re.MULTILINE)
    assert rows == [str(i) for i in range(entries)]

    assert f"Box(low, high, ({length},), float32)" in sections["Observation space"]
    assert env.observation_space.dtype == np.float32
    pattern = r"^\| (\d+)(?:-(\d+))? \| (\w+) \| (\S+) \.\. (\S+) \| (.+) \|$"
    table = re.findall(pattern, sections["Observation space"], flags=re.MULTILINE)
    told = {name: slice(int(a), int(b or a) + 1) for a, b, name, *_ in table}
    assert told == env.observation_layout
    for _, _, name, low, high, meaning in table:
        block = env.observation_layout[name]
        assert np.all(env.observation_space.low[block] == float(low)), name  # type: ignore[attr-defined]
        assert np.all(env.observation_space.high[block] == float(high)), name  # type: ignore[attr-defined]
        assert len(meaning) > 10

    for outcome in {"goal", *FAILURES}:
        assert f"``{outcome}``" in sections["Episode end"]
    for key in INFO:
        assert key in sections["Info"]
    parameters = set(inspect.signature(AUVEnv).parameters) - {"unknown_settings"}
    elsewhere = {name for name, only in ONLY_IN.items() if env_id != only}
    missing = {name for name in parameters if f"``{name}``" not in sections["Arguments"]}
    noise = {"sensor_noise_m"} if env_id != "AUVThreat3D-v0" else set()
    flat = {"peaks"} if env.dimensions == 2 else set()
    assert missing <= noise | flat | elsewhere | REFUSED.get(env_id, set())
    assert f"v{env_id.rpartition('-v')[2]}:" in sections["Version history"]


@both_dimensions
def test_the_specifications_numbers_are_the_scenarios(dimensions: int) -> None:
    env = bare(dimensions)
    env.reset(seed=0)
    scenario = env.world.scenario.to_dict()
    text = " ".join((type(env).__doc__ or "").split())
    episode, limits = scenario["episode"], scenario["limits"]
    assert f"scaled by the reach of {episode['reach_m']:.0f} m" in text
    assert f"sonar range {episode['sonar_range_m']:.0f} m" in text
    assert f"({episode['waypoint_margin_m']:.0f} m inside its side walls" in text
    assert f"until it is within {episode['capture_radius_m']:.0f} m" in text
    assert f"(after at least {episode['minimum_leg_s']:.0f} s)" in text
    assert f"{episode['maximum_leg_s']:.0f} s have passed" in text
    assert f"physics ticks of {episode['tick_s']:.0f} s" in text
    assert f"within {limits['goal_radius_m']:.0f} m of the goal" in text
    assert f"more than {scenario['domain']['margin_m']:.0f} m outside the box" in text
    assert f"({limits['energy_factor']:.0f} times the still-water straight run)" in text
    assert f"normal step of {scenario['change']['obstacle_step_m']:.0f} m" in text
    assert f"within {scenario['change']['hold_margin_m']:.0f} m of vehicle, start or goal" in text
    assert f"{len(scenario['obstacles'])} {'discs' if dimensions == 2 else 'spheres'}" in text
    assert f"vehicle of {scenario['vehicle']['speed_mps']:.0f} m/s" in text


@both_dimensions
def test_observations_say_what_they_are_said_to(dimensions: int) -> None:
    env = bare(dimensions, obstacle_speed_mps=0.4)
    for seed in range(5):
        observation, info = env.reset(seed=seed)
        for _ in range(6):
            observation, _, terminated, _, info = env.step(to_goal(env))
            if terminated:
                break
        episode, world = env.episode, env.world
        position, goal, (low, high) = episode.position, world.goal, world.domain
        scenario = world.scenario.to_dict()
        speed, sonar_range = scenario["vehicle"]["speed_mps"], scenario["episode"]["sonar_range_m"]

        def block(name: str, observation: Any = observation) -> Any:
            return observation[env.observation_layout[name]]

        level = np.linalg.norm(goal[:2] - position[:2])
        forward = (goal[:2] - position[:2]) / level
        to_frame = np.array([forward, [-forward[1], forward[0]]])
        expected = {
            "goal_distance": [2 * level / episode.straight_distance_m - 1],
            "goal_near": [level / sonar_range],
            "position": (2 * (position - low)[:2] / (high - low)[:2] - 1),
            "time_left": [1 - info["time_s"] / episode.time_limit_s],
            "energy_left": [1 - info["energy_j"] / episode.energy_budget_j],
            "change_distance": [episode.distance_since_change_m / scenario["change"]["every_m"]],
            "heading": to_frame @ episode.heading[:2],
            "frame": forward,
        }
        if dimensions == 3:
            expected["depth"] = [2 * position[2] / high[2] - 1]
            expected["altitude"] = (world.floor_depth([position[:2]]) - position[2]) / sonar_range
            expected["goal_depth"] = [(position[2] - goal[2]) / sonar_range]
            expected["climb"] = [-episode.heading[2]]
        reach = scenario["episode"]["reach_m"]
        ahead = np.array([[0, 0], [1, 0], [0.6, 0.8], [0.6, -0.8]]) * reach @ to_frame
        points = position + np.column_stack([ahead, np.zeros(4)])
        expected["current"] = (world.current(points)[:, :2] @ to_frame.T / speed).ravel()
        for name, values in expected.items():
            bounds = env.observation_space
            low_bound = bounds.low[env.observation_layout[name]]  # type: ignore[attr-defined]
            high_bound = bounds.high[env.observation_layout[name]]  # type: ignore[attr-defined]
            wanted = np.clip(values, low_bound, high_bound)
            np.testing.assert_allclose(block(name), wanted, atol=2e-6, err_msg=name)


@both_dimensions
def test_sonar_hears_what_is_there(dimensions: int) -> None:
    env = bare(dimensions)
    heard = 0
    for seed in range(10):
        observation, _ = env.reset(seed=seed)
        for _ in range(4):
            observation, _, terminated, _, _ = env.step(to_goal(env))
            if terminated:
                break
        world, position = env.world, env.episode.position
        if world.clearance([position])[0] <= 0:
            continue  # it lies in a rock
        ranges = (1 - observation[env.observation_layout["sonar"]].astype(float)) * 5_000
        forward = (world.goal - position)[:2] / np.linalg.norm((world.goal - position)[:2])
        f, left, up = env.sonar_directions.T
        beams = np.column_stack(
            [f * forward[0] - left * forward[1], f * forward[1] + left * forward[0], -up]
        )
        low, high = world.domain
        for beam, length in zip(beams, ranges, strict=True):
            along = np.linspace(0, length, 200)[:, None]
            points = position + along * beam
            # Free all the way (but for the touch of the walk along the beam) ...
            assert world.clearance(points).min() > -1.0
            # ... and an echo comes from a solid or from a wall.
            if length < 4_999:
                end = points[-1]
                axes = slice(0, dimensions)
                at_wall = np.minimum(end - low, high - end)[axes].min() < 10
                assert at_wall or abs(world.clearance([end])[0]) < 10
                heard += 1
    assert heard > 20


@both_dimensions
def test_the_nearest_obstacles_come_first(dimensions: int) -> None:
    env = bare(dimensions, obstacle_speed_mps=0.4)
    seen = 0
    for seed in range(20):
        env.reset(seed=seed)
        observation, _, _, _, _ = env.step(to_goal(env))
        world, position = env.world, env.episode.position
        obstacles = world.snapshot()["obstacles"]
        centres = np.array([obstacle["position_m"] for obstacle in obstacles])
        radii = np.array([obstacle["radius_m"] for obstacle in obstacles])
        speeds = np.array([obstacle["velocity_mps"] for obstacle in obstacles])
        offsets = centres - position
        if dimensions == 2:
            offsets[:, 2] = 0
        gaps = np.linalg.norm(offsets, axis=1) - radii
        forward = (world.goal - position)[:2] / np.linalg.norm((world.goal - position)[:2])
        frame = np.array([[*forward, 0], [-forward[1], forward[0], 0], [0, 0, -1]])[:dimensions]
        wanted = np.zeros((3, 2 * dimensions + 1))
        for row, i in enumerate(gaps.argsort()[:3]):
            if gaps[i] < 5_000:
                wanted[row] = [*frame @ offsets[i] / 5e3, radii[i] / 5e3, *frame @ speeds[i] / 2.0]
                seen += 1
        found = observation[env.observation_layout["obstacles"]].reshape(wanted.shape)
        np.testing.assert_allclose(found, np.clip(wanted, -1, 1), atol=2e-6)
    assert seen > 6


# --- actions -----------------------------------------------------------------------------------


BAD_ACTIONS: dict[str, tuple[Any, str]] = {
    "NaN": ([0.0, np.nan, 0.0], r"action\[1\] = NaN: must lie in -1 .. 1"),
    "infinite": ([np.inf, 0.0, 0.0], r"action\[0\] = inf: must lie in -1 .. 1"),
    "too large": ([0.0, -1.01, 0.0], r"action\[1\] = -1.01: must lie in -1 .. 1"),
    "a bit too large": ([np.nextafter(np.float32(1), 2), 0, 0], r"action\[0\] = 1.0000001: must"),
    "beyond float32": ([1e300, 0.0, 0.0], r"action\[0\] = inf: must lie in -1 .. 1"),
    "beyond float64": ([10**400, 0.0, 0.0], "must be . numbers, not object"),
    "short": ([0.0], "action has shape|action = 1 entries"),
    "long": ([0.0] * 9, "action has shape|action = 9 entries"),
    "a row": ([[0.0, 0.0, 0.0]], r"action has shape \(1, .\): must be"),
    "a number": (0.5, r"action has shape \(\): must be"),
    "empty": ([], "action has shape|action = 0 entries"),
    "text": ("forward", "action = 'forward': must be . numbers, not <U7"),
    "digits as text": (["0", "0", "0"], "must be . numbers, not <U1"),
    "bytes": (b"ab", "must be . numbers, not |S2"),
    "a flag": (True, "action = True: must be . numbers, not bool"),
    "flags": ([True, False, True], "must be . numbers, not bool"),
    "None": (None, "action = None: must be . numbers, not object"),
    "complex": ([1j, 0, 0], "must be . numbers, not complex128"),
    "an object": (object(), "must be . numbers, not object"),
    "a mapping": ({"forward": 1}, "must be . numbers, not object"),
    "ragged": ([[0.0], [0.0, 0.0]], "must be . numbers"),
}


@every_id
@pytest.mark.parametrize("case", BAD_ACTIONS)
def test_a_wrong_action_is_named_and_changes_nothing(env_id: str, case: str) -> None:
    action, message = BAD_ACTIONS[case]
    env = environment_class(env_id)()
    if isinstance(action, list) and len(action) == 3:
        action = action[: env.dimensions]
    if case == "a row":
        action = [action[0][: env.dimensions]]
    env.reset(seed=1)
    env.step(np.zeros(env.dimensions, np.float32))
    before = env.episode.save()
    variants = [action]
    if case in ("NaN", "infinite", "too large", "short", "long", "a row"):
        variants += [np.array(action), np.array(action, np.float32), tuple(action)]
    for variant in variants:
        with pytest.raises(ActionError, match=message):
            env.step(variant)
        assert env.episode.save() == before
    assert isinstance(ActionError("x"), ValueError)


@every_id
def test_numbers_of_any_kind_steer_alike(env_id: str) -> None:
    entries = environment_class(env_id).dimensions
    results = []
    for kind in (np.float32, np.float64, np.float16, np.int64, list, tuple, "strided"):
        env = environment_class(env_id)()
        env.reset(seed=2)
        action: Any = np.array([1.0, 0.0, -1.0][:entries])
        if kind in (list, tuple):
            action = kind(action)
        elif kind == "strided":
            action = np.repeat(action.astype(np.float32), 2)[::2]
        else:
            action = action.astype(kind)
        results.append(env.step(action)[0].tobytes())
    assert len(set(results)) == 1


@every_id
def test_step_needs_a_reset(env_id: str) -> None:
    action = np.zeros(environment_class(env_id).dimensions, np.float32)
    env = environment_class(env_id)()
    for needs_an_episode in (
        lambda: env.step(action),
        lambda: env.action_for([0, 0, 0]),
        lambda: env.world,
        lambda: env.charge(1),
    ):
        with pytest.raises(ResetNeeded, match="call reset"):
            needs_an_episode()
    with pytest.raises(ResetNeeded):
        make(env_id).step(action)

    env.reset(seed=0)
    while not env.step(to_goal(env))[2]:
        pass
    over = env.episode.save()
    for _ in range(2):
        with pytest.raises(ResetNeeded, match=rf"has ended \({env.episode.outcome}\)"):
            env.step(action)
    assert env.episode.save() == over
    env.reset()
    env.step(action)


@both_dimensions
@settings(max_examples=60, deadline=None)
@given(entries=st.lists(st.floats(-1, 1, width=32), min_size=3, max_size=3))
def test_action_for_inverts_waypoint_of(dimensions: int, entries: list[float]) -> None:
    env = in_open_water(
        dimensions,
        missions=[{"start_m": [9_000, 8_000, (dimensions - 2) * 2_000], "goal_m": [7e3, 19e3, 0]}],
    )
    env.reset(seed=0)
    action = np.array(entries[:dimensions], np.float32)
    waypoint = env.episode.waypoint_of(action)
    if dimensions == 2 or 300 < waypoint[2] < DEPTH - 300:  # else it was clipped to the box
        np.testing.assert_allclose(env.action_for(waypoint), action, atol=1e-6)


def test_waypoints_are_what_the_specification_says() -> None:
    env = in_open_water(3)
    position, goal = env.episode.position, env.world.goal
    assert np.allclose(goal - position, [0, 19_000, 0])  # forward = y, left = -x, up = -z
    for action, offset in [
        ([0, 0, 0], [0, 500, 0]),
        ([1, 0, 0], [0, 2_000, 0]),
        ([0, 1, 0], [-2_000, 500, 0]),
        ([0, 0, 0.5], [0, 500, -1_000]),
    ]:
        waypoint = env.episode.waypoint_of(np.array(action, np.float32))
        np.testing.assert_allclose(waypoint, position + offset)
    # -1 backs out, here as far as the wall y = 0 allows; depth is kept 300 m inside the box.
    assert env.episode.waypoint_of(np.array([-1, 0, 0], np.float32))[1] == 0.0
    assert env.episode.waypoint_of(np.array([0, 0, 1], np.float32))[2] == 300.0


@both_dimensions
@settings(max_examples=60, deadline=None)
@given(
    offset=st.tuples(st.floats(-15e3, 15e3), st.floats(-8e3, 12e3), st.floats(-1_600, 1_600)),
)
def test_far_waypoints_are_steered_at(dimensions: int, offset: tuple[float, ...]) -> None:
    start = [10_000, 8_000, (dimensions - 2) * 2_000]
    env = in_open_water(
        dimensions,
        missions=[{"start_m": start, "goal_m": [10e3, 19e3, start[2]]}],
        episode={"waypoint_margin_m": 0.0},
    )
    wanted = np.array(offset) * [1, 1, dimensions - 2]
    action = env.action_for(env.episode.position + wanted)
    assert env.action_space.contains(action)
    flown = env.episode.waypoint_of(action) - env.episode.position
    # On the way to it, or there if it is within reach.
    scale = np.linalg.norm(flown) / max(np.linalg.norm(wanted), 1e-9)
    np.testing.assert_allclose(flown, min(scale, 1.0) * wanted, atol=0.01)
    if np.abs(wanted[[0, 2]]).max() <= 2_000 and -1_000 <= wanted[1] <= 2_000:
        np.testing.assert_allclose(flown, wanted, atol=0.01)


@pytest.mark.parametrize(
    ("waypoint", "message"),
    [
        ([0, 0], r"waypoint has shape \(2,\): must be \(3,\)"),
        ([[0, 0, 0]], r"waypoint has shape \(1, 3\)"),
        ([0, np.nan, 0], r"waypoint\[1\] = NaN: must be finite"),
        ("goal", "waypoint must be numbers"),
        (None, "waypoint must be numbers"),
    ],
)
def test_a_wrong_waypoint_is_named(waypoint: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        in_open_water().action_for(waypoint)


# --- settings ----------------------------------------------------------------------------------


@every_id
def test_an_unknown_setting_lists_the_known_ones(env_id: str) -> None:
    message = r"unknown setting 'dificulty'; did you mean 'difficulty'\? \(there are: .*scenario"
    with pytest.raises(TypeError, match=message):
        environment_class(env_id)(dificulty="easy")
    with pytest.raises(TypeError, match=message):
        make(env_id, dificulty="easy")
    with pytest.raises(TypeError, match=r"unknown setting 'zzz' \(there are: action_mode"):
        environment_class(env_id)(zzz=1)


BAD_SETTINGS: dict[str, tuple[dict[str, Any], type[Exception], str]] = {
    "two ratios": (
        {"current_ratio": 0.1, "ring_ratio": 0.1},
        ValueError,
        "ring_ratio.*current_ratio",
    ),
    "scenario and parameter": (
        {"scenario": "lfhh-2d-1", "difficulty": "easy"},
        ValueError,
        "difficulty is for drawn worlds: leave it out when a scenario is given",
    ),
    "mission without scenario": ({"mission": 1}, ValueError, "mission = 1: needs a scenario"),
    "no such mission": (
        {"scenario": "lfhh-2d-1", "mission": 3},
        ValueError,
        r"mission = 3: the scenario has missions 0 \.\. 2",
    ),
    "negative mission": ({"scenario": "lfhh-2d-1", "mission": -1}, ValueError, "mission = -1"),
    "fractional mission": ({"mission": 0.5}, ValueError, "mission = 0.5: must be an integer"),
    "dimensions": (
        {"scenario": "lfhh-3d-1"},
        ValueError,
        "'lfhh-3d-1' has 3 dimensions: this environment needs 2",
    ),
    "unknown scenario": ({"scenario": "lfhh-2d1"}, ValueError, "did you mean 'lfhh-2d-1'"),
    "missing file": ({"scenario": "no/such.toml"}, FileNotFoundError, "no/such.toml"),
    "not a scenario": ({"scenario": 5}, TypeError, "scenario is a int"),
    "difficulty": ({"difficulty": "nope"}, ValueError, "`nope`.*`easy`, `normal`, `hard`"),
    "variant": ({"variant": "nope"}, ValueError, "`nope`.*`debiased`"),
    "peaks on a plane": ({"peaks": 3}, ValueError, "peaks.*only families in 3-D"),
    "negative ratio": ({"current_ratio": -1.0}, ValueError, "current_ratio = -1"),
    "NaN": ({"time_factor": float("nan")}, ValueError, "time_factor = nan"),
    "too short": ({"time_factor": 0.5}, ValueError, "time_factor = 0.5: must be at least 1"),
    "standing still": ({"vehicle_speed_mps": 0.0}, ValueError, "speed_mps = 0: must be greater"),
    "too many": ({"obstacles": 10**6}, ValueError, "obstacles = 1000000: at most"),
    "fractional count": ({"obstacles": 1.5}, ValueError, "1.5"),
    "an object": ({"obstacles": object()}, ValueError, "obstacles = <object"),
    "action mode": ({"action_mode": "nope"}, ValueError, "action_mode = 'nope': must be"),
    "render mode": ({"render_mode": "ansi"}, ValueError, "render_mode = 'ansi': must be"),
}


@pytest.mark.parametrize("case", BAD_SETTINGS)
def test_wrong_settings_are_named_when_the_environment_is_made(case: str) -> None:
    arguments, kind, message = BAD_SETTINGS[case]
    with pytest.raises(kind, match=message):
        bare(2, **arguments)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"episode_seed": -1}, "episode_seed = -1: must lie in 0"),
        ({"episode_seed": 2**64}, f"episode_seed = {2**64}: must lie in 0"),
        ({"episode_seed": "x"}, "episode_seed = 'x': must be an integer"),
        ({"episode": 3}, r"unknown option 'episode'; did you mean 'episode_seed'"),
    ],
)
def test_wrong_options_of_reset_are_named(options: Any, message: str) -> None:
    env = bare()
    env.reset(seed=0)
    before = env.episode.save()
    with pytest.raises(ValueError, match=message):
        env.reset(options=options)
    assert env.episode.save() == before


def test_settings_change_the_world() -> None:
    def told(dimensions: int = 2, **settings: Any) -> dict[str, Any]:
        env = bare(dimensions, **settings)
        env.reset(seed=1)
        return env.world.scenario.to_dict()

    assert len(told(obstacles=3)["obstacles"]) == 3
    assert len(told(vortices=2)["currents"][0]["vortices"]) == 2
    assert len(told(3, peaks=4)["seabed"]["peaks"]) == 4
    assert told(vehicle_speed_mps=1.25)["vehicle"]["speed_mps"] == 1.25
    assert told(time_factor=2.5)["limits"]["time_factor"] == 2.5
    assert told(change_every_m=3_000)["change"]["every_m"] == 3_000
    assert "change" not in told(change_every_m=0)
    speeds = [obstacle["velocity_mps"] for obstacle in told(obstacle_speed_mps=0.5)["obstacles"]]
    np.testing.assert_allclose(np.linalg.norm(speeds, axis=1), 0.5)
    drifts = [v["drift_mps"] for v in told(vortex_drift_mps=0.25)["currents"][0]["vortices"]]
    np.testing.assert_allclose(np.linalg.norm(drifts, axis=1), 0.25)
    assert told(difficulty="easy")["currents"] != told(difficulty="hard")["currents"]
    assert told(variant="paper") != told(variant="debiased")


@pytest.mark.parametrize("name", auvgym.list_scenarios())
def test_a_scenario_by_name_by_path_and_by_itself(name: str, tmp_path: Path) -> None:
    scenario = auvgym.World(name).scenario
    last = scenario.missions - 1
    path = tmp_path / "own.toml"
    scenario.save(path)
    seen = []
    for given_as in (name, str(path), path, scenario):
        env = bare(scenario.dimensions, scenario=given_as, mission=last)
        observation, _ = env.reset(seed=4)
        assert np.array_equal(env.world.goal, auvgym.World(name, mission=last).goal)
        seen.append((observation.tobytes(), *fly(env, 15)))
    assert all(other == seen[0] for other in seen)


# --- an episode --------------------------------------------------------------------------------


@every_id
def test_info_says_what_happened_in_si_units(env_id: str) -> None:
    still = {"current_ratio": 0.0} if env_id in REFUSED else {"vortices": 0}
    env = environment_class(env_id)(**known(env_id, change_every_m=0, **still))
    _, info = env.reset(seed=0)
    assert {key: type(info[key]) for key in INFO} == INFO
    assert set(info) == {*INFO, "episode_seed"}
    assert (info["time_s"], info["energy_j"], info["path_length_m"]) == (0.0, 0.0, 0.0)
    assert info["distance_to_goal_m"] == pytest.approx(
        np.linalg.norm(env.world.goal - env.world.start)
    )
    vehicle = env.world.scenario.to_dict()["vehicle"]
    speed = vehicle["speed_mps"]
    power_w = vehicle["hotel_power_w"] + vehicle["propulsion_w_per_mps3"] * speed**3
    terminated = False
    while not terminated:
        _, _, terminated, truncated, info = env.step(to_goal(env))
        assert truncated is False
        assert {key: type(value) for key, value in info.items()} == INFO
        episode, trail = env.episode, env.episode.trail
        assert np.array_equal(trail[-1], episode.position)
        assert np.array_equal(trail[0], env.world.start)
        assert info["time_s"] == pytest.approx((len(trail) - 1) * episode.tick_s)
        steps = np.linalg.norm(np.diff(trail, axis=0), axis=1)
        assert info["path_length_m"] == pytest.approx(steps.sum())
        # Full speed through still water at the power that takes, always.
        assert steps.max() <= speed * episode.tick_s + 1e-6
        assert info["energy_j"] == pytest.approx(power_w * info["time_s"])
        assert info["min_clearance_m"] == pytest.approx(env.world.clearance(trail).min())
        to_go = np.linalg.norm(env.world.goal - episode.position)
        assert info["distance_to_goal_m"] == pytest.approx(to_go)
        assert info["is_success"] == (info["outcome"] == "goal")
        assert terminated == (info["outcome"] != "running")
    assert info["map_changes"] == 0
    assert info["map_changed"] is False


def test_planning_is_charged_to_the_episode() -> None:
    env = in_open_water()
    env.charge(evaluations=500, replans=1)
    env.charge(evaluations=20)
    *_, info = env.step(to_goal(env))
    assert (info["evaluations"], info["replans"]) == (520, 1)
    _, info = env.reset()
    assert (info["evaluations"], info["replans"]) == (0, 0)


def against(speed: float) -> list[dict[str, Any]]:
    return [{"kind": "uniform", "velocity_mps": [0.0, -speed]}]


PATIENT = {"time_factor": 9.0, "energy_factor": 9.0}
OUTCOMES: dict[str, dict[str, Any]] = {
    "goal": {},
    "collision": {"obstacles": [wall()]},
    "out_of_bounds": {
        "currents": [{"kind": "uniform", "velocity_mps": [3.0, 0.0]}],
        "limits": PATIENT,
    },
    "timeout": {"currents": against(1.0), "limits": {"time_factor": 1.5, "energy_factor": 9.0}},
    "energy": {"currents": against(1.0), "limits": {"time_factor": 9.0, "energy_factor": 1.5}},
}


@both_dimensions
@pytest.mark.parametrize("outcome", OUTCOMES)
def test_every_outcome_is_reached(dimensions: int, outcome: str) -> None:
    env = in_open_water(dimensions, **OUTCOMES[outcome])
    total, terminated = 0.0, False
    info: dict[str, Any] = {}
    while not terminated:
        _, reward, terminated, _, info = env.step(to_goal(env))
        total += reward
    assert info["outcome"] == outcome
    assert info["is_success"] == (outcome == "goal")
    assert (total > 1) if outcome == "goal" else (total < 0)
    episode, (low, high) = env.episode, env.world.domain
    outside = (episode.position < low - 500) | (episode.position > high + 500)
    ends = {
        "goal": info["distance_to_goal_m"] <= 300,
        "collision": info["min_clearance_m"] <= 0,
        "out_of_bounds": outside.any(),
        "timeout": info["time_s"] >= episode.time_limit_s,
        "energy": info["energy_j"] >= episode.energy_budget_j,
    }
    assert [name for name, met in ends.items() if met] == [outcome]


def test_a_seabed_and_a_surface() -> None:
    env = in_open_water(3, seabed={"kind": "flat", "depth_m": 3_000.0})
    info: dict[str, Any] = {"outcome": "running"}
    while info["outcome"] == "running":
        *_, info = env.step(np.array([0.0, 0.0, -1.0], np.float32))
    assert info["outcome"] == "collision"  # waypoints reach to 300 m above the box's own bottom
    assert env.episode.position[2] >= 3_000
    env.reset()
    for _ in range(5):
        env.step(np.array([-0.33, 0.0, 1.0], np.float32))
    assert env.episode.outcome == "running"
    assert env.episode.trail[:, 2].min() >= 0.0  # nobody flies


def test_the_current_moves_every_vehicle() -> None:
    env = in_open_water(currents=[{"kind": "uniform", "velocity_mps": [0.9, 0.3]}])
    env.step(to_goal(env))
    trail = env.episode.trail
    through_water = np.diff(trail, axis=0) / env.episode.tick_s - [0.9, 0.3, 0.0]
    np.testing.assert_allclose(np.linalg.norm(through_water, axis=1), 2.0)
    # Guidance crabs: over ground it runs straight at the goal.
    np.testing.assert_allclose(trail[:, 0], 10_000, atol=1e-6)


@every_id
def test_the_reward_orders_policies_as_the_leaderboard_does(env_id: str) -> None:
    env = make(env_id)
    arrived: list[float] = []
    failed: list[float] = []
    seeds = {
        "straight": range(30),
        "random": range(12),
        "sonar-rule": range(12),
        "astar-replan": range(5),
    }
    for name, episodes in seeds.items():
        policy = policies.make(name)
        for seed in episodes:
            observation, info = env.reset(seed=seed)
            policy.reset(env)
            total, terminated = 0.0, False
            while not terminated:
                action = policy.act(observation, info)
                observation, reward, terminated, _, info = env.step(action)
                total += reward
            (arrived if info["is_success"] else failed).append(total)
    assert len(arrived) >= 3
    assert len(failed) >= 20
    assert max(failed) < 0 < 1 < min(arrived)


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(0, 2**32),
    time_factor=st.floats(1.0, 4.0),
    ratio=st.floats(0.0, 1.5),
    aim=st.floats(0, 1),
)
def test_no_failure_outscores_an_arrival(
    seed: int, time_factor: float, ratio: float, aim: float
) -> None:
    env = bare(2, time_factor=time_factor, current_ratio=ratio, obstacles=4)
    env.reset(seed=seed)
    random = np.random.default_rng(seed)
    total, terminated = 0.0, False
    info: dict[str, Any] = {}
    while not terminated:
        action = aim * to_goal(env) + (1 - aim) * random.uniform(-1, 1, 2)
        _, reward, terminated, _, info = env.step(action.astype(np.float32))
        total += reward
    assert (total > 1) if info["is_success"] else (total < 0)


@pytest.mark.parametrize("env_id", [env_id for env_id in IDS if env_id not in REFUSED])
def test_a_map_change_ends_the_leg(env_id: str) -> None:
    every_m = EVERY_M[env_id]
    env = environment_class(env_id)(obstacles=0, change_every_m=every_m)
    changes = 0
    for seed in range(4):
        env.reset(seed=seed)
        terminated = False
        before = 0
        while not terminated:
            since = env.episode.distance_since_change_m
            *_, terminated, _, info = env.step(to_goal(env))
            tick = np.linalg.norm(np.diff(env.episode.trail[-2:], axis=0))
            if info["map_changed"]:
                assert info["map_changes"] == before + 1 == env.world.changes
                assert env.episode.distance_since_change_m == 0.0
                changes += 1
            else:
                assert info["map_changes"] == before
                assert env.episode.distance_since_change_m > since
                # It would have changed at the end of the tick that passed 6 km.
                assert env.episode.distance_since_change_m < every_m + (tick if terminated else 0)
            before = info["map_changes"]
        assert info["map_changes"] == int(info["path_length_m"] // every_m) or terminated
    assert changes >= 12


def test_the_observation_after_a_change_is_that_of_the_new_map() -> None:
    env = bare(2, obstacles=0)
    env.reset(seed=0)
    changed = False
    while not changed:
        observation, _, terminated, _, info = env.step(to_goal(env))
        assert not terminated
        changed = info["map_changed"]
    here = env.world.current([env.episode.position])[0, :2] / 2.0
    forward = observation[env.observation_layout["frame"]].astype(float)
    along = np.clip(here @ forward, -2, 2)
    assert observation[env.observation_layout["current"]][0] == pytest.approx(along, abs=1e-6)
    assert observation[env.observation_layout["change_distance"]][0] == 0.0
    assert observation[env.observation_layout["change_time"]][0] == 0.0


# --- copies and replays ------------------------------------------------------------------------

COPIES = {
    "deepcopy": copy.deepcopy,
    "pickle": lambda env: pickle.loads(pickle.dumps(env)),
}


@every_id
@pytest.mark.parametrize("way", COPIES)
@pytest.mark.parametrize("when", ["made", "begun", "changed", "ended"])
def test_copies_of_a_running_environment_go_on_identically(
    env_id: str, way: str, when: str
) -> None:
    settings = {"obstacle_speed_mps": 0.3, "vortex_drift_mps": 0.2, "difficulty": "easy"}
    settings |= {"obstacles": 5, "change_every_m": EVERY_M[env_id]}
    env = make(env_id, **known(env_id, **settings))
    changes = 0 if env_id in REFUSED else 2
    core = env.unwrapped
    if when == "made":
        copied = COPIES[way](env)
        assert env.reset(seed=9)[0].tobytes() == copied.reset(seed=9)[0].tobytes()
    else:
        reached = {
            "begun": lambda: core.episode.time_s > 0,
            "changed": lambda: core.world.changes >= changes and core.episode.outcome == "running",
            "ended": lambda: core.episode.outcome != "running",
        }[when]
        env.reset(seed=9)
        while not reached():
            if core.episode.outcome != "running":
                env.reset()
            env.step(to_goal(env))
        copied = COPIES[way](env)
        assert copied.unwrapped.episode.save() == core.episode.save()
        if when == "ended":
            assert env.reset()[0].tobytes() == copied.reset()[0].tobytes()
    assert type(copied) is type(env)
    before = copied.unwrapped.episode.save()
    flown = fly(env, 70, seed=3)
    assert copied.unwrapped.episode.save() == before, "the copy must not be dragged along"
    assert fly(copied, 70, seed=3) == flown


@every_id
def test_actions_replayed_from_the_episodes_seed_give_the_same_bytes(env_id: str) -> None:
    drawn = known(env_id, difficulty="easy", obstacles=5, change_every_m=EVERY_M[env_id])
    env = make(env_id, **drawn)
    env.reset(seed=5)
    env.reset()
    _, first = env.reset()
    flown = []
    terminated = False
    while not terminated:
        observation, reward, terminated, _, info = env.step(to_goal(env))
        flown.append((observation.tobytes(), reward, terminated, info))
    actions, trail = env.unwrapped.episode.actions, env.unwrapped.episode.trail
    assert actions.dtype == np.float32
    assert actions.shape == (len(flown), env.unwrapped.dimensions)

    other = make(env_id, **drawn)
    _, info = other.reset(options={"episode_seed": first["episode_seed"]})
    assert info == first
    again = []
    for action in actions:
        observation, reward, terminated, _, info = other.step(action)
        again.append((observation.tobytes(), reward, terminated, info))
    assert again == flown
    assert np.array_equal(other.unwrapped.episode.trail, trail)
    assert flown[-1][3]["map_changes"] >= (0 if env_id in REFUSED else 3)


def test_an_episode_seed_may_be_any_64_bit_number() -> None:
    env = bare()
    seen = set()
    for episode_seed in (0, 1, 2**63, 2**64 - 1):
        observation, info = env.reset(options={"episode_seed": episode_seed})
        assert info["episode_seed"] == episode_seed == env.episode.seed
        seen.add(observation.tobytes())
    assert len(seen) == 4


def test_broken_bytes_are_no_episode() -> None:
    env = in_open_water(obstacles=[disc(5_000, 9_000, 500)])
    env.step(to_goal(env))
    whole = env.episode.save()
    load = type(env.episode).load
    assert load(whole).save() == whole
    for broken in (b"", b"nonsense", whole[:-7], whole[: len(whole) // 2]):
        with pytest.raises(ValueError, match=r"saved episode|TOML|missing"):
            load(broken)
