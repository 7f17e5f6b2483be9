"""The ground of the plan view: seabed relief or current speed, land, contours, scales.

Painted once for a map; the current on it is painted again when it has changed enough.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from auvgym.rendering import palette
from auvgym.rendering.axes import (
    Axes,
    Box,
    draw_axes,
    length_unit,
    nice_step,
    number,
    ticks,
)
from auvgym.rendering.canvas import Canvas
from auvgym.rendering.currents import Flow
from auvgym.rendering.subjects import Facts, World

Image = NDArray[np.float64]


@dataclass(frozen=True)
class Ground:
    """A map's seabed over the chart's pixels.

    Attributes:
        image: (h, w, 3) colours 0..255 of sea floor and land.
        land: (h, w) bool: where the vehicle's operating depth, or the surface, is below ground.
        shallowest_m, deepest_m: of the sea floor; equal where it is flat or absent.
        contour_m: depth between contours.
    """

    image: Image
    land: NDArray[np.bool_]
    shallowest_m: float
    deepest_m: float
    contour_m: float


def survey(axes: Axes, world: World, facts: Facts) -> Ground:
    """Sample the sea floor at every pixel of the chart and shade it."""
    columns, rows = round(axes.box.width), round(axes.box.height)
    points = axes.grid(columns, rows)
    floor = np.asarray(world.floor_depth(points.reshape(-1, 2))).reshape(rows, columns)
    # A flat world has no depth to choose: whatever is shallower than it is land to its vehicle.
    shore = max(float(facts.minimum[2]), 0.0) if facts.flat else 0.0
    land = floor <= shore
    sea = floor[np.isfinite(floor) & ~land]
    shallowest, deepest = (float(sea.min()), float(sea.max())) if sea.size else (0.0, 0.0)
    relief = np.where(np.isfinite(floor), floor, deepest)
    interval = nice_step(max(deepest - shallowest, 1e-9), 6)
    image = palette.ramp((relief - shallowest) / max(deepest - shallowest, 1e-9), palette.DEPTH)
    if deepest - shallowest < 1e-6:
        image = np.broadcast_to(np.array(palette.DEPTH[3], dtype=float), image.shape)
    image = np.where(land[..., None], np.array(palette.LAND, dtype=float), image)
    image = image * _hillshade(relief)[..., None]
    ink = _contours(relief, interval, land)[..., None]
    image = image * (1.0 - ink) + ink * np.array(palette.CONTOUR, dtype=float)
    return Ground(np.clip(image, 0.0, 255.0), land, shallowest, deepest, interval)


def _hillshade(relief: Image) -> Image:
    """Brightness of each pixel lit from the north-west, about 1."""
    down, right = np.gradient(relief)
    steepness = float(np.percentile(np.hypot(down, right), 97))
    if steepness < 1e-9:
        return np.ones_like(relief)
    # Depth grows downwards: a slope that deepens to the south-east is in the light's lee.
    lit = -(down + right) / (steepness * np.sqrt(2.0))
    return np.asarray(1.0 + 0.22 * np.clip(lit, -1.0, 1.0))


def _contours(relief: Image, interval: float, land: NDArray[np.bool_]) -> Image:
    """Opacity (h, w) of smooth one-pixel contour lines, the shore line strongest."""
    ink = 0.38 * _level_lines(relief / interval)
    shore = land ^ np.roll(land, 1, axis=0) | land ^ np.roll(land, 1, axis=1)
    shore[0, :] = shore[:, 0] = False
    ink[land] = 0.0
    ink[shore] = 0.8
    return ink


def _level_lines(level: Image) -> Image:
    down, right = np.gradient(level)
    slope = np.hypot(down, right)
    away = np.abs(level - np.rint(level))
    lines: Image = np.clip(1.2 - away / np.maximum(slope, 1e-9), 0.0, 1.0)
    lines[slope < 1e-6] = 0.0
    return lines


def paint(canvas: Canvas, axes: Axes, ground: Ground, flow: Flow, facts: Facts) -> None:
    """Fill the chart's box: speed (flat worlds) or relief, land, and arrows of the current."""
    image = ground.image
    if facts.flat:
        speed = flow.speed_image(ground.land.shape) / flow.scale_mps
        water = palette.ramp(speed, palette.SPEED)
        image = np.where(ground.land[..., None], ground.image, water)
    pixels = np.ascontiguousarray(image, dtype=np.uint8)
    rows, columns = ground.land.shape
    picture = canvas.pygame.image.frombuffer(pixels.tobytes(), (columns, rows), "RGB")
    canvas.surface.blit(picture, (round(axes.box.left), round(axes.box.top)))
    canvas.clip(axes.box)
    flow.draw_arrows(canvas, axes, ground.land)
    canvas.clip(None)


def draw_frame(canvas: Canvas, card: Box, axes: Axes, facts: Facts) -> None:
    """Card, title, axes and scale bar, under which nothing moves."""
    extent = float(np.max(facts.maximum[:2] - facts.minimum[:2]))
    size, unit = length_unit(extent)
    canvas.box(card, fill=palette.CARD, radius=8)
    canvas.text((card.left + 14, card.top + 11), "Chart", 19, palette.INK)
    labels = tuple(f"{name} ({unit})" for name in facts.axis_names)
    draw_axes(canvas, axes, (labels[0], labels[1]), (size, size))


def draw_scale_bar(canvas: Canvas, axes: Axes, facts: Facts) -> None:
    """A scale bar in the chart's lower left corner."""
    extent = float(np.max(facts.maximum[:2] - facts.minimum[:2]))
    size, unit = length_unit(extent)
    wanted = 0.22 * axes.box.width / axes.pixels_per_x
    length = nice_step(wanted, 1)
    width = length * axes.pixels_per_x
    low = axes.box.bottom - 10
    corners = (axes.box.left + 10, axes.box.right - 10 - width)
    ends = axes.pixels(np.stack([facts.start, facts.goal]))
    middles = [np.array([corner + width / 2, low]) for corner in corners]
    room = [float(np.min(np.hypot(*(ends - middle).T))) for middle in middles]
    left = corners[0] if room[0] >= min(room[1], 0.2 * axes.box.height) else corners[1]
    for ink, thick in ((palette.CASING, 4), (palette.INK, 2)):
        canvas.line([(left, low), (left + width, low)], ink, thick)
    for offset, ink in ((1, palette.CASING), (0, palette.INK)):
        label = f"{number(length / size)} {unit}"
        canvas.text((left + offset, low - 5 + offset), label, 16, ink, (0.0, 1.0))


def draw_colour_bar(canvas: Canvas, axes: Axes, ground: Ground, flow: Flow, facts: Facts) -> None:
    """What the chart's colours mean, right of it."""
    colours: tuple[palette.Colour, ...] = palette.SPEED
    low, high, unit, size, name = 0.0, flow.scale_mps, "m/s", 1.0, "current"
    if not facts.flat:
        low, high, name = ground.deepest_m, ground.shallowest_m, "floor"
        colours = tuple(reversed(palette.DEPTH))
        size, unit = length_unit(ground.deepest_m)
        if abs(high - low) < 1e-6:
            return
    box = Box(axes.box.right + 16, axes.box.top + 40, 12, min(180.0, axes.box.height - 60))
    shades = palette.ramp(np.linspace(1.0, 0.0, round(box.height)), colours)
    for row, shade in enumerate(shades.astype(int).tolist()):
        line = (round(box.left), round(box.top) + row, round(box.width), 1)
        canvas.surface.fill(tuple(shade), line)
    canvas.text((box.left - 4, box.top - 32), name, 16, palette.SOFT_INK)
    canvas.text((box.left - 4, box.top - 18), f"({unit})", 16, palette.SOFT_INK)
    scale = Axes(box, (0.0, 1.0), (low / size, high / size))
    for value in ticks(low / size, high / size, 5):
        y = float(scale.pixels(np.array([0.0, value]))[1])
        canvas.text((box.right + 6, y), number(value), 16, palette.SOFT_INK, (0.0, 0.5))
