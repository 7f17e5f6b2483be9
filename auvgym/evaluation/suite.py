"""Suites: named lists of frozen instances."""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from functools import cached_property
from typing import Any

DEFAULT_DIFFICULTY = "normal"
Stratum = tuple[str, str, str, str]  # environment, difficulty, scenario, settings


class SuiteError(ValueError):
    """A suite that does not exist, cannot be read, or is not what it was."""


@dataclass(frozen=True)
class Instance:
    """One episode to fly, the same for every policy.

    Attributes:
        environment: Gymnasium id, e.g. ``"AUVDynamic2D-v0"``.
        seed: given to ``env.reset``.
        difficulty: of the world that the seed draws; ``""`` with a scenario, which is one world.
        scenario: a shipped name, a path or ``"ocean:NAME"`` (:mod:`auvgym.evaluation.oceans`), or
            ``""`` for the environment's own draw.
        settings: the environment's other arguments as JSON with sorted keys, ``""`` for none.
        scenario_hash: the first digits of the hash of the world this is; ``""`` if it is not
            frozen. Two instances are equal without it.
    """

    environment: str
    seed: int
    difficulty: str = DEFAULT_DIFFICULTY
    scenario: str = ""
    settings: str = ""
    scenario_hash: str = field(default="", compare=False)

    @property
    def stratum(self) -> Stratum:
        """What is ranked together: environment, difficulty, scenario, settings."""
        return self.environment, self.difficulty, self.scenario, self.settings

    @property
    def label(self) -> str:
        """The instance in words, for messages."""
        return f"{stratum_label(self.stratum)} seed {self.seed}"

    def change(self, scenario_hash: str) -> str:
        """What differs between the world that was met and the one that was frozen, else empty."""
        if scenario_hash.startswith(self.scenario_hash):
            return ""
        return (
            f"{self.label}: the world has changed since the suite was frozen (hash "
            f"{self.scenario_hash} then, {scenario_hash[:16]} now); results would not be comparable"
        )


def stratum_label(stratum: Stratum) -> str:
    """``AUVDynamic2D-v0 · normal · variant paper``."""
    *parts, settings = stratum
    if settings:
        parts += [f"{name} {value}" for name, value in json.loads(settings).items()]
    return " · ".join(part for part in parts if part)


def settings_json(settings: Mapping[str, Any]) -> str:
    """Arguments of an environment as :attr:`Instance.settings` has them."""
    return json.dumps(dict(settings), sort_keys=True) if settings else ""


@dataclass(frozen=True)
class Suite:
    """A named list of instances, and the policies a board of it shows unless told otherwise."""

    name: str
    instances: tuple[Instance, ...]
    description: str = ""
    policies: tuple[str, ...] = ()

    @cached_property  # every row of a results file is held to it
    def hash(self) -> str:
        """16 hex digits over the instances and their worlds: a suite that changed is another."""
        text = json.dumps([asdict(instance) for instance in self.instances], sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:16]

    @property
    def frozen(self) -> bool:
        """Whether every instance names its world's hash."""
        return all(instance.scenario_hash for instance in self.instances)

    @property
    def strata(self) -> dict[Stratum, int]:
        """How many instances each stratum has, in the suite's order."""
        return dict(Counter(instance.stratum for instance in self.instances))


def single_suite(
    environment: str,
    episodes: int,
    difficulty: str | None = None,
    scenario: str = "",
    first_seed: int = 0,
    settings: Mapping[str, Any] | None = None,
) -> Suite:
    """A suite of ``episodes`` consecutive seeds in one environment, for the command line.

    ``settings`` are the environment's other arguments, as ``{"action_mode": "replan"}``.
    """
    if episodes < 1:
        raise SuiteError(f"episodes is {episodes}; at least 1 is needed")
    difficulty = chosen_difficulty(difficulty, scenario)
    given = settings_json(settings or {})
    name = "/".join(part for part in (environment, difficulty, scenario, given) if part)
    instances = tuple(
        Instance(environment, seed, difficulty, scenario, given)
        for seed in range(first_seed, first_seed + episodes)
    )
    return Suite(f"{name}/{first_seed}+{episodes}", instances)


def chosen_difficulty(given: str | None, scenario: str) -> str:
    """A scenario is one world, drawn at no difficulty; anything else is normal unless said."""
    if given and scenario:
        raise SuiteError(f'give a difficulty ("{given}") or a scenario ("{scenario}"), not both')
    return given or ("" if scenario else DEFAULT_DIFFICULTY)
