"""The current as the chart shows it: sampled on two grids, for colour and for arrows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from auvgym.rendering import palette
from auvgym.rendering.axes import Axes, nice_step
from auvgym.rendering.canvas import Canvas
from auvgym.rendering.subjects import Facts, Points, World

ARROW_SPACING = 25.0  # pixels between arrows
COLOUR_SPACING = 4.0  # pixels between samples of the speed; smooth in between
FAINT = (112, 164, 198)


@dataclass(frozen=True)
class Flow:
    """A current field sampled at one depth and time.

    Attributes:
        arrows: (rows, columns, 2) m/s, top row first.
        places: (rows, columns, 2) m.
        speeds: (rows, columns) m/s on a finer grid, or None where no colour needs it.
        scale_mps: a round speed no sample exceeds; what the longest arrow stands for.
    """

    arrows: Points
    places: Points
    speeds: Points | None
    scale_mps: float

    @classmethod
    def sample(cls, world: World, axes: Axes, depth_m: float, facts: Facts) -> Flow:
        """Ask the world for the current over the chart at ``depth_m``, at its present time.

        Only flat worlds are coloured by speed, so only they are sampled finely.
        """
        places, arrows = _sample(world, axes, depth_m, ARROW_SPACING)
        speeds = None
        if facts.flat:
            _, fine = _sample(world, axes, depth_m, COLOUR_SPACING)
            speeds = np.hypot(fine[..., 0], fine[..., 1])
        # Still water should look still, not like a scale of a thousandth of a metre per second.
        fastest = 0.02 * facts.speed_mps
        fastest = max(fastest, float(np.max(np.hypot(arrows[..., 0], arrows[..., 1]))))
        if speeds is not None:
            fastest = max(fastest, float(speeds.max(initial=0.0)))
        step = nice_step(fastest, 4)
        return cls(arrows, places, speeds, float(np.ceil(fastest / step - 1e-6) * step))

    def speed_image(self, shape: tuple[int, ...]) -> NDArray[np.float64]:
        """The speeds (m/s) resampled linearly to ``shape`` (rows, columns)."""
        assert self.speeds is not None, "sampled without colour"
        rows, columns = self.speeds.shape
        across = _positions(columns, shape[1])
        down = _positions(rows, shape[0])
        left, top = np.floor(across).astype(int), np.floor(down).astype(int)
        right, low = np.minimum(left + 1, columns - 1), np.minimum(top + 1, rows - 1)
        part = across - left
        wide = self.speeds[:, left] * (1.0 - part) + self.speeds[:, right] * part
        share = (down - top)[:, None]
        image: NDArray[np.float64] = wide[top] * (1.0 - share) + wide[low] * share
        return image

    def draw_arrows(self, canvas: Canvas, axes: Axes, land: NDArray[np.bool_]) -> None:
        """Arrows centred on their places; longer and brighter the faster the water."""
        middle = axes.pixels(self.places.reshape(-1, 2))
        velocity = self.arrows.reshape(-1, 2) * (1.0, -1.0)  # the screen's y points down
        speed = np.hypot(velocity[:, 0], velocity[:, 1])
        row = np.clip((middle[:, 1] - axes.box.top).astype(int), 0, land.shape[0] - 1)
        column = np.clip((middle[:, 0] - axes.box.left).astype(int), 0, land.shape[1] - 1)
        seen = (speed > 0.01 * self.scale_mps) & ~land[row, column]
        middle, velocity, speed = middle[seen], velocity[seen], speed[seen]
        share = np.sqrt(speed / self.scale_mps)
        along = velocity / speed[:, None]
        aside = np.stack([-along[:, 1], along[:, 0]], axis=-1)
        length = (0.95 * ARROW_SPACING * share)[:, None]
        tail, tip = middle - 0.5 * length * along, middle + 0.5 * length * along
        head = 0.34 * length
        barbs = [tip - head * along + sign * 0.6 * head * aside for sign in (1.0, -1.0)]
        faint, bright = np.array(FAINT), np.array(palette.CURRENT)
        inks = (faint + (bright - faint) * share[:, None]).astype(int)
        ends = np.stack([tail, tip, *barbs], axis=1).tolist()
        line = canvas.pygame.draw.aaline
        for ink, (start, point, left, right) in zip(inks.tolist(), ends, strict=True):
            line(canvas.surface, ink, start, point)
            line(canvas.surface, ink, left, point)
            line(canvas.surface, ink, right, point)


def _sample(world: World, axes: Axes, depth_m: float, spacing: float) -> tuple[Points, Points]:
    columns = max(2, round(axes.box.width / spacing))
    rows = max(2, round(axes.box.height / spacing))
    places = axes.grid(columns, rows)
    points = np.column_stack([places.reshape(-1, 2), np.full(rows * columns, depth_m)])
    velocity = np.asarray(world.current(points))[:, :2].reshape(rows, columns, 2)
    return places, velocity


def _positions(samples: int, pixels: int) -> NDArray[np.float64]:
    """Where each pixel's middle lies between cell-centred samples, in samples."""
    position = (np.arange(pixels) + 0.5) / pixels * samples - 0.5
    return np.clip(position, 0.0, samples - 1.0)
