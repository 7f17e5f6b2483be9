"""Verification: what is stored is what the logs give, and any flipped byte shows."""

from __future__ import annotations

import dataclasses
import random
import sqlite3
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from auvgym import evaluation
from auvgym.cli import app
from auvgym.evaluation import Instance, PolicySpec, Store, StoreError, Suite, run, verify
from auvgym.evaluation.result import EpisodeResult, pack_actions
from auvgym.evaluation.verify import check_row

SUITE = Suite("mine", tuple(Instance("AUVDynamic2D-v0", seed) for seed in (4, 5)))
SPECS = [PolicySpec("straight"), PolicySpec("random", 3)]
FLIPS = 120


@pytest.fixture(scope="module")
def flown() -> list[EpisodeResult]:
    with Store(None) as store:
        return run(SUITE, SPECS, store)


@pytest.fixture
def path(tmp_path: Path, flown: list[EpisodeResult]) -> Path:
    path = tmp_path / "results.db"
    with Store(path) as store:
        for row in flown:
            store.add(row)
    return path


def forge(path: Path, **values: Any) -> None:
    """Change the first row as somebody who knows of the checksum would."""
    with Store(path) as store:
        first, *others = store.results()
        store.forget(SUITE)
        for row in (dataclasses.replace(first, **values), *others):
            store.add(row)


@pytest.mark.parametrize("workers", [1, 2])
def test_what_was_flown_is_verified(path: Path, workers: int) -> None:
    found = verify(path, workers)
    assert (found.rows, found.differences) == (4, [])
    assert found.notes == ["suite mine is not a shipped one: its worlds are the file's own"]


def test_a_single_flipped_byte_is_caught(path: Path, tmp_path: Path) -> None:
    """Each flip is found, or lies where it changes no figure of any row."""
    whole, chance = path.read_bytes(), random.Random(5)
    with Store(path, read_only=True) as store:
        truth = store.results(), store.checksums()
    # Most of a small file is room that is not used, and zero.
    used = [place for place, byte in enumerate(whole) if byte]
    flipped, harmless = tmp_path / "flipped.db", 0
    for place in chance.sample(used, FLIPS):
        bit = 1 << chance.randrange(8)
        flipped.write_bytes(whole[:place] + bytes([whole[place] ^ bit]) + whole[place + 1 :])
        try:
            if verify(flipped).differences:
                continue
            with Store(flipped, read_only=True) as store:
                assert (store.results(), store.checksums()) == truth, f"byte {place}, bit {bit}"
            harmless += 1
        except StoreError:
            continue
    # The table's own text is not all about figures.
    assert harmless < FLIPS / 4


def test_every_byte_of_an_action_log_counts(flown: list[EpisodeResult]) -> None:
    first = flown[0]
    for place in range(0, len(first.actions), 3):
        log = bytearray(first.actions)
        log[place] ^= 1
        forged = dataclasses.replace(first, actions=bytes(log))
        assert check_row((forged, False)), f"byte {place}"


@pytest.mark.parametrize(
    ("values", "named"),
    [
        ({"time_s": 1.0}, "time_s: stored 1.0"),
        ({"score": 1.0}, "score: stored 1.0"),
        ({"outcome": "goal", "success": 1}, "outcome: stored 'goal'"),
        ({"scenario_hash": "0" * 64}, "scenario_hash"),
        ({"engine_version": "0.0.1"}, "flown by auvgym 0.0.1"),
        ({"suite_hash": "0" * 16}, "rows of several hashes"),
        ({"environment": "os:path"}, "unknown environment"),
        ({"scenario": "/dev/zero"}, "neither shipped nor a file"),
        ({"settings": "{"}, "settings is"),
        ({"steps": 2}, "log is damaged"),
        ({"steps": 10**12}, "at most"),
        ({"steps": "many"}, "steps: stored 'many' is no int"),
    ],
)
def test_a_forged_row_is_named(path: Path, values: dict[str, Any], named: str) -> None:
    forge(path, **values)
    found = verify(path).differences
    assert any(named in text for text in found), found
    assert all("random" in text or "suite" in text for text in found)


def test_a_row_that_was_changed_in_the_file_is_named(path: Path) -> None:
    """What no log can give is still held to the checksum beside it."""
    with sqlite3.connect(path) as database:
        database.execute("UPDATE episodes SET evaluations = 7 WHERE policy = 'straight'")
    database.close()
    assert len(verify(path).differences) == 2
    ran = CliRunner().invoke(app, ["verify", str(path)])
    assert ran.exit_code == 1
    assert "checksum" in ran.output


def test_rows_of_a_shipped_suite_are_its_instances(tmp_path: Path) -> None:
    demo = evaluation.load_suite("demo")
    some = dataclasses.replace(demo, instances=demo.instances[:2])
    with Store(None) as store:
        rows = run(some, [PolicySpec("straight")], store)
    path = tmp_path / "results.db"
    with Store(path) as store:
        store.add(dataclasses.replace(rows[0], suite_hash=demo.hash))
        store.add(dataclasses.replace(rows[1], suite_hash=demo.hash, seed=1))
    found = verify(path)
    assert any("seed 1: is no instance of suite demo" in text for text in found.differences)
    assert not any("seed 9001" in text for text in found.differences)
    assert found.notes == ["straight: 2 of the 16 instances of suite demo"]


def test_another_flight_finds_what_the_log_cannot(path: Path, flown: list[EpisodeResult]) -> None:
    assert verify(path, refly=4).differences == []
    forge(path, evaluations=99)
    assert verify(path).differences == []
    found = verify(path, refly=100)
    assert found.reflown == 4
    assert [text.partition(": ")[2] for text in found.differences] == [
        "evaluations: stored 99, flown again 0"
    ]


def test_nothing_of_a_stranger_s_file_is_run(path: Path, tmp_path: Path) -> None:
    """Policy, environment and actions that would run code if they were believed."""
    (tmp_path / "trap.py").write_text("raise SystemExit('sprung')")
    sys.path.insert(0, str(tmp_path))
    try:
        forge(path, policy="trap:Trap", environment="trap:AUVDynamic2D-v0")
        assert any("unknown environment" in text for text in verify(path, refly=9).differences)
        assert "trap" not in sys.modules
    finally:
        sys.path.remove(str(tmp_path))


def test_a_log_that_unpacks_to_far_too_much_is_refused(path: Path) -> None:
    bomb = pack_actions([np.zeros(5_000_000, np.float32)])
    assert len(bomb) < 30_000
    forge(path, actions=bomb)
    assert any("does not hold" in text for text in verify(path).differences)


def test_what_is_no_results_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(StoreError, match="no such file"):
        verify(tmp_path / "none.db")
    assert CliRunner().invoke(app, ["verify", str(tmp_path / "none.db")]).exit_code == 2
