"""Settings and actions of re-plan mode."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from auvgym import _core, ompl
from auvgym._arrays import numbers
from auvgym._core import ActionError, PlanningError
from auvgym._names import unknown
from auvgym.scenario import parameters_json

#: How many things an action can ask for.
CHOICES = 4
#: Parts of the distance from start to goal that a short and a long window reach along the plan.
WINDOWS = (0.2, 0.5)
_ALLOWED = "must be 0 (go on), or plan anew: 1 (short window), 2 (long), 3 (to the goal)"


@dataclass(frozen=True)
class Replanning:
    """How episodes in re-plan mode are planned.

    Attributes:
        planner: who plans.
        parameters: the planner's own, as JSON.
        windows: parts of the start-goal distance that a short and a long window reach.
        planning_s: what planning takes in a short, a long and the full window, s.
        seconds_per_evaluation: what an evaluation takes instead, s; None for ``planning_s``.
    """

    planner: str
    parameters: str
    windows: tuple[float, float]
    planning_s: tuple[float, float, float]
    seconds_per_evaluation: float | None

    def source(self, source: _core.Source) -> _core.Source:
        """Episodes of ``source`` in re-plan mode.

        Raises:
            PlanningError: for a planner, parameter or value that is not allowed, or that does not
                fit these worlds.
        """
        return source.replanning(
            self.planner,
            self.parameters,
            self.windows,
            self.planning_s,
            self.seconds_per_evaluation,
        )


def replanning(
    source: _core.Source,
    usual_s: float,
    planner: str | None,
    planner_parameters: Mapping[str, Any] | None,
    windows: Sequence[float] | None,
    planning_s: float | Sequence[float] | None,
    seconds_per_evaluation: float | None,
) -> Replanning:
    """Settings from an environment's keywords; None stands for the default.

    Args:
        source: the environment's episodes.
        usual_s: what planning to the goal takes by default, s.
        planner: who plans; by default A* on the grid of the policy ``astar-replan``.
        planner_parameters: the planner's own.
        windows: how far a short and a long window reach, in parts of the start-goal distance.
        planning_s: what planning to the goal takes, s, or one number for each window.
        seconds_per_evaluation: what an evaluation takes instead, s.

    Raises:
        PlanningError: naming the keyword, its value and what was allowed.
    """
    if planner_parameters is not None and not isinstance(planner_parameters, Mapping):
        message = f"planner_parameters = {planner_parameters!r}: must be a mapping of names"
        raise PlanningError(message)
    parameters = dict(planner_parameters or {})
    if planner is None:
        planner = "astar"
        # The spacing of the policy ``astar-replan``: half as fine as the planner's own.
        parameters = {"spacing_m": _spacing_m(source), **parameters}
    if planner in ompl.PLANNERS:
        raise PlanningError(f"planner = {planner!r}: plans outside the engine, use another one")
    if planner not in _core.list_planners():
        raise PlanningError(unknown("planner", planner, _core.list_planners()))
    if planning_s is not None and seconds_per_evaluation is not None:
        raise PlanningError("seconds_per_evaluation: leave it out when planning_s is given")
    if seconds_per_evaluation is not None:
        seconds_per_evaluation = _entries("seconds_per_evaluation", seconds_per_evaluation, 1)[0]
    short, long = _entries("windows", WINDOWS if windows is None else windows, 2)
    given = usual_s if planning_s is None else planning_s
    if np.ndim(given) == 0:
        # In proportion to how far the windows reach.
        (whole,) = _entries("planning_s", given, 1)
        delays = (short * whole, long * whole, whole)
    else:
        first, second, third = _entries("planning_s", given, 3)
        delays = (first, second, third)
    try:
        json = parameters_json(parameters)
    except ValueError as error:
        raise PlanningError(f"planner_parameters: {error}") from error
    return Replanning(planner, json, (short, long), delays, seconds_per_evaluation)


def as_decision(action: Any) -> np.ndarray[Any, np.dtype[np.float32]]:
    """An action of re-plan mode as the engine takes it, (1,) float32.

    A number of any kind that is 0, 1, 2 or 3, alone or as the one entry of an array: action logs
    keep them so.

    Raises:
        ActionError: if it is none.
    """
    try:
        array = np.asarray(action)
    except (TypeError, ValueError) as error:
        raise ActionError(f"action = {action!r}: {_ALLOWED}") from error
    if array.dtype.kind not in "iuf" or array.size != 1:
        raise ActionError(f"action = {action!r}: {_ALLOWED}")
    return np.ascontiguousarray(array.reshape(1), dtype=np.float32)


def _spacing_m(source: _core.Source) -> float:
    world = source.episode(0).world
    low, high = world.domain
    return float((high - low).max() / (80 if world.dimensions == 2 else 40))


def _entries(name: str, values: Any, count: int) -> list[float]:
    try:
        array = numbers(name, values).reshape(-1)
    except ValueError as error:
        raise PlanningError(str(error)) from error
    if len(array) != count or not np.isfinite(array).all():
        raise PlanningError(f"{name} = {values!r}: must be {count} finite number(s)")
    return [float(value) for value in array]
