"""A way among threats that move: measured places go in, the next course comes out."""

from __future__ import annotations

import numpy.typing as npt

from auvgym import _core
from auvgym._arrays import numbers
from auvgym.scenario import parameters_json
from auvgym.world import World

Navigator = _core.Navigator


def navigator(
    world: World,
    start: npt.ArrayLike | None = None,
    goal: npt.ArrayLike | None = None,
    **parameters: object,
) -> Navigator:
    """A navigator that knows what is at rest in a world, but no threat.

    ``see(position, radius_m, time_s)`` takes a measurement in, ``course(position, time_s, tick_s)``
    gives velocity over ground (3,) m/s and the waypoint that it leads to, (3,) m.

    Args:
        world: what is at rest in it now, its box and its current.
        start: (3,) m; None for the mission's.
        goal: (3,) m; None for the mission's.
        **parameters: as ``docs/planners.md`` lists them.

    Raises:
        PlanningError: naming the parameter or place, its value and what was allowed.
    """
    ends = (world.start if start is None else start, world.goal if goal is None else goal)
    (x, y, z), (a, b, c) = (numbers("place", end).tolist() for end in ends)
    return _core.Navigator(world._core, (x, y, z), (a, b, c), parameters_json(parameters))
