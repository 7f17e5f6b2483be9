"""Plots of a card, as PNG files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from auvgym._extras import require
from auvgym.reproduction.card import COLOURS, Card, Picture, swept
from auvgym.reproduction.cells import Cell, cells
from auvgym.reproduction.harbor_maps import draw_maps
from auvgym.reproduction.measures import MEASURES
from auvgym.reproduction.runs import Outcome, Run, checkpoints
from auvgym.reproduction.scenes import SCENES
from auvgym.reproduction.summaries import SUMMARIES

_ABREAST = 3
_PIXELS_PER_INCH = 110
#: Measures that differ by orders of magnitude.
_LOGARITHMIC = ("step_us",)
#: A path is feasible below this (LFHH and AFHH).
_FEASIBLE = 2.0


def draw(card: Card, outcomes: Mapping[Run, Outcome], seeds: int, folder: Path) -> list[str]:
    """Draw a card's plots.

    Returns:
        Names of the files in ``folder``.

    Raises:
        ImportError: without matplotlib.
    """
    figures = require("matplotlib.figure", "report")
    if card.view == "sweeps":
        figure = _sweeps(figures, card, outcomes, seeds)
    elif card.pictures:
        return [_picture(figures, card, one, outcomes, seeds, folder) for one in card.pictures]
    elif card.view == "distributions":
        figure = _distributions(figures, card, cells(card, card.columns, outcomes, seeds))
    elif card.view == "measures":
        figure = _measures(figures, card, cells(card, card.columns, outcomes, seeds))
    else:
        panel = {"costs": _boxes, "seconds": _bars, "curves": _lines}[card.view]
        figure = _panels(figures, card, cells(card, card.columns, outcomes, seeds), panel)
    names = [_save(figure, folder, card.name)]
    if card.protocol == "harbor":
        names.append(_save(draw_maps(figures, card, COLOURS), folder, f"{card.name}-maps"))
    return names


def _save(figure: Any, folder: Path, name: str) -> str:
    figure.savefig(folder / f"{name}.png", dpi=_PIXELS_PER_INCH, metadata={"Software": None})
    return f"{name}.png"


def _picture(
    figures: Any,
    card: Card,
    picture: Picture,
    outcomes: Mapping[Run, Outcome],
    seeds: int,
    folder: Path,
) -> str:
    if picture.kind in SCENES:
        figure = SCENES[picture.kind](figures, card, picture, outcomes, seeds)
    else:
        shown = replace(
            card,
            cases=tuple(picture.rows(card)),
            measures=picture.measures or card.measures,
        )
        rows = cells(shown, picture.shown(card), outcomes, seeds)
        figure = SUMMARIES[picture.kind](figures, shown, picture, rows)
    return _save(figure, folder, f"{card.name}-{picture.name}")


def _panels(figures: Any, card: Card, rows: list[list[Cell]], panel: Any) -> Any:
    """A panel for each case."""
    abreast = min(_ABREAST, len(rows))
    down = -(-len(rows) // abreast)
    figure = figures.Figure(figsize=(3.6 * abreast, 2.9 * down), layout="constrained")
    axes = figure.subplots(down, abreast, squeeze=False, sharey=True)
    for index, row in enumerate(rows):
        axis = axes[index // abreast][index % abreast]
        axis.set_title(row[0].case.label, fontsize=9)
        axis.tick_params(labelsize=8)
        axis.grid(axis="y", alpha=0.3)
        panel(axis, row)
    for index in range(len(rows), down * abreast):
        axes[index // abreast][index % abreast].set_visible(False)
    figure.suptitle(card.title, fontsize=11)
    return figure


def _measures(figures: Any, card: Card, rows: list[list[Cell]]) -> Any:
    """A panel for each measure: means case by case, the paper's figures as diamonds."""
    figure = figures.Figure(figsize=(7.2, 2.9 * len(card.measures)), layout="constrained")
    axes = figure.subplots(len(card.measures), 1, squeeze=False)[:, 0]
    width = 0.8 / len(card.columns)
    for axis, measure in zip(axes, card.measures, strict=True):
        for index, column in enumerate(card.columns):
            places = np.arange(len(rows)) - 0.4 + width * (index + 0.5)
            heights = [np.mean(row[index].measured(measure)) for row in rows]
            axis.bar(
                places, heights, width, color=COLOURS[index % len(COLOURS)], label=column.label
            )
            paper = [row[0].case.paper.get(measure, [""] * len(row))[index] for row in rows]
            known = [i for i, figure in enumerate(paper) if not isinstance(figure, str)]
            axis.plot(places[known], [paper[i] for i in known], "D", color="black", ms=4)
        axis.set_title(f"{MEASURES[measure]}; diamonds: paper", fontsize=9)
        if measure in _LOGARITHMIC:
            axis.set_yscale("log")
        labels = [row[0].case.label for row in rows]
        axis.set_xticks(range(len(rows)), labels, rotation=20, ha="right", fontsize=7)
        axis.tick_params(axis="y", labelsize=8)
        axis.grid(axis="y", alpha=0.3)
    axes[0].legend(fontsize=7, frameon=False, ncols=2)
    figure.suptitle(card.title, fontsize=11)
    return figure


def _distributions(figures: Any, card: Card, rows: list[list[Cell]]) -> Any:
    """A row of panels for each measure, a panel for each case: every seed as a point."""
    down, abreast = len(card.measures), len(rows)
    figure = figures.Figure(figsize=(3.6 * abreast, 2.9 * down), layout="constrained")
    axes = figure.subplots(down, abreast, squeeze=False)
    for measure, line in zip(card.measures, axes, strict=True):
        for axis, row in zip(line, rows, strict=True):
            places = np.arange(len(row))
            for place, cell in zip(places, row, strict=True):
                values = np.array(cell.measured(measure))
                spread = np.linspace(-0.25, 0.25, len(values))
                colour = COLOURS[place % len(COLOURS)]
                axis.plot(place + spread, values, ".", ms=3, color=colour, alpha=0.6)
                axis.plot([place - 0.3, place + 0.3], [np.median(values)] * 2, color="black", lw=1)
            paper = row[0].case.paper.get(measure, [""] * len(row))
            known = [i for i, figure in enumerate(paper) if not isinstance(figure, str)]
            axis.plot(known, [paper[i] for i in known], "D", mfc="none", color="black", ms=6)
            axis.set_title(f"{row[0].case.label}: {MEASURES[measure]}", fontsize=8)
            axis.tick_params(labelsize=8)
            axis.grid(axis="y", alpha=0.3)
            _name_columns(axis, row, places)
    figure.suptitle(f"{card.title}. Line: median of our seeds; diamond: paper", fontsize=11)
    return figure


def _boxes(axis: Any, row: list[Cell]) -> None:
    boxes = axis.boxplot([cell.costs for cell in row], patch_artist=True, widths=0.6)
    for patch, colour in zip(boxes["boxes"], COLOURS, strict=False):
        patch.set(facecolor=colour, alpha=0.55)
    for line in boxes["medians"]:
        line.set(color="black")
    places = range(1, len(row) + 1)
    if row[0].case.mean:
        axis.plot(places, row[0].case.mean, "D", color="black", ms=4, label="paper, mean")
        axis.legend(fontsize=7, frameon=False)
    axis.axhline(_FEASIBLE, color="grey", lw=0.8, ls=":")
    axis.set_ylabel("cost", fontsize=8)
    _name_columns(axis, row, places)


def _bars(axis: Any, row: list[Cell]) -> None:
    places = np.arange(len(row))
    axis.set_yscale("log")
    if row[0].case.seconds:
        axis.bar(places - 0.2, row[0].case.seconds, 0.4, color="0.7", label="paper")
    axis.bar(places + 0.2, [cell.seconds for cell in row], 0.4, color=COLOURS[0], label="ours")
    axis.set_ylabel("seconds", fontsize=8)
    axis.legend(fontsize=7, frameon=False)
    _name_columns(axis, row, places)


def _lines(axis: Any, row: list[Cell]) -> None:
    for cell, colour in zip(row, COLOURS, strict=False):
        curves = np.array([outcome.curve for outcome in cell.outcomes])
        spent = checkpoints(int(cell.evaluations))
        axis.fill_between(
            spent, *np.quantile(curves, [0.25, 0.75], axis=0), color=colour, alpha=0.2
        )
        axis.plot(spent, curves.mean(axis=0), color=colour, lw=1.4, label=cell.column.label)
    axis.axhline(_FEASIBLE, color="grey", lw=0.8, ls=":")
    axis.set_xscale("log")
    axis.set_xlabel("evaluations", fontsize=8)
    axis.set_ylabel("best cost", fontsize=8)
    axis.legend(fontsize=6, frameon=False)


def _name_columns(axis: Any, row: list[Cell], places: Any) -> None:
    labels = [cell.column.label for cell in row]
    axis.set_xticks(list(places), labels, rotation=35, ha="right", fontsize=7)


def _sweeps(figures: Any, card: Card, outcomes: Mapping[Run, Outcome], seeds: int) -> Any:
    """A panel for each sweep and case: a line for each value of the first of two parameters."""
    down, abreast = len(card.sweeps), len(card.cases)
    figure = figures.Figure(figsize=(4.6 * abreast, 3.2 * down), layout="constrained")
    axes = figure.subplots(down, abreast, squeeze=False)
    for sweep, line in zip(card.sweeps, axes, strict=True):
        names, across = list(sweep.parameters), list(sweep.parameters.values())[-1]
        for axis, row in zip(line, cells(card, swept(card, sweep), outcomes, seeds), strict=True):
            for number, start in enumerate(range(0, len(row), len(across))):
                part = row[start : start + len(across)]
                first = f"{names[0]} {part[0].column.parameters[names[0]]:g}"
                label = first if len(names) > 1 else None
                costs = [cell.mean for cell in part]
                axis.plot(across, costs, "o-", ms=3, lw=1, color=COLOURS[number], label=label)
            axis.set_title(f"{sweep.title}: {row[0].case.label}", fontsize=9)
            axis.set_xlabel(names[-1], fontsize=8)
            axis.set_ylabel("mean cost", fontsize=8)
            axis.tick_params(labelsize=8)
            axis.grid(alpha=0.3)
            if len(names) > 1:
                axis.legend(fontsize=7, frameon=False)
    figure.suptitle(card.title, fontsize=11)
    return figure
