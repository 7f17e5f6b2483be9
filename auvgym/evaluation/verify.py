"""Holding a results file to what its action logs give, without running anybody's policy.

What is recomputed: every figure that the engine decides. What a file can only claim (who flew, what
that policy knew, its counted evaluations, its seconds) is held to the row's checksum, and for
auvgym's own policies to another flight where ``refly`` asks for one.
"""

from __future__ import annotations

import types
import typing
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import dataclass, fields, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import auvgym
from auvgym.evaluation.oceans import PREFIX
from auvgym.evaluation.replay import replay_differences
from auvgym.evaluation.result import EpisodeResult, PolicySpec
from auvgym.evaluation.store import Store
from auvgym.evaluation.suite import Instance, Suite
from auvgym.evaluation.suite_file import list_suites, load_suite
from auvgym.evaluation.task import Task, environment, run_task
from auvgym.evaluation.workers import ProcessDiedError, run_tasks
from auvgym.policies.registry import is_shipped
from auvgym.policies.shipped import list_agents

# Called with the number of rows looked at so far, and the number in all.
OnRow = Callable[[int, int], None]
# Wall clock, and what a policy outside this version may count differently.
_NEVER_COMPARED = ("planning_seconds", "suite", "suite_hash")
_HANDFUL = 32  # rows to a message between processes, which takes longer than one row


@dataclass(frozen=True)
class Verification:
    """What was found.

    Attributes:
        rows: how many episodes the file holds.
        reflown: how many of them their policy flew again.
        differences: in words, each naming its episode; empty if all is as it should be.
        notes: what cannot be decided from the file, in words.
    """

    rows: int
    reflown: int
    differences: list[str]
    notes: list[str]


def verify(
    path: str | Path, workers: int = 1, refly: int = 0, on_row: OnRow | None = None
) -> Verification:
    """Replay every action log of a results file and recompute every figure.

    Nothing of the file is run or unpickled: it holds numbers, texts and actions. The worlds are
    drawn by this version of auvgym; those of a shipped suite must be as they were frozen.

    Args:
        path: a results file, anybody's.
        workers: processes to fly in; the findings do not depend on it.
        refly: how many episodes of auvgym's own policies to have flown anew by the policy, evenly
            spread over the file: then their actions, evaluations and gap are recomputed, too.
        on_row: called after each row.

    Raises:
        StoreError: the file is not a results file of this version, or cannot be read.
    """
    if workers < 1:
        raise ValueError(f"workers is {workers}; at least 1 is needed")
    with Store(path, read_only=True) as store:
        differences = [f"file: {text}" for text in store.damage()]
        rows, checksums = store.results(), store.checksums()
    sound: list[EpisodeResult] = []
    for row, checksum in zip(rows, checksums, strict=True):
        found = _impossible(row)
        if not found and row.checksum != checksum:
            found = [f"checksum: stored {checksum!r}, the row gives {row.checksum!r}"]
        differences += [f"{_label(row)}: {text}" for text in found]
        if not _impossible(row):
            sound.append(row)
    differences += _suites(sound)
    # A network's arithmetic is onnxruntime's, whose last bits may differ from machine to machine.
    reflown = [row for row in sound if is_shipped(row.policy) and row.policy not in list_agents()]
    again = _spread(reflown, refly)
    checks = [*[(row, False) for row in sound], *[(row, True) for row in again]]
    done = 0
    with closing(_checked(checks, workers)) as found_by_row:
        for (row, _), texts in found_by_row:
            differences += [f"{_label(row)}: {text}" for text in texts]
            done += 1
            if on_row is not None:
                on_row(done, len(checks))
    return Verification(len(rows), len(again), sorted(set(differences)), _notes(sound))


def check_row(check: tuple[EpisodeResult, bool]) -> list[str]:
    """What differs in one row: by its log, or (True) by another flight of its policy."""
    row, fly_again = check
    try:
        if fly_again:
            return _flown_again(row)
        if not _present(row):
            return [f"scenario: {row.scenario!r} is neither shipped nor a file here"]
        return replay_differences(row, environment(replace(row.instance, seed=0)))
    except (ValueError, OSError, ImportError) as error:
        return [f"cannot be flown: {error}"]


def _checked(
    checks: Sequence[tuple[EpisodeResult, bool]], workers: int
) -> Generator[tuple[tuple[EpisodeResult, bool], list[str]], None, None]:
    if workers == 1:
        for check in checks:
            yield check, check_row(check)
        return
    handfuls = [checks[first : first + _HANDFUL] for first in range(0, len(checks), _HANDFUL)]
    with closing(run_tasks(_check_rows, handfuls, workers)) as results:
        for handful, found in results:
            if isinstance(found, ProcessDiedError):
                found = [[str(found)]] * len(handful)
            yield from zip(handful, found, strict=True)


def _check_rows(checks: Sequence[tuple[EpisodeResult, bool]]) -> list[list[str]]:
    return [check_row(check) for check in checks]


def _flown_again(row: EpisodeResult) -> list[str]:
    import json

    spec = PolicySpec(row.policy, row.policy_seed, json.loads(row.parameters))
    flown = run_task(Task(row.suite, row.suite_hash, spec, row.knows, row.instance))
    if not isinstance(flown, EpisodeResult):
        return [str(flown)]
    return [
        f"{one.name}: stored {_short(getattr(row, one.name))}, "
        f"flown again {_short(getattr(flown, one.name))}"
        for one in fields(EpisodeResult)
        if one.name not in _NEVER_COMPARED and getattr(row, one.name) != getattr(flown, one.name)
    ]


def _suites(rows: Sequence[EpisodeResult]) -> list[str]:
    """What is wrong with rows as parts of their suites and of this version."""
    found: list[str] = []
    hashes: dict[str, set[str]] = {}
    for row in rows:
        hashes.setdefault(row.suite, set()).add(row.suite_hash)
        if row.engine_version != auvgym.__version__:
            found.append(
                f"{_label(row)}: flown by auvgym {row.engine_version}, this is "
                f"{auvgym.__version__}; verify with that version"
            )
        suite = _shipped(row.suite)
        if suite is None:
            continue
        frozen = _instances(row.suite).get(row.instance)
        if row.suite_hash != suite.hash:
            found.append(
                f"{_label(row)}: suite {row.suite} has hash {row.suite_hash}, not {suite.hash}"
            )
        if frozen is None:
            found.append(f"{_label(row)}: is no instance of suite {row.suite}")
        elif changed := frozen.change(row.scenario_hash):
            found.append(changed)
    for name, given in hashes.items():
        if len(given) > 1:
            found.append(f"suite {name}: rows of several hashes, {', '.join(sorted(given))}")
    return found


def _notes(rows: Sequence[EpisodeResult]) -> list[str]:
    notes = []
    flown: dict[tuple[str, str, int, str], int] = {}
    for row in rows:
        entrant = (row.suite, row.policy, row.policy_seed, row.parameters)
        flown[entrant] = flown.get(entrant, 0) + 1
    for (name, policy, _, parameters), count in sorted(flown.items()):
        suite = _shipped(name)
        if suite is not None and count < len(suite.instances):
            who = policy if parameters == "{}" else f"{policy} {parameters}"
            notes.append(f"{who}: {count} of the {len(suite.instances)} instances of suite {name}")
    strange = sorted({row.suite for row in rows if _shipped(row.suite) is None})
    notes += [
        f"suite {name} is not a shipped one: its worlds are the file's own" for name in strange
    ]
    return notes


@lru_cache(maxsize=16)
def _shipped(name: str) -> Suite | None:
    return load_suite(name) if name in list_suites() else None


@lru_cache(maxsize=16)
def _instances(name: str) -> dict[Instance, Instance]:
    suite = _shipped(name)
    return {} if suite is None else {one: one for one in suite.instances}


@lru_cache(maxsize=1)
def _kinds() -> dict[str, tuple[type, ...]]:
    return {
        name: typing.get_args(kind) if isinstance(kind, types.UnionType) else (kind,)
        for name, kind in typing.get_type_hints(EpisodeResult).items()
    }


def _impossible(row: EpisodeResult) -> list[str]:
    """Columns that hold another kind of value than they may: SQLite lets them."""
    return [
        f"{name}: stored {_short(getattr(row, name))} is no {kinds[0].__name__}"
        for name, kinds in _kinds().items()
        if type(getattr(row, name)) not in kinds
    ]


def _present(row: EpisodeResult) -> bool:
    """Whether a scenario is at hand, and no device or pipe that would never end."""
    scenario = row.scenario
    known = not scenario or scenario.startswith(PREFIX) or scenario in auvgym.list_scenarios()
    return known or Path(scenario).is_file()


def _spread(rows: list[EpisodeResult], count: int) -> list[EpisodeResult]:
    if count >= len(rows):
        return rows
    return [rows[index * len(rows) // count] for index in range(count)]


def _label(row: EpisodeResult) -> str:
    try:
        return f"{row.policy} {row.instance.label}"
    except (TypeError, ValueError):
        return f"{row.policy} {row.environment} seed {row.seed}"


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
