"""Pictures of paths and flights: in 3-D, from above, and distances to threats against time.

A journal keeps no paths: the runs that are shown are run again, which gives the same paths.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

import auvgym
from auvgym._extras import require
from auvgym.rendering.shapes import outline
from auvgym.report.meshes import obstacle_mesh
from auvgym.reproduction.card import Card, Case, Column, Picture
from auvgym.reproduction.raster_astar import raster_astar
from auvgym.reproduction.runs import Outcome, Run
from auvgym.reproduction.threats import Flight, flight

Array = NDArray[np.float64]
_KM = 1e3
_ROCK, _FOOT, _THREAT = "#a6a6a6", "#e3e3e3", "#d55e00"
#: Looks at the map along its longer side, and arrows of the current along each.
_LOOKS, _ARROWS = 240, 22
#: What is left for the labels of a box in 3-D.
_ZOOM = 0.9
#: Flat boxes are drawn this high, of their width.
_LEAST_HEIGHT = 0.3
_THREAT_COLOURS = ("#d55e00", "#cc79a7", "#7a6a00")


def paths(
    figures: Any, card: Card, picture: Picture, outcomes: Mapping[Run, Outcome], seeds: int
) -> Any:
    """The best path of each column, or case, among the seeds, in 3-D and from above."""
    shown = [(case, column) for case in picture.rows(card) for column in picture.shown(card)]
    several = len({case.label for case, _ in shown}) > 1
    world = auvgym.World(shown[0][0].scenario, mission=shown[0][0].mission)
    figure = figures.Figure(figsize=(10.4, 5.2), layout="constrained")
    space = figure.add_subplot(1, 2, 1, projection="3d")
    chart = figure.add_subplot(1, 2, 2)
    _space(space, world)
    _chart(chart, world)
    for index, (case, column) in enumerate(shown):
        path = _path(card.run(case, column, _best(card, case, column, outcomes, seeds))) / _KM
        style = {"color": picture.colour(index), "lw": 1.6}
        space.plot(*path.T, zorder=10, **style)
        label = case.label if several else column.label
        chart.plot(path[:, 0], path[:, 1], label=label, **style)
    _ends(space, chart, world)
    chart.legend(fontsize=7, loc="lower right", framealpha=0.9)
    figure.suptitle(picture.title, fontsize=11)
    return figure


def flights(
    figures: Any, card: Card, picture: Picture, outcomes: Mapping[Run, Outcome], seeds: int
) -> Any:
    """A row for each case: its flights in 3-D, from above, and their distances to each threat."""
    del outcomes, seeds
    rows, columns = picture.rows(card), picture.shown(card)
    figure = figures.Figure(figsize=(12.0, 3.9 * len(rows)), layout="constrained")
    for number, case in enumerate(rows):
        flown = [_flight(card, case, column) for column in columns]
        world = auvgym.World(case.scenario, mission=case.mission)
        # Threats stand where they are when the first vehicle comes nearest to one of them.
        instant = int(np.argmin(_gaps(flown[0]).min(axis=1)))
        space = figure.add_subplot(len(rows), 3, 3 * number + 1, projection="3d")
        chart = figure.add_subplot(len(rows), 3, 3 * number + 2)
        times = figure.add_subplot(len(rows), 3, 3 * number + 3)
        world.time_s = float(flown[0].time_s[instant])
        _space(space, world)
        _chart(chart, world)
        for threat, course in enumerate(np.moveaxis(flown[0].threats, 1, 0) / _KM):
            colour = _THREAT_COLOURS[threat % len(_THREAT_COLOURS)]
            space.plot(*course.T, ":", color=colour, lw=1.2)
            chart.plot(course[:, 0], course[:, 1], ":", color=colour, lw=1.2)
        for index, (one, column) in enumerate(zip(flown, columns, strict=True)):
            track, colour = one.track / _KM, picture.colour(index)
            space.plot(*track.T, color=colour, lw=1.6, zorder=10)
            chart.plot(track[:, 0], track[:, 1], color=colour, lw=1.6, label=column.label)
            chart.plot(*track[min(instant, len(track) - 1), :2], "o", color=colour, ms=5)
            for threat, gap in enumerate(_gaps(one).T):
                width, style = 1.3, ("-", "--", ":")[threat % 3]
                times.plot(one.time_s / 3600.0, gap, style, color=colour, lw=width)
        _ends(space, chart, world)
        chart.legend(fontsize=7, loc="upper left", framealpha=0.9)
        chart.set_title(f"{case.label} (t = {world.time_s / 3600.0:.2f} h)", fontsize=9)
        _distances_axis(times)
    figure.suptitle(picture.title, fontsize=11)
    return figure


def distances(
    figures: Any, card: Card, picture: Picture, outcomes: Mapping[Run, Outcome], seeds: int
) -> Any:
    """Distance to the nearest threat against time: a row a scenario, a line a case."""
    del outcomes, seeds
    columns = picture.shown(card)
    scenarios = list(dict.fromkeys(case.scenario for case in picture.rows(card)))
    figure = figures.Figure(
        figsize=(3.9 * len(columns), 2.7 * len(scenarios)), layout="constrained"
    )
    axes = figure.subplots(len(scenarios), len(columns), squeeze=False, sharex=True, sharey="row")
    for line, scenario in zip(axes, scenarios, strict=True):
        cases = [case for case in picture.rows(card) if case.scenario == scenario]
        for axis, column in zip(line, columns, strict=True):
            for index, case in enumerate(cases):
                one = _flight(card, case, column)
                gap = _gaps(one).min(axis=1)
                label = case.label.partition("; ")[2]
                axis.plot(
                    one.time_s / 3600.0, gap, lw=1.3, color=picture.colour(index), label=label
                )
            _distances_axis(axis)
            axis.set_title(f"{cases[0].label.partition('; ')[0]}, {column.label}", fontsize=9)
    axes[0][0].legend(fontsize=7, frameon=False)
    figure.suptitle(picture.title, fontsize=11)
    return figure


def _best(
    card: Card, case: Case, column: Column, outcomes: Mapping[Run, Outcome], seeds: int
) -> int:
    """The seed whose run cost least, for what it was asked for."""
    aims_at_time = card.run(case, column, 0).parameters.find('"kind": "time"') >= 0

    def worth(seed: int) -> float:
        outcome = outcomes[card.run(case, column, seed)]
        return outcome.measures["time_s"] if aims_at_time else outcome.cost

    return min(range(seeds), key=worth)


def _path(run: Run) -> Array:
    world = auvgym.World(run.scenario, seed=run.seed, mission=run.mission)
    parameters = json.loads(run.parameters)
    if run.planner == "raster-astar":
        return raster_astar(world, **parameters)
    return auvgym.plan(world, run.planner, seed=run.seed, **parameters).waypoints


def _flight(card: Card, case: Case, column: Column) -> Flight:
    run = card.run(case, column, 0)
    world = auvgym.World(run.scenario, seed=run.seed, mission=run.mission)
    return flight(world, **json.loads(run.parameters))


def _gaps(one: Flight) -> Array:
    """Distance to the surface of each threat, (n, threats) km."""
    offsets = one.track[:, None, :] - one.threats
    gaps: Array = (np.linalg.norm(offsets, axis=2) - one.radii) / _KM
    return gaps


def _space(axis: Any, world: auvgym.World) -> None:
    """Everything solid but a level floor, in 3-D; depth points down."""
    low, high = (end / _KM for end in world.domain)
    art = require("mpl_toolkits.mplot3d.art3d", "report")
    faces, colours = [], []
    for obstacle in world.snapshot()["obstacles"]:
        mesh = obstacle_mesh(obstacle, low[2] * _KM, high[2] * _KM)
        # Below the floor there is nothing to be seen.
        vertices = np.clip(mesh.vertices / _KM, None, [np.inf, np.inf, high[2]])
        faces.append(vertices[mesh.faces])
        colours += [_THREAT if any(obstacle["velocity_mps"]) else _ROCK] * len(mesh.faces)
    if faces:
        solid = art.Poly3DCollection(np.concatenate(faces), facecolors=colours, shade=True, lw=0.0)
        axis.add_collection3d(solid)
    axis.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(high[2], low[2]))
    width, length, depth = high - low
    axis.set_box_aspect((width, length, max(depth, _LEAST_HEIGHT * width)), zoom=_ZOOM)
    axis.view_init(elev=32.0, azim=-62.0)
    axis.set_xlabel("x (km)", fontsize=8)
    axis.set_ylabel("y (km)", fontsize=8)
    axis.set_zlabel("depth (km)", fontsize=8, labelpad=-2)
    axis.set_zticks(np.linspace(low[2], high[2], 3))
    axis.tick_params(labelsize=7)


def _chart(axis: Any, world: auvgym.World) -> None:
    """What is solid at the start's depth (dark) and at the floor (light), threats, the current."""
    low, high = world.domain
    xs, ys = (np.linspace(low[k], high[k], _LOOKS) for k in (0, 1))
    plane = np.stack(np.meshgrid(xs, ys), axis=-1).reshape(-1, 2)
    for depth, colour in ((high[2] - 1.0, _FOOT), (world.start[2], _ROCK)):
        points = np.column_stack([plane, np.full(len(plane), depth)])
        inside = world.clearance(points).reshape(len(ys), len(xs))
        if inside.min() < 0.0:
            axis.contourf(xs / _KM, ys / _KM, inside, levels=[-1e9, 0.0], colors=[colour])
    for obstacle in world.snapshot()["obstacles"]:
        if any(obstacle["velocity_mps"]):
            ring = outline(obstacle) / _KM
            axis.fill(*ring.T, facecolor="#f0b48a", edgecolor=_THREAT, lw=1.0, zorder=2)
    x, y = (np.linspace(low[k], high[k], _ARROWS) for k in (0, 1))
    arrows = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    current = world.current(np.column_stack([arrows, np.full(len(arrows), world.start[2])]))
    if np.any(current):
        axis.quiver(
            *(arrows / _KM).T, *current[:, :2].T, color="#56b4e9", alpha=0.7, width=0.0025, zorder=1
        )
    axis.set(xlim=(low[0] / _KM, high[0] / _KM), ylim=(low[1] / _KM, high[1] / _KM))
    axis.set_aspect("equal")
    axis.set_xlabel("x (km)", fontsize=8)
    axis.set_ylabel("y (km)", fontsize=8)
    axis.tick_params(labelsize=7)


def _ends(space: Any, chart: Any, world: auvgym.World) -> None:
    for place, mark in ((world.start / _KM, "s"), (world.goal / _KM, "*")):
        space.plot(*place[:, None], mark, color="black", ms=6, zorder=11)
        chart.plot(place[0], place[1], mark, color="black", ms=7, zorder=11)


def _distances_axis(axis: Any) -> None:
    axis.axhline(0.0, color="black", lw=0.8)
    axis.set_xlabel("time (h)", fontsize=8)
    axis.set_ylabel("distance to a threat (km)", fontsize=8)
    axis.tick_params(labelsize=7)
    axis.grid(alpha=0.3)


#: Kinds of picture that run something again.
SCENES: Mapping[str, Any] = {"paths": paths, "flights": flights, "distances": distances}
