"""What a picture needs to know of a world and an episode.

Protocols, so that drawing depends on no engine class: anything that answers these can be drawn.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Snapshot = Mapping[str, Any]


class World(Protocol):
    """The part of :class:`auvgym.World` a picture reads; SI, depth positive down."""

    @property
    def scenario(self) -> Any:
        """An :class:`auvgym.Scenario`."""

    @property
    def mission(self) -> int:
        """Which of the scenario's pairs of start and goal."""

    @property
    def dimensions(self) -> int:
        """2 or 3."""

    @property
    def start(self) -> Points:
        """(3,) m."""

    @property
    def goal(self) -> Points:
        """(3,) m."""

    @property
    def domain(self) -> tuple[Points, Points]:
        """Lowest and highest corner, (3,) m each."""

    @property
    def changes(self) -> int:
        """How often the map has changed."""

    @property
    def time_s(self) -> float:
        """Present time."""

    def current(self, points: Points, time_s: float | None = None) -> Points:
        """(n, 3) m -> (n, 3) m/s."""

    def clearance(self, points: Points, time_s: float | None = None) -> Points:
        """(n, 3) m -> (n,) m to the nearest solid."""

    def floor_depth(self, points_xy: Points) -> Points:
        """(n, 2) m -> (n,) m, infinite where there is no floor."""

    def snapshot(self, time_s: float | None = None) -> dict[str, Any]:
        """Plain numbers of every obstacle."""


class Episode(Protocol):
    """The part of a running episode a picture reads; positions (3,) m, trail (k, 3) m."""

    @property
    def position(self) -> Points:
        """(3,) m."""

    @property
    def heading(self) -> Points:
        """(3,) unit vector through the water."""

    @property
    def trail(self) -> Points:
        """(k, 3) m, the start and the position after each tick."""

    @property
    def waypoint(self) -> Points | None:
        """(3,) m in force, or None."""

    @property
    def time_s(self) -> float:
        """Present time."""

    @property
    def time_limit_s(self) -> float:
        """When the episode ends at the latest."""

    @property
    def energy_j(self) -> float:
        """Spent so far."""

    @property
    def energy_budget_j(self) -> float:
        """All there is to spend."""

    @property
    def path_length_m(self) -> float:
        """Flown so far."""

    @property
    def distance_since_change_m(self) -> float:
        """Flown since the map last changed."""

    @property
    def outcome(self) -> str:
        """``running``, or how it ended."""


@dataclass(frozen=True)
class Facts:
    """What stays the same for a whole episode, read once from the scenario.

    Attributes:
        name: of the scenario.
        minimum, maximum: (3,) corners of the domain, m.
        start, goal: (3,) m.
        goal_radius_m, speed_mps, tick_s, reach_m: from the scenario.
        change_every_m: path length between map changes, or None where the map never changes.
        steady, layered: whether the current stays between map changes; varies with depth.
        axis_names: of x and y.
        flat: the world has two dimensions.
    """

    name: str
    minimum: Points
    maximum: Points
    start: Points
    goal: Points
    goal_radius_m: float
    speed_mps: float
    tick_s: float
    reach_m: float
    change_every_m: float | None
    steady: bool
    layered: bool
    axis_names: tuple[str, str]
    flat: bool

    @classmethod
    def of(cls, world: World) -> Facts:
        """Read a world's facts from its scenario."""
        numbers = world.scenario.to_dict()
        currents = numbers.get("currents", [])
        minimum, maximum = (np.asarray(corner, dtype=np.float64) for corner in world.domain)
        return cls(
            name=world.scenario.name,
            minimum=minimum,
            maximum=maximum,
            start=np.asarray(world.start, dtype=np.float64),
            goal=np.asarray(world.goal, dtype=np.float64),
            goal_radius_m=float(numbers["limits"]["goal_radius_m"]),
            speed_mps=float(numbers["vehicle"]["speed_mps"]),
            tick_s=float(numbers["episode"]["tick_s"]),
            reach_m=float(numbers["episode"]["reach_m"]),
            change_every_m=float(numbers["change"]["every_m"]) if numbers.get("change") else None,
            steady=not any(_varies(current) for current in currents),
            layered=any(current.get("depth_m") for current in currents),
            axis_names=("east", "north") if numbers.get("projection") else ("across", "along"),
            flat=world.dimensions == 2,
        )

    @property
    def distance_m(self) -> float:
        """Straight line from start to goal, m."""
        return float(np.linalg.norm(self.goal - self.start))


def _varies(current: Mapping[str, Any]) -> bool:
    """Whether a current of a scenario changes with time, be it only slowly."""
    drifts = (vortex.get("drift_mps", ()) for vortex in current.get("vortices", ()))
    in_time = bool(current.get("time_s") or current.get("time_scale_s"))
    return in_time or any(any(drift) for drift in drifts)
