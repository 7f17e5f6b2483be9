"""Results in other programs' formats: CSV, Parquet, and the database of OMPL's Planner Arena."""

from __future__ import annotations

import csv
import sqlite3
import typing
from collections.abc import Callable, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any

from auvgym._extras import require
from auvgym.evaluation.result import EpisodeResult
from auvgym.evaluation.suite import stratum_label

#: The columns of tables: all but the actions, which only a replay needs.
COLUMNS = tuple(one.name for one in fields(EpisodeResult) if one.name != "actions")
_OUTCOMES = (
    "goal", "collision", "out_of_bounds", "energy", "timeout",
    "error", "invalid_action", "overtime", "exit",
)  # fmt: skip
# What Planner Arena knows a run by: its column -> type and value. time and solved are its own
# names; time is what it ranks by, and here that is the vehicle's.
_RUN_COLUMNS: dict[str, tuple[str, Callable[[EpisodeResult], Any]]] = {
    "time": ("REAL", lambda row: row.time_s),
    "solved": ("BOOLEAN", lambda row: row.success),
    "status": ("ENUM", lambda row: _OUTCOMES.index(row.outcome)),
    "solution_length": ("REAL", lambda row: row.path_length_m),
    "solution_clearance": ("REAL", lambda row: row.min_clearance_m),
    "solution_cost": ("REAL", lambda row: row.cost),
    "energy": ("REAL", lambda row: row.energy_j),
    "score": ("REAL", lambda row: row.score),
    "planning_time": ("REAL", lambda row: row.planning_seconds),
    "evaluations": ("INTEGER", lambda row: row.evaluations),
    "replans": ("INTEGER", lambda row: row.replans),
}
_ARENA = """
CREATE TABLE experiments (id INTEGER PRIMARY KEY AUTOINCREMENT, name VARCHAR(512), totaltime REAL,
  timelimit REAL, memorylimit REAL, runcount INTEGER, version VARCHAR(128), hostname VARCHAR(1024),
  cpuinfo TEXT, date DATETIME, seed INTEGER, setup TEXT);
CREATE TABLE plannerConfigs (id INTEGER PRIMARY KEY AUTOINCREMENT, name VARCHAR(512) NOT NULL,
  settings TEXT);
CREATE TABLE enums (name VARCHAR(512), value INTEGER, description TEXT, PRIMARY KEY (name, value));
CREATE TABLE progress (runid INTEGER, time REAL, PRIMARY KEY (runid, time),
  FOREIGN KEY (runid) REFERENCES runs(id) ON DELETE CASCADE);
"""


def export_csv(rows: Sequence[EpisodeResult], path: Path) -> None:
    """One line per episode, a heading first; an empty cell where a figure does not exist."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(COLUMNS)
        writer.writerows([getattr(row, name) for name in COLUMNS] for row in rows)


def export_parquet(rows: Sequence[EpisodeResult], path: Path) -> None:
    """The same as typed columns.

    Raises:
        ImportError: without polars; says which extra brings it.
    """
    polars = require("polars", "export")
    kinds = {str: polars.String, int: polars.Int64, float: polars.Float64}
    hints = typing.get_type_hints(EpisodeResult)
    schema = {}
    for name in COLUMNS:
        choices = (*typing.get_args(hints[name]), hints[name])
        schema[name] = next(kinds[one] for one in choices if one in kinds)
    data = {name: [getattr(row, name) for row in rows] for name in COLUMNS}
    polars.DataFrame(data, schema=schema).write_parquet(path, compression="zstd")


def read_parquet(path: str | Path) -> list[EpisodeResult]:
    """Episodes of :func:`export_parquet`, without their actions: to be ranked, not replayed.

    Raises:
        ImportError: without polars; says which extra brings it.
    """
    polars = require("polars", "export")
    rows = polars.read_parquet(Path(path)).iter_rows(named=True)
    return [EpisodeResult(**row, actions=b"") for row in rows]


def export_planner_arena(rows: Sequence[EpisodeResult], path: Path) -> None:
    """The SQLite schema of OMPL's benchmarks, which plannerarena.org reads.

    A stratum is an experiment, a policy with its seed and parameters a planner, an episode a run;
    ``time`` is the vehicle's travel time, ``planning_time`` the planner's wall clock.
    """
    path.unlink(missing_ok=True)
    database = sqlite3.connect(path)
    try:
        with database:
            _write_arena(database, rows)
    finally:
        database.close()


def _write_arena(database: sqlite3.Connection, rows: Sequence[EpisodeResult]) -> None:
    columns = ", ".join(f"{name} {kind}" for name, (kind, _) in _RUN_COLUMNS.items())
    database.executescript(
        f"{_ARENA} CREATE TABLE runs (id INTEGER PRIMARY KEY AUTOINCREMENT, experimentid INTEGER, "
        f"plannerid INTEGER, {columns}, "
        "FOREIGN KEY (experimentid) REFERENCES experiments(id) ON DELETE CASCADE, "
        "FOREIGN KEY (plannerid) REFERENCES plannerConfigs(id) ON DELETE CASCADE);"
    )
    database.executemany("INSERT INTO enums VALUES ('status', ?, ?)", list(enumerate(_OUTCOMES)))
    experiments: dict[tuple[str, ...], int] = {}
    planners: dict[tuple[str, int, str], int] = {}
    for row in rows:
        stratum = _stratum(row)
        if stratum not in experiments:
            same = [one for one in rows if _stratum(one) == stratum]
            experiments[stratum] = _insert(
                database,
                "experiments (name, totaltime, timelimit, memorylimit, runcount, version, "
                "hostname, cpuinfo, date, seed, setup)",
                f"{row.suite}: {stratum_label(row.stratum)}",
                sum(one.time_s for one in same),
                max(one.time_limit_s for one in same),
                0.0,
                len({one.seed for one in same}),
                f"auvgym {row.engine_version}",
                "",
                "",
                "",
                min(one.seed for one in same),
                f"suite {row.suite}, hash {row.suite_hash}",
            )
        policy = (row.policy, row.policy_seed, row.parameters)
        if policy not in planners:
            planners[policy] = _insert(
                database,
                "plannerConfigs (name, settings)",
                row.policy if row.parameters == "{}" else f"{row.policy} {row.parameters}",
                f"seed {row.policy_seed}, parameters {row.parameters}, knows {row.knows}",
            )
        _insert(
            database,
            f"runs (experimentid, plannerid, {', '.join(_RUN_COLUMNS)})",
            experiments[stratum],
            planners[policy],
            *[value(row) for _, value in _RUN_COLUMNS.values()],
        )


def _stratum(row: EpisodeResult) -> tuple[str, ...]:
    return row.suite, row.suite_hash, *row.stratum


def _insert(database: sqlite3.Connection, into: str, *values: Any) -> int:
    marks = ", ".join("?" * len(values))
    return int(database.execute(f"INSERT INTO {into} VALUES ({marks})", values).lastrowid or 0)


#: Format -> what writes it.
FORMATS: dict[str, Callable[[Sequence[EpisodeResult], Path], None]] = {
    "csv": export_csv,
    "parquet": export_parquet,
    "plannerarena": export_planner_arena,
}
