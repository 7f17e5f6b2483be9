"""Grids that are not read yet, refused in a sentence that says what the file is."""

from __future__ import annotations

from typing import Any

from auvgym.ocean import names

ACCEPTED = (
    "auvgym reads regular grids: one-dimensional longitude and latitude axes, depths in metres, "
    "u (eastward) and v (northward) at the same points; interpolate the file to such a grid first"
)


def refuse_staggered(u: Any, v: Any, file: str) -> None:
    """Raise ValueError when u and v do not lie on the same points."""
    if set(u.dims) != set(v.dims) or any(u.sizes[dim] != v.sizes[dim] for dim in u.dims):
        raise ValueError(
            f"{file}: {u.name} {shape_text(u)} and {v.name} {shape_text(v)} lie on different "
            f"points, a staggered (Arakawa C) grid, which is not read yet; {ACCEPTED}"
        )


def refuse_mesh(dataset: Any, variable: Any, file: str) -> None:
    """Raise ValueError when a variable lies on triangles, a curved grid or sigma levels."""
    kind = (
        _unstructured(dataset, variable)
        or _terrain_following(dataset, variable)
        or _curved(dataset, variable)
    )
    if kind is not None:
        raise ValueError(
            f"{file}: {variable.name} {shape_text(variable)} lies on {kind}, "
            f"which is not read yet; {ACCEPTED}"
        )


def coordinate_along(dataset: Any, dimension: str) -> tuple[Any, str | None]:
    """The coordinate variable along a dimension, and what kind of axis it is (None, None)."""
    along = [name for name, x in dataset.variables.items() if x.dims == (dimension,)]
    along.sort(key=lambda name: bool(name != dimension))
    for name in along:
        kind = names.axis_kind(str(name), dataset[name].attrs)
        if kind is not None:
            return dataset[name], kind
    return None, None


def shape_text(variable: Any) -> str:
    """The dimensions as "(lat: 3, lon: 4)"."""
    sizes = zip(variable.dims, variable.shape, strict=True)
    return "(" + ", ".join(f"{dimension}: {size}" for dimension, size in sizes) + ")"


def listing(dataset: Any) -> str:
    """What the file holds instead."""
    variables = list(dataset.variables.items())
    found = [f"{name} {shape_text(x)}" for name, x in variables if x.ndim >= 2]
    found = found or [str(name) for name, _ in variables]
    shown = ", ".join(found[:12]) + (", ..." if len(found) > 12 else "")
    return f"its variables are: {shown}" if found else "it is empty"


def _unstructured(dataset: Any, variable: Any) -> str | None:
    for dimension in variable.dims:
        kinds = {
            names.axis_kind(str(name), x.attrs)
            for name, x in dataset.variables.items()
            if x.dims == (dimension,)
        }
        if {"longitude", "latitude"} <= kinds:
            return f"the points of an unstructured mesh (triangles, dimension {dimension!r})"
    return None


def _terrain_following(dataset: Any, variable: Any) -> str | None:
    for dimension in variable.dims:
        levels = any(
            names.is_terrain_following(str(name), x.attrs)
            for name, x in dataset.variables.items()
            if x.dims[:1] == (dimension,)
        )
        if levels and variable.sizes[dimension] > 1:
            return f"terrain-following (sigma) levels {dimension!r}, as in ROMS and FVCOM"
    return None


def _curved(dataset: Any, variable: Any) -> str | None:
    kinds = {coordinate_along(dataset, str(dimension))[1] for dimension in variable.dims}
    if {"longitude", "latitude"} <= kinds:
        return None
    for name, x in dataset.variables.items():
        if x.ndim == 0 or not set(x.dims) <= set(variable.dims):
            continue
        standard = names.text(x.attrs, "standard_name")
        kind = names.axis_kind(str(name), x.attrs)
        if standard.startswith(("grid_l", "projection_")) or (
            kind in ("longitude", "latitude") and x.ndim == 2
        ):
            return f"a curvilinear, rotated or projected grid ({name} {shape_text(x)})"
    return None
