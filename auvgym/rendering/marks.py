"""What moves on the plan view: obstacles, the course flown and planned, goal and vehicle."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from auvgym.rendering import palette
from auvgym.rendering.axes import Axes
from auvgym.rendering.canvas import Canvas
from auvgym.rendering.shapes import Obstacle, depth_range, middle, outline, section
from auvgym.rendering.subjects import Episode, Facts, Points, Snapshot

# An obstacle this share of the world's depth above or below the vehicle is drawn as far away.
FAR_SHARE = 0.2


def closeness(obstacle: Obstacle, depth_m: float, extent_m: float) -> float:
    """1 where an obstacle reaches the depth, falling to 0 at ``FAR_SHARE`` of the extent away."""
    top, bottom = depth_range(obstacle)
    gap = max(top - depth_m, depth_m - bottom, 0.0)
    return max(0.0, 1.0 - gap / max(FAR_SHARE * extent_m, 1e-9))


def draw_obstacles(
    canvas: Canvas, axes: Axes, snapshot: Snapshot, facts: Facts, depth_m: float
) -> None:
    """Outlines of the full obstacles, their cut at the vehicle's depth solid, and their way."""
    obstacles = snapshot["obstacles"]
    solid = (*palette.OBSTACLE, 205), (*palette.OBSTACLE, 255)
    if facts.flat:
        for shape in axes.pixels_each([outline(obstacle) for obstacle in obstacles]):
            canvas.polygon(shape, *solid)
    else:
        extent = float(facts.maximum[2] - facts.minimum[2])
        near = [closeness(obstacle, depth_m, extent) for obstacle in obstacles]
        order = np.argsort(near, kind="stable").tolist()  # the nearest in depth on top
        full = axes.pixels_each([outline(obstacles[index]) for index in order])
        for index, shape in zip(order, full, strict=True):
            ink = _shaded(near[index])
            fill = (*ink, round(48 * near[index])) if near[index] > 0.0 else None
            canvas.polygon(shape, fill, (*ink, round(70 + 120 * near[index])))
        reaching = [obstacles[index] for index in order if near[index] >= 1.0]
        cuts = [cut for cut in (section(obstacle, depth_m) for obstacle in reaching) if len(cut)]
        for shape in axes.pixels_each(cuts):
            canvas.polygon(shape, *solid)
    _draw_ways(canvas, axes, obstacles, facts)


def _shaded(share: float) -> palette.Colour:
    """Between the colour of an obstacle far above or below (0) and at the vehicle's depth (1)."""
    red, green, blue = (
        round(away + (close - away) * share)
        for away, close in zip(palette.OBSTACLE_AWAY, palette.OBSTACLE, strict=True)
    )
    return red, green, blue


def _draw_ways(canvas: Canvas, axes: Axes, obstacles: Sequence[Obstacle], facts: Facts) -> None:
    """Where moving obstacles will be when the vehicle has gone one reach."""
    moving = [obstacle for obstacle in obstacles if any(obstacle["velocity_mps"][:2])]
    if not moving:
        return
    here = np.stack([middle(obstacle) for obstacle in moving])
    velocity = np.array([obstacle["velocity_mps"][:2] for obstacle in moving], dtype=np.float64)
    tails = axes.pixels(here)
    runs = axes.pixels(here + velocity * (facts.reach_m / facts.speed_mps)) - tails
    lengths = np.hypot(runs[:, 0], runs[:, 1])
    shown = lengths > 2.0
    tips = tails + runs * np.maximum(1.0, 14.0 / np.maximum(lengths, 1e-9))[:, None]
    for tail, tip in zip(tails[shown].tolist(), tips[shown].tolist(), strict=True):
        canvas.arrow(tail, tip, palette.INK, 2)


def draw_goal(canvas: Canvas, axes: Axes, facts: Facts) -> None:
    """Start ring, goal circle at its radius (never too small to see)."""
    start, goal = axes.pixels(np.stack([facts.start, facts.goal]))
    canvas.dot(start, 6, palette.CASING)
    canvas.dot(start, 5, palette.START, 2)
    radius = max(facts.goal_radius_m * axes.pixels_per_x, 6.0)
    canvas.dot(goal, radius + 2, palette.CASING, 4)
    canvas.dot(goal, radius + 1, palette.GOAL, 2)
    canvas.dot(goal, 2, palette.GOAL)


def draw_course(
    canvas: Canvas, axes: Axes, episode: Episode, plan: Points | None, vehicle_size: float = 10.0
) -> None:
    """Plan (dashed), trail, the waypoint in force and the vehicle."""
    position = np.asarray(episode.position, dtype=np.float64)
    here = axes.pixels(position)
    if plan is not None and len(plan) > 1:
        way = axes.pixels(np.asarray(plan, dtype=np.float64))
        canvas.dashes(way, palette.PLAN, 2)
    trail = thin(np.vstack([axes.pixels(np.asarray(episode.trail)), here]))
    canvas.line(trail, palette.CASING, 4)
    canvas.line(trail, palette.TRAIL, 2)
    if episode.waypoint is not None:
        target = axes.pixels(np.asarray(episode.waypoint, dtype=np.float64))
        canvas.line([here, target], palette.WAYPOINT)
        cross = 5.0
        for turn in (1.0, -1.0):
            arm = np.array([cross, turn * cross])
            canvas.line([target - arm, target + arm], palette.CASING, 4)
            canvas.line([target - arm, target + arm], palette.WAYPOINT, 2)
    heading = np.asarray(episode.heading, dtype=np.float64)[:2] * (1.0, -1.0)
    draw_vehicle(canvas, here, heading, vehicle_size)


def draw_vehicle(canvas: Canvas, here: Points, direction: Points, size: float) -> None:
    """A dart at a pixel, pointing along ``direction`` (pixels, y down)."""
    length = float(np.hypot(*direction))
    along = direction / length if length > 1e-6 else np.array([0.0, -1.0])
    aside = np.array([-along[1], along[0]])
    for grow, ink in ((2.5, palette.CASING), (0.0, palette.VEHICLE)):
        reach = size + grow
        corners = [
            here + 1.15 * reach * along,
            here - 0.85 * reach * along + 0.68 * reach * aside,
            here - 0.45 * (size - grow) * along,
            here - 0.85 * reach * along - 0.68 * reach * aside,
        ]
        canvas.polygon(np.stack(corners), ink)


def thin(way: Points, tolerance: float = 0.4) -> Points:
    """Return a pixel polyline without the points that lie within ``tolerance`` of the rest.

    Ramer-Douglas-Peucker: a leg flown straight is one line, however many ticks it took.
    """
    kept = np.zeros(len(way), dtype=np.bool_)
    kept[[0, -1]] = True
    spans = [(0, len(way) - 1)]
    while spans:
        first, last = spans.pop()
        if last - first < 2:
            continue
        run = way[last] - way[first]
        offset = way[first + 1 : last] - way[first]
        length = float(np.hypot(run[0], run[1]))
        if length > 0.0:
            away = np.abs(offset[:, 0] * run[1] - offset[:, 1] * run[0]) / length
        else:
            away = np.hypot(offset[:, 0], offset[:, 1])
        farthest = int(np.argmax(away))
        if away[farthest] > tolerance:
            middle = first + 1 + farthest
            kept[middle] = True
            spans += [(first, middle), (middle, last)]
    corners: Points = way[kept]
    return corners
