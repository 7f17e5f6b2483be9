"""The results file: what ends is on the disk, whoever is killed and whoever else writes."""

from __future__ import annotations

import os
import random
import signal
import sqlite3
import threading
import time
from pathlib import Path

import pytest
from fresh_python import command, environment

from auvgym.evaluation import Instance, PolicySpec, Store, StoreError, Suite, run
from auvgym.evaluation.store import result_key

KILLS = 20
SUITE = Suite("killed", tuple(Instance("AUVDynamic2D-v0", seed) for seed in range(40)))
SPECS = [PolicySpec("straight"), PolicySpec("random")]


def rows(path: Path) -> int:
    if not path.exists():
        return 0
    with Store(path, read_only=True) as store:
        return len(store.results())


def in_a_child(path: Path) -> int:
    """Start the run in a copy of this process; the child never returns."""
    child = os.fork()
    if child == 0:
        try:
            with Store(path) as store:
                run(SUITE, SPECS, store)
        finally:
            os._exit(0)
    return child


@pytest.mark.skipif(not hasattr(os, "fork"), reason="kills copies of this process")
@pytest.mark.filterwarnings("ignore:This process .* is multi-threaded:DeprecationWarning")
def test_twenty_kills_lose_and_double_nothing(tmp_path: Path) -> None:
    """At each kill what was there before is there still, and in the end it is what it should be."""
    path, chance = tmp_path / "results.db", random.Random(7)
    with Store(None) as store:
        whole = run(SUITE, SPECS, store)
    before, in_the_middle, longest_s = 0, 0, 0.1
    for _ in range(KILLS):
        child = in_a_child(path)
        time.sleep(chance.uniform(0.0, longest_s))
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        now = rows(path)
        assert now >= before
        in_the_middle += before < now < len(whole)
        # A busy machine needs longer to get anywhere.
        longest_s *= 1.0 if now > before else 1.4
        before = now
    assert in_the_middle, "every kill came too early or too late"
    with Store(path) as store:
        ended = run(SUITE, SPECS, store)
        assert store.damage() == []
        assert len(store.results()) == len(whole)
    assert [(result_key(one), one.checksum) for one in ended] == [
        (result_key(one), one.checksum) for one in whole
    ]


RUNNER = """
import sys, threading
from auvgym.evaluation import Instance, PolicySpec, Store, Suite, run
suite = Suite("shared", tuple(Instance("AUVDynamic2D-v0", seed) for seed in range(12)))
print("ready", flush=True)
sys.stdin.readline()
with Store(sys.argv[1]) as store:
    print(len(run(suite, [PolicySpec("straight"), PolicySpec("random")], store)))
"""


def test_two_runners_share_a_new_file(tmp_path: Path) -> None:
    import subprocess

    path = tmp_path / "results.db"
    runners = [
        subprocess.Popen(
            [*command(RUNNER), str(path)], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, text=True, env=environment(), cwd=tmp_path,
        )
        for _ in range(2)
    ]  # fmt: skip
    for runner in runners:
        assert runner.stdout is not None
        assert runner.stdout.readline() == "ready\n"
    for runner in runners:
        assert runner.stdin is not None
        runner.stdin.write("\n")
        runner.stdin.flush()
    for runner in runners:
        out, errors = runner.communicate(timeout=60.0)
        assert (runner.returncode, errors, out) == (0, "", "24\n")
    assert rows(path) == 24


def test_many_open_a_new_file_at_the_same_moment(tmp_path: Path) -> None:
    """SQLite's own waiting does not cover the turn to a write-ahead log: it failed one in five."""
    failures: list[str] = []

    def opener(path: Path, gate: threading.Barrier) -> None:
        gate.wait()
        try:
            Store(path).close()
        except StoreError as error:
            failures.append(str(error))

    for attempt in range(10):
        path, gate = tmp_path / f"{attempt}.db", threading.Barrier(6)
        threads = [threading.Thread(target=opener, args=(path, gate)) for _ in range(6)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    assert failures == []


def test_a_reader_changes_nothing(tmp_path: Path) -> None:
    path = tmp_path / "results.db"
    with pytest.raises(StoreError, match="no such file"):
        Store(path, read_only=True)
    with Store(path) as store:
        run(Suite("one", SUITE.instances[:1]), SPECS, store)
    before = path.read_bytes()
    with Store(path, read_only=True) as reader:
        (first, _) = reader.results()
        with pytest.raises(StoreError, match="readonly"):
            reader.add(first)
    assert path.read_bytes() == before


def test_every_commit_waits_for_the_disk(tmp_path: Path) -> None:
    with Store(tmp_path / "results.db") as store:
        assert store._database.execute("PRAGMA synchronous").fetchone() == (2,)
        assert store._database.execute("PRAGMA journal_mode").fetchone() == ("wal",)


def test_a_file_of_an_older_schema_is_named(tmp_path: Path) -> None:
    path = tmp_path / "results.db"
    Store(path).close()
    with sqlite3.connect(path) as database:
        database.execute("PRAGMA user_version = 2")
    database.close()
    with pytest.raises(StoreError, match="has schema 2, this version of auvgym reads 3"):
        Store(path)
