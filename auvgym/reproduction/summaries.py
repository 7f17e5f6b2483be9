"""Pictures of what was measured over all seeds: dots, boxes, progress over budgets."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from auvgym.reproduction.card import Card, Picture
from auvgym.reproduction.cells import Cell
from auvgym.reproduction.measures import MEASURES

Rows = list[list[Cell]]


def dots(figures: Any, card: Card, picture: Picture, rows: Rows) -> Any:
    """A panel for each measure: means and standard deviations case by case; diamonds: the paper."""
    count = len(card.measures)
    figure = figures.Figure(figsize=(7.2, 1.0 + 2.1 * count), layout="constrained")
    axes = figure.subplots(count, 1, squeeze=False, sharex=True)[:, 0]
    for axis, measure in zip(axes, card.measures, strict=True):
        for index, column in enumerate(cell.column for cell in rows[0]):
            found = [row[index].measured(measure) for row in rows]
            places = np.arange(len(rows)) + 0.16 * (index - 0.5 * (len(rows[0]) - 1))
            axis.errorbar(
                places,
                [np.mean(values) for values in found],
                [np.std(values) for values in found],
                fmt="o",
                ms=4,
                lw=1,
                capsize=2,
                color=picture.colour(index),
                label=column.label,
            )
        paper = [row[0].case.paper.get(measure, [""])[0] for row in rows]
        known = [i for i, figure in enumerate(paper) if not isinstance(figure, str)]
        if known:
            axis.plot(known, [paper[i] for i in known], "D", color="black", ms=5, label="paper")
        axis.set_title(MEASURES[measure], fontsize=9)
        axis.tick_params(labelsize=8)
        axis.grid(alpha=0.3)
    axes[0].legend(fontsize=7, frameon=False, ncols=2)
    axes[-1].set_xticks(range(len(rows)), [row[0].case.label for row in rows], fontsize=8)
    figure.suptitle(picture.title, fontsize=11)
    return figure


def boxes(figures: Any, card: Card, picture: Picture, rows: Rows) -> Any:
    """A panel for each case: the first measure over the seeds; diamonds: the paper."""
    measure = card.measures[0]
    figure = figures.Figure(figsize=(4.2 * len(rows), 3.8), layout="constrained")
    axes = figure.subplots(1, len(rows), squeeze=False, sharey=True)[0]
    for axis, row in zip(axes, rows, strict=True):
        drawn = axis.boxplot([cell.measured(measure) for cell in row], patch_artist=True)
        for index, patch in enumerate(drawn["boxes"]):
            patch.set(facecolor=picture.colour(index), alpha=0.55)
        for line in drawn["medians"]:
            line.set(color="black")
        paper = row[0].case.paper.get(measure, [])
        known = [i for i, figure in enumerate(paper) if not isinstance(figure, str)]
        if known:
            places = [1 + i for i in known]
            axis.plot(places, [paper[i] for i in known], "D", color="black", ms=4, label="paper")
            axis.legend(fontsize=7, frameon=False)
        labels = [cell.column.label for cell in row]
        axis.set_xticks(range(1, len(row) + 1), labels, rotation=30, ha="right", fontsize=7)
        axis.set_title(row[0].case.label, fontsize=9)
        axis.set_ylabel(MEASURES[measure], fontsize=8)
        axis.tick_params(axis="y", labelsize=8)
        axis.grid(axis="y", alpha=0.3)
    figure.suptitle(picture.title, fontsize=11)
    return figure


def progress(figures: Any, card: Card, picture: Picture, rows: Rows) -> Any:
    """A panel for each group of cases: the first measure over budgets, mean and half the spread."""
    measure = card.measures[0]
    groups: dict[str, list[tuple[int, list[Cell]]]] = {}
    for row in rows:
        group, _, budget = row[0].case.label.rpartition(", ")
        groups.setdefault(group, []).append((int(budget.split()[0]), row))
    figure = figures.Figure(figsize=(4.2 * len(groups), 3.6), layout="constrained")
    axes = figure.subplots(1, len(groups), squeeze=False, sharey=True)[0]
    for axis, (group, budgets) in zip(axes, groups.items(), strict=True):
        spent = [budget for budget, _ in budgets]
        for index, column in enumerate(cell.column for cell in budgets[0][1]):
            found = np.array([row[index].measured(measure) for _, row in budgets])
            low, high = np.quantile(found, [0.25, 0.75], axis=1)
            colour = picture.colour(index)
            axis.fill_between(spent, low, high, color=colour, alpha=0.15, lw=0)
            axis.plot(
                spent, found.mean(axis=1), "o-", ms=4, lw=1.4, color=colour, label=column.label
            )
        axis.set_xscale("log")
        axis.set_xticks(spent, [str(budget) for budget in spent], fontsize=8)
        axis.minorticks_off()
        axis.set_title(group, fontsize=9)
        axis.set_xlabel("lines drawn", fontsize=8)
        axis.set_ylabel(MEASURES[measure], fontsize=8)
        axis.tick_params(axis="y", labelsize=8)
        axis.grid(alpha=0.3)
    axes[0].legend(fontsize=8, frameon=False)
    figure.suptitle(picture.title, fontsize=11)
    return figure


#: Kinds of picture that show what was measured.
SUMMARIES: Mapping[str, Any] = {"dots": dots, "boxes": boxes, "progress": progress}
