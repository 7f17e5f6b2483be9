"""The depth profile: a vertical section along the way flown and the way still ahead."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from auvgym.rendering import palette
from auvgym.rendering.axes import Axes, Box, draw_axes, length_unit
from auvgym.rendering.canvas import Canvas
from auvgym.rendering.marks import closeness, draw_vehicle, thin
from auvgym.rendering.shapes import crossing, vertical_extent
from auvgym.rendering.subjects import Episode, Facts, Points, Snapshot, World

SAMPLES = 280
SEABED = (66, 60, 52)
SEABED_EDGE = (176, 158, 118)
SHALLOW_WATER = (30, 98, 134)
DEEP_WATER = (10, 36, 64)


class Route(NamedTuple):
    """The way a profile follows: (k, 3) m with the horizontal distance along it, m."""

    points: Points
    along_m: Points
    flown: int  # the first points of it: the trail, up to the vehicle

    def at(self, along_m: Points) -> Points:
        """(n, 2) horizontal positions at distances along the route."""
        return np.stack(
            [np.interp(along_m, self.along_m, self.points[:, axis]) for axis in (0, 1)], axis=-1
        )


def route(episode: Episode, plan: Points | None, goal: Points) -> Route:
    """The trail, then the plan from where the vehicle is on it (or a straight line) to the goal."""
    position = np.asarray(episode.position, dtype=np.float64)
    trail = np.asarray(episode.trail, dtype=np.float64).reshape(-1, 3)
    flown = np.vstack([trail[:: max(1, len(trail) // 600)], position])
    ahead = [goal]
    if plan is not None and len(plan):
        course = np.asarray(plan, dtype=np.float64)
        nearest = int(np.argmin(np.linalg.norm(course - position, axis=1)))
        rest = list(course[nearest + 1 :])
        reaches = bool(rest) and np.linalg.norm(rest[-1] - goal) < 1.0
        ahead = rest if reaches else [*rest, goal]
    points = np.vstack([flown, *ahead])
    steps = np.hypot(*np.diff(points[:, :2], axis=0).T)
    return Route(points, np.concatenate([[0.0], np.cumsum(steps)]), len(flown))


def draw_card(canvas: Canvas, card: Box) -> None:
    """The card and its title, under which nothing moves."""
    canvas.box(card, fill=palette.CARD, radius=8)
    canvas.text((card.left + 14, card.top + 11), "Depth along the route", 19, palette.INK)


def draw_profile(
    canvas: Canvas,
    card: Box,
    world: World,
    snapshot: Snapshot,
    episode: Episode,
    plan: Points | None,
    facts: Facts,
) -> None:
    """The section, filling ``card``: seabed, obstacles across it, the course and the vehicle."""
    way = route(episode, plan, facts.goal)
    length = max(float(way.along_m[-1]), 1.0)
    deepest = float(facts.maximum[2])
    axes = Axes(card.inset(62, 38, 18, 46), (0.0, length), (deepest, min(0.0, facts.minimum[2])))
    _draw_water(canvas, axes)
    canvas.clip(axes.box)
    along = np.linspace(0.0, length, SAMPLES)
    places = way.at(along)
    reached = float(way.along_m[way.flown - 1])
    _draw_obstacles(canvas, axes, snapshot, along, places, reached, float(episode.position[2]))
    _draw_seabed(canvas, axes, along, np.asarray(world.floor_depth(places)), deepest)
    # Marks at the ends of the route may reach beyond them.
    canvas.clip(axes.box.inset(-10, -4, -10, -4))
    here = axes.pixels(np.array([reached, episode.position[2]]))
    canvas.dashes([(here[0], axes.box.top), (here[0], axes.box.bottom)], palette.SOFT_INK, 1, 3)
    _draw_goal(canvas, axes, facts, length)
    course = axes.pixels(np.column_stack([way.along_m, way.points[:, 2]]))
    canvas.dashes(course[way.flown - 1 :], palette.SOFT_INK if plan is None else palette.PLAN, 2)
    trail = thin(course[: way.flown])
    canvas.line(trail, palette.CASING, 4)
    canvas.line(trail, palette.TRAIL, 2)
    pitch = np.asarray(episode.heading, dtype=np.float64)
    scale = np.array([axes.pixels_per_x, axes.box.height / deepest])
    draw_vehicle(canvas, here, np.array([np.hypot(*pitch[:2]), pitch[2]]) * scale, 9.0)
    canvas.clip(None)
    size, unit = length_unit(length)
    tall, tall_unit = length_unit(deepest)
    labels = (f"distance along the route ({unit})", f"depth ({tall_unit})")
    draw_axes(canvas, axes, labels, (size, tall), (80.0, 45.0))


def _draw_water(canvas: Canvas, axes: Axes) -> None:
    shades = palette.ramp(np.linspace(0.0, 1.0, 24), (SHALLOW_WATER, DEEP_WATER)).astype(int)
    edges = np.rint(np.linspace(axes.box.top, axes.box.bottom, 25)).astype(int)
    for shade, top, low in zip(shades.tolist(), edges[:-1], edges[1:], strict=True):
        rectangle = (round(axes.box.left), int(top), round(axes.box.width), int(low - top))
        canvas.surface.fill(tuple(shade), rectangle)


def _draw_obstacles(
    canvas: Canvas,
    axes: Axes,
    snapshot: Snapshot,
    along: Points,
    places: Points,
    reached_m: float,
    depth_m: float,
) -> None:
    """Obstacles over the route; those behind faint, for they were elsewhere when passed."""
    deepest, top = axes.y_range
    for obstacle in crossing(snapshot["obstacles"], places):
        extent = vertical_extent(obstacle, places)
        across = np.flatnonzero((extent[:, 1] > top) & (extent[:, 0] < deepest))
        if not across.size:
            continue
        share = closeness(obstacle, depth_m, deepest)
        for run in np.split(across, np.flatnonzero(np.diff(across) > 1) + 1):
            shell = np.clip(extent[run], top, deepest)
            upper = axes.pixels(np.column_stack([along[run], shell[:, 0]]))
            lower = axes.pixels(np.column_stack([along[run], shell[:, 1]]))
            behind = along[run[-1]] < reached_m
            fill, edge = (22, 90) if behind else (round(70 + 110 * share), 230)
            shape = np.vstack([upper, lower[::-1]])
            canvas.polygon(shape, (*palette.OBSTACLE, fill), (*palette.OBSTACLE, edge))


def _draw_seabed(
    canvas: Canvas, axes: Axes, along: Points, floor: Points, deepest_m: float
) -> None:
    if not np.isfinite(floor).any():
        return
    edge = axes.pixels(np.column_stack([along, np.minimum(floor, 2.0 * deepest_m)]))
    box = axes.box
    corners = [(box.right + 2, box.bottom + 2), (box.left - 2, box.bottom + 2)]
    canvas.polygon(np.vstack([edge, corners]), SEABED)
    canvas.line(edge, SEABED_EDGE, 2)


def _draw_goal(canvas: Canvas, axes: Axes, facts: Facts, length: float) -> None:
    # Across is kilometres and down may be metres: a bar over the goal's depths, not a circle.
    centre = axes.pixels(np.array([length, facts.goal[2]]))
    half = max(facts.goal_radius_m * axes.box.height / abs(axes.y_range[0]), 6.0)
    reach = np.array([0.0, half])
    canvas.line([centre - reach, centre + reach], palette.GOAL, 4)
