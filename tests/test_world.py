"""Worlds: currents and clearance against plain formulas."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from small_worlds import (
    DEPTH,
    ETA,
    LENGTH,
    WIDTH,
    ZETA,
    Array,
    disc,
    lamb_oseen,
    open_water,
    sphere,
    vortices,
    world,
)

import auvgym
from auvgym import Scenario, World

SHIPPED = auvgym.list_scenarios()
RANDOM = np.random.default_rng(1)
POINTS = RANDOM.random((500, 3)) * [WIDTH, LENGTH, DEPTH]
FLAT_POINTS = POINTS * [1, 1, 0]

places = st.tuples(st.floats(0, WIDTH), st.floats(0, LENGTH), st.floats(0, DEPTH))
quick = settings(max_examples=60, deadline=None)


# --- currents ----------------------------------------------------------------------------------

VORTEX = vortices((9_000.0, 11_000.0, ETA), core_radius_m=ZETA)


def test_a_vortex_follows_lfhh_equations_3_to_5() -> None:
    velocity = world(currents=[VORTEX]).current(FLAT_POINTS)
    wanted = lamb_oseen(FLAT_POINTS, 9_000, 11_000, ETA, ZETA)
    np.testing.assert_allclose(velocity[:, :2], wanted, rtol=1e-12, atol=1e-15)
    assert np.all(velocity[:, 2] == 0)


def test_a_vortex_is_still_at_its_centre_and_turns_rigidly_round_it() -> None:
    east = np.array([0.0, 1e-9, 1e-6, 1e-3, 0.1, 1.0, 10.0])
    points = np.column_stack([9_000 + east, np.full_like(east, 11_000.0), np.zeros_like(east)])
    velocity = world(currents=[VORTEX]).current(points)
    assert np.all(velocity[0] == 0)
    np.testing.assert_allclose(velocity[:, 0], 0, atol=1e-18)
    rigid = ETA / (2 * np.pi * ZETA**2) * (points[:, 0] - 9_000)
    np.testing.assert_allclose(velocity[:, 1], rigid, rtol=1e-4, atol=1e-18)
    assert np.all(velocity[1:, 1] > 0)  # positive circulation turns x towards y


def test_a_vortex_is_fastest_on_its_ring() -> None:
    radius = np.linspace(1, 5_000, 5_000)
    points = np.column_stack([9_000 + radius, np.full_like(radius, 11_000.0), 0 * radius])
    speed = np.linalg.norm(world(currents=[VORTEX]).current(points), axis=1)
    assert radius[speed.argmax()] == pytest.approx(1.1209 * ZETA, abs=1)
    assert speed.max() == pytest.approx(0.638173 * ETA / (2 * np.pi * ZETA), rel=1e-5)


def test_a_uniform_current_is_the_same_everywhere_and_always() -> None:
    uniform = world(3, currents=[{"kind": "uniform", "velocity_mps": [0.3, -0.7]}])
    for time_s in (None, 0.0, 1e6):
        assert np.all(uniform.current(POINTS, time_s) == [0.3, -0.7, 0.0])


JET = {
    "kind": "jet",
    "t": 3.0,
    "c": 1.2,
    "k": 0.8,
    "e": 0.1,
    "b0": 2.2,
    "omega": 0.4,
    "chi": np.pi / 2,
    "peak_speed_mps": 1.0,
    "length_scale_m": 1_000.0,
}


def stream_function(x: Array, y: Array, t: float) -> Array:
    """IIFDS eq. 16-18 with JET's numbers, in its own units."""
    b = 2.2 + 0.1 * np.cos(0.4 * t + np.pi / 2)
    phase = 0.8 * (x - 1.2 * t)
    return 1 - np.tanh((y - b * np.cos(phase)) / np.sqrt(1 + (0.8 * b * np.sin(phase)) ** 2))


def test_a_jet_gives_the_golden_numbers() -> None:
    velocity = world(currents=[JET]).current([[2_000, 1_000, 0], [5_000, 500, 0], [0, 0, 0]])
    golden = [
        [0.5042850207, 0.7797034517],
        [0.5222434171, -0.8511882906],
        [0.08380735925, 0.1179016412],
    ]
    np.testing.assert_allclose(velocity[:, :2], golden, atol=1e-8)


@pytest.mark.parametrize("time_s", [0.0, 7_200.0])
def test_a_jet_is_the_curl_of_its_stream_function(time_s: float) -> None:
    moving = world(currents=[{**JET, "time_scale_s": 3_600.0}])
    velocity = moving.current(FLAT_POINTS, time_s)
    x, y, step = FLAT_POINTS[:, 0] / 1e3, FLAT_POINTS[:, 1] / 1e3, 1e-5
    t = 3.0 + time_s / 3_600.0
    u = (stream_function(x, y - step, t) - stream_function(x, y + step, t)) / (2 * step)
    v = (stream_function(x + step, y, t) - stream_function(x - step, y, t)) / (2 * step)
    np.testing.assert_allclose(velocity[:, 0], u, atol=1e-8)
    np.testing.assert_allclose(velocity[:, 1], v, atol=1e-8)


def test_a_jet_without_a_time_scale_is_frozen() -> None:
    frozen = world(currents=[JET])
    assert np.array_equal(frozen.current(FLAT_POINTS), frozen.current(FLAT_POINTS, 1e5))


def gridded(u: Any, v: Any = None, **axes: Any) -> dict[str, Any]:
    axes = {"x_m": [0.0, 8_000.0, 20_000.0], "y_m": [0.0, 20_000.0], **axes}
    u = np.asarray(u, dtype=np.float64)
    v = np.zeros_like(u) if v is None else v
    return {"kind": "gridded", **axes, "u_mps": u.ravel().tolist(), "v_mps": np.ravel(v).tolist()}


def test_a_gridded_current_is_linear_along_every_axis() -> None:
    axes = {
        "time_s": np.array([0.0, 3_600.0]),
        "depth_m": np.array([0.0, 1_000.0, 4_000.0]),
        "y_m": np.array([0.0, 20_000.0]),
        "x_m": np.array([0.0, 8_000.0, 20_000.0]),
    }
    t, z, y, x = np.meshgrid(*axes.values(), indexing="ij")

    def field(x: Array, y: Array, z: Array, t: float | Array) -> list[Array]:
        return [2e-5 * x - 1e-4 * z + 1e-4 * t, 3e-5 * y]

    u, v = field(x, y, z, t)
    current = gridded(u, v, **{name: axis.tolist() for name, axis in axes.items()})
    ocean = world(3, currents=[current])
    for time_s in (0.0, 900.0, 3_600.0):
        wanted = np.column_stack(field(*POINTS.T, time_s))
        np.testing.assert_allclose(ocean.current(POINTS, time_s)[:, :2], wanted, atol=1e-6)
    # Beyond the ends of depth and time the last value holds.
    after = ocean.current(POINTS, 1e6)
    assert np.array_equal(after, ocean.current(POINTS, 3_600.0))


def test_missing_values_are_left_out_of_a_gridded_current() -> None:
    hole = gridded([[0.4, 0.6, 0.8], [0.4, 0.6, 0.8]])
    text = Scenario.from_dict(open_water(currents=[hole])).to_toml()
    ocean = World(Scenario.from_toml(text.replace("0.6", "nan")))
    known = [[0, 100, 0], [4_000, 0, 0], [7_999, 9_000, 0], [16_000, 50, 0], [20_000, 0, 0]]
    np.testing.assert_allclose(ocean.current(known)[:, 0], [0.4, 0.4, 0.4, 0.8, 0.8], rtol=1e-6)
    assert np.all(ocean.current([[8_000, 0, 0]]) == 0)  # nothing near is known
    assert np.isfinite(ocean.current(FLAT_POINTS)).all()


strengths = st.floats(-5_000, 5_000)
vortex_rows = st.lists(st.tuples(st.floats(0, WIDTH), st.floats(0, LENGTH), strengths), max_size=7)


@quick
@given(groups=st.lists(vortex_rows, max_size=3), uniform=st.tuples(*[st.floats(-2, 2)] * 2))
def test_currents_superpose(groups: list[Any], uniform: tuple[float, float]) -> None:
    parts: list[dict[str, Any]] = [vortices(*rows) for rows in groups]
    parts += [
        {"kind": "uniform", "velocity_mps": list(uniform)},
        JET,
        gridded([[0.1, 0.2, 0.3]] * 2),
    ]
    together = world(currents=parts).current(FLAT_POINTS)
    apart = sum(world(currents=[part]).current(FLAT_POINTS) for part in parts)
    np.testing.assert_allclose(together, apart, rtol=1e-9, atol=1e-12)


# --- clearance ---------------------------------------------------------------------------------


def centres(count: int) -> Array:
    # Clear of start and goal, which lie at y = 0 and y = 19 km.
    return np.random.default_rng(count).uniform([0, 4_000, 0], [WIDTH, 15_000, DEPTH], (count, 3))


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 23, 70])
def test_clearance_of_spheres_is_exact(count: int) -> None:
    radii = np.linspace(200, 2_500, count)
    balls = [
        sphere(centre.tolist(), radius)
        for centre, radius in zip(centres(count), radii, strict=True)
    ]
    clearance = world(3, obstacles=balls).clearance(POINTS)
    apart = np.linalg.norm(POINTS[:, None] - centres(count), axis=2) - radii
    above_rock = DEPTH - POINTS[:, 2]  # without a seabed the box ends in rock
    np.testing.assert_allclose(clearance, np.minimum(apart.min(axis=1), above_rock), atol=1e-9)
    assert (clearance < 0).any() or count < 23


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 22])
@pytest.mark.parametrize("dimensions", [2, 3])
def test_clearance_of_discs_is_exact(count: int, dimensions: int) -> None:
    radii = np.linspace(200, 2_500, count)
    discs = [disc(x, y, r) for (x, y, _), r in zip(centres(count).tolist(), radii, strict=True)]
    points = POINTS if dimensions == 3 else FLAT_POINTS
    clearance = world(dimensions, obstacles=discs).clearance(points)
    apart = np.linalg.norm(points[:, None, :2] - centres(count)[:, :2], axis=2) - radii
    wanted = apart.min(axis=1)
    if dimensions == 3:
        wanted = np.minimum(wanted, DEPTH - points[:, 2])
    np.testing.assert_allclose(clearance, wanted, atol=1e-9)


def test_clearance_of_a_cylinder_is_exact() -> None:
    cylinder = {
        "kind": "cylinder",
        "position_m": [9_000.0, 9_000.0],
        "radius_m": 1_500.0,
        "top_m": 1_000.0,
        "bottom_m": 2_500.0,
    }
    clearance = world(3, obstacles=[cylinder]).clearance(POINTS)
    side = np.hypot(POINTS[:, 0] - 9_000, POINTS[:, 1] - 9_000) - 1_500
    end = np.maximum(1_000 - POINTS[:, 2], POINTS[:, 2] - 2_500)
    outside = np.hypot(np.maximum(side, 0), np.maximum(end, 0))
    wanted = np.where((side < 0) & (end < 0), np.maximum(side, end), outside)
    np.testing.assert_allclose(clearance, np.minimum(wanted, DEPTH - POINTS[:, 2]), atol=1e-9)


def test_clearance_of_a_polygon_is_exact() -> None:
    # An L: its notch is outside.
    corners = np.array([[4, 6], [12, 6], [12, 9], [7, 9], [7, 14], [4, 14]]) * 1e3
    polygon = {"kind": "polygon", "vertices_m": corners.tolist(), "top_m": -1.0, "bottom_m": 9e3}
    clearance = world(2, obstacles=[polygon]).clearance(FLAT_POINTS)
    x, y = FLAT_POINTS[:, 0], FLAT_POINTS[:, 1]
    inside = ((x > 4e3) & (x < 12e3) & (y > 6e3) & (y < 9e3)) | (
        (x > 4e3) & (x < 7e3) & (y > 6e3) & (y < 14e3)
    )
    nearest = np.full(len(x), np.inf)
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        along = np.clip(((FLAT_POINTS[:, :2] - a) @ (b - a)) / ((b - a) @ (b - a)), 0, 1)
        gap = np.linalg.norm(FLAT_POINTS[:, :2] - a - along[:, None] * (b - a), axis=1)
        nearest = np.minimum(nearest, gap)
    # The prism's top lies 1 m above the plane: no deeper inside than that.
    wanted = np.where(inside, np.maximum(-nearest, -1.0), nearest)
    np.testing.assert_allclose(clearance, wanted, atol=1e-9)
    assert inside.sum() > 20


exponents = st.tuples(*[st.floats(1, 8)] * 3)
semi_axes = st.tuples(*[st.floats(300, 3_000)] * 3)


@quick
@given(point=places, power=exponents, axes=semi_axes)
def test_clearance_never_overestimates_for_superquadrics(
    point: tuple[float, ...], power: tuple[float, ...], axes: tuple[float, ...]
) -> None:
    centre = np.array([10_000.0, 10_000.0, 2_000.0])
    solid = {
        "kind": "superquadric",
        "position_m": centre.tolist(),
        "semi_axes_m": list(axes),
        "exponents": list(power),
    }
    clearance = world(3, obstacles=[solid]).clearance([point])[0]
    offset = (np.array(point) - centre) / axes
    value = np.sum(np.abs(offset) ** power)
    assume(abs(value - 1) > 1e-6)
    floor = DEPTH - point[2]
    if value < 1:
        assert clearance < 0
        return
    # Directions scaled out to the surface: each is a point of it.
    directions = np.random.default_rng(5).normal(size=(2_000, 3))
    low, high = np.zeros(2_000), np.full(2_000, 4.0)
    for _ in range(50):
        middle = 0.5 * (low + high)
        out = np.sum(np.abs(directions * middle[:, None]) ** power, axis=1) > 1
        low, high = np.where(out, low, middle), np.where(out, middle, high)
    surface = centre + directions * high[:, None] * axes
    nearest = np.linalg.norm(surface - point, axis=1).min()
    assert 0 < clearance <= min(nearest, floor) + 1e-6 or floor == 0


peak = st.fixed_dictionaries(
    {
        "x_m": st.floats(0, WIDTH),
        "y_m": st.floats(0, LENGTH),
        "height_m": st.floats(100, 3_900),
        "a": st.floats(0.5, 1.5),
        "b": st.floats(0.5, 1.5),
        "sigma_m": st.floats(300, 3_000),
    }
)


def floor_of(peaks: list[dict[str, float]], x: Array, y: Array) -> Array:
    """LFHH eq. 11: the highest of the peaks above a floor at DEPTH."""
    heights = [
        p["height_m"]
        * np.exp(
            -((y - p["y_m"]) ** 2 * p["a"] ** 2 + (x - p["x_m"]) ** 2 * p["b"] ** 2)
            / (2 * p["sigma_m"] ** 2)
        )
        for p in peaks
    ]
    return DEPTH - np.max([np.zeros_like(x), *heights], axis=0)


def near_points(point: tuple[float, ...]) -> tuple[Array, Array]:
    """Places round a point, dense close to it."""
    random = np.random.default_rng(9)
    radius, angle = 8_000 * random.random(3_000) ** 3, 2 * np.pi * random.random(3_000)
    return point[0] + radius * np.cos(angle), point[1] + radius * np.sin(angle)


@quick
@given(point=places, peaks=st.lists(peak, min_size=1, max_size=9))
def test_clearance_never_overestimates_above_peaks(
    point: tuple[float, ...], peaks: list[dict[str, float]]
) -> None:
    seabed = {"kind": "peaks", "floor_depth_m": DEPTH, "peaks": peaks}
    ends = np.array([[10_000.0, 0.0], [10_000.0, 19_000.0]])
    assume((floor_of(peaks, *ends.T) > 2_001).all())
    ocean = world(3, seabed=seabed)
    x, y = near_points(point)
    depths = ocean.floor_depth(np.column_stack([x, y]))
    np.testing.assert_allclose(depths, floor_of(peaks, x, y), rtol=1e-9)
    clearance = ocean.clearance([point])[0]
    gap = floor_of(peaks, np.array([point[0]]), np.array([point[1]]))[0] - point[2]
    if gap <= -1e-6:
        assert clearance < 0
    elif gap > 1e-6:
        away = np.sqrt((x - point[0]) ** 2 + (y - point[1]) ** 2 + (depths - point[2]) ** 2)
        assert 0 < clearance <= min(away.min(), gap) + 1e-6


@quick
@given(point=places, rows=st.lists(st.floats(500, 4_000), min_size=9, max_size=9))
def test_clearance_never_overestimates_above_a_grid_of_depths(
    point: tuple[float, ...], rows: list[float]
) -> None:
    depths = np.reshape(rows, (3, 3))
    depths[:, 1] = 3_500.0  # start and goal lie here
    axis = [0.0, 10_000.0, 20_000.0]
    seabed = {"kind": "gridded", "x_m": axis, "y_m": axis, "depth_m": depths.ravel().tolist()}
    ocean = world(3, seabed=seabed)
    x, y = near_points(point)
    floor = ocean.floor_depth(np.column_stack([x, y]))
    clearance = ocean.clearance([point])[0]
    gap = ocean.floor_depth([point[:2]])[0] - point[2]
    if gap < 0:
        assert clearance < 0
    elif gap > 1e-6:
        away = np.sqrt((x - point[0]) ** 2 + (y - point[1]) ** 2 + (floor - point[2]) ** 2)
        assert 0 < clearance <= min(away.min(), gap) + 1e-6


def test_a_grid_of_depths_is_bilinear() -> None:
    axis = [0.0, 20_000.0]
    seabed = {"kind": "gridded", "x_m": axis, "y_m": axis, "depth_m": [2_100, 3_000, 3_500, 4_000]}
    ocean = world(3, seabed=seabed)
    x, y = POINTS[:, 0] / 2e4, POINTS[:, 1] / 2e4
    wanted = 2_100 * (1 - x) * (1 - y) + 3_000 * x * (1 - y) + 3_500 * (1 - x) * y + 4_000 * x * y
    np.testing.assert_allclose(ocean.floor_depth(POINTS[:, :2]), wanted, rtol=1e-6)


def test_a_flat_floor_and_no_floor() -> None:
    flat = world(3, seabed={"kind": "flat", "depth_m": 3_000.0})
    assert np.all(flat.floor_depth(POINTS[:, :2]) == 3_000)
    np.testing.assert_allclose(flat.clearance(POINTS), 3_000 - POINTS[:, 2])
    assert np.all(np.isposinf(world(2).floor_depth(POINTS[:, :2])))
    assert np.all(np.isposinf(world(2).clearance(FLAT_POINTS)))
