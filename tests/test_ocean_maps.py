"""The real-ocean loader: maps, and the engine's view of them."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ocean_files import (
    GOAL,
    LON,
    START,
    current_file,
    east_on_the_map,
    floor_file,
    nodes,
    write,
)

import auvgym
from auvgym import ocean
from auvgym.ocean import OceanDataWarning, Projection, Request, build
from auvgym.ocean.axes import make_axis, recentre
from auvgym.ocean.mission import Extent, Place, lay_out
from auvgym.ocean.projection import distances_m


@pytest.fixture
def currents(tmp_path: Path) -> Path:
    return write(current_file(), tmp_path / "current.nc")


@settings(deadline=None)
@given(
    centre=st.tuples(st.floats(-180.0, 180.0), st.floats(-80.0, 80.0)),
    offset=st.tuples(st.floats(-3e6, 3e6), st.floats(-3e6, 3e6), st.floats(0.0, 6000.0)),
)
def test_projection_round_trip(
    centre: tuple[float, float], offset: tuple[float, float, float]
) -> None:
    """Local metres come back to the millimetre; distances from the centre are true."""
    projection = Projection(*centre)
    point = projection.to_lonlat([offset])
    np.testing.assert_allclose(projection.to_local(point), [offset], atol=1e-3)
    away = distances_m(point[0, 0], point[0, 1], *centre)
    assert float(away) == pytest.approx(float(np.hypot(*offset[:2])), abs=0.05)
    assert -180.0 <= point[0, 0] <= 180.0


@settings(deadline=None)
@given(
    first=st.floats(-180.0, 180.0),
    spacing=st.sampled_from([0.25, 1.0 / 3.0, 1.0]),
    span=st.floats(5.0, 360.0),
    inside=st.floats(0.0, 1.0),
)
def test_longitudes_are_turned_to_the_mission(
    first: float, spacing: float, span: float, inside: float
) -> None:
    """Whatever turn of the circle a file is on: ascending, the same meridians, near the mission."""
    values = np.arange(first, first + span, spacing)
    axis = make_axis("lon", values, "test")
    wanted = (values[0] + inside * (values[-1] - values[0]) + 180.0) % 360.0 - 180.0
    turned = recentre(axis, wanted)
    assert (np.diff(turned.values) > 0.0).all()
    turns = (turned.values - values[turned.order]) / 360.0
    np.testing.assert_allclose(turns, np.round(turns), atol=1e-9)
    middle = (turned.low + turned.high) / 2.0
    assert abs(middle - wanted) <= 180.0 + spacing


@settings(deadline=None, max_examples=50)
@given(
    latitude=st.floats(-75.0, 75.0),
    longitude=st.floats(-180.0, 180.0),
    east=st.floats(0.2, 5.0),
    north=st.floats(-5.0, 5.0),
    margin=st.floats(1e3, 1e6),
)
def test_the_box_lies_within_the_data(
    latitude: float, longitude: float, east: float, north: float, margin: float
) -> None:
    start = Place("start", longitude, latitude, 0.0)
    goal = Place("goal", longitude + east, latitude + north, 0.0)
    mission = lay_out(start, goal)
    data = Extent(
        longitude - 2.0,
        longitude + east + 1.0,
        min(latitude, latitude + north) - 1.0,
        max(latitude, latitude + north) + 2.0,
    )
    box = mission.inside(mission.box(margin), data)
    window = mission.window(box)
    tolerance = 1e-5
    assert window.west >= data.west - tolerance
    assert window.east <= data.east + tolerance
    assert window.south >= data.south - tolerance
    assert window.north <= data.north + tolerance


def test_plans_go_back_to_longitude_and_latitude(currents: Path) -> None:
    scenario = build(Request(currents, None, START, GOAL))
    ends = [scenario["missions"][0][key] for key in ("start_m", "goal_m")]
    found = ocean.to_lonlat(scenario, ends)
    assert found.shape == (2, 3)
    np.testing.assert_allclose(found[:, :2], [START, GOAL], atol=1e-7)
    np.testing.assert_allclose(ocean.from_lonlat(scenario, found), ends, atol=1e-3)
    assert ocean.to_lonlat(scenario, np.array(ends)[:, :2]).shape == (2, 2)
    with pytest.raises(ValueError, match="no \\[projection\\]"):
        ocean.to_lonlat({"name": "box"}, ends)
    with pytest.raises(ValueError, match="last axis must be 2 or 3"):
        ocean.to_lonlat(scenario, [1.0])


def test_across_the_180th_meridian(tmp_path: Path) -> None:
    attributes = {"units": "degrees_east"}
    west = floor_file().assign_coords(lon=("lon", (LON + 430.0) % 360.0 - 180.0, attributes))
    for name, dataset in (("jump", west), ("sorted", west.sortby("lon"))):
        path = write(dataset, tmp_path / f"{name}.nc")
        scenario = build(Request(None, path, (179.6, 38.4), (-179.4, 39.6)))
        longitudes = np.array(scenario["seabed"]["longitude_deg"])
        assert (np.diff(longitudes) == 0.25).all()
        assert abs(longitudes - scenario["projection"]["longitude_deg"]).max() < 2.0
        ends = [scenario["missions"][0][key] for key in ("start_m", "goal_m")]
        back = ocean.to_lonlat(scenario, ends)
        np.testing.assert_allclose(back[:, :2], [(179.6, 38.4), (-179.4, 39.6)], atol=1e-7)


def test_the_engine_turns_the_current_to_the_map(tmp_path: Path) -> None:
    """A linear field comes back at any depth and time, turned by the meridians' convergence."""
    path = write(current_file(times=3, depths=(0.0, 200.0)), tmp_path / "current.nc")
    floor = write(floor_file(), tmp_path / "floor.nc")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OceanDataWarning)
        scenario = ocean.load(path, floor, start=START, goal=GOAL, dimensions=3)
    world = auvgym.World(scenario)
    mapping = scenario.to_dict()
    degrees, metres, inside = nodes(mapping, mapping["currents"][0])
    degrees, metres = degrees[inside], metres[inside]
    depth, time = 50.0, 9.0 * 3600.0
    points = np.column_stack([metres, np.full(len(metres), depth)])
    found = world.current(points, time_s=time)
    u = 0.4 + 0.1 * (degrees[:, 0] + 70.0) + 0.05 * (degrees[:, 1] - 39.0) + 0.15 - 0.05
    v = -0.2 + 0.07 * (degrees[:, 1] - 39.0) - 0.03
    east = east_on_the_map(Projection(**mapping["projection"]), degrees)
    expected = np.column_stack([u * east[:, 0] - v * east[:, 1], u * east[:, 1] + v * east[:, 0]])
    np.testing.assert_allclose(found[:, :2], expected, atol=2e-4)
    assert np.abs(found[:, 1] - v).max() > 2e-3
    np.testing.assert_allclose(ocean.to_lonlat(scenario, points)[:, :2], degrees, atol=1e-7)
