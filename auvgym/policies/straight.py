"""``straight``: at the goal, through whatever is in between."""

from __future__ import annotations

from typing import Any

from auvgym.policies.base import Action, Observation, ScriptedPolicy


class StraightPolicy(ScriptedPolicy):
    """Steers at the goal in every leg."""

    name = "straight"
    description = "straight at the goal"

    def act(self, observation: Observation, info: dict[str, Any]) -> Action:
        """The action that steers at the goal, (d,) float32."""
        return self.steer_to(self.goal)
