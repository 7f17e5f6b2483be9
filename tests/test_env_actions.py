"""Environments: actions and settings, right and wrong."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from env_flights import (
    bare,
    both_dimensions,
    environment_class,
    every_id,
    fly,
    in_open_water,
    make,
    to_goal,
)
from gymnasium.error import ResetNeeded
from hypothesis import given, settings
from hypothesis import strategies as st
from small_worlds import DEPTH

import auvgym
from auvgym import ActionError

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
