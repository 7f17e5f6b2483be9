"""Finding the current and the bathymetry in a file, and refusing the grids not read yet."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from auvgym.ocean import names
from auvgym.ocean.axes import Axis, FloatArray, make_axis
from auvgym.ocean.files import reading
from auvgym.ocean.refusals import (
    ACCEPTED,
    coordinate_along,
    listing,
    refuse_mesh,
    refuse_staggered,
    shape_text,
)


@dataclass(frozen=True)
class Field:
    """Variables of one file on one regular grid. ``depth`` and ``time`` may be absent."""

    file: str
    variables: tuple[Any, ...]
    factor: float
    longitude: Axis
    latitude: Axis
    depth: Axis | None
    time: Any | None
    notes: tuple[str, ...]

    @property
    def title(self) -> str:
        """File and variables, for notes and errors."""
        return f"{self.file} ({', '.join(str(variable.name) for variable in self.variables)})"


def find_current(dataset: Any, file: str, wanted: tuple[str, str] | None) -> Field:
    """The current of an ``xarray.Dataset``: the ``wanted`` pair of variables, else the known ones.

    Raises ValueError, naming the file, when there is none, more than one, or its grid or units
    are of a kind that is not read.
    """
    pair = wanted or _known_pair(dataset, file)
    for name in pair:
        if name not in dataset.variables:
            raise ValueError(
                f"{file}: has no variable {name!r} for the current; {listing(dataset)}"
            )
    u, v = dataset[pair[0]], dataset[pair[1]]
    refuse_staggered(u, v, file)
    refuse_mesh(dataset, u, file)
    factors = [names.speed_factor(str(x.attrs.get("units", "m/s"))) for x in (u, v)]
    if factors[0] is None or factors[0] != factors[1]:
        units = [x.attrs.get("units") for x in (u, v)]
        raise ValueError(
            f"{file}: {u.name} and {v.name} are in {units[0]!r} and {units[1]!r}; "
            "m/s, cm/s, mm/s or knots, the same for both, are understood"
        )
    notes = []
    if "units" not in u.attrs:
        notes.append(f"{file} gives no units for {u.name} and {v.name}: m/s is assumed.")
    return _field(dataset, file, (u, v), factors[0], notes)


def find_bathymetry(dataset: Any, file: str, wanted: str | None, positive: str | None) -> Field:
    """The sea floor of an ``xarray.Dataset``; the field's factor makes it positive down.

    ``wanted`` names the variable, ``positive`` ("up", "down") what the file leaves open. Raises
    ValueError, naming the file, when it is not found or of a kind that is not read.
    """
    name = wanted or bathymetry_name(dataset, certain=False)
    if name is None or name not in dataset.variables:
        missing = f"no variable {name!r}" if name else "no bathymetry under a known name"
        raise ValueError(
            f'{file}: has {missing}; {listing(dataset)}; name it with bathymetry_name="..."'
        )
    variable = dataset[name]
    refuse_mesh(dataset, variable, file)
    units = str(variable.attrs.get("units", "m"))
    if not names.is_metres(units):
        raise ValueError(f"{file}: {name} is in {units!r}; bathymetry must be in metres")
    field = _field(dataset, file, (variable,), 1.0, [])
    for extra in (field.time, field.depth):
        if extra is not None and variable.sizes[_dimension(extra)] > 1:
            raise ValueError(
                f"{file}: {name} {shape_text(variable)} changes along {_dimension(extra)!r}; "
                "a sea floor has longitude and latitude only"
            )
    direction, why = _direction(variable, file, positive)
    if direction is None:
        raise ValueError(
            f"{file}: whether {name} is a depth or a height cannot be told ({why}); "
            'say bathymetry_positive="down" or "up"'
        )
    shown = "depth, positive down" if direction == "down" else "height, positive up"
    note = f"{file}: {name} is read as a {shown} ({why})."
    factor = 1.0 if direction == "down" else -1.0
    return Field(
        file, (variable,), factor, field.longitude, field.latitude, None, None,
        (*field.notes, note),
    )  # fmt: skip


def bathymetry_name(dataset: Any, *, certain: bool) -> str | None:
    """Which variable is the sea floor; with ``certain`` only one whose standard name says so."""
    candidates = {
        str(name): variable
        for name, variable in dataset.variables.items()
        if variable.ndim >= 1 and variable.dims != (name,) and variable.dtype.kind in "iuf"
    }
    standard = {name: names.text(x.attrs, "standard_name") for name, x in candidates.items()}
    for name, value in standard.items():
        if "sea_floor_depth" in value:
            return name
    if certain:
        return None
    lower = {name.lower(): name for name in reversed(list(candidates))}
    for known in names.BATHYMETRY_NAMES:
        if known in lower:
            return lower[known]
    for name, value in standard.items():
        if value in names.HEIGHT_STANDARD_NAMES and candidates[name].ndim >= 2:
            return name
    return next((name for key, name in lower.items() if key.startswith("etopo")), None)


def _known_pair(dataset: Any, file: str) -> tuple[str, str]:
    """The names of u and v."""
    waters = {
        str(name): variable
        for name, variable in dataset.variables.items()
        if not any(
            word in names.text(variable.attrs, "standard_name")
            or word in names.text(variable.attrs, "long_name").replace(" ", "_").split("_")
            for word in names.NOT_A_CURRENT
        )
    }

    def standard(wanted: tuple[str, ...]) -> list[str]:
        return [
            name
            for name, variable in waters.items()
            if any(part in names.text(variable.attrs, "standard_name") for part in wanted)
        ]

    east, north = standard(names.EASTWARD), standard(names.NORTHWARD)
    if len(east) == len(north) == 1:
        return east[0], north[0]
    lower = {name.lower(): name for name in waters}
    for u, v in names.CURRENT_PAIRS:
        if u in lower and v in lower:
            return lower[u], lower[v]
    found = f"more than one current: {', '.join(east + north)}" if east and north else "no current"
    known = ", ".join("/".join(pair) for pair in names.CURRENT_PAIRS)
    raise ValueError(
        f"{file}: has {found}; {listing(dataset)}; known are the CF standard names "
        f'eastward/northward_sea_water_velocity and {known}; or say current_names=("...", "...")'
    )


def _direction(variable: Any, file: str, positive: str | None) -> tuple[str | None, str]:
    """Where the numbers of a sea floor grow to ("up", "down", None = not known), and why."""
    if positive is not None:
        if positive not in ("up", "down"):
            raise ValueError(f'bathymetry_positive={positive!r}: must be "up", "down" or None')
        return positive, "as asked"
    declared = names.text(variable.attrs, "positive")
    if declared in ("up", "down"):
        return declared, f"positive = {declared!r}"
    standard = names.text(variable.attrs, "standard_name")
    if standard in names.DEPTH_STANDARD_NAMES:
        return "down", f"standard name {standard}"
    if standard in names.HEIGHT_STANDARD_NAMES:
        return "up", f"standard name {standard}"
    lower = str(variable.name).lower()
    if lower in names.BATHYMETRY_NAMES:
        return names.BATHYMETRY_NAMES[lower], "by its name"
    if lower.startswith("etopo"):
        return "up", "by its name"
    values = _values(variable, file)
    if not np.isfinite(values).any():
        return "down", "no values"
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    if low >= 0.0:
        return "down", f"no value is below 0, the largest is {high:g}"
    if high <= 0.0:
        return "up", f"no value is above 0, the lowest is {low:g}"
    return None, f"its values run from {low:g} to {high:g}"


def _field(
    dataset: Any, file: str, variables: tuple[Any, ...], factor: float, notes: list[str]
) -> Field:
    """Finds the axes of a variable."""
    first = variables[0]
    axes: dict[str, Any] = {}
    for dim in map(str, first.dims):
        coordinate, kind = coordinate_along(dataset, dim)
        if kind is None:
            if first.sizes[dim] > 1:
                raise ValueError(
                    f"{file}: dimension {dim!r} of {first.name} {shape_text(first)} is neither "
                    f"longitude, latitude, depth nor time; {ACCEPTED}"
                )
            continue
        if kind in axes:
            raise ValueError(f"{file}: {first.name} {shape_text(first)} has two {kind} axes")
        axes[kind] = coordinate
    for kind in ("longitude", "latitude"):
        if kind not in axes:
            raise ValueError(
                f"{file}: {first.name} {shape_text(first)} has no {kind} axis; {ACCEPTED}"
            )
        if axes[kind].size < 2:
            raise ValueError(f"{file}: its {kind} axis has one node; at least two make a grid")
    longitude, latitude = (_horizontal(axes[k], k, file) for k in ("longitude", "latitude"))
    depth = _depth_axis(axes["depth"], file) if "depth" in axes else None
    time = axes.get("time")
    return Field(file, variables, factor, longitude, latitude, depth, time, tuple(notes))


def _horizontal(coordinate: Any, kind: str, file: str) -> Axis:
    values = _values(coordinate, file)
    axis = make_axis(str(coordinate.dims[0]), values, f"{file}: {kind} {coordinate.name}")
    if kind == "latitude" and (axis.low < -90.0 or axis.high > 90.0):
        raise ValueError(
            f"{file}: latitude {coordinate.name} runs from {axis.low:g} to {axis.high:g}; "
            "-90 .. 90 degrees are possible"
        )
    return axis


def _depth_axis(coordinate: Any, file: str) -> Axis:
    """Depths, positive down."""
    units = str(coordinate.attrs.get("units", "m"))
    if not names.is_metres(units):
        raise ValueError(f"{file}: depth {coordinate.name} is in {units!r}; metres are understood")
    values = _values(coordinate, file)
    upwards = (
        names.text(coordinate.attrs, "positive") == "up"
        or names.text(coordinate.attrs, "standard_name") in ("height", "altitude")
        or (values.max() <= 0.0 and values.min() < 0.0)
    )
    # Heights that were called "positive up" but grow downwards are depths all the same.
    if upwards and not values.min() >= 0.0:
        values = -values
    if values.min() < 0.0:
        raise ValueError(
            f"{file}: depth {coordinate.name} runs from {values.min():g} to {values.max():g}; "
            "all levels must lie on one side of the surface (0)"
        )
    return make_axis(str(coordinate.dims[0]), values + 0.0, f"{file}: depth {coordinate.name}")


def _dimension(extra: Any) -> str:
    return extra.dimension if isinstance(extra, Axis) else str(extra.dims[0])


def _values(variable: Any, file: str) -> FloatArray:
    with reading(file):
        return np.asarray(variable.values, dtype=np.float64)
