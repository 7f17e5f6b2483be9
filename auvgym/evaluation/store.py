"""The results file: SQLite, one row per episode, written as each one ends."""

from __future__ import annotations

import sqlite3
import typing
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import astuple, fields
from pathlib import Path
from types import TracebackType

from auvgym.evaluation.result import EpisodeResult, PolicySpec
from auvgym.evaluation.suite import Instance, Suite

APPLICATION_ID = 0x41555647  # "AUVG": SQLite keeps it in the file's header, so that ours is known
SCHEMA = 2
_SQL_TYPES = {int: "INTEGER", float: "REAL", str: "TEXT", bytes: "BLOB"}
_KEY = (
    "suite", "policy", "policy_seed", "parameters",
    "environment", "difficulty", "scenario", "seed",
)  # fmt: skip
Key = tuple[str | int, ...]


class StoreError(ValueError):
    """A results file that cannot be used."""


class Store:
    """A results file, open. Use it in a ``with`` block.

    Args:
        path: the file, made if it does not exist; None keeps the results in memory.

    Raises:
        StoreError: the file is not a results file of this version, or cannot be written.
    """

    def __init__(self, path: str | Path | None) -> None:
        self.path = None if path is None else Path(path)
        with self._explained():
            if self.path is not None:
                self.path.parent.mkdir(parents=True, exist_ok=True)
                _refuse_foreign(self.path)
            # Two runners may share the file: each waits for the other's short write.
            self._database = sqlite3.connect(self.path or ":memory:", timeout=30.0)
            self._prepare()

    def _prepare(self) -> None:
        database = self._database
        database.execute("PRAGMA journal_mode = WAL")
        database.execute("PRAGMA synchronous = NORMAL")
        columns = ", ".join(_column(name, kind) for name, kind in _columns().items())
        with database:
            database.execute(f"PRAGMA application_id = {APPLICATION_ID}")
            database.execute(f"PRAGMA user_version = {SCHEMA}")
            database.execute(
                f"CREATE TABLE IF NOT EXISTS episodes ({columns}, UNIQUE ({', '.join(_KEY)}))"
            )

    def check_same(self, suite: Suite, engine_version: str) -> None:
        """Refuse to mix: rows of this suite must come from this engine and these instances."""
        with self._explained():
            found = self._database.execute(
                "SELECT DISTINCT suite_hash, engine_version FROM episodes WHERE suite = ?",
                (suite.name,),
            ).fetchall()
        for stored_hash, stored_version in found:
            if stored_version != engine_version:
                raise StoreError(
                    f'{self.path}: holds episodes of suite "{suite.name}" from auvgym '
                    f"{stored_version}, this is {engine_version}; use another folder, or --fresh"
                )
            if stored_hash != suite.hash:
                raise StoreError(
                    f'{self.path}: suite "{suite.name}" has changed since (hash {stored_hash} '
                    f"then, {suite.hash} now); use another folder, or --fresh"
                )

    def forget(self, suite: Suite) -> None:
        """Delete what is stored for ``suite``."""
        with self._explained(), self._database:
            self._database.execute("DELETE FROM episodes WHERE suite = ?", (suite.name,))

    def finished(self, suite: Suite) -> set[Key]:
        """The :func:`key` of every stored episode of ``suite``."""
        with self._explained():
            rows = self._database.execute(
                f"SELECT {', '.join(_KEY)} FROM episodes WHERE suite = ?", (suite.name,)
            )
            return set(rows)

    def add(self, result: EpisodeResult) -> None:
        """Write one episode and commit; one that is there already stays as it is."""
        marks = ", ".join("?" * len(fields(EpisodeResult)))
        names = ", ".join(_columns())
        with self._explained(), self._database:
            self._database.execute(
                f"INSERT OR IGNORE INTO episodes ({names}) VALUES ({marks})", astuple(result)
            )

    def results(self, suite: Suite | None = None) -> list[EpisodeResult]:
        """The stored episodes (of ``suite``), in an order that no thread count changes."""
        query = f"SELECT {', '.join(_columns())} FROM episodes"
        arguments: tuple[str, ...] = ()
        if suite is not None:
            query, arguments = f"{query} WHERE suite = ?", (suite.name,)
        with self._explained():
            rows = self._database.execute(f"{query} ORDER BY {', '.join(_KEY)}", arguments)
            return [EpisodeResult(*row) for row in rows]

    def close(self) -> None:
        """Close the file; SQLite then folds its write-ahead log into it."""
        self._database.close()

    def __enter__(self) -> Store:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    @contextmanager
    def _explained(self) -> Iterator[None]:
        """Turn what SQLite and the system say into a sentence that names the file."""
        try:
            yield
        except (sqlite3.Error, OSError) as error:
            raise StoreError(f"{self.path}: results cannot be kept there ({error})") from error


def key(suite: Suite, policy: PolicySpec, instance: Instance) -> Key:
    """What makes an episode one and the same in a results file."""
    return (
        suite.name, policy.name, policy.seed, policy.parameters_json,
        instance.environment, instance.difficulty, instance.scenario, instance.seed,
    )  # fmt: skip


def _refuse_foreign(path: Path) -> None:
    """Look before writing: an existing file must carry our mark."""
    if not path.exists() or (path.is_file() and path.stat().st_size == 0):
        return
    try:
        with _reading(path) as database:
            (application,) = database.execute("PRAGMA application_id").fetchone()
            (schema,) = database.execute("PRAGMA user_version").fetchone()
    except sqlite3.OperationalError:
        raise
    except sqlite3.DatabaseError as error:
        raise StoreError(f"{path}: is not an auvgym results file ({error})") from error
    if application != APPLICATION_ID:
        raise StoreError(f"{path}: is an SQLite file, but not auvgym's; choose another folder")
    if schema != SCHEMA:
        raise StoreError(
            f"{path}: has schema {schema}, this version of auvgym reads {SCHEMA}; "
            "choose another folder"
        )


@contextmanager
def _reading(path: Path) -> Iterator[sqlite3.Connection]:
    database = sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True)
    try:
        yield database
    finally:
        database.close()


def _columns() -> dict[str, object]:
    return typing.get_type_hints(EpisodeResult)


def _column(name: str, kind: object) -> str:
    choices = typing.get_args(kind) or (kind,)
    sql = next(_SQL_TYPES[choice] for choice in choices if choice in _SQL_TYPES)
    return f"{name} {sql}{'' if type(None) in choices else ' NOT NULL'}"
