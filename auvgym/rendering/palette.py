"""Colours: a night chart. Water is blue, land sand, danger coral, the vehicle's own amber."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Colour = tuple[int, int, int]

PAGE: Colour = (8, 20, 33)
CARD: Colour = (14, 31, 48)
RULE: Colour = (40, 64, 86)
INK: Colour = (226, 236, 244)
SOFT_INK: Colour = (142, 166, 187)
LAND: Colour = (112, 100, 74)
CONTOUR: Colour = (4, 14, 26)

CURRENT: Colour = (190, 228, 255)
OBSTACLE: Colour = (255, 112, 92)
OBSTACLE_AWAY: Colour = (172, 168, 190)
TRAIL: Colour = (255, 196, 66)
PLAN: Colour = (214, 170, 255)
WAYPOINT: Colour = (255, 226, 150)
GOAL: Colour = (104, 232, 148)
START: Colour = (236, 244, 250)
VEHICLE: Colour = (255, 255, 255)
CASING: Colour = (6, 14, 24)

OUTCOMES: dict[str, Colour] = {
    "running": (86, 168, 232),
    "goal": GOAL,
    "collision": OBSTACLE,
    "out_of_bounds": (255, 150, 80),
    "energy": (240, 190, 80),
    "timeout": (240, 190, 80),
}

DEPTH = ((134, 182, 168), (78, 144, 152), (38, 108, 138), (24, 78, 118), (15, 50, 88))
SPEED = ((13, 44, 76), (20, 82, 122), (30, 128, 148), (96, 178, 150), (236, 214, 130))


def ramp(values: NDArray[np.float64], colours: tuple[Colour, ...]) -> NDArray[np.float64]:
    """Colours of ``values`` in 0..1 along evenly spaced ``colours``: (...,) -> (..., 3), 0..255."""
    stops = np.linspace(0.0, 1.0, len(colours))
    table = np.asarray(colours, dtype=np.float64)
    clipped = np.clip(values, 0.0, 1.0)
    return np.stack([np.interp(clipped, stops, table[:, band]) for band in range(3)], axis=-1)


def css(colour: Colour, opacity: float = 1.0) -> str:
    """The colour as a CSS ``rgba()`` text."""
    return f"rgba({colour[0]},{colour[1]},{colour[2]},{opacity:g})"
