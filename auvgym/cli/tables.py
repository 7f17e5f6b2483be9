"""The ranked table, fitted to the width of the terminal."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import groupby
from typing import TYPE_CHECKING, NamedTuple

from rich import box
from rich.table import Table
from rich.text import Text

if TYPE_CHECKING:
    from auvgym.evaluation import PolicySummary

_GAP = 2


class Column(NamedTuple):
    """A column of the board: its heading, its cells, and what there is to know about it."""

    header: str
    text: Callable[[PolicySummary], str]
    note: str = ""
    dropped: int = 0  # columns with the highest number go first when the terminal is narrow
    left: bool = False


COLUMNS = (
    Column("#", lambda row: str(row.rank)),
    Column("policy", lambda row: _name(row), left=True),
    Column("knows", lambda row: row.knows, dropped=3, left=True),
    Column(
        "solved",
        lambda row: f"{row.solved}/{row.episodes}",
        "solved: episodes that reached the goal",
    ),
    Column(
        "95 %",
        lambda row: f"{row.success_low:.0%}-{row.success_high:.0%}",
        "95 %: Wilson interval of that share",
        dropped=2,
    ),
    Column(
        "score",
        lambda row: f"{row.score:.3f}",
        "score: straight still-water time over travel time, 0 if not solved",
        dropped=1,
    ),
    Column("time h", lambda row: _scaled(row.time_s, 3600.0, 2)),
    Column(
        "all h",
        lambda row: _scaled(row.time_or_limit_s, 3600.0, 2),
        "all h: time with each failure counted as the limit",
        dropped=4,
    ),
    Column("MJ", lambda row: _scaled(row.energy_j, 1e6, 2)),
    Column("cost", lambda row: _scaled(row.cost, 1.0, 2)),
    Column(
        "clear m",
        lambda row: _scaled(row.min_clearance_m, 1.0, 0),
        "time, energy (MJ), LFHH cost of the flown path and least clearance: means over the solved",
    ),
    Column(
        "gap",
        lambda row: _scaled(row.gap, 1.0, 3),
        "gap: what a planner's first plan costs above the exact optimum (in harbours m), mean over "
        "those that break no constraint",
        dropped=5,
    ),
    Column("evals", lambda row: _count(row.evaluations)),
    Column(
        "plan s",
        lambda row: f"{row.planning_seconds:.2f}",
        "evals: path evaluations, plan s: wall clock spent planning, both per episode",
    ),
)


def ranked_tables(summaries: Sequence[PolicySummary], columns: Sequence[Column]) -> Iterator[Table]:
    """One table per stratum (environment, difficulty, scenario, settings)."""
    from auvgym.evaluation.suite import stratum_label

    for stratum, group in groupby(summaries, key=lambda row: row.stratum):
        rows = list(group)
        episodes = max(row.episodes for row in rows)
        title = stratum_label(stratum)
        table = Table(
            title=Text(f"{title} · {episodes} episodes", style="bold"),
            title_justify="left",
            box=box.SIMPLE_HEAD,
            padding=(0, _GAP - 1, 0, 0),
            pad_edge=False,
            show_edge=False,
        )
        for column in columns:
            table.add_column(
                column.header, justify="left" if column.left else "right", no_wrap=True
            )
        for row in rows:
            cells = (column.text(row) for column in columns)
            table.add_row(*cells, style="bold" if row.rank == 1 else None)
        yield table


def fitting_columns(rows: Sequence[PolicySummary], width: int) -> list[Column]:
    """Choose the columns that fit into ``width`` characters, the most telling ones first."""
    columns = list(COLUMNS)
    while True:
        needed = sum(
            max(len(column.header), *(len(column.text(row)) for row in rows)) + _GAP
            for column in columns
        )
        droppable = max(columns, key=lambda column: column.dropped)
        if needed - _GAP <= width or not droppable.dropped:
            return columns
        columns.remove(droppable)


def explanation(columns: Sequence[Column] = COLUMNS) -> str:
    """Say what the columns mean."""
    return "; ".join(column.note for column in columns if column.note) + "."


def _name(row: PolicySummary) -> str:
    name = row.policy if row.parameters == "{}" else f"{row.policy} {row.parameters}"
    return f"{name} ({row.errors} errors)" if row.errors else name


def _scaled(value: float | None, unit: float, digits: int) -> str:
    return "-" if value is None else f"{value / unit:.{digits}f}"


def _count(value: float) -> str:
    """A mean count in three figures: 0, 512, 64.2k, 1.30M."""
    for unit, letter in ((1e6, "M"), (1e3, "k")):
        if value >= unit:
            return f"{value / unit:.3g}{letter}"
    return f"{value:.0f}"
