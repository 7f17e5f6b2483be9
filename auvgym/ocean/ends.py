"""Whether start and goal lie in known water, and where the nearest water is when not."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from auvgym.ocean import water
from auvgym.ocean.mission import Extent, Mission, Place, near
from auvgym.ocean.projection import Projection, distances_m
from auvgym.ocean.sea import Sea

FloatArray = NDArray[np.float64]


def check_end(place: Place, mission: Mission, data: Extent, box: FloatArray, sea: Sea) -> None:
    """Raise ValueError, with the nearest good place, unless ``place`` is in known water.

    ``place`` is as the user gave it (longitude near the map's centre), ``data`` what the files
    cover, ``box`` (2, 2) m what the map covers.
    """
    wrong = _fault(place, mission, data, box, sea)
    if wrong is not None:
        raise ValueError(f"{place} {wrong}{_suggestion(place, mission.projection, box, sea)}")


def _fault(place: Place, mission: Mission, data: Extent, box: FloatArray, sea: Sea) -> str | None:
    if not data.holds(place.longitude, place.latitude):
        return f"is outside the data: {data} are allowed"
    local = mission.projection.to_local([place.longitude, place.latitude])
    if (local <= box[0]).any() or (local >= box[1]).any():
        return f"is at the very edge of the data ({data}): choose a point farther inside"
    if sea.seabed is not None:
        floor = float(water.sample(sea.seabed, *_point(place)))
        if floor <= 0.0:
            return f"is on land by {sea.seabed.title}: water is allowed"
        if floor <= place.depth:
            return (
                f"depth {place.depth:g} m is below the sea floor there, {floor:.1f} m by "
                f"{sea.seabed.title}"
            )
    known = sea.known_at(place.depth)
    if sea.current is not None and known is not None:
        corners = water.cell_corners(sea.current, place.longitude, place.latitude)
        if not known[corners].any():
            return f"has no current in {sea.current.title}: a place with one is allowed"
    return None


def _suggestion(place: Place, projection: Projection, box: FloatArray, sea: Sea) -> str:
    """The nearest grid node that would do, in a clause."""
    grid = sea.current if sea.current is not None else sea.seabed
    if grid is None:
        return ""
    longitude, latitude = np.meshgrid(grid.longitude, grid.latitude)
    good = np.ones(longitude.shape, dtype=np.bool_)
    if sea.seabed is not None:
        good &= water.sample(sea.seabed, longitude, latitude) > place.depth
    known = sea.known_at(place.depth)
    if known is not None:
        good &= known
    local = projection.to_local(np.stack([longitude, latitude], axis=-1))
    good &= ((local > box[0] + 1.0) & (local < box[1] - 1.0)).all(axis=-1)
    # A node whose neighbours are good as well is not right at a coast.
    open_water = good.copy()
    for axis in (0, 1):
        for shift in (1, -1):
            open_water &= np.roll(good, shift, axis=axis)
    good = open_water if open_water.any() else good
    if not good.any():
        return "; there is none nearby"
    way = distances_m(longitude[good], latitude[good], place.longitude, place.latitude)
    nearest = int(np.argmin(way))
    lon = float(near(longitude[good][nearest], 0.0))
    lat = float(latitude[good][nearest])
    return (
        f"; the nearest such place known is ({lon:.4f}, {lat:.4f}), "
        f"{way[nearest] / 1000.0:.3g} km away"
    )


def _point(place: Place) -> tuple[FloatArray, FloatArray]:
    return np.array(place.longitude), np.array(place.latitude)
