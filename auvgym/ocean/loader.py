"""``load``: files, a start and a goal in; a scenario in local metres out."""

from __future__ import annotations

import base64
import re
import warnings
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from auvgym.ocean.ends import check_end
from auvgym.ocean.files import OceanDataWarning
from auvgym.ocean.layout import describe, map_box
from auvgym.ocean.mission import Extent, Place, lay_out, middle_longitude, near
from auvgym.ocean.request import Missing, PathLike, Request, TimeWish
from auvgym.ocean.sea import Sea, read_sea
from auvgym.ocean.sources import open_sources

if TYPE_CHECKING:
    from auvgym import Scenario

# A scenario file holds at most 64 MB of text.
LARGEST_TEXT_BYTES = 60_000_000


def load(
    currents: PathLike | None = None,
    bathymetry: PathLike | None = None,
    *,
    start: Sequence[float],
    goal: Sequence[float],
    vehicle_speed_mps: float = 1.0,
    time: TimeWish = None,
    depth_m: float | None = None,
    margin_m: float | None = None,
    dimensions: int = 2,
    max_depth_m: float | None = None,
    missing: Missing = "fill",
    time_factor: float = 4.0,
    name: str | None = None,
    current_names: tuple[str, str] | None = None,
    bathymetry_name: str | None = None,
    bathymetry_positive: str | None = None,
) -> Scenario:
    """A scenario in local metres (x east, y north of the mission's middle) from NetCDF files.

    ``currents``, ``bathymetry``: paths; at least one. Without bathymetry, land is where the
    surface current is missing; without currents the water is still.
    ``start``, ``goal``: (longitude, latitude[, depth]) in degrees east, degrees north, m.
    ``vehicle_speed_mps``: speed through water.
    ``time``: None = the whole series (one slice = steady); an ISO time (UTC) = from then on; a
    pair of ISO times = from the first to the second, equal ones = that moment, steady.
    ``depth_m``: the depth of start and goal where they give none (default 0, the surface).
    ``margin_m``: water kept around start and goal; default the larger of 100 km and half the
    distance between them; the data's edge limits it.
    ``dimensions``: 2 = at one depth, 3 = from the surface to the floor or to ``max_depth_m``.
    ``missing``: water (by the bathymetry) without a current: "fill" = from the nearest node of
    its level, "error" = raise, "land" = make it land.
    ``time_factor``: time and energy limits over those of the straight run in still water.
    ``name``: of the scenario; default the first file's.
    ``current_names`` (u, v), ``bathymetry_name``, ``bathymetry_positive`` ("up" or "down"): for
    files whose variables are not recognised.

    The scenario's ``notes`` say what was decided; what needs attention is also an
    :class:`OceanDataWarning`. Raises FileNotFoundError; ValueError naming the argument or file,
    the value and what was allowed; ImportError saying what to install.
    """
    from auvgym import Scenario

    request = Request(
        currents, bathymetry, start, goal, vehicle_speed_mps, time, depth_m, margin_m, dimensions,
        max_depth_m, missing, time_factor, name, current_names, bathymetry_name,
        bathymetry_positive,
    )  # fmt: skip
    return Scenario.from_dict(build(request, stacklevel=3))


def build(request: Request, *, stacklevel: int = 2) -> dict[str, Any]:
    """The scenario as a plain dict, in the keys of the scenario file. Errors as :func:`load`."""
    request.check()
    start, goal = request.places()
    middle = middle_longitude(start, goal)
    start, goal = (_turned(place, middle) for place in (start, goal))
    with open_sources(request, middle) as whole:
        data = whole.extent()
        # An end outside the data is moved to its edge, so that the water nearest to it can be
        # named in the error that follows.
        mission = lay_out(_clamped(start, data), _clamped(goal, data))
        margin_m = request.margin_m or max(0.5 * mission.distance_m, 100_000.0)
        sources = whole.crop(mission.window(mission.box(1.1 * margin_m)))
        sea = read_sea(sources, request, start.depth if request.dimensions == 2 else None)
        box, edge_m = map_box(mission, margin_m, sources.extent())
    for place in (start, goal):
        check_end(place, mission, data, box, sea)
    tables = describe(request, mission, box, edge_m, sea, margin_m)
    for text in sea.warnings:
        warnings.warn(text, OceanDataWarning, stacklevel=stacklevel)
    return {
        "schema": 1,
        "name": request.name or _name(request),
        "description": f"from ({start}) to ({goal})",
        "dimensions": request.dimensions,
        "notes": sea.notes,
        **tables,
        **_grids(sea),
    }


def _turned(place: Place, middle: float) -> Place:
    """The place with its longitude near the mission's middle."""
    return replace(place, longitude=float(near(place.longitude, middle)))


def _clamped(place: Place, data: Extent) -> Place:
    return replace(
        place,
        longitude=float(np.clip(place.longitude, data.west, data.east)),
        latitude=float(np.clip(place.latitude, data.south, data.north)),
    )


def _name(request: Request) -> str:
    """The first file's name in the manner of scenario names."""
    first = Path(request.currents or request.bathymetry or "ocean")
    return re.sub(r"[^a-z0-9]+", "-", first.stem.lower()).strip("-") or "ocean"


def _grids(sea: Sea) -> dict[str, Any]:
    """[seabed] and [[currents]]."""
    tables: dict[str, Any] = {}
    if sea.seabed is not None:
        tables["seabed"] = {
            "kind": "gridded",
            "longitude_deg": sea.seabed.longitude.tolist(),
            "latitude_deg": sea.seabed.latitude.tolist(),
            "depth_m": packed(sea.seabed.depth),
        }
    if sea.current is not None:
        current = sea.current
        table: dict[str, Any] = {
            "kind": "gridded",
            "longitude_deg": current.longitude.tolist(),
            "latitude_deg": current.latitude.tolist(),
        }
        if current.depth.size > 1:
            table["depth_m"] = current.depth.tolist()
        if current.time_s.size > 1:
            table["time_s"] = current.time_s.tolist()
        tables["currents"] = [{**table, "u_mps": packed(current.u), "v_mps": packed(current.v)}]
    texts = [tables.get("seabed", {}).get("depth_m", "")]
    texts += [table[key] for table in tables.get("currents", []) for key in ("u_mps", "v_mps")]
    size = sum(map(len, texts))
    if size > LARGEST_TEXT_BYTES:
        raise ValueError(
            f"the mission's area takes {size / 1e6:.0f} MB as a scenario, "
            f"{LARGEST_TEXT_BYTES / 1e6:.0f} MB are allowed: choose a smaller margin_m, a shorter "
            "time=(from, to), a smaller max_depth_m, or a coarser file"
        )
    return tables


def packed(values: NDArray[Any]) -> str:
    """An array as the scenario file holds it: float32, little-endian, base64."""
    raw = np.ascontiguousarray(values, dtype="<f4").tobytes()
    return "f32le:" + base64.b64encode(raw).decode("ascii")
