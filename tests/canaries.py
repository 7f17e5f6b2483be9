"""Policies that deserve nothing: if one of them scores, the board or an environment is wrong."""

from __future__ import annotations

from typing import Any

import numpy as np

from auvgym.policies import ScriptedPolicy


class Spin(ScriptedPolicy):
    """Turns on the spot: each waypoint a quarter further round."""

    name, knows = "spin", "nothing"

    def reset(self, env: Any) -> None:
        super().reset(env)
        self.turns = 0

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        self.turns += 1
        angle = 0.5 * np.pi * self.turns
        action = np.zeros(self.env.dimensions, np.float32)
        action[:2] = (np.cos(angle) - 0.25) / 1.25, np.sin(angle)
        return action


class HugTheWall(ScriptedPolicy):
    """Goes to the western wall and stays along it, a wall being where nothing is in the way."""

    name, knows = "hug-the-wall", "nothing"

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        domain = self.env.world.scenario.to_dict()["domain"]
        margin = 0.01 * (domain["max_m"][0] - domain["min_m"][0])
        wall = np.array([domain["min_m"][0] + margin, self.position[1], self.position[2]])
        along = np.array([0.0, 4.0 * margin, 0.0])
        return self.steer_to(wall + along)
