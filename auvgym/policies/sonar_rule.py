"""``sonar-rule``: towards the goal where the sonar sees room, else through the nearest gap."""

from __future__ import annotations

from typing import Any

import numpy as np

from auvgym.policies.base import Action, Knows, Observation, ScriptedPolicy, Vector


class SonarRulePolicy(ScriptedPolicy):
    """A reactive rule over one ping.

    It takes the goal's direction if a tube along it is free of returns, else the beam nearest to
    that direction whose tube is free, else the longest beam.

    Args:
        seed: unused; every policy takes one.
        tube_radius_m: how far returns must stay from the tube's axis, m; None takes 0.225 of the
            scenario's reach.
        tube_length_m: how far ahead the tube reaches, m; None takes the reach.
    """

    name = "sonar-rule"
    knows: Knows = "sensors"
    description = "reactive: the free sonar direction nearest to the goal's"

    def __init__(
        self,
        seed: int = 0,
        tube_radius_m: float | None = None,
        tube_length_m: float | None = None,
    ) -> None:
        super().__init__(seed)
        self.tube_radius_m = tube_radius_m
        self.tube_length_m = tube_length_m

    def reset(self, env: Any) -> None:
        """Lay out the beams and the angles between them once."""
        super().reset(env)
        self._sonar = self.env.observation_layout["sonar"]
        self._directions = np.asarray(self.env.sonar_directions, dtype=np.float64)
        episode = self.env.world.scenario.to_dict()["episode"]
        self._range_m = float(episode["sonar_range_m"])
        reach_m = float(episode["reach_m"])
        self._radius_m = 0.225 * reach_m if self.tube_radius_m is None else self.tube_radius_m
        self._length_m = reach_m if self.tube_length_m is None else self.tube_length_m
        self._between = self._directions @ self._directions.T

    def act(self, observation: Observation, info: dict[str, Any]) -> Action:
        """The action along the chosen direction, (d,) float32."""
        position = self.position
        to_goal = self.goal - position
        distance_m = float(np.linalg.norm(to_goal))
        frame = goal_aligned_frame(to_goal)
        goal_direction = frame @ to_goal / max(distance_m, 1e-9)
        ranges_m = (1.0 - observation[self._sonar].astype(np.float64)) * self._range_m
        ahead_m = min(self._length_m, distance_m)
        direction, free_m = self._choose(ranges_m, goal_direction, ahead_m)
        return self.steer_to(position + free_m * (direction @ frame))

    def _choose(
        self, ranges_m: Vector, goal_direction: Vector, ahead_m: float
    ) -> tuple[Vector, float]:
        """The direction to take (3,) in the goal-aligned frame, and how far to go along it, m."""
        to_goal = self._directions @ goal_direction
        # Row 0 asks about the goal's own direction, row 1 + b about beam b.
        cosines = np.vstack([to_goal, self._between])
        along_m = cosines * ranges_m
        across_m = np.sqrt(np.maximum(1.0 - cosines**2, 0.0)) * ranges_m
        returned = ranges_m < 0.999 * self._range_m
        blocked = returned & (along_m > 0.0) & (along_m < ahead_m)
        free = ~np.any(blocked & (across_m < self._radius_m), axis=1)
        if free[0]:
            return goal_direction, ahead_m
        if free.any():
            beam = int(np.argmax(np.where(free[1:], to_goal, -np.inf)))
            return self._directions[beam], ahead_m
        beam = int(np.argmax(ranges_m))
        # Half-way to the return: the next ping is taken well before what this one saw.
        return self._directions[beam], min(ahead_m, 0.5 * float(ranges_m[beam]))


def goal_aligned_frame(to_goal: Vector) -> Vector:
    """Rows forward, left and up (3, 3) of the frame whose forward is horizontal to the goal.

    ``to_goal`` is (3,) m with z positive down, as everywhere; up is therefore -z.
    """
    horizontal_m = float(np.hypot(to_goal[0], to_goal[1]))
    east, north = (1.0, 0.0) if horizontal_m < 1e-9 else to_goal[:2] / horizontal_m
    return np.array([[east, north, 0.0], [-north, east, 0.0], [0.0, 0.0, -1.0]])
