"""Environments in re-plan mode for tests, and episodes under triggers."""

from __future__ import annotations

from typing import Any

import gymnasium

from auvgym import policies

# Coarse grids: what is tested does not depend on how good a plan is.
SPACING = {
    "AUVDynamic2D-v0": 1000.0,
    "AUVDynamic3D-v0": 2000.0,
    "AUVHarbor2D-v0": 6.0,
    "AUVStatic3D-v0": 2.0,
    "AUVThreat3D-v0": 600.0,
}


def settings(env_id: str = "AUVDynamic2D-v0", **more: Any) -> dict[str, Any]:
    astar = {"planner": "astar", "planner_parameters": {"spacing_m": SPACING[env_id]}}
    return {"action_mode": "replan", **astar, **more}


def make(env_id: str = "AUVDynamic2D-v0", **more: Any) -> Any:
    return gymnasium.make(env_id, **settings(env_id, **more))


def fly(env: Any, seed: int, name: str, **parameters: Any) -> tuple[dict[str, Any], list[int]]:
    """One episode under a trigger: the last info, and the actions."""
    observation, info = env.reset(seed=seed)
    trigger = policies.make(name, **parameters)
    trigger.reset(env)
    taken = []
    while info["outcome"] == "running":
        assert env.observation_space.contains(observation)
        taken.append(trigger.act(observation, info))
        assert env.action_space.contains(taken[-1])
        observation, _, _, _, info = env.step(taken[-1])
    return info, taken
