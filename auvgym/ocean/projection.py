"""Longitude and latitude to local metres and back; distances on the sphere.

Spherical azimuthal equidistant: distances and bearings from the centre are true, the sphere has
the Earth's mean radius (Snyder 1987, Map Projections: A Working Manual, USGS 1395, eq. 21-2 ff).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from auvgym._extras import require

if TYPE_CHECKING:
    from auvgym import Scenario

FloatArray = NDArray[np.float64]

EARTH_RADIUS_M = 6371008.8


@dataclass(frozen=True)
class Projection:
    """A map centred on (longitude_deg, latitude_deg): x east, y north in metres."""

    longitude_deg: float
    latitude_deg: float

    def to_local(self, points_deg: ArrayLike) -> FloatArray:
        """(..., 2 or 3) longitude, latitude (degrees)[, depth] to (..., 2 or 3) x, y (m)[, depth].

        Raises ValueError on another shape or a point that has no place on the map.
        """
        return self._convert(points_deg, inverse=False)

    def to_lonlat(self, points_m: ArrayLike) -> FloatArray:
        """(..., 2 or 3) x, y (m)[, depth] to (..., 2 or 3) longitude, latitude (degrees)[, depth].

        Longitudes lie in -180 .. 180. Raises ValueError as ``to_local``.
        """
        return self._convert(points_m, inverse=True)

    def _convert(self, points: ArrayLike, *, inverse: bool) -> FloatArray:
        result = np.array(points, dtype=np.float64)
        if result.ndim == 0 or result.shape[-1] not in (2, 3):
            raise ValueError(f"points of shape {result.shape}: the last axis must be 2 or 3 long")
        proj = require("pyproj", "ocean").Proj(
            proj="aeqd", lon_0=self.longitude_deg, lat_0=self.latitude_deg, R=EARTH_RADIUS_M
        )
        first, second = proj(result[..., 0], result[..., 1], inverse=inverse)
        result[..., 0], result[..., 1] = first, second
        if not np.isfinite(result[..., :2]).all():
            raise ValueError("a point has no place on the map: not finite, or across the globe")
        return result


def distances_m(
    longitude: FloatArray, latitude: FloatArray, to_longitude: float, to_latitude: float
) -> FloatArray:
    """Great-circle distances (m) to a point, haversine formula."""
    lat, to_lat = np.radians(latitude), np.radians(to_latitude)
    half = np.sin((lat - to_lat) / 2.0) ** 2 + (
        np.cos(lat) * np.cos(to_lat) * np.sin(np.radians(longitude - to_longitude) / 2.0) ** 2
    )
    return np.asarray(2.0 * EARTH_RADIUS_M * np.arcsin(np.sqrt(np.clip(half, 0.0, 1.0))))


def to_lonlat(scenario: Scenario | Mapping[str, Any], points_m: ArrayLike) -> FloatArray:
    """Points of a real-ocean scenario, such as a plan's waypoints, as longitude and latitude.

    ``points_m`` (n, 2) or (n, 3) m, x east, y north, depth; returns the same shape, float64,
    longitude and latitude in degrees (longitude in -180 .. 180), depth in m as it was.
    Raises ValueError when the scenario has no projection or a point no place on the Earth.
    """
    return _projection(scenario).to_lonlat(points_m)


def from_lonlat(scenario: Scenario | Mapping[str, Any], points_deg: ArrayLike) -> FloatArray:
    """Longitudes and latitudes as local metres of a real-ocean scenario.

    ``points_deg`` (n, 2) or (n, 3), longitude and latitude in degrees, depth in m; returns the
    same shape, float64 m. Raises ValueError as :func:`to_lonlat`.
    """
    return _projection(scenario).to_local(points_deg)


def _projection(scenario: Scenario | Mapping[str, Any]) -> Projection:
    mapping = scenario if isinstance(scenario, Mapping) else scenario.to_dict()
    centre = mapping.get("projection")
    if centre is None:
        raise ValueError(
            f"scenario {mapping.get('name')!r} has no [projection]: "
            "only real oceans lie on the Earth"
        )
    return Projection(centre["longitude_deg"], centre["latitude_deg"])
