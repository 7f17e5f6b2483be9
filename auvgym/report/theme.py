"""Colours and settings of figures that must read on a light page and on a dark one."""

from __future__ import annotations

from typing import Any

from auvgym.rendering.palette import DEPTH, LAND, SPEED, Colour, css

OBSTACLE = "#e8604c"
TRAIL = "#f0a020"
PLAN = "#b070f2"
START = "#5c88a8"
GOAL = "#22a861"
VEHICLE = "#f0a020"
CURRENT = "#6fa8cc"
INK = "#748899"
RULE = "rgba(128,148,168,0.35)"
LAND_FILL = css(LAND)
SHORE = "#2b2a20"
FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, sans-serif"


def scale(colours: tuple[Colour, ...]) -> list[list[Any]]:
    """A plotly colour scale of evenly spaced colours."""
    last = len(colours) - 1
    return [[index / last, css(colour)] for index, colour in enumerate(colours)]


# Depth grows along the scale: shallow first.
DEPTH_SCALE = scale(DEPTH)
SPEED_SCALE = scale(SPEED)
ARROW_SCALE = scale(((110, 150, 182), (70, 150, 210), (20, 110, 200)))
