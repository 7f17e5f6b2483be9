"""Results for other programs: the same episodes, read back by what will read them."""

from __future__ import annotations

import csv
import dataclasses
import sqlite3
from pathlib import Path

import pytest
from typer.testing import CliRunner

from auvgym.cli import app
from auvgym.evaluation import Instance, PolicySpec, Store, Suite, run, summarise
from auvgym.evaluation.export import COLUMNS, read_parquet
from auvgym.evaluation.result import EpisodeResult

SUITE = Suite(
    "mine",
    (
        Instance("AUVDynamic2D-v0", 4),
        Instance("AUVDynamic2D-v0", 5),
        Instance("AUVDynamic3D-v0", 4, "easy", settings='{"variant": "paper"}'),
    ),
)


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[EpisodeResult]]:
    path = tmp_path_factory.mktemp("results") / "results.db"
    with Store(path) as store:
        return path, run(SUITE, [PolicySpec("straight"), PolicySpec("random")], store)


def export(path: Path, out: Path, *more: str) -> None:
    done = CliRunner().invoke(app, ["export", str(path), "--out", str(out), *more])
    assert done.exit_code == 0, done.output


def test_csv(results: tuple[Path, list[EpisodeResult]], tmp_path: Path) -> None:
    path, rows = results
    export(path, tmp_path / "episodes.csv")
    with (tmp_path / "episodes.csv").open(newline="") as file:
        read = list(csv.DictReader(file))
    assert len(read) == len(rows) == 6
    for row, line in zip(rows, read, strict=True):
        assert list(line) == list(COLUMNS)
        assert float(line["time_s"]) == row.time_s
        assert line["settings"] == row.settings
        assert line["gap"] == ""


def test_parquet_ranks_as_the_file_does(
    results: tuple[Path, list[EpisodeResult]], tmp_path: Path
) -> None:
    pytest.importorskip("polars")
    path, rows = results
    export(path, tmp_path / "episodes.parquet")
    read = read_parquet(tmp_path / "episodes.parquet")
    assert read == [dataclasses.replace(row, actions=b"") for row in rows]
    assert summarise(read) == summarise(rows)


def test_planner_arena(results: tuple[Path, list[EpisodeResult]], tmp_path: Path) -> None:
    """The joins that Planner Arena and OMPL's own plots make."""
    path, rows = results
    for _ in range(2):  # an older file is replaced
        export(path, tmp_path / "arena.db")
    with sqlite3.connect(tmp_path / "arena.db") as database:
        database.execute("PRAGMA foreign_keys = ON")
        assert database.execute("PRAGMA foreign_key_check").fetchall() == []
        found = database.execute(
            "SELECT e.name, p.name, r.time, r.solved, s.description FROM runs r "
            "JOIN experiments e ON r.experimentid = e.id "
            "JOIN plannerConfigs p ON r.plannerid = p.id "
            "JOIN enums s ON s.name = 'status' AND s.value = r.status ORDER BY r.id"
        ).fetchall()
        counts = database.execute("SELECT name, runcount FROM experiments").fetchall()
    database.close()
    assert [(one[1], one[2], one[3], one[4]) for one in found] == [
        (row.policy, row.time_s, row.success, row.outcome) for row in rows
    ]
    assert sorted(counts) == [
        ("mine: AUVDynamic2D-v0 · normal", 2),
        ("mine: AUVDynamic3D-v0 · easy · variant paper", 1),
    ]


def test_a_format_must_be_known(results: tuple[Path, list[EpisodeResult]], tmp_path: Path) -> None:
    path, _ = results
    for out, said in ((tmp_path / "episodes.xls", "ending says no format"), (path, "itself")):
        done = CliRunner().invoke(app, ["export", str(path), "--out", str(out)])
        assert done.exit_code == 2
        assert said in done.output
    export(path, tmp_path / "episodes.txt", "--format", "csv")
