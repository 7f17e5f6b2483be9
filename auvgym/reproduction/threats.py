"""A flight among moving threats under the navigator's law of motion, as in the IIFDS paper."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import auvgym
from auvgym.navigation import navigator

Array = NDArray[np.float64]
#: The paper's time between points, s.
_TICK_S = 6.0
#: Looks at the truth in a tick.
_LOOKS = 4
#: A flight this many times as long as the straight one is lost.
_LONGEST = 3.0


@dataclass(frozen=True, eq=False)
class Flight:
    """A flight tick by tick.

    Attributes:
        time_s: (n,) s.
        track: where the vehicle was, (n, 3) m.
        threats: where the threats' centres were, (n, threats, 3) m.
        radii: theirs, (threats,) m.
        measures: see :data:`auvgym.reproduction.measures.MEASURES`.
    """

    time_s: Array
    track: Array
    threats: Array
    radii: Array
    measures: dict[str, float]


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
    return flight(world, **parameters).measures


def flight(world: auvgym.World, **parameters: Any) -> Flight:
    """The same flight with its track: as :func:`fly_among_threats`."""
    pilot = navigator(world, **parameters)
    moving = [i for i, one in enumerate(world.snapshot()["obstacles"]) if any(one["velocity_mps"])]
    radii = np.array([world.snapshot()["obstacles"][i]["radius_m"] for i in moving])
    speed = float(world.scenario.to_dict()["vehicle"]["speed_mps"])
    longest_s = _LONGEST * float(np.linalg.norm(world.goal - world.start)) / speed
    here, time_s, hits = world.start, 0.0, 0
    seconds: list[float] = []
    length, gap = 0.0, np.inf
    centres = _places(world, moving)
    times, track, threats = [time_s], [here], [centres]
    while time_s < longest_s and not np.array_equal(here, world.goal):
        x, y, z = here.tolist()
        seen = [(place[0], place[1], place[2]) for place in centres.tolist()]
        began = time.perf_counter()
        for place, radius in zip(seen, radii.tolist(), strict=True):
            pilot.see(place, radius, time_s)
        _, there = pilot.course((x, y, z), time_s, _TICK_S)
        seconds.append(time.perf_counter() - began)
        # Between two ticks threats go straight, or so nearly that it does not show.
        before = centres
        world.time_s = time_s + _TICK_S
        centres = _places(world, moving)
        for part in np.linspace(0.0, 1.0, _LOOKS + 1):
            point = here + part * (there - here)
            world.time_s = time_s + part * _TICK_S
            hits += int(world.clearance(point)[0] <= 0.0)
            places = before + part * (centres - before)
            gap = min(gap, float(np.min(np.linalg.norm(point - places, axis=1) - radii)))
        length += float(np.linalg.norm(there - here))
        here, time_s = there, time_s + _TICK_S
        times.append(time_s)
        track.append(here)
        threats.append(centres)
    measures = {
        "length_km": length / 1e3,
        "threat_km": gap / 1e3,
        "hits": float(hits),
        "reached": float(np.array_equal(here, world.goal)),
        "step_us": 1e6 * float(np.median(seconds)),
    }
    return Flight(np.array(times), np.array(track), np.array(threats), radii, measures)


def _places(world: auvgym.World, moving: list[int]) -> Array:
    """Centres (n, 3) m of the obstacles that move."""
    obstacles = world.snapshot()["obstacles"]
    return np.array([obstacles[i]["position_m"] for i in moving])
