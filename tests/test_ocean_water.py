"""The real-ocean loader: gaps, land, depths, starts and goals."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from ocean_files import (
    GOAL,
    START,
    current_file,
    current_grid,
    floor_file,
    quiet,
    seabed_grid,
    write,
    xr,
)

from auvgym.ocean import OceanDataWarning, Request, build


@pytest.fixture
def currents(tmp_path: Path) -> Path:
    return write(current_file(), tmp_path / "current.nc")


@pytest.fixture
def floor(tmp_path: Path) -> Path:
    return write(floor_file(), tmp_path / "floor.nc")


def gap_files(tmp_path: Path) -> tuple[Path, Path]:
    """A current with a hole of 2 x 2 nodes in the middle of deep water."""
    dataset = current_file()
    dataset["u"][0, 0, 4:6, 4:6] = np.nan
    return (
        write(dataset, tmp_path / "gap.nc"),
        write(floor_file(), tmp_path / "floor.nc"),
    )


def test_gaps_over_water_are_filled_from_the_nearest_node_and_said(tmp_path: Path) -> None:
    current, floor = gap_files(tmp_path)
    with pytest.warns(OceanDataWarning, match=r"4 of \d+ nodes are water .* nearest known") as said:
        scenario = build(Request(current, floor, START, GOAL))
    assert str(said[0].message) in scenario["notes"]
    u, v = current_grid(scenario)
    assert np.isfinite(u).all()
    assert np.isfinite(v).all()
    whole, _ = current_grid(
        quiet(Request(write(current_file(), tmp_path / "w.nc"), floor, START, GOAL))
    )
    # East-west is the short way at 39 degrees north.
    np.testing.assert_array_equal(u[0, 0, 4:6, 4], whole[0, 0, 4:6, 3])
    np.testing.assert_array_equal(u[0, 0, 4:6, 5], whole[0, 0, 4:6, 6])


def test_gaps_raise_or_become_land_when_asked(tmp_path: Path) -> None:
    current, floor = gap_files(tmp_path)
    with pytest.raises(ValueError, match=r'missing="error": 4 of'):
        build(Request(current, floor, START, GOAL, missing="error"))
    with pytest.warns(OceanDataWarning, match="4 nodes of the sea floor .* made land"):
        scenario = build(Request(current, floor, START, GOAL, missing="land"))
    assert (seabed_grid(scenario)[4:6, 4:6] <= 0.0).all()
    assert np.isnan(current_grid(scenario)[0][0, 0, 4:6, 4:6]).all()


def test_without_bathymetry_land_is_where_there_is_no_current(tmp_path: Path) -> None:
    current, _ = gap_files(tmp_path)
    scenario = build(Request(current, None, START, GOAL))
    depth = seabed_grid(scenario)
    assert (depth[4:6, 4:6] <= 0.0).all()
    assert (depth <= 0.0).sum() == 4
    assert "No bathymetry was given: land is where gap.nc has no current (4 of" in " ".join(
        scenario["notes"]
    )


def test_land_marked_by_zeros_is_suspected(tmp_path: Path) -> None:
    dataset = current_file()
    for name in ("u", "v"):
        dataset[name][0, 0, :3, :3] = 0.0
    with pytest.warns(OceanDataWarning, match="9 of 81 nodes .* exactly no current"):
        build(Request(write(dataset, tmp_path / "zeros.nc"), None, START, GOAL))


def test_no_island_is_lost(tmp_path: Path) -> None:
    """A low island of one node gets the height that keeps it where the engine resamples."""
    dataset = floor_file()
    dataset["elevation"][:] = -800.0
    dataset["elevation"][4, 4] = 1.0
    dataset["elevation"][2, 6] = np.nan
    scenario = build(Request(None, write(dataset, tmp_path / "island.nc"), START, GOAL))
    depth = seabed_grid(scenario)
    assert depth[4, 4] == depth[2, 6] == -800.0
    assert (depth == 800.0).sum() == depth.size - 2
    notes = " ".join(scenario["notes"])
    assert "1 of 81 nodes have no depth and are taken as land" in notes
    assert "2 land nodes beside water are made as high as it is deep" in notes


def model_file() -> xr.Dataset:
    """Three levels; the deepest ends where the floor of ``floor_file`` does, halfway rounded."""
    dataset = current_file(depths=(0.0, 200.0, 600.0))
    dataset["u"][0, 1:, :, :2] = np.nan
    dataset["u"][0, 2, :, :6] = np.nan
    return dataset


def test_mask_of_a_model_gives_its_depth(tmp_path: Path) -> None:
    path = write(model_file(), tmp_path / "model.nc")
    scenario = build(Request(path, None, START, GOAL, dimensions=3))
    np.testing.assert_array_equal(
        seabed_grid(scenario), np.tile([100.0] * 2 + [400.0] * 4 + [600.0] * 3, (9, 1))
    )
    assert scenario["domain"]["min_m"][2] == 0.0
    assert scenario["domain"]["max_m"][2] == 600.0
    assert scenario["currents"][0]["depth_m"] == [0.0, 200.0, 600.0]


def test_below_the_deepest_current_it_goes_on(tmp_path: Path) -> None:
    path = write(model_file(), tmp_path / "model.nc")
    floor = write(floor_file(-2.0), tmp_path / "floor.nc")
    scenario = build(Request(path, floor, START, GOAL, dimensions=3))
    u, _ = current_grid(scenario)
    np.testing.assert_array_equal(u[0, 1, :, :2], u[0, 0, :, :2])
    np.testing.assert_array_equal(u[0, 2, :, :2], u[0, 0, :, :2])
    np.testing.assert_array_equal(u[0, 2, :, 2:6], u[0, 1, :, 2:6])
    assert re.search(r"\d+ water nodes lie below the deepest level", " ".join(scenario["notes"]))


def test_two_dimensions_take_one_depth(tmp_path: Path) -> None:
    path = write(model_file(), tmp_path / "model.nc")
    raw = model_file()["u"].values[0]
    at_100 = build(Request(path, None, (*START, 100.0), (-69.4, 39.6), depth_m=100.0))
    assert at_100["domain"]["min_m"][2] == at_100["domain"]["max_m"][2] == 100.0
    assert at_100["missions"][0]["start_m"][2] == 100.0
    assert "depth_m" not in at_100["currents"][0]
    u, _ = current_grid(at_100)
    np.testing.assert_allclose(u[0, 0, :, 2:], (raw[0] + raw[1])[:, 2:] / 2.0, atol=1e-6)
    assert "between the levels at 0 m and 200 m" in " ".join(at_100["notes"])
    with pytest.warns(OceanDataWarning, match="the level at 600 m, the deepest of"):
        build(Request(path, None, (-69.3, 38.4), (-69.3, 39.6), depth_m=650.0))


def test_one_level_in_three_dimensions(currents: Path, floor: Path) -> None:
    with pytest.warns(OceanDataWarning, match="at 0 m is used at all depths"):
        scenario = build(Request(currents, floor, START, GOAL, dimensions=3))
    assert "depth_m" not in scenario["currents"][0]
    assert scenario["domain"]["max_m"][2] == 900.0


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"depth_m": 700.0}, r"start .* depth 700 m is below the sea floor there, 260\.0 m"),
        ({"goal": (-69.1, 38.1)}, r"goal \(-69\.1, 38\.1\) is on land by floor\.nc"),
        ({"start": (-80.0, 38.4)}, r"start \(-80, 38\.4\) is outside the data: longitude -71"),
        ({"start": (38.4, -70.6)}, r"start \(38\.4, -70\.6\) is outside the data"),
        ({"goal": (-69.4, 40.0)}, r"goal \(-69\.4, 40\) is at the very edge of the data"),
        ({"start": (-70.6, 99.0)}, "latitude 99 must lie in -90 .. 90"),
        ({"start": (-70.6,)}, r"start=\(-70\.6,\): must be \(longitude, latitude\)"),
        ({"start": (-70.6, 38.4, -3.0)}, r"depth -3 m is above the surface \(0 m\)"),
        ({"start": (-70.6, 38.4, 3.0)}, "depths differ"),
        ({"goal": START}, r"is 0 km from start"),
        ({"dimensions": 4}, "dimensions=4: must be 2 or 3"),
        ({"max_depth_m": 5.0}, "max_depth_m=5.0: is for dimensions=3"),
        ({"missing": "zero"}, "missing='zero'"),
        ({"margin_m": -1.0}, "margin_m=-1.0: must be greater than 0"),
        ({"vehicle_speed_mps": 0.0}, "vehicle_speed_mps=0.0: must be greater than 0"),
        ({"depth_m": -1.0}, "depth_m=-1.0: must be 0"),
        ({"time_factor": 0.5}, "time_factor=0.5: must be at least 1"),
        ({"currents": None, "bathymetry": None}, "at least one file is needed"),
        ({"dimensions": 3, "bathymetry": None}, "tells nothing of the sea floor"),
        ({"dimensions": 3, "start": (*START, 9.0), "max_depth_m": 5.0}, "max_depth_m=5"),
        ({"current_names": ("a", "v")}, "has no variable 'a' for the current"),
        ({"bathymetry_name": "a"}, "has no variable 'a'; its variables are: elevation"),
        ({"currents": None, "time": "2020-01-01"}, "there are no currents"),
    ],
)
def test_wrong_arguments(
    changes: dict[str, Any], message: str, currents: Path, floor: Path
) -> None:
    request = replace(Request(currents, floor, START, GOAL), **changes)
    with pytest.raises(ValueError, match=message):
        quiet(request)


@pytest.mark.parametrize("goal", [(-69.1, 38.1), (-60.0, 38.1), (-69.9, 38.97)])
def test_the_suggested_place_is_good(goal: tuple[float, float], tmp_path: Path) -> None:
    dataset = current_file()
    dataset["u"][0, 0, 3:6, 3:6] = np.nan
    request = Request(
        write(dataset, tmp_path / "gap.nc"),
        write(floor_file(), tmp_path / "floor.nc"),
        START,
        goal,
    )
    with pytest.raises(ValueError, match="nearest such place") as said:
        quiet(request)
    place = re.search(r"known is \(([-\d.]+), ([-\d.]+)\)", str(said.value))
    assert place is not None
    quiet(replace(request, goal=(float(place[1]), float(place[2]))))
