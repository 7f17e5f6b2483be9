"""Reading fields into arrays: (time, depth, latitude, longitude), ascending, metres per second."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from auvgym.ocean.axes import Axis
from auvgym.ocean.fields import Field
from auvgym.ocean.files import reading
from auvgym.ocean.times import Slices

FloatArray = NDArray[np.float64]
Values = NDArray[np.float32]
Mask = NDArray[np.bool_]

# No ocean current is faster (the Saltstraumen runs 10 m/s): such numbers are unmarked gaps.
FASTEST_CURRENT_MPS = 20.0
# No sea is deeper and no land higher than this.
DEEPEST_M = 12000.0
# Land is made at least as high as the water beside it is deep, within these.
LOWEST_LAND_M, HIGHEST_LAND_M = 0.1, 1000.0


@dataclass
class CurrentGrid:
    """A current: ``u``, ``v`` (time, depth, latitude, longitude) float32 m/s, NaN = missing.

    ``depth`` (k,) m, positive down, holds one level of depth 0 where the file has none.
    """

    title: str
    longitude: FloatArray
    latitude: FloatArray
    depth: FloatArray
    time_s: FloatArray
    u: Values
    v: Values
    notes: list[str] = field(default_factory=list)

    @property
    def known(self) -> Mask:
        """(depth, latitude, longitude): where the current is known at all times."""
        return np.asarray((np.isfinite(self.u) & np.isfinite(self.v)).all(axis=0))


@dataclass
class DepthGrid:
    """A sea floor: ``depth`` (latitude, longitude) float64 m, positive down, land <= 0."""

    title: str
    longitude: FloatArray
    latitude: FloatArray
    depth: FloatArray
    notes: list[str] = field(default_factory=list)


def read_current(source: Field, slices: Slices, levels: Axis | None) -> CurrentGrid:
    """The current of a cropped field at chosen times and ``levels`` (None where it has none).

    Raises ValueError, naming the file, when nothing is known in it.
    """
    u, v = (
        slices.interpolate(_read(source, variable, slices.order, levels))
        for variable in source.variables
    )
    u, v = u * np.float32(source.factor), v * np.float32(source.factor)
    notes = []
    with np.errstate(invalid="ignore"):
        absurd = (np.abs(u) > FASTEST_CURRENT_MPS) | (np.abs(v) > FASTEST_CURRENT_MPS)
    missing = absurd | ~np.isfinite(u) | ~np.isfinite(v)
    if absurd.any():
        notes.append(
            f"{source.file}: {int(absurd.sum())} values beyond {FASTEST_CURRENT_MPS:g} m/s are "
            "taken as missing."
        )
    if missing.all():
        raise ValueError(
            f"{source.file}: {_joined(source)} has no value at all in the mission's area"
            + (f" that is below {FASTEST_CURRENT_MPS:g} m/s" if absurd.any() else "")
        )
    u[missing] = np.nan
    v[missing] = np.nan
    depth = np.zeros(1) if levels is None else levels.values
    return CurrentGrid(
        source.title, source.longitude.values, source.latitude.values, depth, slices.time_s,
        u, v, notes,
    )  # fmt: skip


def read_known(source: Field, first: int) -> Mask:
    """(depth, latitude, longitude): where a cropped field has a current in one slice of the file.

    ``first`` is the slice's place in the file.
    """
    order = np.array([first], dtype=np.intp)
    u, v = (_read(source, variable, order, source.depth)[0] for variable in source.variables)
    return np.asarray(np.isfinite(u) & np.isfinite(v))


def read_depth(source: Field) -> DepthGrid:
    """The sea floor of a cropped field, positive down; unknown depths become land.

    Raises ValueError, naming the file, when nothing is known in it.
    """
    values = _read(source, source.variables[0], None, None)[0, 0].astype(np.float64)
    depth = values * source.factor
    with np.errstate(invalid="ignore"):
        missing = ~np.isfinite(depth) | (np.abs(depth) > DEEPEST_M)
    if missing.all():
        raise ValueError(
            f"{source.file}: {_joined(source)} has no value at all in the mission's area"
        )
    notes = list(source.notes)
    if missing.any():
        notes.append(
            f"{source.file}: {int(missing.sum())} of {missing.size} nodes have no depth and are "
            "taken as land."
        )
    depth[missing] = 0.0
    raised = raise_land(depth)
    if raised:
        notes.append(
            f"{source.file}: {raised} land nodes beside water are made as high as it is deep, so "
            "that no island is lost."
        )
    return DepthGrid(source.title, source.longitude.values, source.latitude.values, depth, notes)


def raise_land(depth: FloatArray) -> int:
    """Make land at least as high as the water beside it is deep (in place), up to HIGHEST_LAND_M.

    ``depth`` (latitude, longitude) m, land <= 0. Land of unknown height gets one, the coast lies
    at most halfway to the next water node, and no island is lost when the grid is resampled.
    Returns how many nodes beside water were changed.
    """
    land = depth <= 0.0
    rows, columns = depth.shape
    around = np.pad(np.where(land, np.nan, depth), 1, constant_values=np.nan)
    beside = np.stack([around[y : y + rows, x : x + columns] for y in range(3) for x in range(3)])
    count = np.isfinite(beside).sum(axis=0)
    mean = np.nansum(beside, axis=0) / np.maximum(count, 1)
    height = np.clip(mean, LOWEST_LAND_M, HIGHEST_LAND_M)
    low = land & (depth > -height)
    depth[low] = -height[low]
    return int((low & (count > 0)).sum())


def _read(
    source: Field, variable: Any, slices: NDArray[np.intp] | None, levels: Axis | None
) -> Values:
    """A variable as (time, depth, latitude, longitude) float32, with length 1 where it has none."""
    wanted: dict[str, Any] = {}
    for axis in (source.latitude, source.longitude, levels):
        if axis is not None:
            wanted[axis.dimension] = axis.order
    if source.time is not None and slices is not None:
        wanted[str(source.time.dims[0])] = slices
    others = [dimension for dimension in variable.dims if dimension not in wanted]
    picked = variable.isel({**wanted, **dict.fromkeys(others, 0)})
    kept = [source.latitude.dimension, source.longitude.dimension]
    if levels is not None:
        kept.insert(0, levels.dimension)
    has_time = False
    if source.time is not None and slices is not None:
        has_time = True
        kept.insert(0, str(source.time.dims[0]))
    with reading(source.file):
        values = np.asarray(picked.transpose(*kept).values, dtype=np.float32)
    if levels is None:
        values = np.expand_dims(values, -3)
    return values if has_time else values[np.newaxis]


def _joined(source: Field) -> str:
    return "/".join(str(variable.name) for variable in source.variables)
