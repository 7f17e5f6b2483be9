"""Maps of a card's harbours: polygons, zones, links, and the path of each column."""

from __future__ import annotations

from typing import Any

import numpy as np

import auvgym
from auvgym.reproduction.card import Card
from auvgym.reproduction.harbors import harbor_plan

_ABREAST = 2


def draw_maps(figures: Any, card: Card, colours: tuple[str, ...]) -> Any:
    """A figure with a map for each case, and the paths of seed 0 on it.

    Args:
        figures: ``matplotlib.figure``.
        card: of protocol "harbor".
        colours: one for each column, again and again.
    """
    abreast = min(_ABREAST, len(card.cases))
    down = -(-len(card.cases) // abreast)
    figure = figures.Figure(figsize=(6.0 * abreast, 5.9 * down + 0.5), layout="constrained")
    axes = figure.subplots(down, abreast, squeeze=False).ravel()
    for axis, case in zip(axes, card.cases, strict=False):
        world = auvgym.World(case.scenario, mission=case.mission)
        common = {**card.parameters, **case.parameters}
        _ground(axis, world, auvgym.maklink(world, **common.get("zones", {})))
        for index, column in enumerate(card.columns):
            plan = harbor_plan(world, column.planner, 0, {**common, **column.parameters})
            # Thick below and thin above, so that paths that are the same can all be seen.
            width = 0.8 + 3.4 * (1.0 - index / len(card.columns))
            colour = colours[index % len(colours)]
            x, y = plan.waypoints[:, 0], plan.waypoints[:, 1]
            axis.plot(x, y, color=colour, lw=width, label=column.label, alpha=0.85)
        axis.set_title(case.label, fontsize=9)
        axis.tick_params(labelsize=7)
    for axis in axes[len(card.cases) :]:
        axis.set_visible(False)
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(
        handles, labels, loc="outside lower center", ncols=2 * abreast, fontsize=8, frameon=False
    )
    figure.suptitle(f"{card.title}: seed 0", fontsize=11)
    return figure


def _ground(axis: Any, world: auvgym.World, chart: auvgym.Maklink) -> None:
    low, high = world.domain
    for ring in chart.cells:
        axis.fill(ring[:, 0], ring[:, 1], fc="#eef5fa", ec="#c8d8e4", lw=0.6)
    for ring in chart.zones:
        axis.fill(ring[:, 0], ring[:, 1], fc="#f6cfc6", ec="#d55e00", lw=0.7, ls=":")
    for one in world.snapshot()["obstacles"]:
        ring = np.asarray(one["vertices_m"])
        axis.fill(ring[:, 0], ring[:, 1], fc="#8a5a4a", ec="none")
    for link in chart.links:
        axis.plot(link[:, 0], link[:, 1], color="#8898a8", lw=0.7, ls="--")
    axis.plot(*world.start[:2], "o", color="black", ms=6)
    axis.plot(*world.goal[:2], "*", color="black", ms=9)
    axis.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
