"""``lane``: a blind script that needs no sensor, there to show what a map's margins give away."""

from __future__ import annotations

from typing import Any

import numpy as np

from auvgym.policies.base import Action, Observation, ScriptedPolicy


class LanePolicy(ScriptedPolicy):
    """Runs along the eastern margin and turns in just before the goal.

    Obstacles are drawn round the middle of the papers' maps, so their margins are thin in
    obstacles. A policy that does not beat this one has learned the map's bias, not to look.

    Args:
        seed: unused; every policy takes one.
        lane: where the lane lies, as a fraction of the domain's width (0.925: x = 18.5 of 20 km).
        turn_in: how far before the goal to leave it, as a fraction of the domain's length
            (0.1: y = 35 of 40 km for a goal at 39).
    """

    name = "lane"
    description = "blind: along the eastern margin, then turn in"

    def __init__(self, seed: int = 0, lane: float = 0.925, turn_in: float = 0.1) -> None:
        super().__init__(seed)
        self.lane = lane
        self.turn_in = turn_in

    def reset(self, env: Any) -> None:
        """Lay the lane into the episode's domain."""
        super().reset(env)
        world = self.env.world
        minimum, maximum = (np.asarray(corner, dtype=np.float64) for corner in world.domain)
        length_m = maximum[1] - minimum[1]
        self._direction = 1.0 if self.goal[1] >= world.start[1] else -1.0
        self._lane_x_m = minimum[0] + self.lane * (maximum[0] - minimum[0])
        self._turn_in_m = self.turn_in * length_m
        # Two steps of a fortieth of the length: the lane is joined at a slant and then followed.
        self._ahead_m = length_m / 20.0

    def act(self, observation: Observation, info: dict[str, Any]) -> Action:
        """The action towards a point of the lane ahead, then towards the goal, (d,) float32."""
        position = self.position
        left_m = self._direction * (self.goal[1] - position[1])
        if left_m <= self._turn_in_m:
            return self.steer_to(self.goal)
        ahead = np.array(
            [self._lane_x_m, position[1] + self._direction * self._ahead_m, position[2]]
        )
        return self.steer_to(ahead)
