"""A flight among moving threats under the navigator's law of motion, as in the IIFDS paper."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

import auvgym
from auvgym.navigation import navigator

Array = NDArray[np.float64]
#: The paper's time between points, s.
_TICK_S = 6.0
_KEYS = ("position_m", "radius_m", "velocity_mps")
#: Looks at the truth in a tick.
_LOOKS = 4
#: A flight this many times as long as the straight one is lost.
_LONGEST = 3.0


def fly_among_threats(world: auvgym.World, **parameters: Any) -> dict[str, float]:
    """Fly from start to goal; every threat is measured exactly at every tick.

    Args:
        world: moved on in time; the spheres that move in it, one at least, are threats.
        **parameters: the navigator's.

    Returns:
        Measures: see :data:`auvgym.reproduction.measures.MEASURES`.

    Raises:
        PlanningError: for a wrong parameter.
    """
    pilot = navigator(world, **parameters)
    speed = float(world.scenario.to_dict()["vehicle"]["speed_mps"])
    longest_s = _LONGEST * float(np.linalg.norm(world.goal - world.start)) / speed
    here, time_s, seconds, steps, hits = world.start, 0.0, 0.0, 0, 0
    length, gap = 0.0, np.inf
    while time_s < longest_s and not np.array_equal(here, world.goal):
        x, y, z = here.tolist()
        centres, radii, velocities = _threats(world)
        seen = [(place[0], place[1], place[2]) for place in centres.tolist()]
        began = time.perf_counter()
        for place, radius in zip(seen, radii, strict=True):
            pilot.see(place, radius, time_s)
        _, there = pilot.course((x, y, z), time_s, _TICK_S)
        seconds += time.perf_counter() - began
        for part in np.linspace(0.0, 1.0, _LOOKS + 1):
            point = here + part * (there - here)
            world.time_s = time_s + part * _TICK_S
            hits += int(world.clearance(point)[0] <= 0.0)
            places = centres + part * _TICK_S * velocities
            gap = min(gap, float(np.min(np.linalg.norm(point - places, axis=1) - radii)))
        length += float(np.linalg.norm(there - here))
        here, time_s, steps = there, time_s + _TICK_S, steps + 1
    return {
        "length_km": length / 1e3,
        "threat_km": gap / 1e3,
        "hits": float(hits),
        "reached": float(np.array_equal(here, world.goal)),
        "step_us": 1e6 * seconds / max(steps, 1),
    }


def _threats(world: auvgym.World) -> tuple[Array, Array, Array]:
    """Centres (n, 3) m, radii (n,) m and velocities (n, 3) m/s of the spheres that move."""
    moving = [one for one in world.snapshot()["obstacles"] if any(one["velocity_mps"])]
    rows = [np.array([one[key] for one in moving]) for key in _KEYS]
    return rows[0], rows[1], rows[2]
