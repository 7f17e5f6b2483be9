"""The results file: SQLite, one row per episode, written as each one ends."""

from __future__ import annotations

import os
import sqlite3
import threading
import typing
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import fields
from functools import lru_cache
from pathlib import Path
from types import TracebackType

from auvgym.evaluation.result import EpisodeResult, PolicySpec
from auvgym.evaluation.suite import Instance, Suite

APPLICATION_ID = 0x41555647  # "AUVG": SQLite keeps it in the file's header, so that ours is known
SCHEMA = 3
_SQL_TYPES = {int: "INTEGER", float: "REAL", str: "TEXT", bytes: "BLOB"}
_KEY = (
    "suite", "policy", "policy_seed", "parameters",
    "environment", "difficulty", "scenario", "settings", "seed",
)  # fmt: skip
_PATIENCE_SECONDS = 30.0
Key = tuple[str | int, ...]


class StoreError(ValueError):
    """A results file that cannot be used."""


class Store:
    """A results file, open. Use it in a ``with`` block.

    A row is on the disk when :meth:`add` returns: neither ``kill -9`` nor a power cut takes it
    away, and none is ever written twice. Several processes may use one file at once.

    Args:
        path: the file, made if it does not exist; None keeps the results in memory.
        read_only: only read what is there, and change nothing.

    Raises:
        StoreError: the file is not a results file of this version, or cannot be written.
    """

    def __init__(self, path: str | Path | None, *, read_only: bool = False) -> None:
        self.path = None if path is None else Path(path)
        with self._explained():
            if read_only and self.path is not None:
                if not self.path.is_file():
                    raise StoreError(f"{self.path}: there is no such file")
                if _refuse_foreign(self.path):
                    self._database = _open_to_read(self.path)
                    return
            # What has no table yet reads as an empty file.
            in_memory = self.path is None or read_only
            if self.path is not None and not read_only:
                self.path.parent.mkdir(parents=True, exist_ok=True)
                if not self.path.exists():
                    _make(self.path)
                _refuse_foreign(self.path)
            # Two runners may share the file: each waits for the other's short write.
            self._database = sqlite3.connect(
                ":memory:" if in_memory else str(self.path), timeout=_PATIENCE_SECONDS
            )
            _prepare(self._database)

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

    def add(self, *results: EpisodeResult) -> None:
        """Write episodes, all or none, and commit; one that is there already stays as it is."""
        marks = ", ".join("?" * (len(fields(EpisodeResult)) + 1))
        names = ", ".join([*_columns(), "checksum"])
        with self._explained(), self._database:
            self._database.executemany(
                f"INSERT OR IGNORE INTO episodes ({names}) VALUES ({marks})",
                [(*result.values, result.checksum) for result in results],
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

    def checksums(self) -> list[str]:
        """What is kept beside each row of :meth:`results`, in the same order."""
        with self._explained():
            rows = self._database.execute(
                f"SELECT checksum FROM episodes ORDER BY {', '.join(_KEY)}"
            )
            return [checksum for (checksum,) in rows]

    def damage(self) -> list[str]:
        """What SQLite itself finds wrong with the file; empty if nothing."""
        with self._explained():
            found = [text for (text,) in self._database.execute("PRAGMA integrity_check")]
        return [] if found == ["ok"] else found

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
        except UnicodeDecodeError as error:
            raise StoreError(f"{self.path}: holds a text that is none ({error})") from error


def key(suite: Suite, policy: PolicySpec, instance: Instance) -> Key:
    """What makes an episode one and the same in a results file."""
    return (
        suite.name, policy.name, policy.seed, policy.parameters_json,
        instance.environment, instance.difficulty, instance.scenario, instance.settings,
        instance.seed,
    )  # fmt: skip


def result_key(result: EpisodeResult) -> Key:
    """The :func:`key` of the pair that a result is of."""
    return tuple(getattr(result, name) for name in _KEY)


def _make(path: Path) -> None:
    """Make a new file, whole from its first moment on.

    SQLite makes one in steps, between which a kill leaves a half, and two that make the same one
    meet a lock for which it does not wait ("database is locked" at once, whatever the timeout). So
    it is made aside and linked to its name; whoever comes second takes the first one's.
    """
    aside = path.with_name(f".{path.name}.{os.getpid()}.{threading.get_ident()}.new")
    try:
        database = sqlite3.connect(aside)
        try:
            _prepare(database)
        finally:
            database.close()
        # A file system without links: then it is made in steps after all.
        with suppress(OSError):
            os.link(aside, path)
    finally:
        aside.unlink(missing_ok=True)


def _prepare(database: sqlite3.Connection) -> None:
    database.execute("PRAGMA journal_mode = WAL")
    # FULL: a commit is on the disk, not in the system's cache alone.
    database.execute("PRAGMA synchronous = FULL")
    if database.execute("SELECT count(*) FROM sqlite_schema").fetchone() != (0,):
        return
    columns = ", ".join(_column(name, kind) for name, kind in _columns().items())
    with database:
        database.execute(f"PRAGMA application_id = {APPLICATION_ID}")
        database.execute(f"PRAGMA user_version = {SCHEMA}")
        database.execute(
            f"CREATE TABLE IF NOT EXISTS episodes "
            f"({columns}, checksum TEXT NOT NULL, UNIQUE ({', '.join(_KEY)}))"
        )


def _refuse_foreign(path: Path) -> bool:
    """Look before writing: an existing file must carry our mark. True if it holds a table."""
    if not path.exists() or (path.is_file() and path.stat().st_size == 0):
        return False
    try:
        with _reading(path) as database:
            (application,) = database.execute("PRAGMA application_id").fetchone()
            (schema,) = database.execute("PRAGMA user_version").fetchone()
            (tables,) = database.execute("SELECT count(*) FROM sqlite_schema").fetchone()
    except sqlite3.OperationalError:
        raise
    except (sqlite3.DatabaseError, UnicodeDecodeError) as error:
        raise StoreError(f"{path}: is not an auvgym results file ({error})") from error
    if not application and not tables:
        return False
    if application != APPLICATION_ID:
        raise StoreError(f"{path}: is an SQLite file, but not auvgym's; choose another folder")
    if schema != SCHEMA:
        raise StoreError(
            f"{path}: has schema {schema}, this version of auvgym reads {SCHEMA}; "
            "choose another folder"
        )
    return True


@contextmanager
def _reading(path: Path) -> Iterator[sqlite3.Connection]:
    database = _open_to_read(path)
    try:
        yield database
    finally:
        database.close()


def _open_to_read(path: Path) -> sqlite3.Connection:
    """Open without the right to change, and without trust in what its schema may call."""
    # A reader of a write-ahead log needs a file beside it, unless it may take it that nobody
    # writes: so it is where the folder takes no files.
    alone = not os.access(path.absolute().parent, os.W_OK)
    uri = f"{path.absolute().as_uri()}?mode=ro{'&immutable=1' if alone else ''}"
    database = sqlite3.connect(uri, uri=True, timeout=_PATIENCE_SECONDS)
    database.execute("PRAGMA trusted_schema = OFF")
    return database


@lru_cache(maxsize=1)
def _columns() -> dict[str, object]:
    return typing.get_type_hints(EpisodeResult)


def _column(name: str, kind: object) -> str:
    choices = typing.get_args(kind) or (kind,)
    sql = next(_SQL_TYPES[choice] for choice in choices if choice in _SQL_TYPES)
    return f"{name} {sql}{'' if type(None) in choices else ' NOT NULL'}"
