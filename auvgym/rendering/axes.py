"""From metres to pixels, with ticks and labels whose unit suits the range."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from auvgym.rendering import palette
from auvgym.rendering.canvas import Canvas
from auvgym.rendering.subjects import Points


class Box(NamedTuple):
    """A rectangle in pixels."""

    left: float
    top: float
    width: float
    height: float

    @property
    def right(self) -> float:
        """Right edge."""
        return self.left + self.width

    @property
    def bottom(self) -> float:
        """Lower edge."""
        return self.top + self.height

    def inset(self, left: float, top: float, right: float, bottom: float) -> Box:
        """What remains when each side moves inwards."""
        return Box(
            self.left + left, self.top + top, self.width - left - right, self.height - top - bottom
        )


@dataclass(frozen=True)
class Axes:
    """A box of pixels showing a range of x and of y.

    ``y_range`` is (value at the bottom, value at the top), so depth reads (deepest, 0).
    """

    box: Box
    x_range: tuple[float, float]
    y_range: tuple[float, float]

    def pixels(self, points: Points) -> Points:
        """(n, >= 2) values -> (n, 2) pixels; further columns are ignored."""
        across = self.box.width / (self.x_range[1] - self.x_range[0])
        down = -self.box.height / (self.y_range[1] - self.y_range[0])
        pixels: Points = (points[..., :2] - (self.x_range[0], self.y_range[0])) * (across, down)
        pixels += (self.box.left, self.box.bottom)
        return pixels

    def pixels_each(self, shapes: Sequence[Points]) -> list[Points]:
        """:meth:`pixels` of many small shapes at once."""
        if not shapes:
            return []
        ends = np.cumsum([len(shape) for shape in shapes])
        return np.split(self.pixels(np.concatenate(shapes)), ends[:-1])

    @property
    def pixels_per_x(self) -> float:
        """Pixels per unit of x."""
        return self.box.width / abs(self.x_range[1] - self.x_range[0])

    def grid(self, columns: int, rows: int) -> Points:
        """(rows, columns, 2) values at the middles of an even grid of cells, top row first."""
        x0, x1 = self.x_range
        y0, y1 = self.y_range
        x = x0 + (np.arange(columns) + 0.5) / columns * (x1 - x0)
        y = y1 + (np.arange(rows) + 0.5) / rows * (y0 - y1)
        return np.stack(np.meshgrid(x, y), axis=-1)


def equal_axes(space: Box, minimum: Points, maximum: Points) -> Axes:
    """Axes with one scale for x and y, as large as fits, in the middle of ``space``."""
    extent = np.maximum(np.asarray(maximum)[:2] - np.asarray(minimum)[:2], 1e-9)
    scale = min(space.width / extent[0], space.height / extent[1])
    width, height = extent * scale
    left = space.left + (space.width - width) / 2.0
    top = space.top + (space.height - height) / 2.0
    return Axes(
        Box(round(left), round(top), round(width), round(height)),
        (float(minimum[0]), float(maximum[0])),
        (float(minimum[1]), float(maximum[1])),
    )


def length_unit(extent_m: float) -> tuple[float, str]:
    """(metres in the unit, its name) for lengths up to about ``extent_m``."""
    return (1000.0, "km") if extent_m >= 2000.0 else (1.0, "m")


def time_unit(extent_s: float) -> tuple[float, str]:
    """(seconds in the unit, its name) for times up to about ``extent_s``."""
    if extent_s >= 3 * 86400.0:
        return 86400.0, "d"
    if extent_s >= 2 * 3600.0:
        return 3600.0, "h"
    return (60.0, "min") if extent_s >= 120.0 else (1.0, "s")


def nice_step(extent: float, about: int) -> float:
    """A 1-2-5 step that divides ``extent`` into about ``about`` parts."""
    rough = max(extent, 1e-12) / max(about, 1)
    power = 10.0 ** math.floor(math.log10(rough))
    return next(power * factor for factor in (1.0, 2.0, 5.0, 10.0) if power * factor >= rough * 0.8)


def ticks(low: float, high: float, about: int) -> list[float]:
    """Round values from ``low`` to ``high``."""
    low, high = min(low, high), max(low, high)
    step = nice_step(high - low, about)
    first = math.ceil(low / step - 1e-6)
    last = math.floor(high / step + 1e-6)
    return [index * step for index in range(first, last + 1)]


def number(value: float) -> str:
    """A short text for a number, without a trailing ``.0`` or a negative zero."""
    return f"{value + 0.0:.6g}" if abs(value) > 1e-12 else "0"


def draw_axes(
    canvas: Canvas,
    axes: Axes,
    labels: tuple[str, str],
    units: tuple[float, float] = (1.0, 1.0),
    spacing: tuple[float, float] = (70.0, 60.0),
    gridlines: bool = False,
) -> None:
    """Frame, ticks, numbers and axis labels; ``units`` are the size of one labelled unit."""
    box = axes.box
    for value in ticks(
        axes.x_range[0] / units[0], axes.x_range[1] / units[0], round(box.width / spacing[0])
    ):
        x = axes.pixels(np.array([value * units[0], axes.y_range[0]]))[0]
        if gridlines:
            canvas.line([(x, box.top), (x, box.bottom)], palette.RULE)
        canvas.line([(x, box.bottom), (x, box.bottom + 4)], palette.SOFT_INK)
        canvas.text((x, box.bottom + 7), number(value), 16, palette.SOFT_INK, (0.5, 0.0))
    for value in ticks(
        axes.y_range[0] / units[1], axes.y_range[1] / units[1], round(box.height / spacing[1])
    ):
        y = axes.pixels(np.array([axes.x_range[0], value * units[1]]))[1]
        if gridlines:
            canvas.line([(box.left, y), (box.right, y)], palette.RULE)
        canvas.line([(box.left - 4, y), (box.left, y)], palette.SOFT_INK)
        canvas.text((box.left - 7, y), number(value), 16, palette.SOFT_INK, (1.0, 0.5))
    canvas.box((box.left - 1, box.top - 1, box.width + 2, box.height + 2), border=palette.RULE)
    middle = (box.left + box.width / 2, box.top + box.height / 2)
    canvas.text((middle[0], box.bottom + 21), labels[0], 17, palette.SOFT_INK, (0.5, 0.0))
    canvas.text((box.left - 46, middle[1]), labels[1], 17, palette.SOFT_INK, (0.0, 0.5), True)
