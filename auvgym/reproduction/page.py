"""A card as Markdown: the paper's figures and ours side by side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import fmean, stdev

import auvgym
from auvgym.reproduction.card import Card, Case, Column, swept
from auvgym.reproduction.cells import Cell, cells, sign
from auvgym.reproduction.distributions import distributions
from auvgym.reproduction.measures import MEASURES
from auvgym.reproduction.runs import CURVE_POINTS, Outcome, Run, checkpoints

Table = list[list[str]]


def markdown(
    card: Card, outcomes: Mapping[Run, Outcome], seeds: int, pictures: Sequence[str]
) -> str:
    """The whole card.

    Args:
        card: the card.
        outcomes: at least the card's runs.
        seeds: how many seeds of each cell are shown.
        pictures: file names of its plots, beside the card.
    """
    parts = [f"# {card.title}", _head(card, seeds)]
    if card.view == "sweeps":
        parts += _sweeps(card, outcomes, seeds)
    else:
        rows = cells(card, card.columns, outcomes, seeds)
        parts += _VIEWS[card.view](card, rows)
    parts += [f"![{card.title}]({picture})" for picture in pictures]
    if card.why:
        parts += ["## Why", card.why.strip()]
    return "\n\n".join(parts) + "\n"


def _head(card: Card, seeds: int) -> str:
    return (
        f"{card.source}. Ours: auvgym {auvgym.__version__}, {seeds} seeds of each cell, printed by "
        f"`auvgym reproduce {card.name} --seeds {seeds}`. The papers did not publish their maps; "
        "ours are of the same kind, so that levels may differ where orders should not."
    )


def _costs(card: Card, rows: list[list[Cell]]) -> list[str]:
    table = [["case", "", *(column.label for column in card.columns)]]
    for row in rows:
        if row[0].case.mean:
            table.append([row[0].case.label, "paper", *_paper_costs(row[0].case)])
        ours = [_cost(cell, "" if cell is row[0] else sign(row[0], cell)) for cell in row]
        table.append(["" if row[0].case.mean else row[0].case.label, "ours", *ours])
    parts = [
        _table(table),
        "Mean (standard deviation) of the cost; ours with the runs that broke no constraint. By "
        f"Wilcoxon's rank-sum test at 0.05, + means that {card.columns[0].label} costs "
        "significantly less, - more, = neither.",
    ]
    if any(row[0].case.mean for row in rows):
        parts += ["## Paper and ours", _agreement(card, rows)]
    return [*parts, "## Time", *_seconds(card, rows)]


def _paper_costs(case: Case) -> list[str]:
    signs = case.sign or ("",) * len(case.mean)
    return [
        f"{mean:.3g} ({deviation:.2g}) {mark}".rstrip()
        for mean, deviation, mark in zip(case.mean, case.deviation, signs, strict=True)
    ]


def _cost(cell: Cell, mark: str) -> str:
    runs = f"{cell.feasible}/{len(cell.outcomes)}"
    return f"{cell.mean:.3f} ({cell.deviation:.3f}) {mark} {runs}".replace("  ", " ")


def _agreement(card: Card, rows: list[list[Cell]]) -> str:
    """In words: for each column whether the reference is better, and the order of all columns."""
    rows = [row for row in rows if row[0].case.mean]
    reference, *others = card.columns
    lines = []
    for index, column in enumerate(others, 1):
        paper = sum(row[0].case.mean[0] < row[0].case.mean[index] for row in rows)
        ours = sum(row[0].mean < row[index].mean for row in rows)
        verdict = "as in the paper" if paper == ours else "**otherwise than in the paper**"
        lines.append(
            f"- {reference.label} costs less on average than {column.label} in {ours} of "
            f"{len(rows)} cases, {verdict}" + ("." if paper == ours else f" ({paper}).")
        )
    paper_order = _order(
        card.columns,
        [fmean(column) for column in zip(*(row[0].case.mean for row in rows), strict=True)],
    )
    our_order = _order(
        card.columns, [fmean(cell.mean for cell in column) for column in zip(*rows, strict=True)]
    )
    same = "the same" if paper_order == our_order else "not the same"
    lines.append(f"- The order over all cases is {same}. Paper: {paper_order}. Ours: {our_order}.")
    return "\n".join(lines)


def _order(columns: Sequence[Column], means: Sequence[float]) -> str:
    ranked = sorted(zip(means, (column.label for column in columns), strict=True))
    return " < ".join(f"{label} {mean:.2f}" for mean, label in ranked)


def _seconds(card: Card, rows: list[list[Cell]]) -> list[str]:
    table = [["case", "", *(column.label for column in card.columns)]]
    for row in rows:
        if row[0].case.seconds:
            table.append([row[0].case.label, "paper", *_times(row[0].case.seconds)])
        label = "" if row[0].case.seconds else row[0].case.label
        table.append([label, "ours", *_times([cell.seconds for cell in row])])
    return [
        _table(table),
        "Seconds of a run (ours: median, on one core of the machine that printed this), and as a "
        f"multiple of {card.columns[0].label}'s.",
    ]


def _times(seconds: Sequence[float]) -> list[str]:
    return [f"{one:.3g} ({one / seconds[0]:.2f})" for one in seconds]


def _curves(card: Card, rows: list[list[Cell]]) -> list[str]:
    shown = range(CURVE_POINTS // 4 - 1, CURVE_POINTS, CURVE_POINTS // 4)
    spent = checkpoints(int(rows[0][0].evaluations))
    table = [["case", "evaluations", *(column.label for column in card.columns)]]
    for row in rows:
        for index in shown:
            best = [fmean(outcome.curve[index] for outcome in cell.outcomes) for cell in row]
            label = row[0].case.label if index == shown[0] else ""
            table.append([label, f"{spent[index]:,}", *(f"{cost:.3f}" for cost in best)])
    return [_table(table), "Best cost so far, mean over the seeds. Below 2 a path is feasible."]


def _measures(card: Card, rows: list[list[Cell]]) -> list[str]:
    parts = []
    for measure in card.measures:
        table = [["case", "", *(column.label for column in card.columns)]]
        for row in rows:
            label, paper = row[0].case.label, row[0].case.paper.get(measure)
            if paper:
                figures = (one if isinstance(one, str) else f"{one:g}" for one in paper)
                table.append([label, "paper", *figures])
            ours = [_measured(cell.measured(measure)) for cell in row]
            table.append(["" if paper else label, "ours", *ours])
        parts += [f"## {MEASURES[measure]}", _table(table)]
    runs = [
        f"{column.label} {sum(row[index].feasible for row in rows)}/"
        f"{sum(len(row[index].outcomes) for row in rows)}"
        for index, column in enumerate(card.columns)
    ]
    return [
        *parts,
        "One figure where all seeds agree, else mean (standard deviation) and [least].",
        f"Runs that arrived and met nothing: {', '.join(runs)}.",
    ]


def _measured(values: Sequence[float]) -> str:
    if max(values) - min(values) <= 1e-9 * max(abs(values[0]), 1e-9):
        return f"{values[0]:.4g}"
    return f"{fmean(values):.4g} ({stdev(values):.2g}) [{min(values):.4g}]"


def _sweeps(card: Card, outcomes: Mapping[Run, Outcome], seeds: int) -> list[str]:
    parts = []
    for sweep in card.sweeps:
        parts.append(f"## {sweep.title}")
        names, values = list(sweep.parameters), list(sweep.parameters.values())
        for row in cells(card, swept(card, sweep), outcomes, seeds):
            across = values[-1]
            table = [[" / ".join(names), *(f"{value:g}" for value in across)]]
            for start in range(0, len(row), len(across)):
                part = row[start : start + len(across)]
                name = f"{part[0].column.parameters[names[0]]:g}" if len(names) > 1 else "cost"
                table.append(
                    [name, *(f"{c.mean:.3f} {c.feasible}/{len(c.outcomes)}" for c in part)]
                )
            parts += [f"{row[0].case.label}:", _table(table)]
    return [*parts, "Mean cost, and the runs that broke no constraint."]


def _table(rows: Table) -> str:
    head, *body = rows
    lines = [head, ["---"] * len(head), *body]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


_VIEWS = {
    "costs": _costs,
    "seconds": _seconds,
    "curves": _curves,
    "measures": _measures,
    "distributions": distributions,
}
