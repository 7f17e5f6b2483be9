"""Environments: episodes from departure to their end, copied and replayed."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import numpy as np
import pytest
from env_flights import (
    EVERY_M,
    IDS,
    INFO,
    REFUSED,
    bare,
    both_dimensions,
    environment_class,
    every_id,
    fly,
    in_open_water,
    known,
    make,
    to_goal,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from small_worlds import disc, wall

from auvgym import policies

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
