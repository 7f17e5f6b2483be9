"""Any planner of the engine as a policy: plan, follow, plan again when the map changes."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np

import auvgym
from auvgym.planning import is_harbor
from auvgym.policies.base import (
    Action,
    Knows,
    Observation,
    PolicyError,
    ScriptedPolicy,
    Vector,
)

_POOL = {
    "schema": 1,
    "name": "pool",
    "dimensions": 2,
    "domain": {"min_m": [0.0, 0.0, 0.0], "max_m": [1.0, 1.0, 0.0], "margin_m": 0.0},
    "missions": [{"start_m": [0.5, 0.0, 0.0], "goal_m": [0.5, 1.0, 0.0]}],
    "limits": {"goal_radius_m": 0.1},
}


class PlannerPolicy(ScriptedPolicy):
    """Plans at the start, follows the waypoints, and re-plans within a window at each map change.

    Args:
        planner: one of ``auvgym.list_planners()``.
        seed: seed of the planner's random stream.
        window: how many sections ahead a re-plan looks at first; it grows while no feasible path
            is found (LFHH's planning window).
        replan_every_s: plan anew also when the last plan is so many seconds old, for worlds in
            which things move; a plan that finds no way is then not taken. None: at changes alone.
        **parameters: the planner's own, passed on to every plan.

    Raises:
        PlanningError: an unknown planner or parameter, or a value that is not allowed.
    """

    knows: Knows = "map"

    def __init__(
        self,
        planner: str = "lfhh",
        seed: int = 0,
        window: int = 20,
        replan_every_s: float | None = None,
        **parameters: Any,
    ) -> None:
        super().__init__(seed)
        self.name = planner
        self.description = f"plans with {planner}, re-plans within a window at each change"
        self.planner = planner
        self.window = window
        if replan_every_s is not None and not replan_every_s > 0.0:
            message = f"replan_every_s = {replan_every_s!r}: must be None or above 0, s"
            raise PolicyError(message)
        self.replan_every_s = replan_every_s
        self.parameters = parameters
        if parameters:
            # The planner alone knows its parameters: a plan of one evaluation asks it now, not
            # in the middle of a run. The pool is so small that no grid in it is large, however
            # fine the environment's own may be.
            trial = {**parameters, "max_evaluations": 1}
            auvgym.plan(auvgym.World(auvgym.Scenario.from_dict(_POOL)), planner, **trial)

    def reset(self, env: Any) -> None:
        """Plan from the start to the goal on the first map."""
        super().reset(env)
        scenario = self.env.world.scenario.to_dict()
        self._capture_m = float(scenario["episode"]["capture_radius_m"])
        self._speed_mps = float(scenario["vehicle"]["speed_mps"])
        self._changes, self._next, self._planned_s = 0, 1, 0.0
        with self.planning():
            plan = auvgym.plan(self.env.world, self.planner, seed=self.seed, **self.parameters)
        self._first = (self.env.world, plan)
        self._follow(plan, replans=0)

    def gap(self) -> float | None:
        """What the episode's first plan costs above the exact optimum, see :func:`auvgym.gap`.

        In harbours that is length, m. None if the plan breaks a constraint, or there is no way.
        Asked after the episode: it is no part of planning.
        """
        world, plan = self._first
        if "cost" not in self.parameters and is_harbor(world):
            zones = dict(self.parameters.get("zones", {}))
            gap = auvgym.gap(world, plan, "length", **zones) if plan.feasible else np.inf
            return float(gap) if np.isfinite(gap) else None
        if not plan.cost["feasible"]:
            return None
        cost = str(self.parameters.get("cost", "lfhh"))
        options = dict(self.parameters.get("cost_options", {}))
        return auvgym.gap(world, plan, cost, **options)

    def act(self, observation: Observation, info: dict[str, Any]) -> Action:
        """The action towards the next waypoint of the plan, (d,) float32."""
        position = self.position
        if info["map_changes"] != self._changes:
            self._changes = info["map_changes"]
            self._replan(position, info["time_s"])
        elif self.replan_every_s is not None and (
            info["time_s"] - self._planned_s >= self.replan_every_s
        ):
            self._replan(position, info["time_s"], take="feasible")
        self._next = next_waypoint(self._waypoints, self._next, position, self._capture_m)
        return self.steer_to(self._aim())

    def _aim(self) -> Vector:
        """Where to steer for the next waypoint, (3,) m.

        A leg ends a capture radius before the point it steers to. Aiming that much beyond the
        waypoint ends it on the path instead of cutting the corner, where the planner left no room.
        """
        if self.replan_every_s is None:
            return self._aim_at_waypoint()
        # No leg may outlast the plan.
        offset = self._aim_at_waypoint() - self.position
        ahead_m = self._capture_m + self._speed_mps * self.replan_every_s
        aim: Vector = self.position + offset * min(
            1.0, ahead_m / max(float(np.linalg.norm(offset)), 1e-9)
        )
        return aim

    def _aim_at_waypoint(self) -> Vector:
        waypoint: Vector = self._waypoints[self._next]
        if self._next == len(self._waypoints) - 1:
            return waypoint
        leading = waypoint - self._waypoints[self._next - 1]
        beyond: Vector = self._capture_m * leading / max(float(np.linalg.norm(leading)), 1e-9)
        return waypoint + beyond

    def _replan(
        self, position: Vector, time_s: float, take: Literal["any", "feasible"] = "any"
    ) -> None:
        self._planned_s = time_s
        with self.planning():
            plan = auvgym.replan(
                self.env.world,
                self._waypoints,
                position,
                self.planner,
                # A new stream for each re-plan: a planner must not repeat an unlucky draw.
                seed=self.seed + self.replans + 1,
                window=self.window,
                **self.parameters,
            )
        if plan.feasible or take == "any":
            self._follow(plan, replans=1)
        else:
            self.count(plan.evaluations, replans=1)

    def _follow(self, plan: Any, replans: int) -> None:
        self.count(plan.evaluations, replans)
        self._waypoints: Vector = np.asarray(plan.waypoints, dtype=np.float64)
        self._next = 1
        self.env.plan = self._waypoints


def next_waypoint(waypoints_m: Vector, index: int, position_m: Vector, capture_m: float) -> int:
    """The first waypoint from ``index`` on that is neither reached nor passed.

    A waypoint (row of (n, 3) m) is passed once the vehicle crosses the plane through it that
    stands across the segment leading to it: a vehicle that the current carried beside its path
    goes on instead of turning back. The last one is never given up.
    """
    last = len(waypoints_m) - 1
    index = min(max(index, 1), last)
    while index < last:
        waypoint, leading = waypoints_m[index], waypoints_m[index] - waypoints_m[index - 1]
        reached = np.linalg.norm(position_m - waypoint) <= capture_m
        passed = float((position_m - waypoint) @ leading) >= 0.0
        if not (reached or passed):
            break
        index += 1
    return index
