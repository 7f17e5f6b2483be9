"""Scenarios: everything a world is made of, as plain numbers in a TOML file."""

from __future__ import annotations

import json
import operator
import os
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np

from auvgym import _core
from auvgym._names import unknown


class Scenario:
    """Everything a world is made of, checked; immutable.

    Made by :meth:`load`, :meth:`from_toml`, :meth:`from_dict` or :meth:`generate`. The file format
    is documented key by key in ``docs/scenario.md``.
    """

    __slots__ = ("_core",)

    def __init__(self, core: _core.Scenario) -> None:
        self._core = core

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Scenario:
        """Read a TOML file.

        Raises:
            FileNotFoundError, OSError: if it cannot be read.
            ScenarioError: naming the file, the key, its value and what was allowed.
        """
        return cls(_core.Scenario.load(os.fspath(path)))

    @classmethod
    def from_toml(cls, text: str) -> Scenario:
        """Read TOML text.

        Raises:
            ScenarioError: naming the key, its value and what was allowed.
        """
        return cls(_core.Scenario.from_toml(text))

    @classmethod
    def from_dict(cls, mapping: Mapping[str, Any]) -> Scenario:
        """Make a scenario of nested mappings, lists and numbers in the file's own structure.

        Raises:
            ScenarioError: naming the key, its value and what was allowed.
        """
        try:
            text = json.dumps(mapping, allow_nan=False)
        except (TypeError, ValueError) as error:
            raise _core.ScenarioError(f"not a mapping of plain finite numbers: {error}") from error
        return cls(_core.Scenario.from_json(text))

    @classmethod
    def generate(cls, family: str, seed: int, **parameters: Any) -> Scenario:
        """Draw a scenario from a family; the same arguments give the same scenario.

        Args:
            family: one of :func:`list_families`.
            seed: 0 .. 2**64 - 1.
            **parameters: of the families, see ``docs/scenario.md``: ``difficulty`` ("easy",
                "normal", "hard"), ``variant`` ("debiased", "paper"), ``obstacles``, ``vortices``,
                ``peaks`` (numbers), ``current_ratio`` (fastest summed current over vehicle
                speed), ``ring_ratio`` (instead: one vortex's ring speed over vehicle speed),
                ``time_factor``, ``vehicle_speed_mps``, ``change_every_m``,
                ``obstacle_speed_mps``, ``vortex_drift_mps``, ``manoeuvres`` ("none", "turn",
                "zigzag", "mixed"), ``sensor_noise_m``.

        Raises:
            ValueError: naming the family or parameter, its value and what was allowed.
        """
        if family not in list_families():
            raise ValueError(unknown("family", family, list_families()))
        return cls(_core.Scenario.generate(family, check_seed(seed), parameters_json(parameters)))

    def to_toml(self) -> str:
        """The scenario as TOML text, which :meth:`from_toml` reads back to an equal one."""
        return self._core.to_toml()

    def to_dict(self) -> dict[str, Any]:
        """The scenario as nested dictionaries in the file's own structure."""
        mapping: dict[str, Any] = json.loads(self._core.to_json())
        return mapping

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a TOML file; the old file stays whole if that fails.

        Raises:
            OSError: if it cannot be written.
        """
        self._core.save(os.fspath(path))

    @property
    def hash(self) -> str:
        """SHA-256 of the TOML text, hexadecimal: one hash, one world."""
        return self._core.hash

    @property
    def name(self) -> str:
        """Short name."""
        return self._core.name

    @property
    def description(self) -> str:
        """What it is, in a sentence; may be empty."""
        return self._core.description

    @property
    def family(self) -> str:
        """The family that it belongs to; may be empty."""
        return self._core.family

    @property
    def dimensions(self) -> int:
        """2 or 3."""
        return self._core.dimensions

    @property
    def notes(self) -> list[str]:
        """What a loader decided, in sentences."""
        return self._core.notes

    @property
    def missions(self) -> int:
        """Number of start/goal pairs."""
        return self._core.missions

    @property
    def projection(self) -> tuple[float, float] | None:
        """(longitude, latitude) in degrees of the local origin; None for worlds not on Earth."""
        return self._core.projection

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scenario):
            return NotImplemented
        return self._core == other._core

    def __hash__(self) -> int:
        return hash(self.hash)

    def __reduce__(self) -> tuple[Any, ...]:
        return Scenario.from_toml, (self.to_toml(),)

    def __repr__(self) -> str:
        return f"<Scenario {self.name}: {self.dimensions}-D, {self.hash[:12]}>"


def list_families() -> list[str]:
    """Families that :meth:`Scenario.generate` draws from."""
    return list(_core.families())


def list_scenarios() -> list[str]:
    """Names of the scenarios that come with the package."""
    folder = resources.files("auvgym") / "scenarios"
    return sorted(
        entry.name.removesuffix(".toml")
        for entry in folder.iterdir()
        if entry.name.endswith(".toml")
    )


def resolve_scenario(scenario: Scenario | str | os.PathLike[str]) -> Scenario:
    """A scenario from itself, the name of a shipped one, or the path of a TOML file.

    Raises:
        ValueError: for an unknown name, listing those that exist.
        FileNotFoundError, OSError, ScenarioError: as :meth:`Scenario.load`.
    """
    if isinstance(scenario, Scenario):
        return scenario
    if not isinstance(scenario, (str, os.PathLike)):
        kind = type(scenario).__name__
        raise TypeError(f"scenario is a {kind}: must be a Scenario, a name or the path of a file")
    name = os.fspath(scenario)
    if name in list_scenarios():
        with resources.as_file(resources.files("auvgym") / "scenarios" / f"{name}.toml") as path:
            return Scenario.load(path)
    if name.endswith(".toml") or os.sep in name or Path(name).is_file():
        return Scenario.load(name)
    raise ValueError(unknown("scenario", name, list_scenarios()) + " or give the path of a file")


def parameters_json(parameters: Mapping[str, Any]) -> str:
    """Parameters as JSON; None stands for "not given".

    Raises:
        ValueError: naming the first that is no plain finite number, text or flag.
    """
    given = (item for item in parameters.items() if item[1] is not None)
    return (
        "{" + ", ".join(f"{json.dumps(name)}: {_json(name, value)}" for name, value in given) + "}"
    )


def _json(name: str, value: Any) -> str:
    try:
        return json.dumps(value, allow_nan=False, default=_plain)
    except (TypeError, ValueError) as error:
        message = f"{name} = {value!r}: must be a finite number, text or flag ({error})"
        raise ValueError(message) from error


def _plain(value: Any) -> Any:
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"it is a {type(value).__name__}")


def check_seed(seed: int, name: str = "seed") -> int:
    """Give the seed as a Python int.

    Raises:
        ValueError: if it is not an integer in 0 .. 2**64 - 1.
    """
    try:
        value = operator.index(seed)
    except TypeError:
        raise ValueError(f"{name} = {seed!r}: must be an integer") from None
    if not 0 <= value < 2**64:
        raise ValueError(f"{name} = {value}: must lie in 0 .. 2**64 - 1")
    return value
