"""The real-ocean loader on real files: $AUVGYM_DATA, or ../shared/data beside the repository."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from ocean_files import (
    GOAL,
    START,
    current_grid,
    east_on_the_map,
    nodes,
    quiet,
    real,
    seabed_grid,
)

import auvgym
from auvgym import ocean
from auvgym.ocean import Projection, Request, build

GULF_STREAM = ("gulf_stream_cmems_20240101.nc", "bathy_etopo5_gulf_stream.nc")
GIBRALTAR = ("gibraltar_alboran_cmems_20240101.nc", "bathy_etopo5_gibraltar_alboran.nc")
HOURLY = ("gom_hycom_hourly_20201101_97h.nc4", "bathy_gom_hycom_model_depth.nc")
LEVELS = ("gom_hycom_3d_20201117.nc", "bathy_gom_hycom_model_depth.nc")
COLUMBIA = ("columbia_river_creofs_regular_100m.nc", None)
ETOPO20 = (None, "bathy_etopo20_global.cdf")

# Files, start, goal, what else is asked, and the grid's (time, depth, latitude, longitude).
REAL: dict[str, tuple[tuple[str | None, str | None], Any, Any, dict[str, Any]]] = {
    "gulf stream": (GULF_STREAM, (-70.5, 40.0), (-69.0, 35.0), {}),
    "gulf stream, no bathymetry": ((GULF_STREAM[0], None), (-66.0, 39.0), (-73.5, 36.0), {}),
    "gibraltar": (GIBRALTAR, (-3.0, 36.3), (-5.6, 36.0), {}),
    "gibraltar, no bathymetry": ((GIBRALTAR[0], None), (-3.0, 36.3), (-5.6, 36.0), {}),
    "gibraltar, gaps are land": (GIBRALTAR, (-3.0, 36.3), (-5.6, 36.0), {"missing": "land"}),
    "loop current": (
        ("loop_current_florida_cmems_20240101.nc", "bathy_etopo5_loop_current_florida.nc"),
        (-80.0, 25.6),
        (-79.35, 25.75),
        {},
    ),
    "dover strait": (
        ("english_channel_cmems_20240101.nc", "bathy_etopo2022_30s_dover_strait.nc"),
        (2.2, 51.3),
        (2.8, 52.5),
        {},
    ),
    "hourly": (HOURLY, (-97.5, 22.0), (-95.7, 21.4), {}),
    "hourly, no bathymetry": ((HOURLY[0], None), (-97.5, 22.0), (-95.7, 21.4), {}),
    "3-D file at the surface": (LEVELS, (-93.4, 19.6), (-95.5, 22.6), {}),
    "3-D file at 200 m": (LEVELS, (-93.6, 19.6), (-95.5, 22.6), {"depth_m": 200.0}),
    "3-D": (LEVELS, (-93.6, 19.6, 50.0), (-95.5, 22.6, 0.0), {"dimensions": 3}),
    "3-D, no bathymetry": (
        (LEVELS[0], None),
        (-93.6, 19.6, 50.0),
        (-95.5, 22.6, 0.0),
        {"dimensions": 3, "max_depth_m": 1000.0},
    ),
    "3-D, other bathymetry": (
        (LEVELS[0], "bathy_etopo5_gom_campeche.nc"),
        (-93.6, 19.6, 50.0),
        (-95.5, 22.6, 0.0),
        {"dimensions": 3, "max_depth_m": 1000.0},
    ),
    "columbia river": (COLUMBIA, (-123.890, 46.225), (-123.610, 46.256), {}),
    "washington coast": (
        ("wa_coast_hycom_gofs_3hourly_2d.nc", None),
        (-125.7, 47.2),
        (-124.9, 48.6),
        {},
    ),
    "baltic": (("baltic_cmems_uvtotal_3hourly.nc", None), (13.3, 54.75), (13.8, 54.9), {}),
    "cape": (ETOPO20, (10.0, -30.0), (30.0, -40.0), {}),
    "pacific": (ETOPO20, (170.0, -20.0), (-170.0, -30.0), {}),
}


def real_request(case: str) -> Request:
    (current, floor), start, goal, options = REAL[case]
    paths = [None if name is None else real(name) for name in (current, floor)]
    return Request(*paths, start, goal, **options)


def from_file(path: Path) -> dict[str, NDArray[Any]]:
    """Current and axes by the netCDF library alone: (time, depth, lat, lon), gaps as NaN."""
    netcdf = pytest.importorskip("netCDF4")
    found: dict[str, NDArray[Any]] = {}
    kinds = {"lat": "lat", "lon": "lon", "latitude": "lat", "longitude": "lon", "depth": "depth"}
    with netcdf.Dataset(path) as file:
        for name, variable in file.variables.items():
            if name in kinds:
                found[kinds[name]] = np.asarray(variable[:], dtype=np.float64)
            for short, names in {
                "u": ("uo", "water_u", "utotal"),
                "v": ("vo", "water_v", "vtotal"),
            }.items():
                if name not in names:
                    continue
                variable.set_auto_maskandscale(False)
                stored = variable[:]
                scale = getattr(variable, "scale_factor", 1.0)
                values = np.where(stored == variable._FillValue, np.nan, stored * scale)
                if variable.dimensions[:2] == ("depth", "time"):
                    values = values.swapaxes(0, 1)
                for dimension, axis in (("depth", 1), ("time", 0)):
                    if dimension not in variable.dimensions:
                        values = np.expand_dims(values, min(axis, values.ndim - 2))
                found[short] = values
    return found


@pytest.mark.parametrize("case", REAL)
def test_real_files(case: str) -> None:
    """The scenario's current is the file's, node by node; the map lies within the data."""
    request = real_request(case)
    scenario = quiet(request)
    mission, domain = scenario["missions"][0], scenario["domain"]
    for axis in (0, 1):
        for end in ("start_m", "goal_m"):
            assert domain["min_m"][axis] < mission[end][axis] < domain["max_m"][axis]
    ends = ocean.to_lonlat(scenario, [mission["start_m"], mission["goal_m"]])
    np.testing.assert_allclose(ends[:, :2], [request.start[:2], request.goal[:2]], atol=1e-7)
    edge = domain["margin_m"]
    corners = [
        [x, y]
        for x in (domain["min_m"][0] - edge, domain["max_m"][0] + edge)
        for y in (domain["min_m"][1] - edge, domain["max_m"][1] + edge)
    ]
    centre = scenario["projection"]["longitude_deg"]
    lonlat = ocean.to_lonlat(scenario, corners)
    longitudes = centre + (lonlat[:, 0] - centre + 180.0) % 360.0 - 180.0
    for table in (*scenario.get("currents", []), *[scenario.get("seabed")]):
        if table is not None:
            assert table["longitude_deg"][0] <= longitudes.min()
            assert table["longitude_deg"][-1] >= longitudes.max()
            assert table["latitude_deg"][0] <= lonlat[:, 1].min()
            assert table["latitude_deg"][-1] >= lonlat[:, 1].max()
    if request.currents is None:
        return
    raw_file = from_file(Path(request.currents))
    table = scenario["currents"][0]
    rows = np.searchsorted(raw_file["lat"], np.array(table["latitude_deg"]) - 1e-9)
    columns = np.searchsorted(raw_file["lon"], np.array(table["longitude_deg"]) - 1e-9)
    levels = np.arange(len(table.get("depth_m", [0])))
    if request.depth_m:
        levels = np.flatnonzero(raw_file["depth"] == request.depth_m)
    for found, name in zip(current_grid(scenario), ("u", "v"), strict=True):
        there = raw_file[name][:, levels][..., rows[:, None], columns]
        known = np.isfinite(there)
        assert known.mean() > 0.2
        np.testing.assert_allclose(found[known], there[known], atol=1e-6)


@pytest.mark.parametrize(
    ("case", "margin_m", "fastest", "place"),
    [
        ("gulf stream", None, 2.01, (-68.83, 38.17)),
        ("gibraltar", None, 1.14, (-3.67, 36.17)),
        ("hourly", 150e3, 1.07, (-97.44, 22.76)),
        ("columbia river", None, 1.54, (-123.90, 46.24)),
    ],
)
def test_known_extremes(
    case: str, margin_m: float | None, fastest: float, place: tuple[float, float]
) -> None:
    """The fastest current of a file, found by other means, is where it should be."""
    scenario = quiet(replace(real_request(case), margin_m=margin_m))
    u, v = current_grid(scenario)
    speed = np.hypot(u, v)
    _, _, row, column = np.unravel_index(int(np.nanargmax(speed)), speed.shape)
    table = scenario["currents"][0]
    assert float(np.nanmax(speed)) == pytest.approx(fastest, abs=0.006)
    assert table["longitude_deg"][column] == pytest.approx(place[0], abs=0.006)
    assert table["latitude_deg"][row] == pytest.approx(place[1], abs=0.006)


@pytest.mark.parametrize(
    ("name", "as_currents", "message"),
    [
        ("gulf_of_maine_doppio_roms_sigma_25h.nc", True, "staggered"),
        ("gulf_of_maine_doppio_roms_sigma_25h.nc", False, "curvilinear"),
        ("sf_bay_sfbofs_fvcom_mesh_10h.nc", True, "triangles"),
        ("sf_bay_sfbofs_fvcom_mesh_10h.nc", False, "triangles"),
        ("columbia_river_creofs_selfe_mesh.nc", True, "triangles"),
        ("columbia_river_creofs_selfe_mesh.nc", False, "triangles"),
        ("bathy_salish_sea_nemo_500m_curvilinear.nc", False, "curvilinear"),
        ("bathy_haro_strait_curvilinear.nc", False, "curvilinear"),
        ("glider_seaexplorer_eva035_201907.nc", True, "has no current"),
        ("bathy_etopo5_agulhas.nc", True, "has no current; its variables are: elevation"),
    ],
)
def test_real_refusals(name: str, as_currents: bool, message: str) -> None:
    path = real(name)
    files = (path, None) if as_currents else (None, path)
    with pytest.raises(ValueError, match=message) as said:
        build(Request(*files, START, GOAL))
    assert name in str(said.value)


@pytest.mark.parametrize("case", REAL)
def test_real_worlds(case: str) -> None:
    """In the engine: currents as in the file, land solid, deep water free, start and goal clear."""
    request = real_request(case)
    scenario = quiet(request)
    world = auvgym.World(auvgym.Scenario.from_dict(scenario))
    assert (world.clearance(np.stack([world.start, world.goal])) > 0.0).all()
    depth = scenario["domain"]["min_m"][2]
    if "seabed" in scenario:
        _, metres, inside = nodes(scenario, scenario["seabed"])
        floor = seabed_grid(scenario).ravel()[inside]
        points = np.column_stack([metres[inside], np.full(inside.sum(), depth)])
        clearance = world.clearance(points)
        assert (clearance[floor <= 0.0] < 0.0).all()
        assert (clearance[floor > depth + 0.2 * floor.max()] > 0.0).all()
        assert ((clearance > 0.0) == (floor > depth)).mean() > 0.97
    if "currents" in scenario:
        table = scenario["currents"][0]
        degrees, metres, inside = nodes(scenario, table)
        u, v = (values[0, 0].ravel() for values in current_grid(scenario))
        inside &= np.isfinite(u)
        u, v = u[inside], v[inside]
        east = east_on_the_map(Projection(**scenario["projection"]), degrees[inside])
        points = np.column_stack([metres[inside], np.full(inside.sum(), depth)])
        found = world.current(points, time_s=0.0)[:, :2]
        turned = np.column_stack([u * east[:, 0] - v * east[:, 1], u * east[:, 1] + v * east[:, 0]])
        error = np.hypot(*(found - turned).T)
        assert np.sqrt((error**2).mean()) < 0.03
        # Resampling rounds the sharpest fronts off, at half the file's spacing.
        assert error.max() < 0.2


@pytest.mark.parametrize("case", ["gulf stream", "gibraltar", "dover strait", "3-D"])
def test_the_flow_in_real_worlds(case: str) -> None:
    """Planner iifds gets round land and sea floor, and tuned for time it is the faster."""
    scenario = auvgym.Scenario.from_dict(quiet(replace(real_request(case), vehicle_speed_mps=2.5)))
    world = auvgym.World(scenario)
    options = {"cost": "time", "cost_options": {"collision": "segment"}}
    plain = auvgym.plan(world, "iifds", **options)
    tuned = auvgym.plan(
        world, "iifds-de", objective={"kind": "time"}, max_evaluations=60, **options
    )
    for plan in (plain, tuned):
        assert plan.feasible
        assert (world.clearance(plan.waypoints) > 0.0).all()
    assert tuned.cost["time_s"] <= 1.02 * plain.cost["time_s"]
