"""``hold``: stay where the episode began."""

from __future__ import annotations

from typing import Any

from auvgym.policies.base import Action, Observation, ScriptedPolicy


class HoldPolicy(ScriptedPolicy):
    """Asks for the waypoint under the vehicle, so that it keeps station until the time is up."""

    name = "hold"
    description = "keep station at the start"

    def act(self, observation: Observation, info: dict[str, Any]) -> Action:
        """The action whose waypoint is the vehicle's own position, (d,) float32."""
        return self.steer_to(self.position)
