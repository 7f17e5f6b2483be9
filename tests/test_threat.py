"""AUVThreat3D-v0: threats that move while one flies, seen with noise; who gets past them."""

from __future__ import annotations

import copy
import dataclasses
import pickle
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt
import pytest
from small_worlds import open_water, sphere, vortices

import auvgym
from auvgym import Scenario, policies
from auvgym.navigation import navigator
from auvgym.reproduction import (
    CardError,
    Outcome,
    list_cards,
    load_card,
    plots,
    raster_astar,
    scenes,
    write_card,
)
from auvgym.reproduction.card import check_picture
from auvgym.reproduction.measures import of_path
from auvgym.reproduction.runs import execute
from auvgym.reproduction.threats import flight

Array = npt.NDArray[Any]


def make(environment: str = "AUVThreat3D-v0", **settings: Any) -> Any:
    return gymnasium.make(f"auvgym:{environment}", **settings)


def fly(env: Any, policy: Any, episode_seed: int) -> tuple[dict[str, Any], Array]:
    """One episode: the last info, and every observation, (n, entries)."""
    observation, info = env.reset(options={"episode_seed": episode_seed})
    policy.reset(env)
    seen = [observation]
    while info["outcome"] == "running":
        observation, _, _, _, info = env.step(policy.act(observation, info))
        seen.append(observation)
    return info, np.array(seen)


def arrivals(policy: str, episodes: int, parameters: Any = None, **settings: Any) -> int:
    env = make(**settings)
    flown = [
        fly(env, policies.make(policy, **(parameters or {})), seed)[0] for seed in range(episodes)
    ]
    assert all(info["min_clearance_m"] > 0.0 for info in flown if info["is_success"])
    return sum(info["is_success"] for info in flown)


def drawn(family: str, **parameters: Any) -> dict[str, Any]:
    return Scenario.generate(family, 3, **parameters).to_dict()


# --- The sensor ----------------------------------------------------------------------------------


def test_noise_disturbs_the_obstacles_alone_by_what_is_asked_for() -> None:
    noisy, exact = make(), make(sensor_noise_m=0.0)
    where = noisy.unwrapped.observation_layout["obstacles"]
    offsets, velocities = [], []
    for seed in range(20):
        _, disturbed = fly(noisy, policies.make("straight"), seed)
        _, true = fly(exact, policies.make("straight"), seed)
        rest = np.delete(np.arange(true.shape[1]), np.r_[where])
        assert np.array_equal(disturbed[:, rest], true[:, rest])
        a, b = (block[:, where].reshape(-1, 7).astype(np.float64) for block in (disturbed, true))
        assert np.array_equal(a[:, 3], b[:, 3])  # extents
        assert not a[b[:, 3] == 0.0].any()  # nothing is seen where there is nothing
        # An entry of 1 was clipped: how far beyond it something is, nobody sees.
        whole = (b[:, 3] > 0.0) & (np.abs(np.column_stack([a, b])) < 1.0).all(axis=1)
        offsets.append(3000.0 * (a - b)[whole, :3])
        velocities.append(2.0 * (a - b)[whole, 4:])
    off, speed = np.concatenate(offsets), np.concatenate(velocities)
    assert len(off) > 300
    assert np.allclose(off.std(axis=0), 20.0, rtol=0.1)
    assert np.allclose(speed.std(axis=0), np.sqrt(2) * 20.0 / 60.0, rtol=0.1)
    assert np.all(np.abs(off.mean(axis=0)) < 3.0)


def test_looking_twice_shows_the_same_and_the_seed_decides() -> None:
    env = make()
    first, _ = env.reset(options={"episode_seed": 5})
    core = env.unwrapped.episode
    assert np.array_equal(first, core.observe())
    assert np.array_equal(first, core.observe())
    again, _ = env.reset(options={"episode_seed": 5})
    assert np.array_equal(first, again)
    assert not np.array_equal(first, env.reset(options={"episode_seed": 6})[0])


@pytest.mark.parametrize("way", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])
def test_copies_go_on_with_the_same_noise(way: Any) -> None:
    env = make().unwrapped
    env.reset(seed=2)
    ahead = np.array([0.6, 0.1, 0.0], np.float32)
    for _ in range(5):
        env.step(ahead)
    other = way(env)
    for _ in range(10):
        (a, *rest), (b, *others) = env.step(ahead), other.step(ahead)
        assert np.array_equal(a, b)
        assert rest == others


def test_every_environment_can_be_made_noisy_and_only_this_one_is() -> None:
    for family in ("lfhh-2d", "lfhh-3d", "afhh"):
        assert "sensor_noise_m" not in drawn(family)["episode"]
        assert drawn(family, sensor_noise_m=7.0)["episode"]["sensor_noise_m"] == 7.0
    assert drawn("iifds")["episode"]["sensor_noise_m"] == 20.0
    for environment in ("AUVDynamic2D-v0", "AUVDynamic3D-v0"):
        plain, noisy = make(environment), make(environment, sensor_noise_m=50.0)
        _, a = fly(plain, policies.make("straight"), 1)
        _, b = fly(noisy, policies.make("straight"), 1)
        where = plain.unwrapped.observation_layout["obstacles"]
        rest = np.delete(np.arange(a.shape[1]), np.r_[where])
        assert np.array_equal(a[:, rest], b[:, rest])
        assert not np.array_equal(a[:, where], b[:, where])


def test_noise_is_part_of_the_scenario_and_none_leaves_its_text_as_it_was() -> None:
    plain = Scenario.from_dict(open_water(3))
    zero = Scenario.from_dict(open_water(3, episode={"sensor_noise_m": 0.0}))
    assert zero.hash == plain.hash
    assert Scenario.from_dict(open_water(3, episode={"sensor_noise_m": 5.0})).hash != plain.hash
    with pytest.raises(auvgym.ScenarioError, match=r"sensor_noise_m = -1.*must not be negative"):
        Scenario.from_dict(open_water(3, episode={"sensor_noise_m": -1.0}))
    with pytest.raises(ValueError, match="sensor_noise_m"):
        Scenario.generate("iifds", 1, sensor_noise_m=-1.0)


# --- The world -----------------------------------------------------------------------------------


def test_threats_move_while_a_short_leg_is_flown() -> None:
    env = make()
    env.reset(seed=4)
    core, before = env.unwrapped, 0.0
    for _ in range(20):
        there = [np.array(one["position_m"]) for one in core.world.snapshot()["obstacles"]]
        _, _, ended, _, info = env.step(core.action_for(core.world.goal))
        if ended:
            break
        leg, before = info["time_s"] - before, info["time_s"]
        assert 3.0 <= leg <= 60.0
        here = [np.array(one["position_m"]) for one in core.world.snapshot()["obstacles"]]
        moved = [float(np.linalg.norm(b - a)) for a, b in zip(there, here, strict=True)]
        # No faster than 3.5 m/s, but none stands still.
        assert all(0.0 < way <= 3.5 * leg + 1e-6 for way in moved)


@pytest.mark.parametrize("difficulty", ["easy", "normal", "hard"])
def test_the_straight_line_seldom_arrives_and_the_flow_nearly_always(difficulty: str) -> None:
    assert arrivals("straight", 40, difficulty=difficulty) < 20
    assert arrivals("iifds-reactive", 10, difficulty=difficulty) == 10


# --- The navigator and its policy ----------------------------------------------------------------


def test_the_papers_rules_arrive_less_often() -> None:
    paper = arrivals("iifds-reactive", 20, {"rules": "paper"}, difficulty="hard")
    assert 5 <= paper < arrivals("iifds-reactive", 20, difficulty="hard")


@pytest.mark.parametrize("difficulty", ["easy", "hard"])
def test_it_decides_anew_at_every_tick(difficulty: str) -> None:
    env, policy = make(difficulty=difficulty), policies.make("iifds-reactive")
    observation, info = env.reset(seed=1)
    policy.reset(env)
    tick, ended = env.unwrapped.world.scenario.to_dict()["episode"]["tick_s"], False
    while not ended:
        before = info["time_s"]
        observation, _, ended, _, info = env.step(policy.act(observation, info))
        assert info["time_s"] - before == pytest.approx(tick)
    assert info["is_success"]


@pytest.mark.parametrize("scenario", ["iifds-threat1", "iifds-threats3", "iifds-complex"])
def test_the_papers_missions(scenario: str) -> None:
    env = make(scenario=scenario)
    assert fly(env, policies.make("straight"), 0)[0]["outcome"] == "collision"
    info, _ = fly(env, policies.make("iifds-reactive"), 0)
    assert info["is_success"]
    assert info["min_clearance_m"] > 20.0


def test_what_rests_on_the_map_is_no_threat() -> None:
    rock = sphere([10_000, 9_000, 2_000], 1_500.0)
    env = make(
        "AUVDynamic3D-v0",
        scenario=Scenario.from_dict(open_water(3, obstacles=[rock], limits={"time_factor": 2.0})),
    )
    policy: Any = policies.make("iifds-reactive")
    info, seen = fly(env, policy, 0)
    assert seen[:, env.unwrapped.observation_layout["obstacles"]].any()
    assert info["is_success"]
    assert not policy._navigator.threats(0.0)


def test_it_flies_the_other_worlds_too() -> None:
    for dimensions in (2, 3):
        still = open_water(dimensions, currents=[vortices((9e3, 9e3, 2e3))])
        env = make(f"AUVDynamic{dimensions}D-v0", scenario=Scenario.from_dict(still))
        assert fly(env, policies.make("iifds-reactive"), 0)[0]["is_success"]


def test_a_navigator_follows_what_it_sees() -> None:
    world = auvgym.World("iifds-threat1")
    pilot = navigator(world, [0, 5e3, 2e3], [1e4, 5e3, 2e3], noise_m=20.0)
    random = np.random.default_rng(0)
    for time_s in range(0, 300, 15):
        x, y, z = np.array([4e3 - 1.5 * time_s, 5e3, 2e3]) + random.normal(0.0, 20.0, 3)
        pilot.see((x, y, z), 700.0, float(time_s))
    ((centre, velocity, radius),) = pilot.threats(300.0)
    assert radius == 700.0
    assert np.linalg.norm(np.subtract(centre, [3550.0, 5e3, 2e3])) < 60.0
    assert np.linalg.norm(np.subtract(velocity, [-1.5, 0.0, 0.0])) < 0.3
    way, waypoint = pilot.course((2e3, 5e3, 2e3), 300.0, 10.0)
    assert np.linalg.norm(way) == pytest.approx(2.0)
    assert np.allclose(waypoint, np.add([2e3, 5e3, 2e3], 10.0 * way))
    assert abs(way[1]) + abs(way[2]) > 0.2  # round it, not through it
    pilot.forget(301.0)
    assert pilot.threats(300.0) == []
    assert np.allclose(pilot.course((2e3, 5e3, 2e3), 300.0, 10.0)[0], [2.0, 0.0, 0.0])


def test_wrong_parameters_are_named() -> None:
    with pytest.raises(auvgym.PlanningError, match=r"unknown field `sare`.*did you mean `share`"):
        policies.make("iifds-reactive", sare=1)
    with pytest.raises(auvgym.PlanningError, match="rules: unknown variant `mine`"):
        policies.make("iifds-reactive", rules="mine")
    with pytest.raises(auvgym.PlanningError, match=r"margin_m = -1"):
        policies.make("iifds-reactive", margin_m=-1.0)
    world = auvgym.World("iifds-threat1")
    with pytest.raises(auvgym.PlanningError, match="goal"):
        navigator(world, goal=[1e6, 0, 0])
    pilot = navigator(world)
    for radius in (0.0, float("nan")):
        with pytest.raises(ValueError, match="radius_m"):
            pilot.see((1.0, 2.0, 3.0), radius, 0.0)
    with pytest.raises(ValueError, match=r"position\[1\]"):
        pilot.course((0.0, float("inf"), 0.0), 0.0, 1.0)


# --- The paper's cards ---------------------------------------------------------------------------


def outcome(card: str, column: str, case: int) -> Any:
    """One run of a card's cell."""
    loaded = load_card(card)
    (found,) = (one for one in loaded.columns if one.label == column)
    done = execute(loaded.run(loaded.cases[case], found, 0))
    assert not isinstance(done, str), done
    return done


def test_columns_make_a_raster_search_turn_and_the_flow_bend() -> None:
    flow, raster, octile = (
        outcome("iifds-astar", column, 0)
        for column in ("IIFDS, as printed", "A*, Manhattan", "A*, octile")
    )
    # The field was searched for so that these are the paper's 15 and 16.8 km.
    assert flow.measures["length_km"] == pytest.approx(15.0, abs=0.01)
    assert raster.measures["length_km"] == pytest.approx(16.8, abs=0.01)
    assert octile.measures["length_km"] == pytest.approx(15.385, abs=0.01)
    assert flow.measures["turn_deg"] < 1.0
    assert raster.measures["turn_deg"] == pytest.approx(45.0)
    assert flow.measures["hits"] == raster.measures["hits"] == 0.0


def test_as_printed_the_flow_runs_into_threats_that_the_recommended_one_avoids() -> None:
    # Least distances and lengths of an independent implementation, km.
    for case, (gap, length) in {0: (0.912, 14.84), 1: (0.979, 14.89), 5: (-0.020, None)}.items():
        printed = outcome("iifds-threats", "as printed", case)
        assert printed.measures["threat_km"] == pytest.approx(gap, abs=0.005)
        assert length is None or printed.measures["length_km"] == pytest.approx(length, abs=0.01)
        assert printed.feasible == (gap > 0.0)
        mended = outcome("iifds-threats", "recommended", case)
        assert mended.feasible
        assert mended.measures["threat_km"] > printed.measures["threat_km"]


def test_measures_by_hand() -> None:
    east = {"kind": "uniform", "velocity_mps": [1.0, 0.0]}
    rock = sphere([3_000, 0, 2_000], 500.0)
    world = auvgym.World(Scenario.from_dict(open_water(3, currents=[east], obstacles=[rock])))
    path = np.array([[0, 0, 2e3], [3e3, 0, 2e3], [3e3, 4e3, 2e3]], dtype=np.float64)
    told = of_path(world, path, {"eta1": 2.0, "eta2": 10.0})
    assert told["length_km"] == pytest.approx(7.0)
    assert told["angle_rad"] == pytest.approx(np.pi / 4)
    assert told["objective"] == pytest.approx(14.0 + 2.5 * np.pi)
    assert told["turn_deg"] == pytest.approx(90.0)
    assert told["clearance_km"] == pytest.approx(-0.5)
    assert told["hits"] == pytest.approx(101, abs=2)


def test_every_card_can_be_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("matplotlib")
    # Whole runs again would take minutes: straight lines do here.
    straight = np.array([[0.0, 0.0, 3e3], [5e3, 6e3, 3e3], [1e4, 1.1e4, 3e3]])
    flown = flight(auvgym.World("iifds-threats3"), rules="paper", rho=1.0, sigma=1.0, share=0.0)
    monkeypatch.setattr(scenes, "_LOOKS", 40)
    monkeypatch.setattr(plots, "_PIXELS_PER_INCH", 40)
    monkeypatch.setattr(scenes, "_path", lambda run: straight)
    monkeypatch.setattr(scenes, "_flight", lambda card, case, column: flown)
    for name in list_cards():
        card = load_card(name)
        if card.view != "measures":
            continue
        measures = dict.fromkeys(card.measures, 1.0)
        outcomes = {run: Outcome(1.0, True, 10, 0.1, measures=measures) for run in card.runs(2)}
        text = write_card(card, outcomes, 2, tmp_path).read_text(encoding="utf-8")
        for one in (*card.columns, *card.cases):
            assert one.label in text
        for case in card.cases:
            assert all(len(figures) == len(card.columns) for figures in case.paper.values())
            assert set(case.paper) <= set(card.measures)
        for picture in card.pictures:
            assert f"({name}-{picture.name}.png)" in text
            assert (tmp_path / f"{name}-{picture.name}.png").stat().st_size > 2_000


def test_a_flight_is_told_tick_by_tick() -> None:
    one = flight(auvgym.World("iifds-threat1"), rules="paper", rho=1.2, share=0.2)
    assert one.track.shape == (len(one.time_s), 3)
    assert one.threats.shape == (len(one.time_s), 1, 3)
    gaps = np.linalg.norm(one.track[:, None] - one.threats, axis=2) - one.radii
    # Between ticks it may come a little nearer.
    assert one.measures["threat_km"] == pytest.approx(gaps.min() / 1e3, abs=0.005)
    assert np.array_equal(one.track[-1], auvgym.World("iifds-threat1").goal)


def test_a_picture_must_show_what_there_is() -> None:
    card = load_card("iifds-astar")
    wrong = dataclasses.replace(card.pictures[0], columns=("IIFDS",))
    with pytest.raises(CardError, match=r"unknown column 'IIFDS'"):
        check_picture(card, wrong)
    with pytest.raises(CardError, match=r"unknown case"):
        check_picture(card, dataclasses.replace(card.pictures[0], cases=("twelve columns",)))


def test_raster_astar_by_hand_and_its_refusals() -> None:
    def length(world: auvgym.World, **settings: Any) -> float:
        steps = np.diff(raster_astar(world, **settings), axis=0)
        return float(np.linalg.norm(steps, axis=1).sum())

    empty = open_water(3, missions=[{"start_m": [0, 0, 2e3], "goal_m": [2e4, 1e4, 2e3]}])
    open_sea = auvgym.World(Scenario.from_dict(empty))
    # 20 by 10 steps of a kilometre: ten diagonals, or none.
    assert length(open_sea, nodes=21, heuristic="octile") == pytest.approx(1e4 + 1e4 * np.sqrt(2))
    assert length(open_sea, nodes=21, connectivity=4) == pytest.approx(3e4)
    columns = auvgym.World("iifds-astar")
    cut, whole = (length(columns, corner_cutting=cut) for cut in (True, False))
    assert (cut, whole) == (pytest.approx(16_805, abs=1), pytest.approx(16_864, abs=1))
    assert length(columns, heuristic="octile") == pytest.approx(15_385, abs=1)
    for wrong, message in (
        ({"nodes": 1}, "nodes = 1: must lie in 2 .. 2000"),
        ({"heuristic": "euclid"}, "unknown heuristic 'euclid'"),
        ({"connectivity": 6}, "connectivity = 6: must be 4 or 8"),
    ):
        with pytest.raises(auvgym.PlanningError, match=message):
            raster_astar(columns, **wrong)  # type: ignore[arg-type]


# --- The options of the navigator ----------------------------------------------------------------


def course(turned: tuple[float, float] | None = None, **parameters: Any) -> Array:
    """Where a navigator goes that has seen a threat cross to the left, and then go otherwise."""
    pilot = navigator(auvgym.World("iifds-threat1"), [0, 5e3, 2e3], [1e4, 5e3, 2e3], **parameters)
    here, time, x, y = (0.0, 5e3, 2e3), 0.0, 2e3, 5e3
    for u, v in [(0.0, 0.9)] * 10 + ([turned] * 20 if turned else []):
        pilot.see((x, y, 2e3), 700.0, time)
        velocity, _ = pilot.course(here, time, 6.0)
        x, y, time = x + 6.0 * u, y + 6.0 * v, time + 6.0
    return velocity


def test_a_latch_keeps_the_side() -> None:
    settings = {"share": 0.0, "barrier_per_s": 0.0, "process_m2ps3": 1.0}
    # It comes on, and hardly across: to either side the vehicle goes behind it, at once.
    barely = (-1.0, -0.1)
    assert course((-1.0, 0.1), **settings)[1] < 0.0 < course(barely, **settings)[1]
    assert course(barely, latch_rad=0.5, **settings)[1] < 0.0
    # What goes right back is beyond the latch.
    assert course((0.0, -0.9), latch_rad=0.5, **settings)[1] > 0.0
    for wrong in (-0.1, 1.6):
        with pytest.raises(auvgym.PlanningError, match=r"latch_rad = .*must lie in 0 \.\."):
            course(latch_rad=wrong)


def test_prediction_process_and_frame_count() -> None:
    plain = course()
    for other in (
        {"prediction": "all"},
        {"relative": True},
        {"process_m2ps3": 1.0, "noise_m": 50.0},
    ):
        changed = course(**other)
        assert np.linalg.norm(changed) == pytest.approx(2.0)
        assert not np.allclose(changed, plain, atol=1e-6), other
    with pytest.raises(auvgym.PlanningError, match="prediction: unknown variant `first`"):
        course(prediction="first")


def test_a_plan_tells_its_coefficients() -> None:
    world = auvgym.World("iifds-static-dense")
    tuned = auvgym.plan(world, "iifds-de", max_evaluations=40, seed=1)
    assert set(tuned.coefficients) == {"rho", "theta", "sigma", "lambda"}
    again = auvgym.plan(world, "iifds", retry=False, **tuned.coefficients)
    assert np.array_equal(again.waypoints, tuned.waypoints)
    assert auvgym.plan(auvgym.World("lfhh-2d-1"), "astar").coefficients == {}
