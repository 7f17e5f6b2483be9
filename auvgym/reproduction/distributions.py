"""A card's measures as distributions: the paper's figure; mean, median, 95 % quantile of ours."""

from __future__ import annotations

from statistics import fmean, stdev

import numpy as np

from auvgym.reproduction.card import Card
from auvgym.reproduction.cells import Cell
from auvgym.reproduction.measures import MEASURES


def distributions(card: Card, rows: list[list[Cell]]) -> list[str]:
    """Markdown of a table for each measure."""
    parts = []
    for measure in card.measures:
        lines = [
            "| case | | " + " | ".join(column.label for column in card.columns) + " |",
            "|---" * (2 + len(card.columns)) + "|",
        ]
        for row in rows:
            values = [cell.measured(measure) for cell in row]
            paper = row[0].case.paper.get(measure)
            label = row[0].case.label
            if paper:
                lines.append(
                    _line(
                        label,
                        "paper",
                        [one if isinstance(one, str) else f"{one:g}" for one in paper],
                    )
                )
                label = ""
            lines.append(_line(label, "mean ± sd", [_spread(one) for one in values]))
            lines.append(_line("", "median", [f"{np.median(one):.5g}" for one in values]))
            lines.append(_line("", "95 %", [f"{np.quantile(one, 0.95):.5g}" for one in values]))
        parts += [f"## {MEASURES[measure]}", "\n".join(lines)]
    free = [
        f"{column.label} {sum(row[index].feasible for row in rows)}/"
        f"{sum(len(row[index].outcomes) for row in rows)}"
        for index, column in enumerate(card.columns)
    ]
    return [
        *parts,
        f"Runs with a path that enters nothing solid and no danger zone: {', '.join(free)}.",
    ]


def _line(case: str, what: str, figures: list[str]) -> str:
    return f"| {case} | {what} | " + " | ".join(figures) + " |"


def _spread(values: list[float]) -> str:
    deviation = stdev(values) if len(values) > 1 else 0.0
    return f"{fmean(values):.5g} ± {deviation:.2g}"
