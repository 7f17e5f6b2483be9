"""Start, goal and the map around them: the projection, the box, and numbers that suit its size."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from auvgym.ocean.projection import EARTH_RADIUS_M, Projection, distances_m

FloatArray = NDArray[np.float64]

# At this distance the flat map stretches lengths at its ends by 4 %.
LONGEST_M = 6.0e6
# Sections of a mission, and the mission that the default episode numbers were made for (m).
SECTIONS = 40
REFERENCE_M = 40_000.0


@dataclass(frozen=True)
class Extent:
    """A window in degrees."""

    west: float
    east: float
    south: float
    north: float

    def holds(self, longitude: float, latitude: float) -> bool:
        """Whether a point lies in it."""
        return self.west <= longitude <= self.east and self.south <= latitude <= self.north

    def __str__(self) -> str:
        return (
            f"longitude {self.west:.4f} .. {self.east:.4f}, "
            f"latitude {self.south:.4f} .. {self.north:.4f}"
        )


@dataclass(frozen=True)
class Place:
    """A start or goal: degrees east and north, metres down."""

    name: str
    longitude: float
    latitude: float
    depth: float

    def __str__(self) -> str:
        return f"{self.name} ({self.longitude:g}, {self.latitude:g})"


@dataclass(frozen=True)
class Mission:
    """Two places and the map between them. Longitudes are near the map's centre, unwrapped."""

    start: Place
    goal: Place
    projection: Projection
    distance_m: float

    def box(self, margin_m: float) -> FloatArray:
        """[[x, y] lowest, [x, y] highest] (m): both places and a margin around them."""
        local = self.local()
        return np.stack([local.min(axis=0) - margin_m, local.max(axis=0) + margin_m])

    def local(self) -> FloatArray:
        """(2, 2) m: x, y of start and goal."""
        return self.projection.to_local(
            [[p.longitude, p.latitude] for p in (self.start, self.goal)]
        )

    def window(self, box: FloatArray) -> Extent:
        """The degrees that hold a box of local metres."""
        (west, south), (east, north) = box
        pole_m = math.radians(90.0 - abs(self.projection.latitude_deg)) * EARTH_RADIUS_M
        pole_m = math.copysign(pole_m, self.projection.latitude_deg)
        if west <= 0.0 <= east and south <= pole_m <= north:
            raise ValueError(
                "the mission's area holds a pole, where longitudes have no order; "
                "choose a smaller margin_m or a mission farther from it"
            )
        edge = np.linspace(0.0, 1.0, 65)
        x, y = west + edge * (east - west), south + edge * (north - south)
        border = np.concatenate(
            [
                np.stack([x, np.full_like(x, south)], axis=1),
                np.stack([x, np.full_like(x, north)], axis=1),
                np.stack([np.full_like(y, west), y], axis=1),
                np.stack([np.full_like(y, east), y], axis=1),
            ]
        )
        points = self.projection.to_lonlat(border)
        longitude = near(points[:, 0], self.projection.longitude_deg)
        return Extent(
            float(longitude.min()), float(longitude.max()),
            float(points[:, 1].min()), float(points[:, 1].max()),
        )  # fmt: skip

    def inside(self, box: FloatArray, data: Extent) -> FloatArray:
        """The box, shrunk to lie within the data: meridians and parallels are curves on the map."""
        edge = np.linspace(0.0, 1.0, 2001)
        longitude = data.west + edge * (data.east - data.west)
        latitude = data.south + edge * (data.north - data.south)

        def local(longitudes: FloatArray, latitudes: FloatArray) -> FloatArray:
            return self.projection.to_local(np.stack([longitudes, latitudes], axis=1))

        shrunk: FloatArray = np.array(box, dtype=np.float64)
        for axis, sides in enumerate(((data.west, data.east), (data.south, data.north))):
            for end, side in enumerate(sides):
                fixed = np.full_like(edge, side)
                curve = local(fixed, latitude) if axis == 0 else local(longitude, fixed)
                along = curve[:, 1 - axis]
                beside = (along >= shrunk[0, 1 - axis]) & (along <= shrunk[1, 1 - axis])
                # A box smaller than the samples' spacing lies beside one of them; and the curve
                # runs on to the next sample, beyond the box's corner.
                beside[int(np.argmin(np.abs(along - shrunk[:, 1 - axis].mean())))] = True
                beside[:-1] |= beside[1:].copy()
                beside[1:] |= beside[:-1].copy()
                limit = curve[beside, axis]
                if end == 0:
                    shrunk[0, axis] = max(shrunk[0, axis], limit.max())
                else:
                    shrunk[1, axis] = min(shrunk[1, axis], limit.min())
        return shrunk


def near(longitude: ArrayLike, centre: float) -> FloatArray:
    """Longitudes as numbers within 180 degrees of ``centre``."""
    turned = (np.asarray(longitude, dtype=np.float64) - centre + 180.0) % 360.0
    return np.asarray(turned + (centre - 180.0), dtype=np.float64)


def parse_place(name: str, value: Sequence[float], depth_m: float | None) -> Place:
    """A (longitude, latitude[, depth]) argument. Raises ValueError naming what is wrong."""
    rule = "must be (longitude, latitude) in degrees, and a depth in metres if wanted"
    try:
        numbers = [float(number) for number in value]
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name}={value!r}: {rule}") from error
    if len(numbers) not in (2, 3) or not all(map(math.isfinite, numbers)):
        raise ValueError(f"{name}={value!r}: {rule}")
    longitude, latitude = numbers[:2]
    if not -90.0 <= latitude <= 90.0:
        raise ValueError(f"{name}={value!r}: latitude {latitude:g} must lie in -90 .. 90; {rule}")
    if not -360.0 <= longitude <= 540.0:
        raise ValueError(f"{name}={value!r}: longitude {longitude:g} must lie in -180 .. 360")
    depth = numbers[2] if len(numbers) == 3 else (0.0 if depth_m is None else depth_m)
    if depth < 0.0:
        raise ValueError(f"{name}={value!r}: depth {depth:g} m is above the surface (0 m)")
    return Place(name, longitude, latitude, depth)


def middle_longitude(start: Place, goal: Place) -> float:
    """The longitude halfway, the short way around, in -180 .. 180."""
    halfway = start.longitude + float(near(goal.longitude - start.longitude, 0.0)) / 2.0
    return float(near(halfway, 0.0))


def lay_out(start: Place, goal: Place) -> Mission:
    """The map of a mission, centred on the middle of its great circle.

    Longitudes must be unwrapped. Raises ValueError when the two are too near or too far apart.
    """
    distance = float(
        distances_m(
            np.array(start.longitude), np.array(start.latitude), goal.longitude, goal.latitude
        )
    )
    if not 1.0 <= distance <= LONGEST_M:
        raise ValueError(
            f"goal ({goal.longitude:g}, {goal.latitude:g}) is {distance / 1000.0:.4g} km from "
            f"start ({start.longitude:g}, {start.latitude:g}): 1 m .. {LONGEST_M / 1000.0:g} km "
            "are allowed"
        )
    ends = np.radians([[p.longitude, p.latitude] for p in (start, goal)])
    vectors = np.stack(
        [
            np.cos(ends[:, 1]) * np.cos(ends[:, 0]),
            np.cos(ends[:, 1]) * np.sin(ends[:, 0]),
            np.sin(ends[:, 1]),
        ]
    )
    x, y, z = vectors.sum(axis=1)
    # Rounded (to 0.1 m) so that every machine centres its map on the same digits.
    middle = (start.longitude + goal.longitude) / 2.0
    longitude = round(float(near(math.degrees(math.atan2(y, x)), middle)), 6)
    latitude = round(math.degrees(math.atan2(z, math.hypot(x, y))), 6)
    return Mission(start, goal, Projection(longitude, latitude), distance)


def episode_numbers(
    distance_m: float, speed_mps: float, current_mps: float, cell_m: float
) -> dict[str, float]:
    """[episode] for a mission of this length: the defaults' proportions of a 40 km mission.

    A tick crosses at most half of the finest grid cell (``cell_m``), so that no land is skipped.
    """
    scale = distance_m / REFERENCE_M
    reach = 2000.0 * scale
    tick = min(30.0 * scale / speed_mps, 0.5 * cell_m / (speed_mps + current_mps))
    return {
        "tick_s": rounded(tick),
        "reach_m": rounded(reach),
        "capture_radius_m": rounded(0.1 * reach),
        "minimum_leg_s": rounded(4.0 * tick),
        "maximum_leg_s": rounded(1.5 * reach / speed_mps),
        "station_radius_m": rounded(0.05 * reach),
        "waypoint_margin_m": rounded(0.15 * reach),
        "sonar_range_m": rounded(2.5 * reach),
    }


def rounded(value: float) -> float:
    """To two significant digits: these numbers are choices, not measurements."""
    return float(f"{value:.2g}")
