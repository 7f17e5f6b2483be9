"""Worlds: motion, what a map change may do, copies, and wrong questions."""

from __future__ import annotations

import copy
import json
import pickle
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_worlds import (
    DEPTH,
    ETA,
    LENGTH,
    WIDTH,
    ZETA,
    Array,
    answers,
    lamb_oseen,
    open_water,
    sphere,
    vortices,
    wall,
    world,
)

import auvgym
from auvgym import Scenario, ScenarioError, World

SHIPPED = auvgym.list_scenarios()
RANDOM = np.random.default_rng(1)
POINTS = RANDOM.random((500, 3)) * [WIDTH, LENGTH, DEPTH]
FLAT_POINTS = POINTS * [1, 1, 0]

places = st.tuples(st.floats(0, WIDTH), st.floats(0, LENGTH), st.floats(0, DEPTH))
quick = settings(max_examples=60, deadline=None)


# --- motion ------------------------------------------------------------------------------------


def folded(start: float, velocity: float, time_s: float, width: float) -> float:
    """A point that runs between two walls."""
    unfolded = (start + velocity * time_s) % (2 * width)
    return min(unfolded, 2 * width - unfolded)


START, VELOCITY, RADIUS = (4_000.0, 7_000.0, 1_500.0), (0.7, -1.1, 0.4), 600.0
MOVING = open_water(3, obstacles=[sphere(START, RADIUS, VELOCITY)])
BOX = (WIDTH, LENGTH, DEPTH)


@quick
@given(time_s=st.floats(0, 2e6))
def test_obstacles_reflect_at_the_walls(time_s: float) -> None:
    moving = World(Scenario.from_dict(MOVING))
    place = np.array([folded(*row) for row in zip(START, VELOCITY, [time_s] * 3, BOX, strict=True)])
    (found,) = moving.snapshot(time_s)["obstacles"]
    np.testing.assert_allclose(found["position_m"], place, atol=1e-5)
    np.testing.assert_allclose(np.abs(found["velocity_mps"]), np.abs(VELOCITY))
    apart = np.linalg.norm(POINTS - place, axis=1) - RADIUS
    wanted = np.minimum(apart, DEPTH - POINTS[:, 2])
    np.testing.assert_allclose(moving.clearance(POINTS, time_s), wanted, atol=1e-5)
    # Its velocity is where it goes next.
    (later,) = moving.snapshot(time_s + 0.01)["obstacles"]
    step = np.subtract(later["position_m"], found["position_m"]) / 0.01
    away_from_walls = (place > 0.02) & (place < np.array(BOX) - 0.02)
    np.testing.assert_allclose(
        step[away_from_walls], np.array(found["velocity_mps"])[away_from_walls], atol=1e-3
    )


def test_vortices_drift_and_reflect() -> None:
    group = vortices((9_000.0, 11_000.0, ETA))
    group["vortices"][0]["drift_mps"] = [0.5, 0.9]
    drifting = world(currents=[group])
    for time_s in (0.0, 5_000.0, 123_456.0):
        x, y = folded(9_000, 0.5, time_s, WIDTH), folded(11_000, 0.9, time_s, LENGTH)
        wanted = lamb_oseen(FLAT_POINTS, x, y, ETA, ZETA)
        found = drifting.current(FLAT_POINTS, time_s)[:, :2]
        np.testing.assert_allclose(found, wanted, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("kind", ["disc", "cylinder", "superquadric", "polygon"])
def test_every_kind_of_obstacle_moves(kind: str) -> None:
    velocity: list[float] = [0.5, -0.25]
    shapes: dict[str, dict[str, Any]] = {
        "disc": {"position_m": [5e3, 9e3], "radius_m": 500.0},
        "cylinder": {"position_m": [5e3, 9e3], "radius_m": 500.0, "top_m": 0.0, "bottom_m": 2e3},
        "superquadric": {
            "position_m": [5e3, 9e3, 1e3],
            "semi_axes_m": [500.0, 400.0, 300.0],
            "exponents": [2.0, 2.0, 2.0],
        },
        "polygon": {
            "vertices_m": [[5e3, 9e3], [6e3, 9e3], [5e3, 10e3]],
            "top_m": 0.0,
            "bottom_m": 2e3,
        },
    }
    if kind == "superquadric":
        velocity.append(0.125)
    solid = {"kind": kind, **shapes[kind], "velocity_mps": velocity}
    moving, resting = (
        world(3, obstacles=[solid]),
        world(3, obstacles=[{"kind": kind, **shapes[kind]}]),
    )
    shift = 1_000.0 * np.array([*velocity, 0.0][:3])
    wanted = resting.clearance(POINTS - shift)
    deep_enough = POINTS[:, 2] - shift[2] < DEPTH - 1_000  # the floor does not move along
    free = deep_enough & (wanted < DEPTH - POINTS[:, 2])
    assert free.sum() > 20
    found = moving.clearance(POINTS, 1_000.0)
    np.testing.assert_allclose(found[free], wanted[free], atol=1e-6)
    if kind == "polygon":
        (shape,) = moving.snapshot(1_000.0)["obstacles"]
        np.testing.assert_allclose(shape["vertices_m"][0], np.array([5e3, 9e3]) + shift[:2])


def test_time_goes_forwards_and_backwards() -> None:
    moving = World(Scenario.generate("lfhh-3d", 4, obstacle_speed_mps=0.8, vortex_drift_mps=0.5))
    first = answers(moving)
    asked = moving.clearance(POINTS, 9_999.0), moving.current(POINTS, 9_999.0)
    assert answers(moving) == first, "a question about another time must not move the world"
    moving.time_s = 9_999.0
    assert moving.time_s == 9_999.0
    assert np.array_equal(moving.clearance(POINTS), asked[0])
    assert np.array_equal(moving.current(POINTS), asked[1])
    assert not np.array_equal(asked[0], moving.clearance(POINTS, 0.0))
    moving.time_s = 0.0
    assert answers(moving) == first


# --- map changes -------------------------------------------------------------------------------


def obstacle_places(world: World) -> Array:
    return np.array([obstacle["position_m"] for obstacle in world.snapshot()["obstacles"]])


# Families whose maps change, and how to ask for it.
CHANGING: dict[str, dict[str, Any]] = {
    "lfhh-2d": {},
    "lfhh-3d": {},
    "afhh": {"change_every_m": 6.0},
}


@quick
@given(
    family=st.sampled_from(list(CHANGING)),
    seed=st.integers(0, 10_000),
    part=st.floats(0, 1),
    changes=st.integers(1, 4),
    speed=st.sampled_from([0.0, 0.6]),
)
def test_a_change_holds_its_margin(
    family: str, seed: int, part: float, changes: int, speed: float
) -> None:
    scenario = Scenario.generate(family, seed, obstacle_speed_mps=speed, **CHANGING[family])
    margin_m = scenario.to_dict()["change"]["hold_margin_m"]
    drawn = World(scenario, seed=seed)
    flat = drawn.dimensions == 2
    radii = np.array([obstacle["radius_m"] for obstacle in drawn.snapshot()["obstacles"]])
    moved = 0
    for change in range(changes):
        drawn.time_s = 3_000.0 * (change + 1)
        vehicle = drawn.start + part * (drawn.goal - drawn.start)
        before = obstacle_places(drawn)
        assert drawn.apply_change(vehicle)
        after = obstacle_places(drawn)
        jumped = np.any(after != before, axis=1)
        moved += int(jumped.sum())
        for protected in (vehicle, drawn.start, drawn.goal):
            offset = after - protected
            if flat:
                offset = offset[:, :2]
            apart = np.linalg.norm(offset, axis=1) - radii
            assert np.all(apart[jumped] >= margin_m - 1e-9)
        low, high = drawn.domain
        assert np.all((after >= low) & (after <= high))
    assert moved > changes * len(radii) / 2


def test_a_change_moves_vortices_and_keeps_the_fastest_current() -> None:
    drawn = World(Scenario.generate("lfhh-2d", 3, current_ratio=0.8), seed=3)
    x, y = np.meshgrid(np.arange(0, 20_001, 200.0), np.arange(0, 40_001, 200.0))
    points = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    centres = [vortex["x_m"] for vortex in drawn.snapshot()["vortices"]]
    for _ in range(3):
        assert drawn.apply_change(drawn.start)
        now = [vortex["x_m"] for vortex in drawn.snapshot()["vortices"]]
        assert not set(now) & set(centres)
        centres = now
        fastest = np.linalg.norm(drawn.current(points), axis=1).max()
        assert 0.95 * 1.6 < fastest < 1.15 * 1.6


def test_seeds_decide_what_a_change_draws() -> None:
    scenario = Scenario.generate("lfhh-3d", 1)
    worlds = [World(scenario, seed=seed) for seed in (5, 5, 6)]
    assert answers(worlds[0]) == answers(worlds[2])
    for changed in worlds:
        changed.apply_change(changed.start)
    assert answers(worlds[0]) == answers(worlds[1])
    assert answers(worlds[0]) != answers(worlds[2])


@pytest.mark.parametrize(
    "name", [name for name in SHIPPED if "change" in World(name).scenario.to_dict()]
)
def test_the_shipped_maps_change_as_their_tables_say(name: str) -> None:
    shipped = World(name)
    file = shipped.scenario.to_dict()
    table = file["change"]
    assert table["kind"] == "table"
    assert len(table["phases"]) == 5
    radii = np.array([obstacle["radius_m"] for obstacle in file["obstacles"]])
    vehicle = shipped.start
    held = 0
    for count, phase in enumerate(table["phases"], start=1):
        before = obstacle_places(shipped)
        assert shipped.apply_change(vehicle)
        assert shipped.changes == count
        after, wanted = obstacle_places(shipped), np.array(phase["obstacles_m"])
        protected = [vehicle]
        if table.get("hold", "all") == "all":
            protected += [shipped.start, shipped.goal]
        flat = 2 if shipped.dimensions == 2 else 3
        near = np.zeros(len(radii), dtype=bool)
        for point in protected:
            apart = np.linalg.norm((wanted - point)[:, :flat], axis=1)
            near |= apart < radii + table["hold_margin_m"]
        assert np.array_equal(after[near], before[near])
        assert np.array_equal(after[~near], wanted[~near])
        held += int(near.sum())
        found = [[vortex["x_m"], vortex["y_m"]] for vortex in shipped.snapshot()["vortices"]]
        assert found == phase["vortices_m"]
        # Next time sit beside an obstacle's next place, so that the margin is put to the test.
        vehicle = np.array(table["phases"][min(count, 4)]["obstacles_m"][0])
    assert held > 0
    last = answers(shipped)
    assert not shipped.apply_change(vehicle)
    assert shipped.changes == 5
    assert answers(shipped) == last


def test_a_world_without_changes_never_changes() -> None:
    still = world()
    assert not still.apply_change([0, 0, 0])
    assert still.changes == 0


# --- copies ------------------------------------------------------------------------------------

COPIES = {
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
    "pickle": lambda original: pickle.loads(pickle.dumps(original)),
    "old pickle": lambda original: pickle.loads(pickle.dumps(original, protocol=2)),
}


@pytest.mark.parametrize("way", COPIES)
@pytest.mark.parametrize("name", ["lfhh-2d", "lfhh-3d", "lfhh-2d-1", "lfhh-3d-1"])
def test_copies_go_on_identically(way: str, name: str) -> None:
    scenario: Any = name
    if name in auvgym.list_families():
        scenario = Scenario.generate(name, 11, obstacle_speed_mps=0.7, vortex_drift_mps=0.3)
    original = World(scenario, seed=2**63 + 5)
    for time_s, part in ((1_000.0, 0.1), (5_000.0, 0.3)):
        original.time_s = time_s
        original.apply_change(original.start + part * (original.goal - original.start))
    original.time_s = 7_500.0
    again = COPIES[way](original)
    assert repr(again) == repr(original)
    assert (again.seed, again.mission, again.changes, again.time_s) == (2**63 + 5, 0, 2, 7_500.0)
    assert again.scenario == original.scenario
    assert answers(again) == answers(original)
    before = answers(original)
    again.time_s = 9_000.0
    assert again.apply_change(again.goal)
    assert answers(original) == before, "a copy must not drag the original along"
    original.time_s = 9_000.0
    assert original.apply_change(original.goal)
    assert answers(again) == answers(original)
    assert again.snapshot() == original.snapshot()


def test_a_snapshot_is_plain_and_complete() -> None:
    for name in SHIPPED:
        last = World(name).scenario.missions - 1
        shipped = World(name, mission=last)
        snapshot, file = shipped.snapshot(), shipped.scenario.to_dict()
        assert json.loads(json.dumps(snapshot)) == snapshot
        assert len(snapshot["obstacles"]) == len(file["obstacles"])
        assert snapshot["peaks"] == file.get("seabed", {}).get("peaks", [])
        told = [
            (vortex["circulation_m2ps"], current["core_radius_m"])
            for current in file.get("currents", [])
            for vortex in current.get("vortices", [])
        ]
        found = [
            (vortex["circulation_m2ps"], vortex["core_radius_m"]) for vortex in snapshot["vortices"]
        ]
        assert np.allclose(found, told)
        assert len(found) == len(told)
        assert snapshot["start_m"] == shipped.start.tolist() == file["missions"][last]["start_m"]
        assert snapshot["goal_m"] == shipped.goal.tolist()


# --- questions ---------------------------------------------------------------------------------


def test_shapes_and_kinds_of_points() -> None:
    ocean = World("lfhh-3d-1")
    one = [1_000.0, 2_000.0, 3_000.0]
    assert ocean.current(one).shape == (1, 3)
    assert ocean.clearance(one).shape == (1,)
    assert ocean.floor_depth(one[:2]).shape == (1,)
    assert ocean.current(np.zeros((0, 3))).shape == (0, 3)
    assert ocean.clearance(np.zeros((0, 3))).shape == (0,)
    wanted = ocean.clearance(POINTS)
    assert np.array_equal(ocean.clearance(POINTS.tolist()), wanted)
    assert np.array_equal(ocean.clearance(np.asfortranarray(POINTS)), wanted)
    assert np.array_equal(ocean.clearance(POINTS[::-1])[::-1], wanted)
    assert np.array_equal(
        ocean.clearance(POINTS.astype(np.float32)),
        ocean.clearance(POINTS.astype(np.float32).astype(np.float64)),
    )
    whole = POINTS.round().astype(int)
    assert np.array_equal(ocean.current(whole), ocean.current(whole.astype(float)))
    # One point or many: the same bytes.
    assert np.array_equal([ocean.clearance(point)[0] for point in POINTS], wanted)
    result = ocean.current(POINTS)
    result[:] = 7.0  # the caller's own
    assert not np.any(ocean.current(POINTS) == 7.0)


@quick
@given(
    point=st.tuples(*[st.floats(-1e300, 1e300)] * 3), name=st.sampled_from(auvgym.list_scenarios())
)
def test_no_finite_point_gives_nonsense(point: tuple[float, float, float], name: str) -> None:
    ocean = World(name)
    assert np.isfinite(ocean.current(point)).all()
    assert not np.isnan(ocean.clearance(point)).any()
    assert not np.isnan(ocean.floor_depth(point[:2])).any()


BAD_POINTS: dict[str, tuple[Any, str]] = {
    "NaN": ([[0, 0, 0], [0, np.nan, 0]], r"points\[1, 1\] = NaN: must be finite"),
    "infinite": ([[0, 0, -np.inf]], r"points\[0, 2\] = -inf: must be finite"),
    "too narrow": ([[0, 0]], r"points have shape \(1, 2\): must be \(n, 3\)"),
    "too wide": ([[0, 0, 0, 0]], r"points have shape \(1, 4\): must be \(n, 3\)"),
    "a number": (5.0, r"points have shape \(\): must be \(n, 3\)"),
    "a cube": (np.zeros((2, 2, 3)), r"points have shape \(2, 2, 3\): must be \(n, 3\)"),
    "ragged": ([[0, 0, 0], [0]], "points must be numbers"),
    "text": ("origin", "points must be numbers, not <U6"),
    "digits as text": ([["1", "2", "3"]], "points must be numbers, not <U1"),
    "None": (None, "points must be numbers, not object"),
    "complex": ([[1j, 0, 0]], "points must be numbers, not complex128"),
    "flags": ([[True, False, True]], "points must be numbers, not bool"),
    "an object": (object(), "points must be numbers, not object"),
    "a date": (np.array(["2020-01-01"] * 3, dtype="datetime64[D]"), "points must be numbers"),
}


@pytest.mark.parametrize("case", BAD_POINTS)
def test_wrong_points_are_refused_by_name(case: str) -> None:
    points, message = BAD_POINTS[case]
    ocean = World("lfhh-2d-1")
    for ask in (ocean.current, ocean.clearance):
        with pytest.raises(ValueError, match=message):
            ask(points)
    if case != "too narrow":  # a sea floor is asked about (x, y)
        with pytest.raises(ValueError, match=r"points (have shape|must be)|points\["):
            ocean.floor_depth(points)


BAD_TIMES: dict[str, tuple[Any, str]] = {
    "NaN": (np.nan, "time_s = NaN: must be finite"),
    "infinite": (np.inf, "time_s = inf: must be finite"),
    "text": ("noon", "time_s = 'noon': must be a number"),
    "digits as text": ("5", "time_s = '5': must be a number"),
    "a flag": (True, "time_s = True: must be a number"),
    "a list": ([0.0], r"time_s = \[0.0\]: must be a number"),
    "complex": (1j, "time_s = 1j: must be a number"),
}


@pytest.mark.parametrize("case", BAD_TIMES)
def test_wrong_times_are_refused_by_name(case: str) -> None:
    time_s, message = BAD_TIMES[case]
    ocean = World("lfhh-2d-1")
    for ask in (ocean.current, ocean.clearance):
        with pytest.raises(ValueError, match=message):
            ask([[0, 0, 0]], time_s)
    with pytest.raises(ValueError, match=message):
        ocean.snapshot(time_s)
    with pytest.raises(ValueError, match=message):
        ocean.time_s = time_s
    assert ocean.time_s == 0.0
    with pytest.raises(ValueError, match="time_s = None: must be a number"):
        ocean.time_s = None  # type: ignore[assignment]


@pytest.mark.parametrize(
    ("vehicle", "message"),
    [
        ([0, np.nan, 0], r"vehicle\[1\] = NaN: must be finite"),
        ([0, 0], r"vehicle has shape \(2,\): must be \(3,\)"),
        ([[0, 0, 0], [1, 1, 1]], r"vehicle has shape \(2, 3\): must be \(3,\)"),
        (np.zeros((0, 3)), r"vehicle has shape \(0, 3\): must be \(3,\)"),
        ("here", "vehicle must be numbers"),
        (None, "vehicle must be numbers"),
    ],
)
def test_a_wrong_vehicle_changes_nothing(vehicle: Any, message: str) -> None:
    ocean = World("lfhh-2d-1")
    with pytest.raises(ValueError, match=message):
        ocean.apply_change(vehicle)
    assert ocean.changes == 0


def test_an_impossible_world_is_refused_when_it_is_made() -> None:
    with pytest.raises(
        ScenarioError, match=r"missions\[0\].start_m = .* inside rock or an obstacle"
    ):
        world(obstacles=[wall(y=-500.0)])
