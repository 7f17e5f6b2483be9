"""Rows of results made up by hand, for what is computed from rows alone."""

from __future__ import annotations

from typing import Any

from auvgym.evaluation import EpisodeResult

_ROW: dict[str, Any] = {
    "suite": "made-up", "suite_hash": "0" * 16, "policy": "one", "policy_seed": 0,
    "parameters": "{}", "knows": "map", "environment": "AUVDynamic2D-v0", "difficulty": "normal",
    "scenario": "", "settings": "", "seed": 0, "scenario_hash": "0" * 64, "engine_version": "0",
    "outcome": "goal", "error": "", "success": 1, "score": 1.0, "time_s": 100.0, "energy_j": 2e6,
    "path_length_m": 5e3, "min_clearance_m": 40.0, "distance_to_goal_m": 10.0, "cost": 3.0,
    "time_limit_s": 150.0, "still_water_time_s": 100.0, "steps": 3, "reward": 1.0,
    "evaluations": 10, "replans": 1, "gap": None, "planning_seconds": 0.5, "actions": b"",
}  # fmt: skip


def row(policy: str = "one", seed: int = 0, score: float = 1.0, **more: Any) -> EpisodeResult:
    """An episode that arrives in 100 / score seconds, or with score 0 collides after 50."""
    solved = score > 0.0
    made = {
        "outcome": "goal" if solved else "collision",
        "success": int(solved),
        "time_s": 100.0 / score if solved else 50.0,
    }
    return EpisodeResult(**{**_ROW, **made, "policy": policy, "seed": seed, "score": score, **more})
