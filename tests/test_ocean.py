"""The real-ocean loader: every convention says the same, times are chosen."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from ocean_files import (
    GOAL,
    LAT,
    LON,
    START,
    current_file,
    current_grid,
    floor_file,
    seabed_grid,
    write,
    xr,
)

from auvgym.ocean import Request, build


@pytest.fixture
def currents(tmp_path: Path) -> Path:
    return write(current_file(), tmp_path / "current.nc")


def packed(dataset: xr.Dataset, path: Path) -> Path:
    how = {"dtype": "int16", "scale_factor": 0.001, "add_offset": 0.1, "_FillValue": -30000}
    return write(dataset, path, encoding={"u": how, "v": how})


def renamed(u: str, v: str) -> Callable[[xr.Dataset, Path], Path]:
    def make(dataset: xr.Dataset, path: Path) -> Path:
        for name in ("u", "v"):
            del dataset[name].attrs["standard_name"]
        return write(dataset.rename({"u": u, "v": v}), path)

    return make


def bare_axes(dataset: xr.Dataset, path: Path) -> Path:
    for name in ("lat", "lon", "depth"):
        dataset[name].attrs.clear()
    return write(dataset.rename({"lat": "latitude", "lon": "longitude"}), path)


def standard_names_only(dataset: xr.Dataset, path: Path) -> Path:
    dataset = dataset.rename({"u": "a", "v": "b", "lat": "north", "lon": "east"})
    wind = xr.zeros_like(dataset["a"]).assign_attrs(standard_name="eastward_wind")
    return write(dataset.assign(u=wind, v=wind), path)


def unmarked_fill(dataset: xr.Dataset, path: Path) -> Path:
    """Land as 999, said nowhere."""
    for name in ("u", "v"):
        dataset[name] = dataset[name].fillna(999.0)
        dataset[name].encoding["_FillValue"] = None
    return write(dataset, path)


def scaled(factor: float, units: str) -> Callable[[xr.Dataset, Path], Path]:
    def make(dataset: xr.Dataset, path: Path) -> Path:
        for name in ("u", "v"):
            dataset[name] = (dataset[name] * factor).assign_attrs(units=units)
        return write(dataset, path)

    return make


def depth_up(dataset: xr.Dataset, path: Path) -> Path:
    up = {"units": "m", "positive": "up"}
    return write(dataset.assign_coords(depth=("depth", -dataset.depth.values, up)), path)


def nameless_depth_up(dataset: xr.Dataset, path: Path) -> Path:
    dataset = dataset.assign_coords(depth=("depth", -dataset.depth.values, {"units": "m"}))
    return write(dataset.isel(depth=slice(None, None, -1)), path)


CONVENTIONS: dict[str, Callable[[xr.Dataset, Path], Path]] = {
    "packed": packed,
    "uo/vo": renamed("uo", "vo"),
    "water_u/water_v": renamed("water_u", "water_v"),
    "utotal/vtotal": renamed("utotal", "vtotal"),
    "U/V": renamed("U", "V"),
    "standard names only": standard_names_only,
    "0..360": lambda d, p: write(d.assign_coords(lon=("lon", LON + 360.0, d.lon.attrs)), p),
    "descending": lambda d, p: write(d.isel(lat=slice(None, None, -1)), p),
    "all descending": lambda d, p: write(
        d.isel({name: slice(None, None, -1) for name in ("lat", "lon", "depth", "time")}), p
    ),
    "depth first": lambda d, p: write(d.transpose("depth", "time", "lat", "lon"), p),
    "longitude first": lambda d, p: write(d.transpose("lon", "lat", "depth", "time"), p),
    "bare axes": bare_axes,
    "unmarked fill": unmarked_fill,
    "cm/s": scaled(100.0, "cm s-1"),
    "knots": scaled(3600.0 / 1852.0, "kn"),
    "depth positive up": depth_up,
    "depth below 0": nameless_depth_up,
    "NetCDF-3": lambda d, p: write(d, p.with_suffix(".nc4"), format="NETCDF3_CLASSIC"),
    "NetCDF-3 64 bit": lambda d, p: write(d, p, format="NETCDF3_64BIT"),
    "NetCDF-5": lambda d, p: write(d, p.with_suffix(".bin"), format="NETCDF3_64BIT_DATA"),
    "float64": lambda d, p: write(d.astype(np.float64), p),
}


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_every_convention_says_the_same(convention: str, tmp_path: Path) -> None:
    plain = current_file(times=2, depths=(0.0, 100.0, 400.0), land=True)
    wanted = Request(write(plain, tmp_path / "plain.nc"), None, START, GOAL, dimensions=3)
    path = CONVENTIONS[convention](plain.copy(deep=True), tmp_path / "other.nc")
    expected = build(wanted)
    found = build(replace(wanted, currents=path))
    for key in ("domain", "missions", "projection", "sections", "limits", "vehicle"):
        assert found[key] == expected[key], key
    for axis in ("longitude_deg", "latitude_deg", "depth_m", "time_s"):
        np.testing.assert_allclose(
            found["currents"][0][axis], expected["currents"][0][axis], atol=1e-9
        )
    for found_values, values in zip(current_grid(found), current_grid(expected), strict=True):
        np.testing.assert_allclose(found_values, values, atol=6e-4, equal_nan=True)
    np.testing.assert_array_equal(seabed_grid(found), seabed_grid(expected))
    assert (seabed_grid(found) <= 0.0).any()


def test_a_closed_circle_of_longitudes(tmp_path: Path) -> None:
    """20 .. 380 degrees with the seam stored twice, not to the last digit: no node is lost."""
    around = np.arange(20.25, 380.3, 0.25)
    around[-1] -= 4e-5
    attributes = {"units": "degrees_east"}
    values = np.tile(1000.0 + around % 360.0, (LAT.size, 1))
    dataset = xr.Dataset(
        {"deptho": (("lat", "lon"), values)},
        coords={"lat": ("lat", LAT), "lon": ("lon", around, attributes)},
    )
    path = write(dataset, tmp_path / "circle.nc")
    for shift in (0.0, 89.4, 90.3, 250.0):
        start, goal = (START[0] + shift, START[1]), (GOAL[0] + shift, GOAL[1])
        scenario = build(Request(None, path, start, goal))
        longitudes = np.array(scenario["seabed"]["longitude_deg"])
        np.testing.assert_allclose(np.diff(longitudes), 0.25, atol=1e-4)
        expected = 1000.0 + longitudes % 360.0
        np.testing.assert_allclose(seabed_grid(scenario)[0], expected, atol=1e-3)


@pytest.mark.parametrize(
    ("sign", "name", "attributes"),
    [
        (-1.0, "elevation", {}),
        (1.0, "deptho", {}),
        (1.0, "elevation", {"positive": "down"}),
        (-1.0, "anything", {"standard_name": "height_above_mean_sea_level"}),
        (1.0, "anything", {"standard_name": "sea_floor_depth_below_geoid"}),
        (-1.0, "ROSE", {}),
        (-1.0, "topo", {}),
        (-1.0, "z", {}),
        (1.0, "Bathymetry", {}),
        (1.0, "h", {}),
    ],
)
def test_bathymetry_is_positive_down(
    sign: float, name: str, attributes: dict[str, str], tmp_path: Path
) -> None:
    path = write(floor_file(sign, name, **attributes), tmp_path / "floor.nc")
    scenario = build(Request(None, path, START, GOAL))
    depth = seabed_grid(scenario)
    assert depth.max() == pytest.approx(900.0)
    expected = -floor_file()["elevation"].values
    np.testing.assert_allclose(depth[expected > 0.0], expected[expected > 0.0], rtol=1e-6)
    assert (depth[expected <= 0.0] <= -50.0).all()
    assert "the water is still" in " ".join(scenario["notes"])
    assert "currents" not in scenario


def test_direction_by_evidence_or_as_asked(tmp_path: Path) -> None:
    water = floor_file(-1.0, "relief_of_something").clip(max=-1.0)
    path = write(water, tmp_path / "floor.nc")
    wanted = Request(None, path, START, GOAL, bathymetry_name="relief_of_something")
    assert seabed_grid(build(wanted)).max() == pytest.approx(900.0)
    mixed = write(floor_file(-1.0, "relief_of_something"), tmp_path / "mixed.nc")
    with pytest.raises(ValueError, match=r"-900 to 50.*bathymetry_positive"):
        build(replace(wanted, bathymetry=mixed))
    asked = build(replace(wanted, bathymetry=mixed, bathymetry_positive="up"))
    assert seabed_grid(asked).max() == pytest.approx(900.0)


def test_one_slice_is_steady_and_said(currents: Path) -> None:
    scenario = build(Request(currents, None, START, GOAL))
    assert "time_s" not in scenario["currents"][0]
    assert "one time slice, 2020-01-01T00:00: the current is steady" in " ".join(scenario["notes"])


def test_times(tmp_path: Path) -> None:
    path = write(current_file(times=5), tmp_path / "series.nc")
    whole = build(Request(path, None, START, GOAL))
    assert whole["currents"][0]["time_s"] == [0.0, 21600.0, 43200.0, 64800.0, 86400.0]
    u, _ = current_grid(whole)
    late = build(Request(path, None, START, GOAL, time="2020-01-01T09:00Z"))
    assert late["currents"][0]["time_s"] == [0.0, 10800.0, 32400.0, 54000.0]
    np.testing.assert_allclose(current_grid(late)[0][0], (u[1] + u[2]) / 2.0, atol=1e-6)
    np.testing.assert_array_equal(current_grid(late)[0][1:], u[2:])
    moment = build(Request(path, None, START, GOAL, time=("2020-01-01T12:00",) * 2))
    assert "time_s" not in moment["currents"][0]
    np.testing.assert_array_equal(current_grid(moment)[0][0], u[2])
    part = build(Request(path, None, START, GOAL, time=("2020-01-01T06:00", "2020-01-01T15:00")))
    assert part["currents"][0]["time_s"] == [0.0, 21600.0, 32400.0]


@pytest.mark.parametrize(
    ("time", "message"),
    [
        ("2020-01-03", r"time=2020-01-03T00:00: .* holds 2020-01-01T00:00 \.\. 2020-01-01T06:00"),
        ("yesterday", "time='yesterday': must be an ISO time"),
        (("2020-01-01T06:00", "2020-01-01"), "the second time is before the first"),
        (("2020-01-01",), "must be None, an ISO time or a pair"),
    ],
)
def test_wrong_times(time: Any, message: str, tmp_path: Path) -> None:
    path = write(current_file(times=2), tmp_path / "series.nc")
    with pytest.raises(ValueError, match=message):
        build(Request(path, None, START, GOAL, time=time))
