"""Where there is water, and a current for all of it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from auvgym._extras import require
from auvgym.ocean.grids import CurrentGrid, DepthGrid, FloatArray, Mask, raise_land
from auvgym.ocean.projection import EARTH_RADIUS_M

# Where a file does not say how deep the water is, the floor of a 2-D world is put this far below
# the vehicle (m).
UNKNOWN_DEPTH_M = 1000.0


def extend_down(current: CurrentGrid) -> Mask:
    """Below the deepest level with a current, use that level's (in place).

    Returns (depth, latitude, longitude): the nodes that were given one.
    """
    before = current.known
    for values in (current.u, current.v):
        for level in range(1, values.shape[1]):
            gap = np.isnan(values[:, level])
            values[:, level][gap] = values[:, level - 1][gap]
    return np.asarray(current.known & ~before)


def take_depth(current: CurrentGrid, depth_m: float) -> None:
    """Leave one level, the current at ``depth_m``, linear between levels (in place)."""
    after = int(np.clip(np.searchsorted(current.depth, depth_m), 0, current.depth.size - 1))
    before = max(after - 1, 0)
    span = current.depth[after] - current.depth[before]
    share = np.clip((depth_m - current.depth[before]) / span, 0.0, 1.0) if span > 0.0 else 1.0
    for name in ("u", "v"):
        values = getattr(current, name)
        above, below = values[:, before], values[:, after]
        if share == 1.0:
            mixed = below
        else:
            mixed = above * np.float32(1.0 - share) + below * np.float32(share)
            mixed = np.where(np.isnan(below), above, mixed)
        setattr(current, name, mixed[:, np.newaxis].astype(np.float32))
    current.depth = np.array([depth_m])


def seabed_from_mask(
    known: Mask, levels_m: FloatArray, grid: CurrentGrid, open_floor_m: float
) -> DepthGrid:
    """A sea floor from where a model has currents: ``known`` (level, latitude, longitude).

    The floor lies halfway between a node's deepest level with a current and the next one, at
    ``open_floor_m`` where all levels have one; a node without any is land.
    """
    count = known.sum(axis=0)
    halfway = (levels_m[:-1] + levels_m[1:]) / 2.0
    depth = np.concatenate([[0.0], halfway, [open_floor_m]])[count]
    raise_land(depth)
    return DepthGrid(grid.title, grid.longitude, grid.latitude, depth)


def count_gaps(current: CurrentGrid, seabed: DepthGrid) -> tuple[int, int]:
    """How many water nodes (all levels) have no current at some time, and how many there are."""
    water = floor_at_nodes(current, seabed) > current.depth[:, np.newaxis, np.newaxis]
    return int((water & ~current.known).sum()), int(water.sum())


def fill_gaps(current: CurrentGrid, seabed: DepthGrid) -> float:
    """Give water without a current that of the nearest node of its level (in place).

    Water is where the seabed is deeper than the level. Nodes around water are filled too, so that
    no point of the water is left without a current. Returns the longest way taken (m).
    Raises ValueError when a level has no current at all.
    """
    around = np.maximum(floor_at_nodes(current, seabed), _deepest_around(current, seabed))
    longest_m = 0.0
    for level, depth in enumerate(current.depth):
        for u, v in zip(current.u[:, level], current.v[:, level], strict=True):
            present = np.isfinite(u)
            gap = (around > depth) & ~present
            if not gap.any():
                continue
            if not present.any():
                raise ValueError(
                    f"{current.title}: no current at all at {depth:g} m in the mission's area"
                )
            source, way_m = _nearest(current.longitude, current.latitude, present, gap)
            u[gap], v[gap] = u.flat[source], v.flat[source]
            longest_m = max(longest_m, way_m)
    return longest_m


def make_land(current: CurrentGrid, seabed: DepthGrid) -> int:
    """Turn seabed nodes into land where the nearest current node has none; how many (in place)."""
    known = current.known[0]
    rows = _nearest_index(current.latitude, seabed.latitude)
    columns = _nearest_index(current.longitude, seabed.longitude)
    dry = ~known[np.ix_(rows, columns)] & (seabed.depth > current.depth[0])
    seabed.depth[dry] = 0.0
    raise_land(seabed.depth)
    return int(dry.sum())


def sample(grid: DepthGrid, longitude: FloatArray, latitude: FloatArray) -> FloatArray:
    """Depth (m) at points, linear in between; the edge's beyond the edge."""
    column, x = _cell(grid.longitude, longitude)
    row, y = _cell(grid.latitude, latitude)
    depth = grid.depth
    south = depth[row, column] * (1 - x) + depth[row, column + 1] * x
    north = depth[row + 1, column] * (1 - x) + depth[row + 1, column + 1] * x
    return np.asarray(south * (1 - y) + north * y)


def cell_corners(current: CurrentGrid, longitude: float, latitude: float) -> tuple[slice, slice]:
    """(rows, columns) of the four nodes around a point."""
    column, _ = _cell(current.longitude, np.array(longitude))
    row, _ = _cell(current.latitude, np.array(latitude))
    return slice(int(row), int(row) + 2), slice(int(column), int(column) + 2)


def _cell(axis: FloatArray, at: FloatArray) -> tuple[NDArray[np.intp], FloatArray]:
    """The cell of an axis that holds a value, and where in it (0 .. 1)."""
    index = np.clip(np.searchsorted(axis, at, side="right") - 1, 0, axis.size - 2)
    share = (at - axis[index]) / (axis[index + 1] - axis[index])
    return index, np.clip(share, 0.0, 1.0)


def _nearest_index(axis: FloatArray, at: FloatArray) -> NDArray[np.intp]:
    index, share = _cell(axis, at)
    return index + (share > 0.5)


def floor_at_nodes(current: CurrentGrid, seabed: DepthGrid) -> FloatArray:
    """Depth (m) of the sea floor at the current's nodes (latitude, longitude)."""
    return sample(seabed, *np.meshgrid(current.longitude, current.latitude))


def _deepest_around(current: CurrentGrid, seabed: DepthGrid) -> FloatArray:
    """For every current node the deepest seabed node in the cells that touch it (m)."""
    deepest = np.full((current.latitude.size, current.longitude.size), -np.inf)
    rows = (seabed.latitude >= current.latitude[0]) & (seabed.latitude <= current.latitude[-1])
    columns = (seabed.longitude >= current.longitude[0]) & (
        seabed.longitude <= current.longitude[-1]
    )
    row, _ = _cell(current.latitude, seabed.latitude[rows])
    column, _ = _cell(current.longitude, seabed.longitude[columns])
    depth = seabed.depth[np.ix_(rows, columns)]
    for north in (0, 1):
        for east in (0, 1):
            np.maximum.at(deepest, (row[:, None] + north, column[None, :] + east), depth)
    return deepest


def _nearest(
    longitude: FloatArray, latitude: FloatArray, present: Mask, gap: Mask
) -> tuple[NDArray[np.intp], float]:
    """For every gap the flat index of the nearest present node, and the longest distance (m).

    Of several equally near the first in (latitude, longitude) order, whatever the rounding.
    """
    spatial = require("scipy.spatial", "ocean")
    longitudes, latitudes = np.meshgrid(np.radians(longitude), np.radians(latitude))
    unit = np.stack(
        [
            np.cos(latitudes) * np.cos(longitudes),
            np.cos(latitudes) * np.sin(longitudes),
            np.sin(latitudes),
        ],
        axis=-1,
    )
    places = np.flatnonzero(present)
    tree = spatial.cKDTree(unit.reshape(-1, 3)[places])
    several = min(8, places.size)
    chord, index = tree.query(unit[gap], k=several)
    chord, index = chord.reshape(-1, several), index.reshape(-1, several)
    tied = chord <= chord[:, :1] * (1.0 + 1e-6)
    chosen = places[np.where(tied, index, places.size - 1).min(axis=1)]
    longest = 2.0 * np.arcsin(min(float(chord[:, 0].max()) / 2.0, 1.0))
    return np.asarray(chosen, dtype=np.intp), float(longest * EARTH_RADIUS_M)
