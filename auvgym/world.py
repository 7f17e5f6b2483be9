"""Worlds: one scenario at one time, asked about currents, clearance and depth."""

from __future__ import annotations

import json
import os
from numbers import Real
from typing import Any

import numpy as np
import numpy.typing as npt

from auvgym import _core
from auvgym._arrays import numbers
from auvgym.scenario import Scenario, check_seed, resolve_scenario

Array = npt.NDArray[np.float64]


class World:
    """One scenario at one time, after the map changes so far.

    A pure function of scenario, seed and the changes so far: it can be copied and pickled and
    answers the same afterwards.

    Args:
        scenario: a :class:`Scenario`, the name of a shipped one, or the path of a TOML file.
        seed: decides what map changes draw, 0 .. 2**64 - 1.
        mission: which of the scenario's start/goal pairs.

    Raises:
        ScenarioError, ValueError, OSError: if there is no such scenario or it is not allowed.
    """

    __slots__ = ("_core",)

    def __init__(
        self, scenario: Scenario | str | os.PathLike[str], seed: int = 0, mission: int = 0
    ) -> None:
        if isinstance(mission, bool) or not isinstance(mission, int) or mission < 0:
            raise ValueError(f"mission = {mission!r}: must be an integer, 0 or more")
        self._core = _core.World(resolve_scenario(scenario)._core, check_seed(seed), mission)

    @classmethod
    def _of(cls, core: _core.World) -> World:
        world = cls.__new__(cls)
        world._core = core
        return world

    @property
    def scenario(self) -> Scenario:
        """What it is made of."""
        return Scenario(self._core.scenario)

    @property
    def seed(self) -> int:
        """The seed of its map changes."""
        return self._core.seed

    @property
    def mission(self) -> int:
        """Index of the start/goal pair."""
        return self._core.mission

    @property
    def dimensions(self) -> int:
        """2 or 3."""
        return self._core.dimensions

    @property
    def start(self) -> Array:
        """Start of the mission, (3,) m."""
        return self._core.start

    @property
    def goal(self) -> Array:
        """Goal of the mission, (3,) m."""
        return self._core.goal

    @property
    def domain(self) -> tuple[Array, Array]:
        """Lowest and highest corner of the box, (3,) m each."""
        return self._core.domain

    @property
    def changes(self) -> int:
        """Number of map changes so far."""
        return len(self._core.changes)

    @property
    def time_s(self) -> float:
        """The present time, s."""
        return self._core.time_s

    @time_s.setter
    def time_s(self, value: float) -> None:
        self._core.time_s = _time(value)

    def current(self, points: npt.ArrayLike, time_s: float | None = None) -> Array:
        """Velocity of the water, (n, 3) m/s, at points (n, 3) m; its third column is zero.

        Args:
            points: (n, 3), or (3,) for one point; m.
            time_s: when, s; None for the present time.

        Raises:
            ValueError: if a point or the time is not finite, or the shape is wrong.
        """
        return self._core.current(_rows(points, 3), _maybe_time(time_s))

    def clearance(self, points: npt.ArrayLike, time_s: float | None = None) -> Array:
        """Signed distance, (n,) m, from points (n, 3) m to the nearest solid.

        Negative inside anything solid; exact for spheres and discs, never too large for other
        shapes and the sea floor.

        Raises:
            ValueError: if a point or the time is not finite, or the shape is wrong.
        """
        return self._core.clearance(_rows(points, 3), _maybe_time(time_s))

    def floor_depth(self, points: npt.ArrayLike) -> Array:
        """Depth of the sea floor, (n,) m, at points (n, 2) m; infinite where there is none.

        Raises:
            ValueError: if a point is not finite, or the shape is wrong.
        """
        return self._core.floor_depth(_rows(points, 2))

    def snapshot(self, time_s: float | None = None) -> dict[str, Any]:
        """Every obstacle, vortex and peak with its numbers at a time, as a plain dictionary."""
        numbers: dict[str, Any] = json.loads(self._core.snapshot_json(_maybe_time(time_s)))
        return numbers

    def apply_change(self, vehicle: npt.ArrayLike) -> bool:
        """Change the map as when a vehicle at (3,) m has travelled the change distance.

        Returns whether anything was left to change.

        Raises:
            ValueError: if the vehicle's place is not finite or has another shape.
        """
        place = numbers("vehicle", vehicle)
        if place.shape != (3,):
            raise ValueError(f"vehicle has shape {place.shape}: must be (3,)")
        return self._core.apply_change((float(place[0]), float(place[1]), float(place[2])))

    def __copy__(self) -> World:
        return World._of(self._core.copy())

    def __deepcopy__(self, memo: dict[int, Any]) -> World:
        return World._of(self._core.copy())

    def __reduce__(self) -> tuple[Any, ...]:
        core = self._core
        arguments = (self.scenario, core.seed, core.mission, core.changes, core.time_s)
        return _restore, arguments

    def __repr__(self) -> str:
        return (
            f"<World {self.scenario.name}: seed {self.seed}, mission {self.mission}, "
            f"{self.time_s:.0f} s, {self.changes} changes>"
        )


def _restore(
    scenario: Scenario,
    seed: int,
    mission: int,
    changes: list[tuple[float, tuple[float, float, float]]],
    time_s: float,
) -> World:
    return World._of(_core.World.restore(scenario._core, seed, mission, changes, time_s))


def _rows(points: npt.ArrayLike, width: int) -> Array:
    """Points as a contiguous (n, width) float64 array; one point becomes one row."""
    array = numbers("points", points)
    if array.ndim == 1:
        array = array[None, :]
    if array.ndim != 2 or array.shape[1] != width:
        raise ValueError(f"points have shape {np.shape(points)}: must be (n, {width})")
    return array


def _time(time_s: float) -> float:
    if isinstance(time_s, bool) or not isinstance(time_s, Real):
        raise ValueError(f"time_s = {time_s!r}: must be a number, s")
    return float(time_s)


def _maybe_time(time_s: float | None) -> float | None:
    return None if time_s is None else _time(time_s)
