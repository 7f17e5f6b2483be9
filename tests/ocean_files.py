"""Small NetCDF files for the tests of the real-ocean loader, and readers of what it makes."""

from __future__ import annotations

import base64
import os
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

xr = pytest.importorskip("xarray", reason="needs auvgym[ocean]")
pytest.importorskip("netCDF4", reason="needs auvgym[ocean]")
pytest.importorskip("pyproj", reason="needs auvgym[ocean]")
pytest.importorskip("scipy", reason="needs auvgym[ocean]")

from auvgym.ocean import OceanDataWarning, Projection, Request, build  # noqa: E402

DATA = Path(os.environ.get("AUVGYM_DATA") or Path(__file__).parents[2] / "shared" / "data")

LON = np.round(np.arange(-71.0, -68.99, 0.25), 6)
LAT = np.round(np.arange(38.0, 40.01, 0.25), 6)
START, GOAL = (-70.6, 38.4), (-69.4, 39.6)
CURRENT_NAMES = {"u": "eastward_sea_water_velocity", "v": "northward_sea_water_velocity"}


def unpack(text: str, *shape: int) -> NDArray[np.float32]:
    """Numbers of a scenario's grid."""
    assert text.startswith("f32le:")
    return np.frombuffer(base64.b64decode(text[6:]), dtype="<f4").reshape(shape)


def current_grid(scenario: dict[str, Any]) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """u, v as (time, depth, latitude, longitude)."""
    table = scenario["currents"][0]
    shape = (
        len(table.get("time_s", [0])),
        len(table.get("depth_m", [0])),
        len(table["latitude_deg"]),
        len(table["longitude_deg"]),
    )
    return unpack(table["u_mps"], *shape), unpack(table["v_mps"], *shape)


def seabed_grid(scenario: dict[str, Any]) -> NDArray[np.float32]:
    table = scenario["seabed"]
    return unpack(table["depth_m"], len(table["latitude_deg"]), len(table["longitude_deg"]))


def current_file(
    times: int = 1, depths: tuple[float, ...] = (0.0,), land: bool = False
) -> xr.Dataset:
    """A smooth current (time, depth, lat, lon) in the plainest convention."""
    t, z, y, x = np.meshgrid(np.arange(times), np.array(depths), LAT, LON, indexing="ij")
    u = 0.4 + 0.1 * (x + 70.0) + 0.05 * (y - 39.0) + 0.1 * t - 0.001 * z
    v = -0.2 + 0.07 * (y - 39.0) - 0.02 * t
    if land:
        u = np.where((x < -70.8) & (y > 39.5), np.nan, u)
    return xr.Dataset(
        {
            name: (
                ("time", "depth", "lat", "lon"),
                values.astype(np.float32),
                {"units": "m s-1", "standard_name": CURRENT_NAMES[name]},
            )
            for name, values in (("u", u), ("v", v))
        },
        coords={
            "time": ("time", np.arange(times) * 6.0, {"units": "hours since 2020-01-01"}),
            "depth": ("depth", np.array(depths), {"units": "m", "positive": "down"}),
            "lat": ("lat", LAT, {"units": "degrees_north"}),
            "lon": ("lon", LON, {"units": "degrees_east"}),
        },
    )


def floor_file(sign: float = -1.0, name: str = "elevation", **attributes: str) -> xr.Dataset:
    """A sea floor 100 m deep at the western edge, 900 m at the eastern, land in one corner."""
    y, x = np.meshgrid(LAT, LON, indexing="ij")
    depth = 100.0 + 400.0 * (x + 71.0)
    depth = np.where((x > -69.3) & (y < 38.3), -50.0, depth)
    return xr.Dataset(
        {name: (("lat", "lon"), sign * depth, {"units": "m", **attributes})},
        coords={
            "lat": ("lat", LAT, {"units": "degrees_north"}),
            "lon": ("lon", LON, {"units": "degrees_east"}),
        },
    )


def write(dataset: xr.Dataset, path: Path, **options: Any) -> Path:
    dataset.to_netcdf(path, engine="netcdf4", **options)
    return path


def quiet(request: Request) -> dict[str, Any]:
    """Build without the warnings that other tests are about."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OceanDataWarning)
        return build(request)


def real(name: str) -> Path:
    """A real file, or a skipped test that says why."""
    path = DATA / name
    if not path.is_file():
        pytest.skip(f"{path} is not at hand; set AUVGYM_DATA to the folder of real ocean data")
    return path


def east_on_the_map(projection: Projection, points_deg: NDArray[Any]) -> NDArray[np.float64]:
    """Unit vectors (n, 2) of "east" at (n, 2) longitudes and latitudes, by differences."""
    step = np.array([1e-4, 0.0])
    ahead = projection.to_local(points_deg + step) - projection.to_local(points_deg - step)
    return np.asarray(ahead / np.linalg.norm(ahead, axis=1, keepdims=True))


def nodes(
    scenario: dict[str, Any], table: dict[str, Any]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
    """Degrees (n, 2) and metres (n, 2) of a grid's nodes, and which of them lie in the box."""
    longitude, latitude = np.meshgrid(table["longitude_deg"], table["latitude_deg"])
    degrees = np.stack([longitude.ravel(), latitude.ravel()], axis=1)
    metres = Projection(**scenario["projection"]).to_local(degrees)
    low, high = (np.array(scenario["domain"][key][:2]) for key in ("min_m", "max_m"))
    return degrees, metres, ((metres > low) & (metres < high)).all(axis=1)
