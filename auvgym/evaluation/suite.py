"""Suites: named lists of frozen instances, kept as data."""

from __future__ import annotations

import hashlib
import json
import sys
from dataclasses import asdict, dataclass
from importlib import resources
from pathlib import Path
from typing import Any

from auvgym._names import unknown

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib  # type: ignore[import-not-found,unused-ignore]

SCHEMA = 1
DEFAULT_DIFFICULTY = "normal"
_SUITE_KEYS = {"schema", "name", "description", "policies", "instances"}
_GROUP_KEYS = {"environment", "difficulty", "scenario", "seeds"}


class SuiteError(ValueError):
    """A suite that does not exist or cannot be read."""


@dataclass(frozen=True)
class Instance:
    """One episode to fly, the same for every policy.

    Attributes:
        environment: Gymnasium id, e.g. ``"AUVDynamic2D-v0"``.
        seed: given to ``env.reset``.
        difficulty: of the world that the seed draws; ``""`` with a scenario, which is one world.
        scenario: a shipped name or a path, or ``""`` for the environment's own draw.
    """

    environment: str
    seed: int
    difficulty: str = DEFAULT_DIFFICULTY
    scenario: str = ""

    @property
    def stratum(self) -> tuple[str, str, str]:
        """What is ranked together: environment, difficulty, scenario."""
        return self.environment, self.difficulty, self.scenario


@dataclass(frozen=True)
class Suite:
    """A named list of instances, and the policies a board of it shows unless told otherwise."""

    name: str
    instances: tuple[Instance, ...]
    description: str = ""
    policies: tuple[str, ...] = ()

    @property
    def hash(self) -> str:
        """16 hex digits over the instances: a suite that changed is another suite."""
        text = json.dumps([asdict(instance) for instance in self.instances], sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:16]


def list_suites() -> list[str]:
    """Names of the shipped suites."""
    folder = resources.files("auvgym.evaluation") / "suites"
    return sorted(
        entry.name.removesuffix(".toml")
        for entry in folder.iterdir()
        if entry.name.endswith(".toml")
    )


def load_suite(name_or_path: str | Path) -> Suite:
    """Read a shipped suite by name, or one's own from a TOML file.

    Raises:
        SuiteError: no such suite, or a file that is not a suite.
    """
    text = str(name_or_path)
    if text.endswith(".toml"):
        path = Path(text)
        try:
            content = path.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise SuiteError(f"suite {path}: cannot be read ({error})") from error
    elif text in list_suites():
        content = (resources.files("auvgym.evaluation") / "suites" / f"{text}.toml").read_text(
            encoding="utf-8"
        )
    else:
        raise SuiteError(f"{unknown('suite', text, list_suites())}, or a path that ends in .toml")
    try:
        return _parse(tomllib.loads(content))
    except (tomllib.TOMLDecodeError, SuiteError) as error:
        raise SuiteError(f"suite {text}: {error}") from error


def single_suite(
    environment: str,
    episodes: int,
    difficulty: str | None = None,
    scenario: str = "",
    first_seed: int = 0,
) -> Suite:
    """A suite of ``episodes`` consecutive seeds in one environment, for the command line."""
    if episodes < 1:
        raise SuiteError(f"episodes is {episodes}; at least 1 is needed")
    difficulty = _difficulty(difficulty, scenario)
    name = "/".join(part for part in (environment, difficulty, scenario) if part)
    instances = tuple(
        Instance(environment, seed, difficulty, scenario)
        for seed in range(first_seed, first_seed + episodes)
    )
    return Suite(f"{name}/{first_seed}+{episodes}", instances)


def _parse(data: dict[str, Any]) -> Suite:
    _known_keys("suite", data, _SUITE_KEYS)
    if data.get("schema") != SCHEMA:
        raise SuiteError(f"schema is {data.get('schema')!r}; this version reads {SCHEMA}")
    if not isinstance(data.get("name"), str) or not data["name"]:
        raise SuiteError("name is missing; a suite has a name")
    instances: list[Instance] = []
    for index, group in enumerate(data.get("instances", [])):
        where = f"instances[{index}]"
        _known_keys(where, group, _GROUP_KEYS)
        if not isinstance(group.get("environment"), str):
            raise SuiteError(f"{where}: environment is missing; it is a Gymnasium id")
        scenario = str(group.get("scenario", ""))
        difficulty = _difficulty(group.get("difficulty"), scenario)
        instances += [
            Instance(group["environment"], seed, difficulty, scenario)
            for seed in _seeds(where, group.get("seeds"))
        ]
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


def _difficulty(given: str | None, scenario: str) -> str:
    """A scenario is one world, drawn at no difficulty; anything else is normal unless said."""
    if given and scenario:
        raise SuiteError(f'give a difficulty ("{given}") or a scenario ("{scenario}"), not both')
    return given or ("" if scenario else DEFAULT_DIFFICULTY)


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
