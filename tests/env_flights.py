"""Environments for tests, and ways to fly them."""

from __future__ import annotations

import importlib
from typing import Any

import gymnasium
import numpy as np
import pytest
from small_worlds import open_water

from auvgym import Scenario
from auvgym.envs import AUVEnv
from auvgym.registration import ENVIRONMENTS

IDS = list(ENVIRONMENTS)
INFO = {
    "time_s": float,
    "energy_j": float,
    "path_length_m": float,
    "min_clearance_m": float,
    "distance_to_goal_m": float,
    "evaluations": int,
    "replans": int,
    "map_changes": int,
    "map_changed": bool,
    "is_success": bool,
    "outcome": str,
}
FAILURES = {"collision", "out_of_bounds", "energy", "timeout"}
# Path length between map changes, m: in a tank, where none are usual, a thousandth.
EVERY_M = {env_id: 6.0 if env_id == "AUVStatic3D-v0" else 6_000.0 for env_id in IDS}

# Settings that a family refuses: its map never changes, and its current is a jet.
REFUSED = {
    "AUVThreat3D-v0": {
        "peaks",
        "ring_ratio",
        "vortices",
        "change_every_m",
        "vortex_drift_mps",
        "variant",
    },
    "AUVHarbor2D-v0": {
        "peaks",
        "ring_ratio",
        "vortices",
        "change_every_m",
        "vortex_drift_mps",
        "variant",
    },
}

# Settings that one family alone knows.
ONLY_IN = {"vessels": "AUVHarbor2D-v0", "manoeuvres": "AUVThreat3D-v0"}

every_id = pytest.mark.parametrize("env_id", IDS)
both_dimensions = pytest.mark.parametrize("dimensions", [2, 3])


def environment_class(env_id: str) -> type[AUVEnv]:
    module, _, name = ENVIRONMENTS[env_id].partition(":")
    found: type[AUVEnv] = getattr(importlib.import_module(module), name)
    return found


def make(env_id: str, **settings: Any) -> Any:
    """An environment as users get it, with all of Gymnasium's wrappers."""
    return gymnasium.make(f"auvgym:{env_id}", **settings)


def known(env_id: str, **settings: Any) -> dict[str, Any]:
    """Those of the settings that the environment's family does not refuse."""
    refused = REFUSED.get(env_id, set())
    return {name: value for name, value in settings.items() if name not in refused}


def bare(dimensions: int = 2, **settings: Any) -> AUVEnv:
    return environment_class(f"AUVDynamic{dimensions}D-v0")(**settings)


def in_open_water(dimensions: int = 2, **parts: Any) -> AUVEnv:
    env = bare(dimensions, scenario=Scenario.from_dict(open_water(dimensions, **parts)))
    env.reset(seed=0)
    return env


def fly(env: Any, steps: int, seed: int = 0) -> list[Any]:
    """Step with random actions, beginning again after each end; everything that came back."""
    random, width = np.random.default_rng(seed), env.action_space.shape
    seen: list[Any] = []
    for _ in range(steps):
        action = random.uniform(-1, 1, width).astype(np.float32)
        observation, reward, terminated, truncated, info = env.step(action)
        seen.append((observation.tobytes(), reward, terminated, truncated, info))
        if terminated or truncated:
            observation, info = env.reset()
            seen.append((observation.tobytes(), info))
    return seen


def to_goal(env: Any) -> np.ndarray[Any, Any]:
    core = env.unwrapped
    action: np.ndarray[Any, Any] = core.action_for(core.world.goal)
    return action
