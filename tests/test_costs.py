"""Costs: what any path costs is what the papers say."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_worlds import LENGTH, WIDTH, Array, disc, lamb_oseen, vortices, world

import auvgym
from auvgym import PlanningError, World

VORTICES = [(6_000.0, 5_000.0, 2_000.0), (12_000.0, 11_000.0, 2_000.0), (9_000.0, 15_000.0, -900.0)]
DISCS = [(8_000.0, 8_000.0, 1_500.0), (13_000.0, 13_000.0, 900.0), (10_000.0, 3_000.0, 1_000.0)]
SEA = world(currents=[vortices(*VORTICES)], obstacles=[disc(*row) for row in DISCS])


def turns(path: Array) -> Array:
    """Change of direction at each inner waypoint, rad."""
    steps = np.diff(path, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    cosines = np.sum(steps[:-1] * steps[1:], axis=1) / (lengths[:-1] * lengths[1:])
    return np.arccos(np.clip(cosines, -1, 1))


def lfhh_cost(path: Array) -> dict[str, float]:
    """LFHH eq. 6-10 on SEA, in the recommended readings."""
    steps = np.diff(path[:, :2], axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    n = len(steps)
    sharp = np.sum(turns(path[:, :2]) > np.pi / 6)
    hits = 0
    for a, step in zip(path[:-1, :2], steps, strict=True):
        for x, y, radius in DISCS:
            part = np.clip(np.dot([x - a[0], y - a[1]], step) / np.dot(step, step), 0, 1)
            if np.linalg.norm(a + part * step - [x, y]) < radius:
                hits += 1
                break
    middles = 0.5 * (path[:-1] + path[1:])
    flow = sum(lamb_oseen(middles, x, y, eta, 1_200.0) for x, y, eta in VORTICES)
    cosines = np.sum(steps * flow, axis=1) / (lengths * np.linalg.norm(flow, axis=1))
    terms = {
        "length": 1 - np.linalg.norm(path[-1] - path[0]) / lengths.sum(),
        "curvature": sharp / n + 2 if sharp else 0.0,
        "block": hits / n + 2 if hits else 0.0,
        "current": float(np.mean(np.arccos(np.clip(cosines, -1, 1)) / np.pi)),
    }
    return {
        **terms,
        "total": sum(terms.values()),
        "path_length_m": lengths.sum(),
        "feasible": float(not sharp and not hits),
    }


bends = st.lists(st.floats(-900, 900), min_size=1, max_size=30)


def path_of(offsets: list[float], wander: float) -> Array:
    """From south to north, the more crooked the more it wanders."""
    inner = np.linspace(10_000, 10_000, len(offsets)) + wander * np.cumsum(offsets)
    x = [10_000.0, *np.clip(inner, 100, WIDTH - 100), 10_000.0]
    return np.column_stack([x, np.linspace(10, LENGTH - 500, len(x)), np.zeros(len(x))])


@settings(max_examples=150, deadline=None)
@given(offsets=bends, wander=st.sampled_from([0.02, 0.3, 1.0, 3.0]))
def test_cost_lfhh_is_equations_6_to_10(offsets: list[float], wander: float) -> None:
    path = path_of(offsets, wander)
    cost, wanted = auvgym.path_cost(SEA, path), lfhh_cost(path)
    assert set(cost) == set(wanted)
    for term, value in wanted.items():
        # Angles are in single precision.
        assert cost[term] == pytest.approx(value, rel=1e-9, abs=1e-6), term


def test_the_readings_are_options() -> None:
    path = path_of([900.0, -900.0, 900.0, 0.0, 400.0], 1.0)
    n, angles = len(path) - 1, turns(path)
    for limit in (0.05, 0.3, 1.0):
        sharp = int(np.sum(angles > limit))
        cost = auvgym.path_cost(SEA, path, turn_limit_rad=limit)
        assert cost["curvature"] == pytest.approx(2 + sharp / n if sharp else 0.0)
        interior = int(np.sum(np.pi - angles < np.pi - limit))
        same_limit = auvgym.path_cost(SEA, path, turn_limit_rad=np.pi - limit, angle="interior")
        assert interior == sharp
        assert same_limit["curvature"] == pytest.approx(cost["curvature"])
    base = auvgym.path_cost(SEA, path)
    assert auvgym.path_cost(SEA, path, alpha="per-path")["current"] != base["current"]
    assert auvgym.path_cost(SEA, path, margin_m=2_000.0)["block"] > 2


UNIFORM = np.array([0.6, -0.5])
STEADY = world(currents=[{"kind": "uniform", "velocity_mps": UNIFORM.tolist()}])


@settings(max_examples=60, deadline=None)
@given(offsets=bends, wander=st.sampled_from([0.02, 0.3, 1.0]))
def test_costs_time_and_energy_go_by_ground_speed(offsets: list[float], wander: float) -> None:
    path = path_of(offsets, wander)
    steps = np.diff(path[:, :2], axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    along = steps @ UNIFORM / lengths
    ground = along + np.sqrt(2.0**2 - (UNIFORM @ UNIFORM - along**2))
    seconds = np.sum(lengths / ground)
    direct = np.linalg.norm(path[-1] - path[0])
    for name in ("time", "energy"):
        cost = auvgym.path_cost(STEADY, path, name)
        assert cost["time_s"] == pytest.approx(seconds, rel=1e-9)
        assert cost["energy_j"] == pytest.approx((20 + 10 * 2.0**3) * seconds, rel=1e-9)
        assert cost["excess"] == pytest.approx(1 - direct / 2.0 / seconds, abs=1e-9)
        assert cost["current"] == 0
        parts = cost["excess"] + cost["curvature"] + cost["block"] + cost["current"]
        assert cost["total"] == pytest.approx(parts)
        assert cost["curvature"] == auvgym.path_cost(STEADY, path)["curvature"]


def test_travel_time_through_vortices_is_an_integral() -> None:
    strong = world(currents=[vortices(*[(x, y, 4 * eta) for x, y, eta in VORTICES])])
    path = path_of([300.0, -200.0, 100.0, 0.0, 250.0] * 5, 1.0)
    seconds = 0.0
    for a, b in itertools.pairwise(path):
        way, pieces = b - a, 200
        length = np.linalg.norm(way)
        points = a + (np.arange(pieces)[:, None] + 0.5) / pieces * way
        flow = strong.current(points)
        along = flow @ way / length
        ground = along + np.sqrt(4.0 - (np.sum(flow**2, axis=1) - along**2))
        seconds += float(np.sum(length / pieces / ground))
    cost = auvgym.path_cost(strong, path, "time")
    assert cost["time_s"] == pytest.approx(seconds, rel=2e-3)
    still = auvgym.path_cost(world(), path, "time")
    assert abs(cost["time_s"] - still["time_s"]) > 100


def test_a_beaten_vehicle_is_told_so() -> None:
    for velocity, beaten in [([0.0, -1.85], 0.0), ([0.0, -1.95], 3.0), ([2.1, 0.0], 3.0)]:
        sea = world(currents=[{"kind": "uniform", "velocity_mps": velocity}])
        cost = auvgym.path_cost(sea, [sea.start, sea.goal], "time")
        assert cost["current"] == beaten
        assert cost["feasible"] == float(beaten == 0)
        assert auvgym.path_cost(sea, [sea.start, sea.goal], "lfhh")["feasible"] == 1.0


def test_any_path_has_a_cost() -> None:
    ocean = World("lfhh-3d-1")
    for path in (
        [ocean.start, ocean.goal],
        [ocean.start, ocean.start],
        [[0, 0, 0], [0, 0, 0], [0, 0, 0], [1, 1, 1]],
        [[-1e5, -1e5, 0], [1e6, 1e6, 1e4]],
        [[5e3, 5e3, 0], [5e3, 5e3, 9e3], [5e3, 5e3, 0]],
    ):
        for name in ("lfhh", "time", "energy"):
            cost = auvgym.path_cost(ocean, path, name)
            assert np.isfinite(list(cost.values())).all(), (path, cost)


def test_an_unknown_cost_and_wrong_options_are_named() -> None:
    ocean = World("lfhh-2d-1")
    path = [ocean.start, ocean.goal]
    with pytest.raises(PlanningError, match=r'"lfh".*did you mean "lfhh".*time, energy'):
        auvgym.path_cost(ocean, path, "lfh")
    with pytest.raises(PlanningError, match=r"`margin`, expected .*`margin_m`"):
        auvgym.path_cost(ocean, path, margin=3.0)
    with pytest.raises(PlanningError, match=r"margin_m = -3.*must lie in 0"):
        auvgym.path_cost(ocean, path, margin_m=-3.0)
    with pytest.raises(PlanningError, match=r"margin_m = nan"):
        auvgym.path_cost(ocean, path, margin_m=float("nan"))
    with pytest.raises(PlanningError, match=r"margin_m.*invalid type"):
        auvgym.path_cost(ocean, path, margin_m="wide")
