"""A planner's answer on its map."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from auvgym.rendering.subjects import Points, World
from auvgym.report import theme
from auvgym.report.chart import Chart, chart_traces
from auvgym.report.scene import scene_of


class Plan(Protocol):
    """The part of a plan a figure reads."""

    @property
    def waypoints(self) -> Points:
        """(n, 3) m."""

    @property
    def feasible(self) -> bool:
        """Whether it keeps clear of everything."""

    @property
    def cost(self) -> Mapping[str, float]:
        """``total`` and its parts."""

    @property
    def evaluations(self) -> int:
        """What it took to find."""

    @property
    def planner(self) -> str:
        """Who made it."""


def plan_figure(
    world: World, plan: Plan, chart: Chart | None = None, corners: Points | None = None
) -> Any:
    """An interactive figure of a plan: map, obstacles, current and the way.

    Worlds in three dimensions are shown in space (depth downwards, stretched where the world is
    shallow, as its axis says), worlds in two as a plan view.

    Args:
        world: the plan was made in, at the time it was made.
        plan: from :func:`auvgym.plan`.
        chart: from :func:`auvgym.maklink`, to be drawn below the plan of a harbour.
        corners: the path before it was smoothed, (n, 3) m, to be drawn beside it.

    Returns:
        A ``plotly.graph_objects.Figure``; :func:`auvgym.report.figure_page` makes a page of it.

    Raises:
        ImportError: without plotly; says which extra brings it.
    """
    scene = scene_of(world)
    depth_m = float(plan.waypoints[:, 2].mean())
    name = plan.planner if plan.feasible else f"{plan.planner} (not feasible)"
    # Land hides the current below it on the plane; in space the order makes no difference.
    traces = [
        *scene.flow(world, depth_m, scene.fastest_mps([world], depth_m)),
        *scene.ground(),
        *(chart_traces(scene, chart) if chart is not None else []),
        scene.obstacles(world.snapshot()["obstacles"]),
        *([scene.way(corners, "before smoothing", theme.START)] if corners is not None else []),
        scene.way(plan.waypoints, name, theme.PLAN, None if plan.feasible else "dash"),
        *scene.ends(),
    ]
    for trace in traces:
        trace.showlegend = in_legend(trace)
    figure = scene.go.Figure(traces)
    total = plan.cost.get("total", float("nan"))
    figure.update_layout(
        **scene.layout(),
        **base_layout(
            f"{name} on {scene.facts.name}",
            f"cost {total:.4g}, {plan.evaluations:,} evaluations",
        ),
    )
    return figure


def in_legend(trace: Any) -> bool:
    """Whether a trace has an entry: colours over an area explain themselves."""
    return trace.showlegend is not False and trace.type in ("scatter", "scatter3d", "mesh3d")


def base_layout(title: str, subtitle: str) -> dict[str, Any]:
    """What all figures share: fonts, see-through background, a legend above."""
    return {
        "title": {
            "text": title,
            "subtitle": {"text": subtitle},
            "x": 0.02,
            "xanchor": "left",
            "y": 0.975,
            "yref": "container",
            "yanchor": "top",
            "font": {"size": 18},
        },
        "font": {"family": theme.FONT, "color": theme.INK, "size": 13},
        "paper_bgcolor": "rgba(0,0,0,0)",
        "plot_bgcolor": "rgba(0,0,0,0)",
        "legend": {"orientation": "h", "y": 1.0, "x": 0.01, "yanchor": "bottom"},
        "modebar": {"bgcolor": "rgba(0,0,0,0)", "color": theme.RULE, "activecolor": theme.CURRENT},
        "uirevision": "kept",
        "showlegend": True,
        "hovermode": "closest",
    }
