"""Worlds in two dimensions: speed as colour, arrows, obstacles as outlines."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from auvgym.rendering.shapes import Obstacle, outline
from auvgym.rendering.subjects import Points, World
from auvgym.report import theme
from auvgym.report.scene import Scene, Trace

SPEED_POINTS = 9000
LAND_POINTS = 50000


class Plane(Scene):
    """A plan view."""

    scatter_name = "Scatter"
    marker = 10.0

    def coordinates(self, points: Points) -> dict[str, Any]:
        """``x`` and ``y`` in the scene's unit."""
        flat = np.asarray(points, dtype=np.float64)[:, :2] / self.size_m
        return {"x": flat[:, 0].astype(np.float32), "y": flat[:, 1].astype(np.float32)}

    def ground(self) -> list[Trace]:
        """Land, filled, and its shore line."""
        x, y, places = self._grid(LAND_POINTS)
        shore = max(float(self.facts.minimum[2]), 0.0)
        floor = np.asarray(self.world.floor_depth(places)).reshape(len(y), len(x))
        land = floor <= shore
        if not land.any():
            return []
        quiet = {"showscale": False, "hoverinfo": "skip", "name": "land"}
        open_sea = "rgba(0,0,0,0)"
        steps = [[0.0, open_sea], [0.5, open_sea], [0.5, theme.LAND_FILL], [1.0, theme.LAND_FILL]]
        # Filled contours turn inside out on some shores; a fine raster does not.
        fill = self.go.Heatmap(
            x=x, y=y, z=land.astype(np.uint8), zmin=0, zmax=1, colorscale=steps, **quiet
        )
        line = self.go.Contour(
            x=x[::2],
            y=y[::2],
            z=floor[::2, ::2].clip(-1e5, 1e5).astype(np.float32),
            contours={"start": shore, "end": shore, "size": 1.0, "coloring": "none"},
            line={"color": theme.SHORE, "width": 1.5},
            **quiet,
        )
        return [fill, line]

    def flow(self, world: World, depth_m: float, fastest_mps: float) -> list[Trace]:
        """Speed as colour, and arrows."""
        x, y, places = self._grid(SPEED_POINTS)
        points = np.column_stack([places, np.full(len(places), depth_m)])
        velocity = np.asarray(world.current(points))[:, :2]
        speed = np.hypot(velocity[:, 0], velocity[:, 1]).reshape(len(y), len(x))
        return [
            self.go.Heatmap(
                x=x,
                y=y,
                z=speed.astype(np.float32),
                zmin=0.0,
                zmax=fastest_mps,
                zsmooth="best",
                colorscale=theme.SPEED_SCALE,
                colorbar={"title": {"text": "current<br>(m/s)"}, "thickness": 14, "len": 0.5},
                name="speed",
                hovertemplate="%{z:.2f} m/s<extra>current</extra>",
            ),
            self.go.Scatter(
                **self.coordinates(self.arrows(world, depth_m, fastest_mps)),
                mode="lines",
                name="current",
                line={"color": "rgba(200,230,255,0.75)", "width": 1},
                hoverinfo="skip",
                showlegend=False,  # white lines on a white page; the colour bar says it
            ),
        ]

    def obstacles(self, obstacles: Sequence[Obstacle]) -> Trace:
        """All obstacles as one filled outline."""
        return self.go.Scatter(
            **self.obstacles_update(obstacles),
            mode="lines",
            fill="toself",
            fillcolor="rgba(240,104,84,0.8)",
            line={"color": theme.OBSTACLE, "width": 1},
            name="obstacles",
            hoverinfo="name",
        )

    def obstacles_update(self, obstacles: Sequence[Obstacle]) -> dict[str, Any]:
        """Outlines, with gaps between."""
        rings: list[Points] = []
        for obstacle in obstacles:
            ring = outline(obstacle)
            rings += [ring, ring[:1], np.full((1, 2), np.nan)]
        return self.coordinates(np.concatenate(rings) if rings else np.empty((0, 2)))

    def layout(self) -> dict[str, Any]:
        """Axes with one scale."""
        low, high = self.facts.minimum / self.size_m, self.facts.maximum / self.size_m
        across, along = self.facts.axis_names
        axis = {"gridcolor": theme.RULE, "zeroline": False, "constrain": "domain"}
        return {
            "xaxis": {
                **axis,
                "title": {"text": f"{across} ({self.unit})"},
                "range": [low[0], high[0]],
            },
            "margin": {"l": 76, "r": 10, "t": 104, "b": 56},
            "yaxis": {
                **axis,
                "title": {"text": f"{along} ({self.unit})"},
                "range": [low[1], high[1]],
                "scaleanchor": "x",
            },
        }

    def _grid(self, about: int) -> tuple[Points, Points, Points]:
        """Return x (c,), y (r,) in the scene's unit and the (r * c, 2) places, m."""
        low, high = self.facts.minimum[:2], self.facts.maximum[:2]
        sides = high - low
        columns = int(np.clip(np.sqrt(about * sides[0] / sides[1]), 12, 600))
        rows = int(np.clip(about / columns, 12, 600))
        x, y = np.linspace(low[0], high[0], columns), np.linspace(low[1], high[1], rows)
        places = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        return (x / self.size_m).astype(np.float32), (y / self.size_m).astype(np.float32), places
