"""Missions in real oceans, by name: ``ocean:gulf-stream-across`` where a scenario is asked for.

The data are other people's and stay theirs: the missions are ours (``oceans.toml``), the files are
looked for in the folder that the environment variable ``AUVGYM_DATA`` names.
"""

from __future__ import annotations

import os
import sys
import warnings
from functools import lru_cache
from importlib import resources
from pathlib import Path
from typing import Any

from auvgym._names import unknown
from auvgym.evaluation.suite import SuiteError
from auvgym.scenario import Scenario

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib  # type: ignore[import-not-found,unused-ignore]

PREFIX = "ocean:"
VARIABLE = "AUVGYM_DATA"
_FILES = ("currents", "bathymetry")


@lru_cache(maxsize=1)
def ocean_missions() -> dict[str, dict[str, Any]]:
    """Name of a mission -> arguments of :func:`auvgym.ocean.load`, files by name alone."""
    file = resources.files("auvgym.evaluation") / "oceans.toml"
    missions: dict[str, dict[str, Any]] = tomllib.loads(file.read_text(encoding="utf-8"))
    return missions


def ocean_scenario(name: str) -> Scenario:
    """The scenario of a mission; ``name`` without the prefix.

    Raises:
        SuiteError: there is no such mission, or its files are not at hand.
        ImportError: without the extra ``ocean``.
    """
    missions = ocean_missions()
    if name not in missions:
        raise SuiteError(unknown("ocean mission", name, missions))
    folder = os.environ.get(VARIABLE)
    if not folder:
        raise SuiteError(
            f'scenario "{PREFIX}{name}" needs real data: set {VARIABLE} to the folder of '
            f"{', '.join(_files(missions[name]))}"
        )
    return _loaded(name, folder)


@lru_cache(maxsize=32)
def _loaded(name: str, folder: str) -> Scenario:
    from auvgym import ocean

    mission = ocean_missions()[name]
    for file in _files(mission):
        if not (Path(folder) / file).is_file():
            raise SuiteError(f'scenario "{PREFIX}{name}": there is no {file} in {folder}')
    paths = {key: Path(folder) / mission[key] for key in _FILES if key in mission}
    with warnings.catch_warnings():
        # What the loader warns of is in the scenario's notes, too.
        warnings.simplefilter("ignore", ocean.OceanDataWarning)
        return ocean.load(**{**mission, **paths, "name": name})


def _files(mission: dict[str, Any]) -> list[str]:
    return [mission[key] for key in _FILES if key in mission]
