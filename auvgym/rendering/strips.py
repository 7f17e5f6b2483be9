"""Flat worlds have no depth profile; their room shows the episode along its time instead."""

from __future__ import annotations

import numpy as np

from auvgym.rendering import palette
from auvgym.rendering.axes import Axes, Box, draw_axes, length_unit, nice_step, time_unit
from auvgym.rendering.canvas import Canvas
from auvgym.rendering.marks import thin
from auvgym.rendering.subjects import Episode, Facts, Points


def ground_speeds(trail: Points, tick_s: float) -> Points:
    """(k - 1,) speed over ground between trail points flown a tick apart, m/s."""
    return np.asarray(np.linalg.norm(np.diff(trail, axis=0), axis=1) / tick_s)


def draw_card(canvas: Canvas, card: Box) -> None:
    """The card and its title, under which nothing moves."""
    canvas.box(card, fill=palette.CARD, radius=8)


def draw_strips(canvas: Canvas, card: Box, episode: Episode, facts: Facts) -> None:
    """Speed over ground and distance to the goal against time, up to the time limit."""
    if card.width > 1.8 * card.height:
        half = (card.width - 10) / 2
        first = Box(card.left, card.top, half, card.height)
        second = Box(card.right - half, card.top, half, card.height)
    else:
        half = card.height / 2
        first = Box(card.left, card.top, card.width, half)
        second = Box(card.left, card.top + half, card.width, half)
    trail = np.asarray(episode.trail, dtype=np.float64).reshape(-1, 3)
    clock = np.arange(len(trail), dtype=np.float64) * facts.tick_s
    _draw_speed(canvas, first, trail, clock, episode, facts)
    _draw_distance(canvas, second, trail, clock, episode, facts)


def _axes(
    canvas: Canvas, box: Box, title: str, high: float, label: str, unit: float, limit_s: float
) -> Axes:
    canvas.text((box.left + 14, box.top + 11), title, 19, palette.INK)
    axes = Axes(box.inset(62, 38, 18, 46), (0.0, limit_s), (0.0, high))
    size, name = time_unit(limit_s)
    draw_axes(canvas, axes, (f"time ({name})", label), (size, unit), (80.0, 34.0), True)
    return axes


def _draw_speed(
    canvas: Canvas, box: Box, trail: Points, clock: Points, episode: Episode, facts: Facts
) -> None:
    speeds = ground_speeds(trail, facts.tick_s)
    fastest = max(1.5 * facts.speed_mps, float(speeds.max(initial=0.0)))
    step = nice_step(fastest, 4)
    high = float(np.ceil(fastest / step) * step)
    axes = _axes(canvas, box, "Speed over ground", high, "m/s", 1.0, episode.time_limit_s)
    canvas.clip(axes.box)
    still = axes.pixels(np.array([[0.0, facts.speed_mps], [axes.x_range[1], facts.speed_mps]]))
    canvas.dashes(still, palette.CURRENT, 1)
    canvas.text((axes.box.right - 6, still[0, 1] - 3), "still water", 15, palette.CURRENT, (1, 1))
    if len(speeds):
        canvas.line(thin(axes.pixels(np.column_stack([clock[1:], speeds]))), palette.TRAIL, 2)
    canvas.clip(None)


def _draw_distance(
    canvas: Canvas, box: Box, trail: Points, clock: Points, episode: Episode, facts: Facts
) -> None:
    size, unit = length_unit(facts.distance_m)
    high = 1.08 * facts.distance_m
    axes = _axes(canvas, box, "Distance to the goal", high, unit, size, episode.time_limit_s)
    canvas.clip(axes.box)
    pace = np.array([[0.0, facts.distance_m], [facts.distance_m / facts.speed_mps, 0.0]])
    canvas.dashes(axes.pixels(pace), palette.CURRENT, 1)
    corner = (axes.box.right - 6, axes.box.top + 5)
    canvas.text(corner, "dashed: straight in still water", 15, palette.CURRENT, (1.0, 0.0))
    left = np.linalg.norm(trail - facts.goal, axis=1)
    now = [episode.time_s, float(np.linalg.norm(np.asarray(episode.position) - facts.goal))]
    curve = np.vstack([np.column_stack([clock, left])[clock < episode.time_s], now])
    canvas.line(thin(axes.pixels(curve)), palette.TRAIL, 2)
    canvas.dot(axes.pixels(np.array(now)), 4, palette.VEHICLE)
    canvas.clip(None)
