"""The board: each policy's summary and comparison side by side, and what its columns say."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

from auvgym.evaluation.result import EpisodeResult
from auvgym.evaluation.statistics import (
    OVERALL,
    Comparison,
    Estimate,
    Table,
    compare_tables,
    score_tables,
)
from auvgym.evaluation.suite import Stratum
from auvgym.evaluation.summary import PolicySummary, summarise


class BoardRow(NamedTuple):
    """One policy in one stratum; no comparison where it has flown too little of it."""

    summary: PolicySummary
    comparison: Comparison | None


class BoardColumn(NamedTuple):
    """A column: heading, what it says, its text, and what it sorts by (NaN: nothing)."""

    heading: str
    note: str
    text: Callable[[BoardRow], str]
    order: Callable[[BoardRow], float | str]


def board(
    results: Iterable[EpisodeResult],
    reference: str | None = None,
    tables: Sequence[Table] | None = None,
) -> dict[Stratum, list[BoardRow]]:
    """The board of each stratum, best mean score first; with several, that of all of them last.

    Args:
        results: episodes of one suite.
        reference: as of :func:`~auvgym.evaluation.statistics.compare`.

        tables: the scores, as of :func:`~auvgym.evaluation.statistics.score_tables`, where they
            are there already.

    Raises:
        ValueError, ImportError: as ``compare``.
    """
    rows = list(results)
    found = compare_tables(score_tables(rows) if tables is None else tables, reference)
    compared = {(one.stratum, one.entrant): one for one in found}
    everywhere = {entrant for stratum, entrant in compared if stratum == OVERALL}
    together = [row for row in rows if (row.policy, row.policy_seed, row.parameters) in everywhere]
    boards: dict[Stratum, list[BoardRow]] = {}
    for summary in [*summarise(rows), *summarise(together, lambda _: OVERALL)]:
        comparison = compared.get((summary.stratum, summary.entrant))
        boards.setdefault(summary.stratum, []).append(BoardRow(summary, comparison))
    return boards


def policy_label(summary: PolicySummary) -> str:
    """Name, and seed and parameters where they are not the usual ones."""
    seed = f" seed {summary.policy_seed}" if summary.policy_seed else ""
    given = json.loads(summary.parameters)
    parameters = "".join(f" {name} {json.dumps(value)}" for name, value in given.items())
    return f"{summary.policy}{parameters}{seed}"


def _solved_mean(heading: str, note: str, name: str, unit: float) -> BoardColumn:
    """A mean over the solved episodes, with how many those are beside it."""

    def text(row: BoardRow) -> str:
        value = getattr(row.summary, name)
        if value is None:
            return "-"
        return f"{value / unit:.4g} ({row.summary.solved}/{row.summary.episodes})"

    def order(row: BoardRow) -> float:
        value = getattr(row.summary, name)
        return math.nan if value is None else float(value)

    return BoardColumn(heading, f"{note}, mean over the solved, which are counted beside it",
                       text, order)  # fmt: skip


def _compared(heading: str, note: str, name: str, form: str) -> BoardColumn:
    def value(row: BoardRow) -> float | None:
        found = getattr(row.comparison, name, None)
        return found.value if isinstance(found, Estimate) else found

    def text(row: BoardRow) -> str:
        found = getattr(row.comparison, name, None)
        if found is None:
            return "-"
        if isinstance(found, Estimate):
            return f"{found.value:{form}} [{found.low:{form}}, {found.high:{form}}]"
        return f"{found:{form}}"

    def order(row: BoardRow) -> float:
        found = value(row)
        return math.nan if found is None else float(found)

    return BoardColumn(heading, note, text, order)


COLUMNS = (
    BoardColumn("policy", "", lambda row: policy_label(row.summary),
                lambda row: policy_label(row.summary)),
    BoardColumn("knows", "what its choices rest on", lambda row: row.summary.knows,
                lambda row: row.summary.knows),
    BoardColumn("solved", "episodes that reached the goal",
                lambda row: f"{row.summary.solved}/{row.summary.episodes}",
                lambda row: row.summary.solved / row.summary.episodes),
    BoardColumn("95 %", "Wilson interval of that share",
                lambda row: f"{row.summary.success_low:.0%}-{row.summary.success_high:.0%}",
                lambda row: row.summary.success_low),
    BoardColumn("score", "straight still-water time over travel time, 0 for a failure; mean",
                lambda row: f"{row.summary.score:.3f}", lambda row: row.summary.score),
    _compared("IQM", "interquartile mean of the score, 95 % bootstrap interval", "iqm", ".3f"),
    BoardColumn("sign", "Wilcoxon signed-rank test against the reference: + better, - worse, "
                "= neither at 5 % (Holm)",
                lambda row: _sign(row.comparison), lambda row: _sign(row.comparison)),
    _compared("P(better)", "probability of a better score than the reference's on an instance",
              "improvement", ".2f"),
    _compared("detectable", "the least difference of mean scores to the reference that so many "
              "instances show four times in five", "detectable", ".3f"),
    _compared("wins", "instances on which no policy scores better", "wins", "d"),
    _compared("of best", "mean score over that of the best policy for each instance",
              "virtual_best_ratio", ".2f"),
    BoardColumn("all h", "time in hours, each failure counted as the limit",
                lambda row: f"{row.summary.time_or_limit_s / 3600:.3g}",
                lambda row: row.summary.time_or_limit_s),
    _solved_mean("time h", "travel time", "time_s", 3600.0),
    _solved_mean("MJ", "energy", "energy_j", 1e6),
    _solved_mean("km", "path length", "path_length_m", 1e3),
    _solved_mean("clear m", "least clearance", "min_clearance_m", 1.0),
    _solved_mean("cost", "LFHH cost of the flown path", "cost", 1.0),
    BoardColumn("re-plans", "an episode", lambda row: f"{row.summary.replans:.1f}",
                lambda row: row.summary.replans),
    BoardColumn("evals", "path evaluations an episode",
                lambda row: f"{row.summary.evaluations:,.0f}",
                lambda row: row.summary.evaluations),
    BoardColumn("plan s", "wall clock spent planning an episode; not reproducible",
                lambda row: f"{row.summary.planning_seconds:.3f}",
                lambda row: row.summary.planning_seconds),
)  # fmt: skip
#: What means something over several environments.
OVERALL_COLUMNS = ("policy", "knows", "solved", "95 %", "score", "IQM", "sign", "P(better)",
                   "detectable", "wins", "of best")  # fmt: skip
#: What a paper has room for.
SHORT = ("policy", "knows", "solved", "95 %", "score", "IQM", "sign", "time h", "MJ", "plan s")


def columns_of(stratum: Stratum, short: bool = False) -> list[BoardColumn]:
    """The columns that a stratum's table shows, or those that fit a paper."""
    if stratum == OVERALL:
        return [column for column in COLUMNS if column.heading in OVERALL_COLUMNS]
    return [column for column in COLUMNS if not short or column.heading in SHORT]


def _sign(comparison: Comparison | None) -> str:
    if comparison is None:
        return "-"
    return comparison.sign or "ref"
