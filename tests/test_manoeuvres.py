"""Threats that manoeuvre: in a scenario file, drawn, flown among, and never foreseen."""

from __future__ import annotations

import math
from typing import Any

import gymnasium
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_worlds import open_water, sphere

import auvgym
from auvgym import Scenario, policies

TURN = {"kind": "turn", "rate_radps": 0.002}
ZIGZAG = {"kind": "zigzag", "angle_rad": 0.7, "period_s": 600.0}
LEGS = {
    "kind": "legs",
    "legs": [
        {"from_s": 500.0, "velocity_mps": [0.0, -2.0, 0.1]},
        {"from_s": 900.0, "velocity_mps": [0.0, 0.0, 0.0]},
    ],
}


def scenario(manoeuvre: dict[str, Any] | None, velocity: Any = (1.5, 0.0, 0.0)) -> Scenario:
    threat = sphere([6_000.0, 9_000.0, 2_000.0], 700.0, velocity)
    if manoeuvre is not None:
        threat["manoeuvre"] = manoeuvre
    return Scenario.from_dict(open_water(3, obstacles=[threat]))


def places(world: auvgym.World, times: Any) -> np.ndarray[Any, Any]:
    found = []
    for time_s in times:
        world.time_s = float(time_s)
        found.append(world.snapshot()["obstacles"][0]["position_m"])
    return np.array(found)


def test_a_file_keeps_it_and_without_it_nothing_changes() -> None:
    for manoeuvre in (TURN, ZIGZAG, LEGS):
        one = scenario(manoeuvre)
        assert Scenario.from_toml(one.to_toml()) == one
        assert one.to_dict()["obstacles"][0]["manoeuvre"] == manoeuvre
        assert one.hash != scenario(None).hash
    assert "manoeuvre" not in scenario(None).to_toml()


def test_courses_by_hand() -> None:
    turning = auvgym.World(scenario(TURN))
    # A circle of 1.5 / 0.002 = 750 m about a point beside the start, to the side of growing y.
    times = np.linspace(0.0, 2.0 * math.pi / 0.002, 50)
    radii = np.linalg.norm(places(turning, times) - [6_000.0, 9_750.0, 2_000.0], axis=1)
    assert np.allclose(radii, 750.0)
    zigzag = auvgym.World(scenario(ZIGZAG))
    (quarter, whole) = places(zigzag, [150.0, 600.0]) - [6_000.0, 9_000.0, 2_000.0]
    assert np.allclose(quarter, [225.0 * math.cos(0.7), 225.0 * math.sin(0.7), 0.0])
    assert np.allclose(whole, [900.0 * math.cos(0.7), 0.0, 0.0])
    legs = places(auvgym.World(scenario(LEGS)), [500.0, 900.0, 5_000.0]) - [6e3, 9e3, 2e3]
    assert np.allclose(legs, [[750, 0, 0], [750, -800, 40], [750, -800, 40]])


@settings(max_examples=40, deadline=None)
@given(
    st.sampled_from([TURN, ZIGZAG, LEGS]),
    st.lists(st.floats(-3.0, 3.0), min_size=3, max_size=3),
    st.lists(st.floats(0.0, 1e6), min_size=1, max_size=8),
)
def test_it_keeps_to_the_box_and_to_its_speed_and_time_runs_either_way(
    manoeuvre: dict[str, Any], velocity: list[float], times: list[float]
) -> None:
    velocity[0] = velocity[0] or 1.0
    world = auvgym.World(scenario(manoeuvre, velocity))
    low, high = world.domain
    there = places(world, times)
    assert np.all((there >= low) & (there <= high))
    assert np.array_equal(there, places(world, times[::-1])[::-1])
    fastest = max(float(np.linalg.norm(velocity)), 2.0 if manoeuvre is LEGS else 0.0, 1e-9)
    later = places(world, np.add(times, 10.0))
    assert np.all(np.linalg.norm(later - there, axis=1) <= 10.1 * fastest + 1e-6)


def test_the_velocity_that_is_told_is_the_present_one() -> None:
    world = auvgym.World(scenario(ZIGZAG))
    for time_s in (10.0, 200.0, 5_000.0, 40_000.0):
        before, after = places(world, [time_s - 0.5, time_s + 0.5])
        world.time_s = time_s
        told = world.snapshot()["obstacles"][0]
        assert np.allclose(told["velocity_mps"], after - before, atol=1e-6)
        # What it will do next is no part of the map.
        assert "manoeuvre" not in told


@pytest.mark.parametrize(
    ("manoeuvre", "velocity", "message"),
    [
        ({"kind": "loop"}, (1, 0, 0), "loop"),
        ({"kind": "turn", "rate_radps": 0.0}, (1, 0, 0), r"rate_radps = 0: must not be 0"),
        (TURN, (0, 0, 1), r"obstacles\[0\]\.manoeuvre.*needs a velocity_mps"),
        ({**ZIGZAG, "period_s": 0.0}, (1, 0, 0), r"period_s = 0: must be at least 0\.001"),
        ({**ZIGZAG, "period": 1.0}, (1, 0, 0), "period"),
        (
            {"kind": "legs", "legs": [{"from_s": -1.0, "velocity_mps": [0, 0, 0]}]},
            (1, 0, 0),
            r"legs\[0\]\.from_s = -1: must be greater than 0",
        ),
        (
            {"kind": "legs", "legs": [LEGS["legs"][1], LEGS["legs"][0]]},  # type: ignore[index]
            (1, 0, 0),
            r"legs\[1\]\.from_s = 500: must be later",
        ),
    ],
)
def test_what_is_not_allowed_is_named(manoeuvre: Any, velocity: Any, message: str) -> None:
    with pytest.raises(auvgym.ScenarioError, match=message):
        scenario(manoeuvre, velocity)


def test_discs_stay_on_the_map() -> None:
    disc = {"kind": "disc", "position_m": [3e3, 9e3], "radius_m": 300.0, "velocity_mps": [1, 0]}
    legs = [{"from_s": 5.0, "velocity_mps": [0.0, 1.0, 1.0]}]
    with pytest.raises(auvgym.ScenarioError, match="a disc, which moves on the map only"):
        Scenario.from_dict(
            open_water(2, obstacles=[{**disc, "manoeuvre": {"kind": "legs", "legs": legs}}])
        )
    turning = Scenario.from_dict(open_water(2, obstacles=[{**disc, "manoeuvre": TURN}]))
    there = places(auvgym.World(turning), [math.pi / 0.002])[0]
    assert np.allclose(there[:2], [3e3, 10e3])


def test_drawn_threats_manoeuvre_if_asked_to_and_the_flow_passes_them() -> None:
    plain = Scenario.generate("iifds", 3)
    assert Scenario.generate("iifds", 3, manoeuvres="none") == plain
    kinds = {
        one["manoeuvre"]["kind"]
        for seed in range(6)
        for one in Scenario.generate("iifds", seed, manoeuvres="mixed").to_dict()["obstacles"]
    }
    assert kinds == {"turn", "zigzag"}
    env: Any = gymnasium.make("auvgym:AUVThreat3D-v0", manoeuvres="mixed", difficulty="hard")
    arrived = {"straight": 0, "iifds-reactive": 0}
    for name in arrived:
        for seed in range(15):
            policy = policies.make(name)
            observation, info = env.reset(options={"episode_seed": seed})
            policy.reset(env)
            while info["outcome"] == "running":
                observation, _, _, _, info = env.step(policy.act(observation, info))
            arrived[name] += info["is_success"]
    assert arrived["iifds-reactive"] >= 14 > 8 > arrived["straight"]
    with pytest.raises(ValueError, match="manoeuvres: unknown variant `wild`"):
        Scenario.generate("iifds", 1, manoeuvres="wild")
    with pytest.raises(ValueError, match=r"manoeuvres.*only the threats"):
        Scenario.generate("lfhh-3d", 1, manoeuvres="turn")
