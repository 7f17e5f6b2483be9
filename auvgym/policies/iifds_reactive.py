"""``iifds-reactive``: the interfered flow as a law of motion among threats that move."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np

import auvgym
from auvgym.navigation import navigator
from auvgym.policies.base import Action, Knows, Observation, ScriptedPolicy, Vector
from auvgym.policies.sonar_rule import goal_aligned_frame

#: An exact sensor still rounds to single precision, m.
_ROUNDING_M = 1.0
#: A threat that was not seen for so many of the shortest legs is forgotten.
_LEGS_UNSEEN = 4
#: Two walls and the surface or the floor meet in a corner.
_SLIDES = 4
#: What is seen within so many deviations of something at rest on the map is that.
_DEVIATIONS = 5.0


class IifdsReactivePolicy(ScriptedPolicy):
    """Follows the flow round what is at rest on the map and round the threats that it sees.

    Each leg takes the measured places of the obstacles in the observation into a Kalman filter for
    each threat, and goes where the flow leads past the predicted ones (Yao & Zhao 2018, section V).
    A leg is as short as the scenario allows: one tick in ``AUVThreat3D-v0``. The measured
    velocities are left alone. Of the map it takes what does not move.

    Args:
        seed: unused; every policy takes one.
        rules: "recommended" (default), or "paper": the flow as printed, no margin, no barrier.
        **parameters: of the navigator, as ``docs/planners.md`` lists them; ``noise_m`` is what the
            scenario says unless given.

    Raises:
        PlanningError: an unknown parameter, or a value that is not allowed.
    """

    name = "iifds-reactive"
    knows: Knows = "map"
    description = "the interfered flow past threats as they are seen, a tick at a time"

    def __init__(
        self,
        seed: int = 0,
        rules: Literal["recommended", "paper"] = "recommended",
        **parameters: Any,
    ) -> None:
        super().__init__(seed)
        self.parameters = {"rules": rules, **parameters}
        # The engine alone knows the parameters: ask it now, not in the middle of a run.
        navigator(auvgym.World("iifds-threat1"), **self.parameters)

    def reset(self, env: Any) -> None:
        """Look at what is at rest."""
        super().reset(env)
        world = self.env.world
        low, high = world.domain
        scenario = world.scenario.to_dict()
        flight = scenario["episode"]
        self._noise_m = float(flight.get("sensor_noise_m", 0.0))
        self._range_m = float(flight["sonar_range_m"])
        self._leg_s = float(flight["minimum_leg_s"])
        # Far enough ahead that the vehicle never keeps station, near enough to be captured within
        # the shortest leg even where the current carries it off.
        flown = float(scenario["vehicle"]["speed_mps"]) * self._leg_s
        beyond = float(flight["station_radius_m"]) + flown
        self._ahead_m = min(
            max(float(flight["capture_radius_m"]) / 2, beyond), float(flight["reach_m"])
        )
        # Where the environment puts waypoints.
        margin = np.minimum(
            float(flight["waypoint_margin_m"]) * np.array([1, 0, 1]), (high - low) / 2
        )
        self._low, self._high = low + margin, high - margin
        self._block = self.env.observation_layout["obstacles"]
        self._changes = -1

    def act(self, observation: Observation, info: dict[str, Any]) -> Action:
        """The action along the flow, (d,) float32."""
        with self.planning():
            if info["map_changes"] != self._changes:
                self._changes = info["map_changes"]
                self._look_at_map()
            time_s = float(info["time_s"])
            here = self.position
            for centre, radius in self._contacts(observation, here):
                if not self._is_at_rest(centre):
                    self._navigator.see(_point(centre), radius, time_s)
            self._navigator.forget(time_s - _LEGS_UNSEEN * self._leg_s)
            velocity, _ = self._navigator.course(_point(here), time_s, self._leg_s)
        return self.steer_to(
            self._along_walls(here, velocity if np.any(velocity) else self.goal - here)
        )

    def _along_walls(self, here: Vector, direction: Vector) -> Vector:
        """A waypoint ahead in a direction, as far off where walls leave only part of it."""
        offset = direction
        for _ in range(_SLIDES):
            length = max(float(np.linalg.norm(offset)), 1e-9)
            waypoint = np.clip(here + self._ahead_m / length * offset, self._low, self._high)
            offset = waypoint - here
        return waypoint

    def _look_at_map(self) -> None:
        world = self.env.world
        told = {"noise_m": max(self._noise_m, _ROUNDING_M)}
        self._navigator = navigator(world, **{**told, **self.parameters})
        places = [
            obstacle["position_m"]
            for obstacle in world.snapshot()["obstacles"]
            if not any(obstacle["velocity_mps"])
        ]
        self._at_rest = np.asarray(places, dtype=np.float64).reshape(-1, 3)

    def _contacts(self, observation: Observation, here: Vector) -> list[tuple[Vector, float]]:
        """Measured centre (3,) m and radius, m, of each obstacle in the observation."""
        dimensions = self.env.dimensions
        frame = goal_aligned_frame(self.goal - here)[:dimensions]
        rows = observation[self._block].astype(np.float64).reshape(-1, 2 * dimensions + 1)
        # An entry of 1 was clipped: that centre lies beyond the sonar range, who knows how far.
        seen = (rows[:, dimensions] > 0.0) & np.all(np.abs(rows[:, :dimensions]) < 1.0, axis=1)
        return [
            (
                here + self._range_m * row[:dimensions] @ frame,
                self._range_m * float(row[dimensions]),
            )
            for row in rows[seen]
        ]

    def _is_at_rest(self, centre: Vector) -> bool:
        """Whether that is an obstacle of the map that does not move.

        The observation tells the depth of no obstacle that is solid from top to bottom; places on
        the map decide.
        """
        off_m = np.hypot(*(self._at_rest[:, :2] - centre[:2]).T)
        return bool(np.any(off_m <= _DEVIATIONS * self._noise_m + 1.0))


def _point(vector: Vector) -> tuple[float, float, float]:
    return float(vector[0]), float(vector[1]), float(vector[2])
