"""What figures are drawn with: one scene for a world in space, one for a world on the plane.

A scene turns a world into plotly traces. Things that change in time have an ``_update``
beside them: only what differs between two frames of an animation.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any

import numpy as np

from auvgym._extras import require
from auvgym.rendering.axes import length_unit
from auvgym.rendering.shapes import Obstacle
from auvgym.rendering.subjects import Facts, Points, World
from auvgym.report import theme

Trace = Any
ARROWS_ACROSS = 16


class Scene(ABC):
    """Traces of one world, in kilometres or metres.

    Args:
        world: whose map, domain and unit the scene has.
    """

    scatter_name: str
    marker: float  # size of start and goal, pixels

    def __init__(self, world: World) -> None:
        self.go = require("plotly.graph_objects", "report")
        self.world = world
        self.facts = Facts.of(world)
        extent = self.facts.maximum[:2] - self.facts.minimum[:2]
        self.size_m, self.unit = length_unit(float(extent.max()))

    @abstractmethod
    def coordinates(self, points: Points) -> dict[str, Any]:
        """``x``, ``y`` (and ``z``) of (n, 3) m in the scene's unit; NaN breaks a line."""

    @abstractmethod
    def ground(self) -> list[Trace]:
        """Seabed and land."""

    @abstractmethod
    def flow(self, world: World, depth_m: float, fastest_mps: float) -> list[Trace]:
        """The current of a world at its present time; ``fastest_mps`` sets the scale."""

    @abstractmethod
    def obstacles(self, obstacles: Sequence[Obstacle]) -> Trace:
        """Obstacles as one trace."""

    @abstractmethod
    def obstacles_update(self, obstacles: Sequence[Obstacle]) -> dict[str, Any]:
        """What to change of :meth:`obstacles` when the same obstacles have moved."""

    @abstractmethod
    def layout(self) -> dict[str, Any]:
        """Axes and camera."""

    def way(self, points: Points, name: str, colour: str, dash: str | None = None) -> Trace:
        """A line along (n, 3) m."""
        line = {"color": colour, "width": 5, "dash": dash or "solid"}
        if self.scatter_name == "Scatter":
            line["width"] = 3
        return getattr(self.go, self.scatter_name)(
            **self.coordinates(points),
            mode="lines",
            name=name,
            line=line,
            hoverinfo="name",
        )

    def spot(self, point: Points, name: str, colour: str, symbol: str, size: float) -> Trace:
        """A marker at (3,) m."""
        return getattr(self.go, self.scatter_name)(
            **self.coordinates(np.asarray(point, dtype=np.float64)[None]),
            mode="markers",
            name=name,
            marker={
                "color": colour,
                "size": size,
                "symbol": symbol,
                "line": {"color": "white", "width": 1},
            },
            hovertemplate=f"{name}<extra></extra>",
        )

    def ends(self) -> list[Trace]:
        """Start and goal."""
        return [
            self.spot(self.facts.start, "start", theme.START, "circle", self.marker),
            self.spot(self.facts.goal, "goal", theme.GOAL, "diamond", self.marker),
        ]

    def fastest_mps(self, worlds: Sequence[World], depth_m: float) -> float:
        """The fastest current the arrows of any of the worlds stand for, and never nothing."""
        speeds = [self._currents(world, depth_m)[1] for world in worlds]
        fastest = max(
            float(np.hypot(velocity[:, 0], velocity[:, 1]).max(initial=0.0)) for velocity in speeds
        )
        return max(fastest, 0.02 * self.facts.speed_mps)

    def arrows(self, world: World, depth_m: float, fastest_mps: float) -> Points:
        """Arrows of the current as one broken line: (n, 3) m with NaN between."""
        points, velocity = self._currents(world, depth_m)
        speed = np.hypot(velocity[:, 0], velocity[:, 1])
        moving = speed > 1e-3 * fastest_mps
        points, velocity, speed = points[moving], velocity[moving], speed[moving]
        along = velocity / speed[:, None]
        length = (0.9 * self._arrow_spacing() * np.sqrt(speed / fastest_mps))[:, None]
        tip, tail = points[:, :2] + 0.5 * length * along, points[:, :2] - 0.5 * length * along
        aside = np.stack([-along[:, 1], along[:, 0]], axis=-1)
        left = tip - 0.35 * length * along + 0.22 * length * aside
        right = tip - 0.35 * length * along - 0.22 * length * aside
        gap = np.full_like(tip, np.nan)
        lines = np.stack([tail, tip, left, tip, right, gap], axis=1).reshape(-1, 2)
        return np.column_stack([lines, np.full(len(lines), depth_m)])

    def _currents(self, world: World, depth_m: float) -> tuple[Points, Points]:
        """Places (n, 3) m above the ground and their current (n, 2) m/s."""
        places = grid(self.facts.minimum[:2], self.facts.maximum[:2], self._arrow_spacing())
        afloat = np.asarray(world.floor_depth(places)) > depth_m
        points = np.column_stack([places, np.full(len(places), depth_m)])[afloat]
        return points, np.asarray(world.current(points))[:, :2]

    def _arrow_spacing(self) -> float:
        sides = self.facts.maximum[:2] - self.facts.minimum[:2]
        return float(max(sides.min() / ARROWS_ACROSS, sides.max() / (2.5 * ARROWS_ACROSS)))


def grid(low: Points, high: Points, spacing: float) -> Points:
    """(n, 2) middles of the square-ish cells that fill a rectangle."""
    sides = [
        np.linspace(start, end, max(2, round((end - start) / spacing)), endpoint=False)
        for start, end in zip(low, high, strict=True)
    ]
    middles = [side + 0.5 * (side[1] - side[0]) for side in sides]
    return np.stack(np.meshgrid(*middles), axis=-1).reshape(-1, 2)


def scene_of(world: World) -> Scene:
    """The scene that suits a world's dimensions."""
    from auvgym.report.plane import Plane
    from auvgym.report.space import Space

    return Plane(world) if world.dimensions == 2 else Space(world)
