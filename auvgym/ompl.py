"""OMPL's planners on auvgym's worlds: judges from outside.

``auvgym.plan(world, "ompl:rrtstar")`` lets a planner of the Open Motion Planning Library search the
same box, with the same solids (:meth:`auvgym.World.clearance`), for the shortest free path. Needs
the extra ``ompl``.
"""

from __future__ import annotations

import math
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from auvgym._core import PlanningError
from auvgym._extras import require
from auvgym._names import unknown

if TYPE_CHECKING:
    from auvgym.planning import Plan
    from auvgym.world import World

Array = npt.NDArray[np.float64]

#: Planner name -> OMPL's class.
PLANNERS = {
    "ompl:rrtstar": "RRTstar",
    "ompl:prmstar": "PRMstar",
    "ompl:bitstar": "BITstar",
    "ompl:informedrrtstar": "InformedRRTstar",
}
DEFAULT_EVALUATIONS = 20_000
# A walk along a segment takes no shorter steps than this part of its length.
_SHORTEST_STEP = 1e-3
_PARAMETERS = ("max_evaluations", "margin_m", "cost", "cost_options")


def plan(
    world: World, planner: str, start: Array, goal: Array, seed: int = 0, **parameters: Any
) -> Plan:
    """Search a free path with one of OMPL's planners.

    Args:
        world: the world as it is now.
        planner: one of :data:`PLANNERS`.
        start: (3,) m.
        goal: (3,) m.
        seed: of OMPL's random numbers, which are one sequence for the whole process: plans of two
            threads at once are not repeatable.
        **parameters: ``max_evaluations``, the clearance queries that may be spent (default
            20 000); ``margin_m``, the clearance to keep (default 0); ``cost`` and
            ``cost_options``, by which the path is judged, not searched.

    Returns:
        The plan; ``evaluations`` counts clearance queries, ``history`` its best length so far in
        metres against them.

    Raises:
        PlanningError: an unknown parameter or a value that is not allowed.
        ImportError: OMPL is not installed.
        KeyboardInterrupt: on Ctrl-C.
    """
    budget, margin, cost, options = _read(planner, parameters)
    require("ompl", "ompl")
    search = _Search(world, start, goal, margin, budget)
    waypoints, feasible = search.run(PLANNERS[planner], seed)
    return search.plan(planner, waypoints, feasible, cost, options)


class _Search:
    """One question to OMPL: the space, its validity, and what was spent."""

    def __init__(self, world: World, start: Array, goal: Array, margin: float, budget: int) -> None:
        self.world, self.start, self.goal = world, start, goal
        self.axes = world.dimensions
        self.budget, self.evaluations = budget, 0
        self.history: list[tuple[float, float]] = []
        self._point = np.array([start], dtype=np.float64)
        self._condition: Any = None
        # Start and goal may lie nearer to solids than the margin; the way there may, too.
        ends = min(self._clearance(start), self._clearance(goal))
        self.margin = min(margin, 0.9 * ends) if ends > 0 else 0.0
        self.free_ends = ends > 0

    def _clearance(self, place: Array) -> float:
        self.evaluations += 1
        self._point[0] = place
        return float(self.world.clearance(self._point)[0])

    def _spent(self) -> bool:
        spent = self.evaluations >= self.budget
        if spent and self._condition is not None:
            self._condition.terminate()
        return spent

    def is_free(self, place: Array) -> bool:
        """Whether a place, (3,) m, keeps the margin; nothing does once the budget is spent."""
        return not self._spent() and self._clearance(place) > self.margin

    def is_free_between(self, a: Array, b: Array) -> bool:
        """Whether a segment keeps the margin, walking by clearances."""
        length = float(np.linalg.norm(b - a))
        if length == 0.0:
            return self.is_free(a)
        walked = 0.0
        while not self._spent():
            free = self._clearance(a + (walked / length) * (b - a)) - self.margin
            if free <= 0.0:
                return False
            if walked >= length:
                return True
            walked = min(walked + max(free, _SHORTEST_STEP * length), length)
        return False

    def run(self, name: str, seed: int) -> tuple[Array, bool]:
        """The best path found, (n, 3) m, and whether it arrives."""
        from ompl import base, geometric, util

        direct = np.array([self.start, self.goal])
        if not self.free_ends or self._spent():
            return direct, False
        util.setLogLevel(util.LOG_NONE)
        # Planners made from here on draw from this seed; 0 would mean the clock.
        util.RNG.setSeed(seed % (2**31 - 1) + 1)
        space, validator = self._space(base), _motion_validator(base)
        information = base.SpaceInformation(space)
        information.setStateValidityChecker(lambda state: self.is_free(self._place(state)))
        motions = validator(information, self)
        information.setMotionValidator(motions)
        information.setup()
        problem = base.ProblemDefinition(information)
        problem.setStartAndGoalStates(
            self._state(information, self.start), self._state(information, self.goal)
        )
        problem.setOptimizationObjective(base.PathLengthOptimizationObjective(information))
        planner = getattr(geometric, name)(information)
        planner.setProblemDefinition(problem)
        planner.setup()
        # Not a condition in Python: PRM* asks from a thread of its own, which would wait for ours.
        self._condition = base.plannerNonTerminatingCondition()
        with self._interrupts_between():
            planner.solve(self._condition)
        if name == "PRMstar":
            waypoints = self._through_roadmap(base, information, planner)
        elif problem.hasExactSolution():
            waypoints = np.array([self._place(s) for s in problem.getSolutionPath().getStates()])
        else:
            waypoints = None
        if waypoints is None:
            return direct, False
        waypoints[0], waypoints[-1] = self.start, self.goal
        return waypoints, True

    @contextmanager
    def _interrupts_between(self) -> Iterator[None]:
        """Let Ctrl-C end the search first: an exception through OMPL's threads ends the process."""
        if threading.current_thread() is not threading.main_thread():
            yield
            return
        stopped = False

        def stop(*_: Any) -> None:
            nonlocal stopped
            stopped = True
            self.budget = 0

        before = signal.signal(signal.SIGINT, stop)
        try:
            yield
        finally:
            signal.signal(signal.SIGINT, before)
        if stopped:
            raise KeyboardInterrupt

    def _through_roadmap(self, base: Any, information: Any, planner: Any) -> Array | None:
        """The shortest way through PRM*'s roadmap.

        OMPL looks for it in a second thread whose progress depends on the machine.
        """
        csgraph = require("scipy.sparse.csgraph", "ompl")
        sparse = require("scipy.sparse", "ompl")
        data = base.PlannerData(information)
        planner.getPlannerData(data)
        count = data.numVertices()
        places = np.array([self._place(data.getVertex(i).getState()) for i in range(count)])
        edges = [(i, j) for i in range(count) for j in data.getEdges(i)]
        pairs = np.array(edges, dtype=np.intp).reshape(-1, 2)
        lengths = np.linalg.norm(places[pairs[:, 0]] - places[pairs[:, 1]], axis=1)
        roadmap = sparse.csr_array((lengths, (pairs[:, 0], pairs[:, 1])), shape=(count, count))
        start, goal = data.getStartIndex(0), data.getGoalIndex(0)
        distance, before = csgraph.dijkstra(
            roadmap, directed=False, indices=start, return_predecessors=True
        )
        if not np.isfinite(distance[goal]):
            return None
        way = [goal]
        while way[-1] != start:
            way.append(before[way[-1]])
        return places[way[::-1]]

    def plan(
        self, planner: str, waypoints: Array, feasible: bool, cost: str, options: dict[str, Any]
    ) -> Plan:
        """The path as a plan, judged by ``cost``."""
        from auvgym.planning import Plan, path_cost

        length = float(np.linalg.norm(np.diff(waypoints, axis=0), axis=1).sum())
        best = length if feasible else math.inf
        return Plan(
            planner=planner,
            waypoints=waypoints,
            feasible=feasible,
            cost=path_cost(self.world, waypoints, cost, **options),
            evaluations=self.evaluations,
            history=np.array([[float(self.evaluations), best]]),
        )

    def _space(self, base: Any) -> Any:
        low, high = self.world.domain
        bounds = base.RealVectorBounds(self.axes)
        for axis in range(self.axes):
            # Real missions may begin in the domain's margin.
            ends = (self.start[axis], self.goal[axis])
            bounds.setLow(axis, float(min(low[axis], *ends)))
            bounds.setHigh(axis, float(max(high[axis], *ends)))
        space = base.RealVectorStateSpace(self.axes)
        space.setBounds(bounds)
        return space

    def _place(self, state: Any) -> Array:
        place: Array = self.start.copy()
        for axis in range(self.axes):
            place[axis] = state[axis]
        return place

    def _state(self, information: Any, place: Array) -> Any:
        state = information.allocState()
        for axis in range(self.axes):
            state[axis] = float(place[axis])
        return state


def _motion_validator(base: Any) -> Callable[[Any, _Search], Any]:
    """A class for OMPL; made late, because its base class is OMPL's."""

    class WalkingValidator(base.MotionValidator):  # type: ignore[misc]
        """Walks by clearances where OMPL would sample."""

        def __init__(self, information: Any, search: _Search) -> None:
            super().__init__(information)
            self.search = search

        def checkMotion(self, a: Any, b: Any, *_: Any) -> bool:  # noqa: N802
            place = self.search._place
            return self.search.is_free_between(place(a), place(b))

    return WalkingValidator


def _read(planner: str, parameters: dict[str, Any]) -> tuple[int, float, str, dict[str, Any]]:
    for name in parameters:
        if name not in _PARAMETERS:
            raise PlanningError(f"{planner}: {unknown('parameter', name, list(_PARAMETERS))}")
    budget = parameters.get("max_evaluations", DEFAULT_EVALUATIONS)
    if isinstance(budget, bool) or not isinstance(budget, int) or budget < 1:
        raise PlanningError(f"max_evaluations = {budget!r}: must be an integer, 1 or more")
    margin = parameters.get("margin_m", 0.0)
    if not isinstance(margin, (int, float)) or not 0.0 <= margin <= 1e9:
        raise PlanningError(f"margin_m = {margin!r}: must lie in 0 .. 1e9")
    return budget, float(margin), parameters.get("cost", "lfhh"), parameters.get("cost_options", {})
