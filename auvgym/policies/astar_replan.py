"""``astar-replan``: the fastest way through the present map, worked out anew at each change."""

from __future__ import annotations

from typing import Any

from auvgym import _core
from auvgym.policies.base import Action, Knows, Observation, ScriptedPolicy


class AstarReplanPolicy(ScriptedPolicy):
    """Follows a field of travel times to the goal on the present snapshot of the world.

    The field is Dijkstra's from the goal over a grid, with the time that each edge takes in the
    current (ground speed along it: V_par + sqrt(V^2 - V_perp^2)). Each leg goes to the grid node
    in reach that minimises the leg's time plus the time left from there.

    Args:
        seed: unused; every policy takes one.
        spacing_m: the grid's spacing, m; None lets the engine choose it for the world.
        inflation_m: how far the grid keeps from everything solid, m; None takes the scenario's
            margin of waypoints.
    """

    name = "astar-replan"
    knows: Knows = "map"
    description = "time-optimal on the present map, re-planned at each change"

    def __init__(
        self, seed: int = 0, spacing_m: float | None = None, inflation_m: float | None = None
    ) -> None:
        super().__init__(seed)
        self.spacing_m = spacing_m
        self.inflation_m = inflation_m

    def reset(self, env: Any) -> None:
        """Build the field of the first map."""
        super().reset(env)
        self._reach_m = float(self.env.world.scenario.to_dict()["episode"]["reach_m"])
        self._changes = 0
        self._build(replans=0)

    def act(self, observation: Observation, info: dict[str, Any]) -> Action:
        """The action towards the best node in reach, (d,) float32."""
        if info["map_changes"] != self._changes:
            self._changes = info["map_changes"]
            self._build(replans=1)
        with self.planning():
            x, y, z = self.position
            waypoint = self._field.best_waypoint(self.env.episode.world, (x, y, z), self._reach_m)
        # No node is in free reach (the current swept the vehicle up to something): go straight.
        return self.steer_to(self.goal if waypoint is None else waypoint)

    def _build(self, replans: int) -> None:
        with self.planning():
            self._field = _core.TimeField(
                self.env.episode.world, spacing_m=self.spacing_m, inflation_m=self.inflation_m
            )
        self.count(self._field.evaluations, replans)
