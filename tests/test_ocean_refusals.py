"""The real-ocean loader: grids and files that it refuses, and in which words."""

from __future__ import annotations

import warnings
from collections.abc import Callable
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
    floor_file,
    write,
    xr,
)

from auvgym.ocean import Request, build


@pytest.fixture
def floor(tmp_path: Path) -> Path:
    return write(floor_file(), tmp_path / "floor.nc")


def mesh(dataset: xr.Dataset, path: Path) -> Path:
    flat = dataset.stack(node=("lat", "lon")).reset_index("node")
    return write(flat, path)


def staggered(dataset: xr.Dataset, path: Path) -> Path:
    v = dataset["v"].isel(lat=slice(None, -1)).rename(lat="lat_v")
    return write(dataset.drop_vars("v").assign(v=v.drop_vars("lat_v")), path)


def curved(dataset: xr.Dataset, path: Path) -> Path:
    y, x = np.meshgrid(LAT, LON, indexing="ij")
    dataset = dataset.drop_vars(["lat", "lon"]).rename(lat="y", lon="x")
    return write(dataset.assign(nav_lat=(("y", "x"), y), nav_lon=(("y", "x"), x + 0.1 * y)), path)


def sigma(dataset: xr.Dataset, path: Path) -> Path:
    levels = ("depth", [-0.9, -0.1], {"standard_name": "ocean_s_coordinate_g2"})
    whole = xr.concat([dataset, dataset], dim="depth").assign_coords(depth=levels)
    return write(whole.rename(depth="s_rho"), path)


def cut(fraction: float, **options: Any) -> Callable[[xr.Dataset, Path], Path]:
    def make(dataset: xr.Dataset, path: Path) -> Path:
        raw = write(dataset, path, **options).read_bytes()
        path.write_bytes(raw[: int(len(raw) * fraction)])
        return path

    return make


def raw(content: bytes) -> Callable[[xr.Dataset, Path], Path]:
    def make(dataset: xr.Dataset, path: Path) -> Path:
        path.write_bytes(content)
        return path

    return make


def with_units(units: str) -> Callable[[xr.Dataset, Path], Path]:
    def make(dataset: xr.Dataset, path: Path) -> Path:
        dataset["u"].attrs["units"] = units
        return write(dataset, path)

    return make


def ensemble(dataset: xr.Dataset, path: Path) -> Path:
    return write(xr.concat([dataset, dataset], dim="member"), path)


def two_currents(dataset: xr.Dataset, path: Path) -> Path:
    others = dataset.rename({"u": "u_model", "v": "v_model"})
    return write(others.assign(u_tide=others.u_model, v_tide=others.v_model), path)


def odd_calendar(dataset: xr.Dataset, path: Path) -> Path:
    two = xr.concat([dataset, dataset], dim="time")
    attributes = {"units": "days since 2000-01-01", "calendar": "360_day"}
    return write(two.assign_coords(time=("time", [1.0, 2.0], attributes)), path)


REFUSED: dict[str, tuple[Callable[[xr.Dataset, Path], Path], str]] = {
    "triangles": (mesh, r"unstructured mesh \(triangles, dimension 'node'\).*regular grids"),
    "staggered": (staggered, "lie on different points, a staggered .*regular grids"),
    "curvilinear": (curved, r"curvilinear, rotated or projected grid \(nav_l.*regular grids"),
    "sigma": (sigma, r"terrain-following \(sigma\) levels 's_rho'.*regular grids"),
    "ensemble": (ensemble, "dimension 'member' .* is neither longitude"),
    "cut NetCDF-4": (cut(0.7), "cannot be read, it is damaged or cut off"),
    "cut NetCDF-3": (cut(0.7, format="NETCDF3_CLASSIC"), "cannot be read, it is damaged"),
    "cut at the end": (cut(0.97, format="NETCDF3_64BIT"), "cannot be read, it is damaged"),
    "text": (raw(b"lon,lat,u,v\n"), "is not a NetCDF file but something else"),
    "web page": (raw(b"<!DOCTYPE html>"), "is not a NetCDF file but a web page"),
    "gzip": (raw(b"\x1f\x8b\x08\x00"), "gzip-compressed: unpack it first"),
    "GRIB": (raw(b"GRIB\x00\x00\x00\x02"), "a GRIB file"),
    "empty": (raw(b""), "is not a NetCDF file but empty"),
    "no current": (
        lambda d, p: write(d.drop_vars("v"), p),
        r"has no current; its variables are: u \(time: 1.*eastward/northward_sea_water",
    ),
    "all missing": (lambda d, p: write(d * np.nan, p), "u/v has no value at all"),
    "absurd": (lambda d, p: write(d + 99.0, p), "no value at all .* below 20 m/s"),
    "unknown units": (with_units("furlong/fortnight"), "'furlong/fortnight' and 'm s-1'"),
    "two currents": (two_currents, "more than one current: u_model, u_tide"),
    "odd calendar": (odd_calendar, "calendar '360_day'.* is not a time of the standard"),
    "repeated time": (lambda d, p: write(xr.concat([d, d], dim="time"), p), "one time twice"),
    "one column": (lambda d, p: write(d.isel(lon=[0]), p), "longitude axis has one node"),
    "far away": (
        lambda d, p: write(d.assign_coords(lat=("lat", LAT - 60.0, d.lat.attrs)), p),
        "currents and bathymetry do not overlap",
    ),
}


@pytest.mark.parametrize("kind", REFUSED)
def test_refusals_name_the_file_and_say_why(kind: str, tmp_path: Path, floor: Path) -> None:
    make, message = REFUSED[kind]
    path = make(current_file(), tmp_path / "odd.nc")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(ValueError, match=message) as said:
            build(Request(path, floor, START, GOAL))
    assert "odd.nc" in str(said.value)


def test_a_missing_file_is_not_found(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"nowhere\.nc: there is no such file"):
        build(Request(tmp_path / "nowhere.nc", None, START, GOAL))
