"""The map written down: box, missions, sections and episode of the scenario."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from auvgym.ocean.grids import CurrentGrid, DepthGrid
from auvgym.ocean.mission import (
    REFERENCE_M,
    SECTIONS,
    Extent,
    Mission,
    episode_numbers,
    rounded,
)
from auvgym.ocean.projection import EARTH_RADIUS_M
from auvgym.ocean.request import Request
from auvgym.ocean.sea import Sea

FloatArray = NDArray[np.float64]


def map_box(mission: Mission, margin_m: float, data: Extent) -> tuple[FloatArray, float]:
    """The box (2, 2) m and the margin around it (m), both within the data.

    The box keeps ``margin_m`` around start and goal where the data reach so far.
    """
    wanted = rounded(500.0 * mission.distance_m / REFERENCE_M)
    outer = mission.inside(mission.box(margin_m + wanted), data)
    local = mission.local()
    room = min(float((local - outer[0]).min()), float((outer[1] - local).min()))
    edge = min(wanted, math.floor(max(room, 0.0) * 5.0) / 10.0)
    inner = np.stack([np.ceil((outer[0] + edge) * 10.0), np.floor((outer[1] - edge) * 10.0)])
    return inner / 10.0, edge


def describe(
    request: Request,
    mission: Mission,
    box: FloatArray,
    edge_m: float,
    sea: Sea,
    margin_m: float,
) -> dict[str, Any]:
    """Every table of the scenario but the grids. Raises ValueError on 3-D without a sea floor."""
    speed_mps = request.vehicle_speed_mps
    start, goal = mission.start, mission.goal
    if request.dimensions == 2:
        shallowest = deepest = start.depth
    else:
        shallowest, deepest = 0.0, _deepest(sea, request.max_depth_m)
    fastest = 0.0
    cells = []
    if sea.current is not None:
        fastest = float(np.nanmax(np.hypot(sea.current.u, sea.current.v)))
        cells.append(_cell_m(sea.current, mission))
    if sea.seabed is not None:
        cells.append(_cell_m(sea.seabed, mission))
    episode = episode_numbers(mission.distance_m, speed_mps, fastest, min(cells))
    spacing = mission.distance_m / (SECTIONS - 1)
    cell_m = spacing
    if request.dimensions == 3:
        # Waypoints keep off the surface and the floor as well: the ocean is flat and wide.
        episode["waypoint_margin_m"] = min(episode["waypoint_margin_m"], rounded(deepest / 100.0))
        cell_m = min(spacing, deepest / 10.0)
    ends = [
        [*np.round(point, 3).tolist(), place.depth]
        for point, place in zip(mission.local(), (start, goal), strict=True)
    ]
    return {
        "domain": {
            "min_m": [*box[0].tolist(), shallowest],
            "max_m": [*box[1].tolist(), deepest],
            "margin_m": edge_m,
        },
        "missions": [{"start_m": ends[0], "goal_m": ends[1]}],
        "limits": {
            "goal_radius_m": rounded(300.0 * mission.distance_m / REFERENCE_M),
            "time_factor": request.time_factor,
            "energy_factor": request.time_factor,
        },
        "vehicle": {"speed_mps": speed_mps},
        "episode": episode,
        "sections": {
            "count": SECTIONS,
            "frame": "mission",
            "half_width_m": rounded(min(margin_m, _farthest_aside(ends, box))),
            "cell_m": rounded(cell_m),
        },
        "projection": {
            "longitude_deg": mission.projection.longitude_deg,
            "latitude_deg": mission.projection.latitude_deg,
        },
    }


def _deepest(sea: Sea, max_depth_m: float | None) -> float:
    """Depth (m) of a 3-D world: its deepest floor, or less if so asked."""
    if sea.seabed is None:
        raise ValueError("dimensions=3 needs a sea floor: give bathymetry=..., or dimensions=2")
    floor = float(math.ceil(sea.seabed.depth.max()))
    return floor if max_depth_m is None else min(floor, float(max_depth_m))


def _cell_m(grid: CurrentGrid | DepthGrid, mission: Mission) -> float:
    """The shorter edge of a grid's cells in the middle of the map (m)."""
    metres = math.radians(1.0) * EARTH_RADIUS_M
    east = float(np.diff(grid.longitude).min()) * math.cos(
        math.radians(mission.projection.latitude_deg)
    )
    return metres * min(east, float(np.diff(grid.latitude).min()))


def _farthest_aside(ends: list[list[float]], box: FloatArray) -> float:
    """How far the box reaches to the side of the line from start to goal (m)."""
    start, goal = np.array(ends[0][:2]), np.array(ends[1][:2])
    along = (goal - start) / np.linalg.norm(goal - start)
    corners = np.array([[x, y] for x in box[:, 0] for y in box[:, 1]]) - start
    return float(np.abs(corners[:, 0] * along[1] - corners[:, 1] * along[0]).max())
