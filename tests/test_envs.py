"""Environments: whatever is registered keeps Gymnasium's contract and its own specification."""

from __future__ import annotations

import inspect
import re
import warnings
from typing import Any

import gymnasium
import numpy as np
import pytest
from env_flights import (
    FAILURES,
    INFO,
    ONLY_IN,
    REFUSED,
    bare,
    both_dimensions,
    environment_class,
    every_id,
    fly,
    known,
    make,
    to_goal,
)
from gymnasium.utils.env_checker import check_env
from hypothesis import given, settings
from hypothesis import strategies as st

from auvgym.envs import AUVEnv

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
