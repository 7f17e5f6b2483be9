"""Hyperparameters as data: a YAML file for each algorithm, a section for each environment."""

from __future__ import annotations

from functools import lru_cache
from importlib import resources
from typing import Any

from auvgym._extras import require
from auvgym._names import unknown

#: What every environment begins with.
COMMON = "default"


@lru_cache(maxsize=1)
def list_algorithms() -> list[str]:
    """Names of the algorithms that there is a recipe for."""
    folder = resources.files("auvgym.training")
    return sorted(
        entry.name.removesuffix(".yaml")
        for entry in folder.iterdir()
        if entry.name.endswith(".yaml")
    )


def load_recipe(algorithm: str, environment: str, action_mode: str = "waypoint") -> dict[str, Any]:
    """Hyperparameters of an algorithm in an environment.

    Sections of the file are laid over each other: ``default``, the action mode
    (``replan``), the environment, and the two together (``AUVDynamic2D-v0/replan``).

    Raises:
        ValueError: there is no such algorithm.
        ImportError: without PyYAML (extra ``train``).
    """
    if algorithm not in list_algorithms():
        raise ValueError(unknown("algorithm", algorithm, list_algorithms()))
    sections = _sections(algorithm)
    names = (COMMON, action_mode, environment, f"{environment}/{action_mode}")
    recipe: dict[str, Any] = {}
    for name in names:
        recipe |= sections.get(name) or {}
    return recipe


@lru_cache
def _sections(algorithm: str) -> dict[str, dict[str, Any]]:
    text = (resources.files("auvgym.training") / f"{algorithm}.yaml").read_text(encoding="utf-8")
    sections: dict[str, dict[str, Any]] = require("yaml", "train").safe_load(text)
    return sections
