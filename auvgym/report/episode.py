"""An episode with a time slider: the trail grows, obstacles move, the map changes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from auvgym._extras import require
from auvgym.rendering.axes import time_unit
from auvgym.rendering.subjects import Points, World
from auvgym.report import theme
from auvgym.report.plan import base_layout, in_legend
from auvgym.report.scene import Scene, Trace, scene_of

FRAMES = 60
TRAIL_POINTS = 300
FRAME_MS = 70

Change = Callable[[float], dict[str, Any]]
Drawing = dict[str, Any]
Plan = tuple[float, Points]


def episode_figure(worlds: Sequence[World], trail: Points, **options: Any) -> Any:
    """An interactive figure of a flown episode, of what :func:`episode_drawing` takes.

    Returns:
        A ``plotly.graph_objects.Figure`` with frames; :func:`auvgym.report.figure_page` or
        :func:`auvgym.report.leaderboard_page` make a page of it.

    Raises:
        ValueError, ImportError: as there.
    """
    drawing = episode_drawing(worlds, trail, **options)
    return require("plotly.graph_objects", "report").Figure(drawing)


def episode_drawing(
    worlds: Sequence[World],
    trail: Points,
    plan: Points | None = None,
    *,
    plans: Sequence[Plan] = (),
    times_s: NDArray[np.float64] | None = None,
    title: str | None = None,
    subtitle: str = "",
    frames: int = FRAMES,
) -> Drawing:
    """A flown episode as the dict that plotly.js reads, without the checks of Python's plotly.

    Args:
        worlds: copies of the world as the episode met it, the first at its start and one after
            each map change, in order of their ``time_s`` (what ``env.unwrapped.world`` gave).
        trail: (k, 3) m, one point per flown tick.
        plan: (n, 3) m, a planned way to show beside it.
        plans: when each plan was made, s, and its way, (n, 3) m, in order: each is shown from then
            to the next.
        times_s: (k,) s of the trail's points; by default one tick of the scenario apart.
        title: by default the scenario's name.
        subtitle: a line below it.
        frames: steps of the slider.

    Raises:
        ValueError: no world, or a trail with fewer than two points or not three columns.
        ImportError: without plotly; says which extra brings it.
    """
    way = np.asarray(trail, dtype=np.float64)
    if not len(worlds):
        raise ValueError("worlds is empty; an episode meets at least one map")
    if way.ndim != 2 or way.shape[1] != 3 or len(way) < 2:
        raise ValueError(f"trail has shape {way.shape}; (k, 3) with k >= 2 is needed")
    scene = scene_of(worlds[0])
    clock = np.asarray(
        np.arange(len(way)) * scene.facts.tick_s if times_s is None else times_s, dtype=np.float64
    )
    shown = list(plans) if plan is None else [(-np.inf, plan), *plans]
    stage = _Stage(scene, worlds, way, clock, shown)
    moments = np.linspace(clock[0], clock[-1], max(2, frames))
    return {
        "data": [trace.to_plotly_json() for trace in stage.traces],
        "frames": [
            {
                "name": str(index),
                "data": stage.updates(float(moment)),
                "traces": stage.changing,
            }
            for index, moment in enumerate(moments)
        ],
        "layout": {
            **scene.layout(),
            **base_layout(title if title is not None else scene.facts.name, subtitle),
            **_controls(moments, [stage.map_at(float(moment)) for moment in moments]),
        },
    }


class _Stage:
    """The traces of an episode, as they stand at its end, and how they differ before.

    Each map has obstacle and current traces of its own, of which one map's are shown: so a
    slider that jumps back finds the right map whatever was shown before.
    """

    def __init__(
        self,
        scene: Scene,
        worlds: Sequence[World],
        trail: Points,
        clock: NDArray[np.float64],
        plans: Sequence[Plan],
    ) -> None:
        self.traces: list[Trace] = []
        self.changing: list[int] = []
        self._changes: list[Change] = []
        self._begins_s = np.array([world.time_s for world in worlds])
        depth_m = float(np.median(trail[:, 2]))
        fastest = scene.fastest_mps(worlds, depth_m)
        for index, world in enumerate(worlds):
            for trace in scene.flow(world, depth_m, fastest):
                self._add(trace, self._shown(index))
        for trace in scene.ground():
            self._add(trace)
        for index, world in enumerate(worlds):
            self._add_obstacles(scene, world, index)
        begins_s = [begin_s for begin_s, _ in plans] + [np.inf]
        for (begin_s, plan), end_s in zip(plans, begins_s[1:], strict=True):
            if len(plan) > 1:
                trace = scene.way(plan, "plan", theme.PLAN, "dash")
                self._add(trace, None if len(plans) == 1 else _between(begin_s, end_s))
        for trace in scene.ends():
            self._add(trace)

        def flown(moment_s: float) -> dict[str, Any]:
            return scene.coordinates(_until(trail, clock, moment_s))

        def here(moment_s: float) -> dict[str, Any]:
            return scene.coordinates(_until(trail, clock, moment_s)[-1:])

        self._add(scene.way(trail, "flown", theme.TRAIL), flown)
        self._add(scene.spot(trail[-1], "vehicle", theme.VEHICLE, "circle", scene.marker), here)
        for index, update in zip(self.changing, self.updates(float(clock[-1])), strict=True):
            self.traces[index].update(update)

    def map_at(self, moment_s: float) -> int:
        """Which of the worlds holds at a time."""
        begun = int(np.searchsorted(self._begins_s, moment_s + 1e-6, side="right"))
        return max(0, begun - 1)

    def updates(self, moment_s: float) -> list[dict[str, Any]]:
        """What the changing traces are at a moment, in the order of :attr:`changing`."""
        return [
            {"type": self.traces[index].type, **change(moment_s)}
            for index, change in zip(self.changing, self._changes, strict=True)
        ]

    def _add(self, trace: Trace, change: Change | None = None) -> None:
        trace.showlegend = in_legend(trace)
        trace.legendgroup = trace.name  # one switch for all maps
        if change is not None:
            self.changing.append(len(self.traces))
            self._changes.append(change)
        self.traces.append(trace)

    def _shown(self, index: int) -> Change:
        return lambda moment_s: {"visible": self.map_at(moment_s) == index}

    def _add_obstacles(self, scene: Scene, world: World, index: int) -> None:
        """Those of a map that stay in one trace, those that move in another."""
        present = world.snapshot()["obstacles"]
        moves = [any(obstacle["velocity_mps"]) for obstacle in present]
        still = [obstacle for obstacle, move in zip(present, moves, strict=True) if not move]
        if still:
            self._add(scene.obstacles(still), self._shown(index))
        if not any(moves):
            return

        def moved(moment_s: float) -> list[Any]:
            later = world.snapshot(moment_s)["obstacles"]
            return [obstacle for obstacle, move in zip(later, moves, strict=True) if move]

        def change(moment_s: float) -> dict[str, Any]:
            if self.map_at(moment_s) != index:
                return {"visible": False}
            return {"visible": True, **scene.obstacles_update(moved(moment_s))}

        trace = scene.obstacles(moved(world.time_s))
        trace.name = "moving obstacles"
        self._add(trace, change)


def _between(begin_s: float, end_s: float) -> Change:
    return lambda moment_s: {"visible": begin_s <= moment_s < end_s}


def _until(trail: Points, clock: NDArray[np.float64], moment_s: float) -> Points:
    """The trail up to a time, of at most about ``TRAIL_POINTS`` points, its end exact."""
    stride = max(1, len(trail) // TRAIL_POINTS)
    kept = trail[: np.searchsorted(clock, moment_s)][::stride]
    end = [np.interp(moment_s, clock, trail[:, axis]) for axis in range(3)]
    return np.vstack([trail[:1], kept[1:], end])


def _controls(moments: NDArray[np.float64], maps: list[int]) -> dict[str, Any]:
    """Play and pause, and the slider, its labels saying time and map."""
    size, unit = time_unit(float(moments[-1]))
    several = max(maps) > 0
    digits = 1 if unit in ("min", "s") else 2
    labels = [
        f"{moment / size:.{digits}f} {unit}" + (f", map {shown + 1}" if several else "")
        for moment, shown in zip(moments, maps, strict=True)
    ]
    still = {"frame": {"duration": 0, "redraw": True}, "mode": "immediate"}
    still["transition"] = {"duration": 0}
    play = {
        "frame": {"duration": FRAME_MS, "redraw": True},
        "transition": {"duration": 0},
        "fromcurrent": True,
        "mode": "immediate",
    }
    return {
        "updatemenus": [
            {
                "type": "buttons",
                "direction": "left",
                "x": 0.02,
                "y": 0.0,
                "xanchor": "left",
                "yanchor": "top",
                "pad": {"t": 56, "r": 10},
                "showactive": False,
                "buttons": [
                    {"label": "▶", "method": "animate", "args": [None, play]},
                    {"label": "❚❚", "method": "animate", "args": [[None], still]},
                ],
            }
        ],
        "sliders": [
            {
                "active": len(moments) - 1,
                "x": 0.16,
                "len": 0.82,
                "y": 0.0,
                "pad": {"t": 46},
                # Every step's label shows above the slider in its turn; below it they would crowd.
                "font": {"color": "rgba(0,0,0,0)", "size": 1},
                "ticklen": 0,
                "minorticklen": 0,
                "currentvalue": {"prefix": "", "font": {"size": 14, "color": theme.INK}},
                "steps": [
                    {"label": label, "method": "animate", "args": [[str(index)], still]}
                    for index, label in enumerate(labels)
                ],
            }
        ],
    }
