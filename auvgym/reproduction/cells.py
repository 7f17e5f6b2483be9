"""The cells of a card: outcomes of a case under a column, and how they compare."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean, median, stdev

from auvgym._extras import require
from auvgym.reproduction.card import Card, Case, Column
from auvgym.reproduction.runs import Outcome, Run

#: Level of the rank-sum tests, as in the papers.
SIGNIFICANCE = 0.05


@dataclass(frozen=True)
class Cell:
    """Outcomes of one case under one column, seed by seed."""

    case: Case
    column: Column
    outcomes: tuple[Outcome, ...]

    @property
    def costs(self) -> list[float]:
        """Costs, seed by seed."""
        return [outcome.cost for outcome in self.outcomes]

    def measured(self, name: str) -> list[float]:
        """A measure, seed by seed."""
        return [outcome.measures[name] for outcome in self.outcomes]

    @property
    def mean(self) -> float:
        """Mean cost."""
        return fmean(self.costs)

    @property
    def deviation(self) -> float:
        """Standard deviation of the cost; 0 for a single run."""
        return stdev(self.costs) if len(self.costs) > 1 else 0.0

    @property
    def feasible(self) -> int:
        """Runs without a broken constraint."""
        return sum(outcome.feasible for outcome in self.outcomes)

    @property
    def seconds(self) -> float:
        """Median time of a run."""
        return median(outcome.seconds for outcome in self.outcomes)

    @property
    def evaluations(self) -> float:
        """Mean number of fitness evaluations."""
        return fmean(outcome.evaluations for outcome in self.outcomes)


def cells(
    card: Card, columns: Sequence[Column], outcomes: Mapping[Run, Outcome], seeds: int
) -> list[list[Cell]]:
    """A row of cells for each case; every run must be among the outcomes."""
    return [
        [
            Cell(
                case, column, tuple(outcomes[card.run(case, column, seed)] for seed in range(seeds))
            )
            for column in columns
        ]
        for case in card.cases
    ]


def sign(reference: Cell, other: Cell) -> str:
    """Wilcoxon's rank-sum test: "+" if the reference costs significantly less, "-" more, else "=".

    Raises:
        ImportError: without scipy.
    """
    stats = require("scipy.stats", "report")
    test = stats.ranksums(reference.costs, other.costs)
    if test.pvalue >= SIGNIFICANCE:
        return "="
    return "+" if test.statistic < 0 else "-"
