"""Plans: from a world to waypoints, and what any path costs."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from numbers import Integral
from typing import Any

import numpy as np
import numpy.typing as npt

from auvgym import _core, ompl
from auvgym._arrays import numbers
from auvgym._names import unknown
from auvgym.scenario import check_seed, parameters_json
from auvgym.world import World

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class HarborReport:
    """What a planner in a harbour says beside its path.

    Attributes:
        gap_m: length above that of the shortest path of all round the same danger zones (planner
            ``visibility``), m; below 0 where smoothing cuts through zones. None if there is no way.
        depth_m: how deep the path gets into danger zones, m; 0 unless smoothing cuts into them.
        corners: the path before smoothing, (n, 3) float64 m.
        trace: the least value so far of what the planner minimises against evaluations, (m, 2)
            float64: of swarms and ants the cost F, generation by generation, else the length, m.
        barriers: where there is no way, the polygons whose zones part the goal from the start.
    """

    gap_m: float | None
    depth_m: float
    corners: Array = field(repr=False)
    trace: Array = field(repr=False)
    barriers: list[int]


@dataclass(frozen=True, eq=False)
class Plan:
    """What a planner found.

    Attributes:
        planner: who planned.
        waypoints: start, waypoints, goal; (n, 3) float64, m.
        feasible: whether the path is allowed everywhere; no way is an answer, not an error.
        cost: the terms of the planner's cost and their "total", as :func:`path_cost` gives them.
        evaluations: counted budget: fitness evaluations, or nodes settled by grid planners.
        history: best total cost against evaluations so far, (m, 2) float64.
        window: sections of the last planning window, where one was used.
        harbor: what planners of harbours say of the path; None from others.
        coefficients: those of the flow that drew the path (``rho``, ``sigma``, ``theta``,
            ``lambda``), chosen or tuned; empty for all but the planners ``iifds``.
    """

    planner: str
    waypoints: Array
    feasible: bool
    cost: dict[str, float]
    evaluations: int
    history: Array = field(repr=False)
    window: int | None = None
    harbor: HarborReport | None = None
    coefficients: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Phase:
    """One phase of the papers' protocol: a plan after a map change.

    Attributes:
        cost: total cost of the window's path (LFHH's F_cost).
        feasible: whether it is allowed everywhere.
        evaluations: fitness evaluations spent.
        window: sections of the window that was planned in the end.
        position: where the vehicle was, (3,) m.
    """

    cost: float
    feasible: bool
    evaluations: int
    window: int
    position: Array


def list_planners() -> list[str]:
    """Names of the planners, those of OMPL (``auvgym.ompl``) apart."""
    return list(_core.list_planners())


def plan(
    world: World,
    planner: str = "lfhh",
    *,
    start: npt.ArrayLike | None = None,
    goal: npt.ArrayLike | None = None,
    seed: int = 0,
    **parameters: Any,
) -> Plan:
    """Plan a path through a world as it is now.

    Args:
        world: the world, at its present time.
        planner: one of :func:`list_planners`, or of ``auvgym.ompl.PLANNERS``.
        start: (3,) m; the mission's start if None.
        goal: (3,) m; the mission's goal if None.
        seed: of the planner's random stream; the same seed gives the same plan.
        **parameters: the planner's own, see ``docs/planners.md``.

    Returns:
        The plan; ``plan.feasible`` says whether there is a way.

    Raises:
        PlanningError: for an unknown planner or parameter, or a start or goal that is not finite
            or outside the box, naming it, its value and what was allowed.
        KeyboardInterrupt: on Ctrl-C, within a fraction of a second.
    """
    if planner in ompl.PLANNERS:
        ends = [
            world_end if end is None else np.array(_point(name, end))
            for name, end, world_end in (("start", start, world.start), ("goal", goal, world.goal))
        ]
        return ompl.plan(world, planner, ends[0], ends[1], check_seed(seed), **parameters)
    _check_planner(planner)
    return _plan(
        _core.plan(
            world._core,
            planner,
            None if start is None else _point("start", start),
            None if goal is None else _point("goal", goal),
            check_seed(seed),
            _parameters(parameters),
        )
    )


def gap(world: World, path: Plan | npt.ArrayLike, cost: str | None = None, **options: Any) -> float:
    """What a path costs above the exact reference of the same problem.

    In a harbour (a 2-D world with polygons) that is length, m, above the shortest path round the
    danger zones, planner ``visibility``; elsewhere a cost above planner ``section-optimum``.

    Args:
        world: the world as it was when the path was planned.
        path: a plan, or waypoints (n, 3) m.
        cost: "length", or as for :func:`path_cost`; None is "length" in harbours, else "lfhh".
        **options: readings of the cost; of "length" those of danger zones, see :func:`maklink`.

    Returns:
        The difference of the totals. Near 0 for the best section plans; below 0 where waypoints
        lie better between the reference's places, or off the sections, or in danger zones.
        Infinite if zones leave no way.

    Raises:
        PlanningError, KeyboardInterrupt: as :func:`plan`; "length" only in worlds that have zones.
    """
    waypoints = path.waypoints if isinstance(path, Plan) else _path("path", path)
    start, goal = waypoints[0], waypoints[-1]
    if cost is None:
        cost = "length" if is_harbor(world) else "lfhh"
    if cost == "length":
        total = _length_m(waypoints)
    else:
        total = path_cost(world, waypoints, cost, **options)["total"]
    key = (
        world.scenario.hash, world.seed, world.mission, world.time_s, repr(world._core.changes),
        start.tobytes(), goal.tobytes(), cost, _parameters(options),
    )  # fmt: skip
    least = _least(_Problem(key, world, start, goal, cost, options))
    return total - least if least < np.inf else np.inf


@dataclass(frozen=True)
class _Problem:
    """What a reference is asked for; equal if the key is."""

    key: tuple[Any, ...]
    world: World = field(compare=False)
    start: Array = field(compare=False)
    goal: Array = field(compare=False)
    cost: str = field(compare=False)
    options: dict[str, Any] = field(compare=False)


@lru_cache(maxsize=64)
def _least(problem: _Problem) -> float:
    """What the reference costs, or infinity: the same for every plan of a problem."""
    world, start, goal = problem.world, problem.start, problem.goal
    if problem.cost == "length":
        best = plan(world, "visibility", start=start, goal=goal, zones=problem.options)
        return _length_m(best.waypoints) if best.feasible else np.inf
    best = plan(
        world, "section-optimum", start=start, goal=goal,
        cost=problem.cost, cost_options=problem.options,
    )  # fmt: skip
    return best.cost["total"]


def is_harbor(world: World) -> bool:
    """Whether a world is a harbour: 2-D, with polygons."""
    if world.dimensions != 2:
        return False
    return any(one["kind"] == "polygon" for one in world.snapshot()["obstacles"])


def _length_m(path: Array) -> float:
    return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())


def replan(
    world: World,
    path: npt.ArrayLike,
    position: npt.ArrayLike,
    planner: str = "lfhh",
    *,
    seed: int = 0,
    window: int = 20,
    **parameters: Any,
) -> Plan:
    """Re-plan the part of a global path that lies in the planning window ahead of the vehicle.

    The window starts with ``window`` sections and grows by one until a feasible path is found or
    it reaches the goal (LFHH, section IV-E).

    Args:
        world: the world as it is now.
        path: the global path so far, (n, 3) m.
        position: where the vehicle is, (3,) m.
        planner: as for :func:`plan`; planners without sections re-plan to the goal.
        seed: of the planner's random stream.
        window: sections of the first window.
        **parameters: the planner's own.

    Returns:
        The plan; its waypoints are the new global path from the vehicle to the goal.

    Raises:
        PlanningError, KeyboardInterrupt: as :func:`plan`.
    """
    if planner in ompl.PLANNERS:
        # Planners that know no sections know no window.
        route = _path("path", path)
        return plan(world, planner, start=position, goal=route[-1], seed=seed, **parameters)
    _check_planner(planner)
    found = _core.replan(
        world._core,
        _path("path", path),
        _point("position", position),
        planner,
        check_seed(seed),
        _window(window),
        _parameters(parameters),
    )
    return _plan(found)


def path_cost(
    world: World, waypoints: npt.ArrayLike, cost: str = "lfhh", **options: Any
) -> dict[str, float]:
    """The terms of a cost for any path through a world as it is now.

    Args:
        world: the world.
        waypoints: (n, 3) m, n >= 2.
        cost: "lfhh" (its eq. 6-10: length, curvature, block, current), "afhh" (its eq. 1-5:
            length, depth, smooth, block), "time" or "energy" (through the real current).
        **options: readings of the cost, see ``docs/planners.md``.

    Returns:
        Each term by name, their "total", and "feasible" (1.0 or 0.0).

    Raises:
        PlanningError: for an unknown cost or option, or a path that is not allowed.
    """
    path = _path("waypoints", waypoints)
    return dict(_core.path_cost(world._core, path, cost, _parameters(options)))


def run_phases(
    world: World,
    planner: str = "lfhh",
    *,
    seed: int = 0,
    window: int | None = 20,
    **parameters: Any,
) -> list[Phase]:
    """LFHH's experiment: plan, travel, re-plan in a window at each change of the map.

    Args:
        world: a world whose scenario has map changes and sections; it is begun anew at time 0.
        planner: one of :func:`list_planners`.
        seed: of the planner's random streams.
        window: sections of the first window, which grows while no feasible path is found; None
            re-plans the whole rest of the path.
        **parameters: the planner's own.

    Returns:
        One phase for the first plan and one for each change; the paper reports the mean cost over
        the latter.

    Raises:
        PlanningError, KeyboardInterrupt: as :func:`plan`.
    """
    _check_planner(planner)
    window = None if window is None else _window(window)
    seed = check_seed(seed)
    phases = _core.run_phases(world._core, planner, seed, window, _parameters(parameters))
    return [Phase(*phase[:4], np.array(phase[4])) for phase in phases]


def _window(window: int) -> int:
    if isinstance(window, bool) or not isinstance(window, Integral) or window < 1:
        raise _core.PlanningError(f"window = {window!r}: must be an integer, 1 section or more")
    return int(window)


def _plan(found: _core.FoundPlan) -> Plan:
    report = None if found[7] is None else HarborReport(*found[7])
    return Plan(*found[:7], report, found[8])


def _check_planner(planner: str) -> None:
    if planner not in list_planners():
        known = [*list_planners(), *ompl.PLANNERS]
        raise _core.PlanningError(unknown("planner", planner, known))


def _parameters(parameters: dict[str, Any]) -> str:
    try:
        return parameters_json(parameters)
    except ValueError as error:
        raise _core.PlanningError(str(error)) from error


def _point(name: str, point: npt.ArrayLike) -> tuple[float, float, float]:
    array = _finite(name, point)
    if array.shape != (3,):
        raise _core.PlanningError(f"{name} = {point!r}: must be three numbers, m")
    return float(array[0]), float(array[1]), float(array[2])


def _path(name: str, path: npt.ArrayLike) -> Array:
    array = _finite(name, path)
    if array.ndim != 2 or array.shape[1] != 3 or len(array) < 2:
        raise _core.PlanningError(f"{name} has shape {array.shape}: must be (n, 3) with n >= 2")
    return array


def _finite(name: str, values: npt.ArrayLike) -> Array:
    try:
        array = numbers(name, values)
    except ValueError as error:
        raise _core.PlanningError(str(error)) from error
    wrong = np.argwhere(~np.isfinite(array))
    if len(wrong):
        entry = tuple(int(index) for index in wrong[0])
        raise _core.PlanningError(f"{name}{list(entry)} = {array[entry]}: must be finite")
    return array
