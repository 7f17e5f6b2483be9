"""Suites on disk: a TOML file of groups of instances, and beside it the hashes of their worlds.

``suites/demo.toml`` says what is flown, ``suites/demo.lock`` what each world was when the suite was
frozen: a line per instance, in the order of the suite, of its label and hash.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from importlib import resources
from pathlib import Path
from typing import Any

from auvgym._names import unknown
from auvgym.evaluation.suite import (
    Instance,
    Suite,
    SuiteError,
    chosen_difficulty,
    settings_json,
)

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib  # type: ignore[import-not-found,unused-ignore]

SCHEMA = 1
DIGITS = 16
_SUITE_KEYS = {"schema", "name", "description", "policies", "instances"}
_GROUP_KEYS = {"environment", "difficulty", "scenario", "settings", "seeds"}


def list_suites() -> list[str]:
    """Names of the shipped suites."""
    folder = resources.files("auvgym.evaluation") / "suites"
    return sorted(
        entry.name.removesuffix(".toml")
        for entry in folder.iterdir()
        if entry.name.endswith(".toml")
    )


def load_suite(name_or_path: str | Path) -> Suite:
    """Read a shipped suite by name, or one's own from a TOML file; with its lock, if it has one.

    Raises:
        SuiteError: no such suite, a file that is not a suite, or a lock of other instances.
    """
    text = str(name_or_path)
    if text.endswith(".toml"):
        file: Any = Path(text)
        lock: Any = lock_path(text)
    elif text in list_suites():
        folder = resources.files("auvgym.evaluation") / "suites"
        file, lock = folder / f"{text}.toml", folder / f"{text}.lock"
    else:
        raise SuiteError(f"{unknown('suite', text, list_suites())}, or a path that ends in .toml")
    try:
        content = file.read_text(encoding="utf-8")
        locked = lock.read_text(encoding="utf-8") if lock.is_file() else None
    except (OSError, UnicodeDecodeError) as error:
        raise SuiteError(f"suite {text}: cannot be read ({error})") from error
    try:
        suite = _parse(tomllib.loads(content))
        return suite if locked is None else _with_lock(suite, locked)
    except (tomllib.TOMLDecodeError, SuiteError) as error:
        raise SuiteError(f"suite {text}: {error}") from error


def lock_path(path: str | Path) -> Path:
    """Where the hashes of a suite's file are."""
    return Path(path).with_suffix(".lock")


def world_hashes(suite: Suite, on_world: Callable[[int], None] | None = None) -> list[str]:
    """The hash of the world of each instance, drawn now, 64 hex digits each.

    ``on_world`` is called with the number drawn so far.
    """
    from auvgym.evaluation.flight import make_environment

    hashes: list[str] = []
    environments: dict[Instance, Any] = {}
    for instance in suite.instances:
        setting = replace(instance, seed=0)
        env = environments.get(setting)
        if env is None:
            env = environments[setting] = make_environment(instance)
        env.reset(seed=instance.seed)
        core: Any = env.unwrapped
        hashes.append(str(core.world.scenario.hash))
        if on_world is not None:
            on_world(len(hashes))
    return hashes


def lock_text(suite: Suite, hashes: list[str]) -> str:
    """The lock of a suite whose worlds have these hashes."""
    lines = [
        f"{digest[:DIGITS]}  {instance.label}"
        for instance, digest in zip(suite.instances, hashes, strict=True)
    ]
    return "\n".join([*lines, ""])


def _with_lock(suite: Suite, text: str) -> Suite:
    lines = text.splitlines()
    if len(lines) != len(suite.instances):
        raise SuiteError(
            f"the lock has {len(lines)} lines, the suite {len(suite.instances)} instances; "
            f"freeze it anew: auvgym suite FILE.toml --freeze"
        )
    instances = []
    for line, instance in zip(lines, suite.instances, strict=True):
        digest, _, label = line.partition("  ")
        if label != instance.label or len(digest) != DIGITS:
            raise SuiteError(
                f'the lock has "{line}" where the suite has {instance.label}; '
                "freeze it anew: auvgym suite FILE.toml --freeze"
            )
        instances.append(replace(instance, scenario_hash=digest))
    return replace(suite, instances=tuple(instances))


def _parse(data: dict[str, Any]) -> Suite:
    _known_keys("suite", data, _SUITE_KEYS)
    if data.get("schema") != SCHEMA:
        raise SuiteError(f"schema is {data.get('schema')!r}; this version reads {SCHEMA}")
    if not isinstance(data.get("name"), str) or not data["name"]:
        raise SuiteError("name is missing; a suite has a name")
    instances: list[Instance] = []
    for index, group in enumerate(data.get("instances", [])):
        instances += _group(f"instances[{index}]", group)
    if not instances:
        raise SuiteError("there are no [[instances]]; at least one is needed")
    if len(set(instances)) < len(instances):
        raise SuiteError("an instance is listed twice; each counts once")
    return Suite(
        data["name"],
        tuple(instances),
        str(data.get("description", "")),
        tuple(str(policy) for policy in data.get("policies", [])),
    )


def _group(where: str, group: Any) -> list[Instance]:
    _known_keys(where, group, _GROUP_KEYS)
    if not isinstance(group.get("environment"), str):
        raise SuiteError(f"{where}: environment is missing; it is a Gymnasium id")
    scenario = str(group.get("scenario", ""))
    difficulty = chosen_difficulty(group.get("difficulty"), scenario)
    settings = group.get("settings", {})
    if not isinstance(settings, dict):
        raise SuiteError(f'{where}: settings is {settings!r}; a table like {{variant = "paper"}}')
    return [
        Instance(group["environment"], seed, difficulty, scenario, settings_json(settings))
        for seed in _seeds(where, group.get("seeds"))
    ]


def _seeds(where: str, value: Any) -> list[int]:
    """``[3, 4, 5]`` or ``{first = 3, count = 3}``."""
    if isinstance(value, dict):
        _known_keys(f"{where}.seeds", value, {"first", "count"})
        first, count = value.get("first", 0), value.get("count")
        if isinstance(first, int) and isinstance(count, int) and first >= 0 and count >= 1:
            return list(range(first, first + count))
    elif isinstance(value, list) and value and all(type(one) is int and one >= 0 for one in value):
        return value
    raise SuiteError(
        f"{where}: seeds is {value!r}; it is a list of whole numbers >= 0, "
        "or {first = 0, count = 10}"
    )


def _known_keys(where: str, table: Any, known: set[str]) -> None:
    if not isinstance(table, dict):
        raise SuiteError(f"{where} is {table!r}; a table is needed")
    for key in table:
        if key not in known:
            raise SuiteError(f"{where}: {unknown('key', key, known)}")
