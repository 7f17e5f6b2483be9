"""Obstacles cut horizontally and vertically: plain NumPy on a snapshot's obstacle entries."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from auvgym.rendering.subjects import Points

Obstacle = Mapping[str, Any]
_TURN = np.linspace(0.0, 2.0 * np.pi, 40, endpoint=False)
_CIRCLE = np.stack([np.cos(_TURN), np.sin(_TURN)], axis=-1)


def depth_range(obstacle: Obstacle) -> tuple[float, float]:
    """(top, bottom) depth of an obstacle, m; infinite for a disc, which has no ends."""
    kind = obstacle["kind"]
    if kind == "sphere":
        middle, reach = float(obstacle["position_m"][2]), float(obstacle["radius_m"])
        return middle - reach, middle + reach
    if kind == "superquadric":
        middle, reach = float(obstacle["position_m"][2]), float(obstacle["semi_axes_m"][2])
        return middle - reach, middle + reach
    if kind == "disc":
        return -np.inf, np.inf
    return float(obstacle["top_m"]), float(obstacle["bottom_m"])


def outline(obstacle: Obstacle) -> Points:
    """The (k, 2) outline of an obstacle where it is widest, m."""
    if obstacle["kind"] == "polygon":
        return np.asarray(obstacle["vertices_m"], dtype=np.float64)[:, :2]
    centre = np.asarray(obstacle["position_m"], dtype=np.float64)[:2]
    if obstacle["kind"] == "superquadric":
        return np.asarray(centre + _superquadric_section(obstacle, 1.0))
    return np.asarray(centre + float(obstacle["radius_m"]) * _CIRCLE)


def section(obstacle: Obstacle, depth_m: float) -> Points:
    """The (k, 2) outline where the plane at ``depth_m`` cuts an obstacle, m; (0, 2) if nowhere."""
    top, bottom = depth_range(obstacle)
    if not top < depth_m < bottom:
        return np.empty((0, 2))
    kind = obstacle["kind"]
    if kind not in ("sphere", "superquadric"):
        return outline(obstacle)
    lift = (2.0 * depth_m - top - bottom) / (bottom - top)  # -1 at the top, 1 at the bottom
    centre = np.asarray(obstacle["position_m"], dtype=np.float64)[:2]
    if kind == "superquadric":
        share = 1.0 - abs(lift) ** float(obstacle["exponents"][2])
        return np.asarray(centre + _superquadric_section(obstacle, share))
    radius = float(obstacle["radius_m"]) * float(np.sqrt(1.0 - lift * lift))
    return np.asarray(centre + radius * _CIRCLE)


def _superquadric_section(obstacle: Obstacle, share: float) -> Points:
    # |x/a|^ex + |y/b|^ey = share: give each term a cos^2 or sin^2 part of the share.
    semi = np.asarray(obstacle["semi_axes_m"], dtype=np.float64)[:2]
    exponents = np.asarray(obstacle["exponents"], dtype=np.float64)[:2]
    offsets: Points = np.sign(_CIRCLE) * semi * (share * _CIRCLE**2) ** (1.0 / exponents)
    return offsets


def vertical_extent(obstacle: Obstacle, points_xy: Points) -> Points:
    """(n, 2) depths of an obstacle's top and bottom over each of (n, 2) points, NaN beside it."""
    kind = obstacle["kind"]
    extent = np.full((len(points_xy), 2), np.nan)
    if kind == "polygon":
        inside = _inside(np.asarray(obstacle["vertices_m"], dtype=np.float64)[:, :2], points_xy)
        extent[inside] = depth_range(obstacle)
        return extent
    centre = np.asarray(obstacle["position_m"], dtype=np.float64)
    x, y = points_xy[:, 0] - centre[0], points_xy[:, 1] - centre[1]
    if kind == "superquadric":
        semi = np.asarray(obstacle["semi_axes_m"], dtype=np.float64)
        exponents = np.asarray(obstacle["exponents"], dtype=np.float64)
        share = 1.0 - np.abs(x / semi[0]) ** exponents[0] - np.abs(y / semi[1]) ** exponents[1]
        inside = share > 0.0
        half = semi[2] * share[inside] ** (1.0 / exponents[2])
    else:
        radius = float(obstacle["radius_m"])
        share = radius**2 - x * x - y * y
        inside = share > 0.0
        if kind != "sphere":
            extent[inside] = depth_range(obstacle)
            return extent
        half = np.sqrt(share[inside])
    extent[inside, 0] = centre[2] - half
    extent[inside, 1] = centre[2] + half
    return extent


def _inside(vertices: Points, points: Points) -> np.ndarray[Any, np.dtype[np.bool_]]:
    """Even-odd rule: an odd number of edges lies to the right of a point inside."""
    inside = np.zeros(len(points), dtype=np.bool_)
    x, y = points[:, 0], points[:, 1]
    for (x0, y0), (x1, y1) in zip(vertices, np.roll(vertices, -1, axis=0), strict=True):
        if y0 != y1:
            crosses = (y0 > y) != (y1 > y)
            inside ^= crosses & (x < x0 + (y - y0) * (x1 - x0) / (y1 - y0))
    return inside


def crossing(obstacles: Sequence[Obstacle], points_xy: Points) -> list[Obstacle]:
    """Those of the obstacles that may lie over or under one of (n, 2) points; misses none."""
    if not obstacles:
        return []
    middles = np.stack([middle(obstacle) for obstacle in obstacles])
    reach = np.array([_reach(obstacle) for obstacle in obstacles])
    x, y = (points_xy[:, axis] - middles[:, axis, None] for axis in (0, 1))
    near = np.min(x * x + y * y, axis=1) <= reach**2
    return [obstacles[index] for index in np.flatnonzero(near).tolist()]


def _reach(obstacle: Obstacle) -> float:
    """Radius of a circle round an obstacle's middle that holds all of it."""
    if obstacle["kind"] == "polygon":
        vertices = np.asarray(obstacle["vertices_m"], dtype=np.float64)[:, :2]
        return float(np.max(np.hypot(*(vertices - middle(obstacle)).T)))
    if obstacle["kind"] == "superquadric":
        return float(np.hypot(*obstacle["semi_axes_m"][:2]))
    return float(obstacle["radius_m"])


def middle(obstacle: Obstacle) -> Points:
    """The (2,) middle of an obstacle in the plan view, m."""
    if obstacle["kind"] == "polygon":
        vertices = np.asarray(obstacle["vertices_m"], dtype=np.float64)[:, :2]
        return np.asarray(vertices.mean(axis=0))
    return np.asarray(obstacle["position_m"], dtype=np.float64)[:2]
