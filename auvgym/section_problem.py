"""A section problem for any optimiser: a box of numbers and a cost."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from auvgym import _core
from auvgym._arrays import numbers
from auvgym.planning import Array, _parameters, _point
from auvgym.world import World


class SectionProblem:
    """What population planners search: a path with one waypoint on each section.

    A candidate is a vector of genes: the lateral places of the inner waypoints and then, in 3-D,
    their depths, all in m. Any optimiser can search it; ``evaluate`` is what the planners' own
    evaluations are.

    Args:
        world: the world as it is now.
        start: (3,) m; the mission's start if None.
        goal: (3,) m; the mission's goal if None.
        cost: "lfhh", "afhh", "time" or "energy".
        **options: readings of the cost, see ``docs/planners.md``.

    Attributes:
        low, high: bounds of the genes, (d,) float64, m.

    Raises:
        PlanningError: for a place, a cost or an option that is not allowed, naming it.
    """

    def __init__(
        self,
        world: World,
        *,
        start: npt.ArrayLike | None = None,
        goal: npt.ArrayLike | None = None,
        cost: str = "lfhh",
        **options: Any,
    ) -> None:
        self._core = _core.SectionProblem(
            world._core,
            None if start is None else _point("start", start),
            None if goal is None else _point("goal", goal),
            cost,
            _parameters(options),
        )
        self.low: Array = self._core.low
        self.high: Array = self._core.high

    def evaluate(self, genes: npt.ArrayLike) -> Array:
        """Total cost of each candidate, (n,) float64, without the GIL.

        Args:
            genes: (n, d), or (d,) for one candidate.

        Raises:
            ValueError: for another shape, or an entry that is not finite.
        """
        return self._core.evaluate(np.atleast_2d(numbers("genes", genes)))

    def path(self, genes: npt.ArrayLike) -> Array:
        """Start, waypoints and goal of one candidate (d,): (d' + 2, 3) float64, m.

        Raises:
            ValueError: for another shape.
        """
        return self._core.path(np.ascontiguousarray(numbers("genes", genes)))
