"""A surface to draw on: anti-aliased lines and shapes, and text. Pixels, y down."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from auvgym._extras import require
from auvgym.rendering.palette import Colour

Pixel = Sequence[float] | NDArray[np.float64]
Pixels = NDArray[np.float64] | Sequence[Pixel]
_PROMPT = "PYGAME_HIDE_SUPPORT_PROMPT"


def load_pygame() -> Any:
    """Import pygame without its greeting on stdout; raises ImportError naming the extra."""
    quiet = _PROMPT in os.environ
    os.environ.setdefault(_PROMPT, "1")
    try:
        pygame = require("pygame", "render")
        require("pygame.gfxdraw", "render")
    finally:
        if not quiet:
            del os.environ[_PROMPT]
    return pygame


@lru_cache(maxsize=16)
def _font(height: int) -> Any:
    # pygame's own font file: the same letters on every machine.
    pygame = load_pygame()
    pygame.font.init()
    return pygame.font.Font(None, height)


@lru_cache(maxsize=2048)
def _letters(text: str, height: int, colour: Colour) -> Any:
    return _font(height).render(text, True, colour)


class Canvas:
    """Draws on one pygame surface.

    Args:
        surface: to draw on; None makes one of ``size``.
        size: (width, height), pixels, of a new surface.
        clear: a new surface starts transparent, to be laid over another.
    """

    def __init__(
        self, surface: Any = None, size: tuple[int, int] = (1, 1), clear: bool = False
    ) -> None:
        self.pygame = load_pygame()
        if surface is None:
            flags = self.pygame.SRCALPHA if clear else 0
            surface = self.pygame.Surface(size, flags, 32)
        self.surface = surface

    def pixels(self) -> NDArray[np.uint8]:
        """The picture as (height, width, 3) uint8, a copy."""
        width, height = self.surface.get_size()
        # A surface whose bytes lie as R, G, B is read several times faster than it is converted.
        # Rows are whole 4-byte words, so it is made a little too wide.
        stride = width + -width % 4
        masks = (0x0000FF, 0x00FF00, 0xFF0000, 0)
        plain = self.pygame.Surface((stride, height), 0, 24, masks)
        plain.blit(self.surface, (0, 0))
        rows = np.frombuffer(plain.get_view("0"), dtype=np.uint8).reshape(height, stride, 3)
        picture: NDArray[np.uint8] = rows[:, :width].copy()
        return picture

    def copy(self) -> Canvas:
        """The same picture on a surface of its own."""
        return Canvas(self.surface.copy())

    def lay(self, other: Canvas, position: tuple[float, float] = (0.0, 0.0)) -> None:
        """Put another canvas on this one, top left corner at ``position``."""
        self.surface.blit(other.surface, position)

    def clip(self, box: tuple[float, float, float, float] | None) -> None:
        """Draw only within (left, top, width, height) until called with None."""
        self.surface.set_clip(None if box is None else self.pygame.Rect(*map(round, box)))

    def text(
        self,
        position: Pixel,
        text: str,
        height: int = 17,
        colour: Colour = (255, 255, 255),
        anchor: tuple[float, float] = (0.0, 0.0),
        turned: bool = False,
    ) -> float:
        """Write; ``anchor`` is the part of the text at ``position`` (0, 0 = its top left corner).

        Returns the width in pixels.
        """
        letters = _letters(text, height, colour)
        if turned:
            letters = self.pygame.transform.rotate(letters, 90)
        width, tall = letters.get_size()
        left, top = position[0] - anchor[0] * width, position[1] - anchor[1] * tall
        self.surface.blit(letters, (round(left), round(top)))
        return float(width)

    def box(
        self,
        box: tuple[float, float, float, float],
        fill: Colour | None = None,
        border: Colour | None = None,
        radius: int = 0,
    ) -> None:
        """A rectangle (left, top, width, height)."""
        rectangle = self.pygame.Rect(*map(round, box))
        if fill is not None:
            self.pygame.draw.rect(self.surface, fill, rectangle, border_radius=radius)
        if border is not None:
            self.pygame.draw.rect(self.surface, border, rectangle, 1, border_radius=radius)

    def polygon(
        self, points: Pixels, fill: tuple[int, ...] | None, edge: tuple[int, ...] | None = None
    ) -> None:
        """A closed polygon; colours may carry an opacity (0..255) as fourth number."""
        corners = _whole(points)
        if len(corners) < 3:
            return
        if fill is not None:
            self.pygame.gfxdraw.filled_polygon(self.surface, corners, fill)
        if edge is not None or fill is not None:
            self.pygame.gfxdraw.aapolygon(self.surface, corners, edge or fill)

    def line(self, points: Pixels, colour: Colour, width: int = 1) -> None:
        """A polyline; wider than a pixel it keeps smooth edges."""
        corners = np.asarray(points, dtype=np.float64)
        # Piece by piece: pygame's aalines (2.5) now and then colours an end pixel differently.
        for first, last in zip(corners[:-1].tolist(), corners[1:].tolist(), strict=True):
            self.pygame.draw.aaline(self.surface, colour, first, last, width)

    def dashes(self, points: Pixels, colour: Colour, width: int = 1, dash: float = 7.0) -> None:
        """A dashed polyline, evenly dashed whatever its corners (which a dash cuts)."""
        corners = np.asarray(points, dtype=np.float64)
        if len(corners) < 2:
            return
        along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(corners, axis=0).T))])
        starts = np.arange(0.0, along[-1], 1.7 * dash)
        ends = np.minimum(starts + dash, along[-1])
        stops = np.stack([starts, ends], axis=-1)
        x, y = (np.interp(stops, along, corners[:, axis]) for axis in (0, 1))
        for first, last in np.stack([x, y], axis=-1).tolist():
            self.pygame.draw.aaline(self.surface, colour, first, last, width)

    def dot(self, centre: Pixel, radius: float, colour: Colour, width: int = 0) -> None:
        """A disc, or with a ``width`` a ring."""
        self.pygame.draw.aacircle(
            self.surface, colour, (round(centre[0]), round(centre[1])), max(radius, 1.0), width
        )

    def arrow(self, tail: Pixel, tip: Pixel, colour: Colour, width: int = 1) -> None:
        """A line with a head, which stays in proportion on a short arrow."""
        # Plain floats: a map of moving obstacles draws dozens of these a frame.
        (x0, y0), (x1, y1) = tail, tip
        length = math.hypot(x1 - x0, y1 - y0)
        if length < 1.0:
            return
        head = min(4.0 + 1.5 * width, 0.55 * length) / length
        back = (head * (x1 - x0), head * (y1 - y0))
        neck = (x1 - back[0], y1 - back[1])
        self.pygame.draw.aaline(self.surface, colour, (x0, y0), neck, width)
        left = (neck[0] - 0.55 * back[1], neck[1] + 0.55 * back[0])
        right = (neck[0] + 0.55 * back[1], neck[1] - 0.55 * back[0])
        self.polygon([(x1, y1), left, right], colour)


def _whole(points: Pixels) -> list[tuple[int, int]]:
    # SDL_gfx takes 16-bit whole pixels; far corners are brought to where they still fit.
    corners = np.rint(np.asarray(points, dtype=np.float64))
    corners = np.maximum(np.minimum(corners, 16000.0), -16000.0)
    whole: list[tuple[int, int]] = corners.astype(np.int32).tolist()
    return whole
