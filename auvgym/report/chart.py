"""What planners of harbours plan on, drawn under a plan: zones, links, cells, route."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Protocol

import numpy as np

from auvgym.rendering.subjects import Points
from auvgym.report import theme
from auvgym.report.scene import Scene, Trace


class Chart(Protocol):
    """The part of :class:`auvgym.Maklink` a figure reads."""

    @property
    def zones(self) -> tuple[Points, ...]:
        """Rings, (n, 2) m."""

    @property
    def cells(self) -> tuple[Points, ...]:
        """Rings, (n, 2) m."""

    @property
    def links(self) -> Points:
        """Ends, (m, 2, 2) m."""

    @property
    def nodes(self) -> Points:
        """Of the graph, (n, 2) m."""

    @property
    def route(self) -> Any:
        """Numbers of nodes from start to goal."""


def chart_traces(scene: Scene, chart: Chart) -> list[Trace]:
    """Traces of a chart, to be drawn over the current and under obstacles and plan."""
    quiet = {"mode": "lines", "hoverinfo": "name"}
    return [
        scene.go.Scatter(
            **_rings(scene, chart.cells),
            **quiet,
            name="cells",
            line={"color": "rgba(255,255,255,0.35)", "width": 1},
        ),
        scene.go.Scatter(
            **_rings(scene, chart.zones),
            **quiet,
            name="danger zones",
            fill="toself",
            fillcolor="rgba(240,104,84,0.28)",
            line={"color": theme.OBSTACLE, "width": 1, "dash": "dot"},
        ),
        scene.go.Scatter(
            **_rings(scene, chart.links, closed=False),
            **quiet,
            name="links",
            line={"color": "rgba(255,236,150,0.9)", "width": 1.2, "dash": "dash"},
        ),
        scene.go.Scatter(
            **scene.coordinates(np.asarray(chart.nodes)[chart.route]),
            mode="lines+markers",
            hoverinfo="name",
            name="MAKLINK route",
            line={"color": "#ffffff", "width": 1.5},
            marker={"size": 5, "color": "#ffffff"},
        ),
    ]


def _rings(scene: Scene, rings: Iterable[Points], closed: bool = True) -> dict[str, Any]:
    """Lines one after the other, with gaps between."""
    parts: list[Points] = []
    for ring in rings:
        parts += [ring, *([ring[:1]] if closed else []), np.full((1, 2), np.nan)]
    return scene.coordinates(np.concatenate(parts) if parts else np.empty((0, 2)))
