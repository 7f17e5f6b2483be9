"""A plan in a harbour, measured against the exact optimum: what the cards of RMPSO show."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

import auvgym
from auvgym import harbors
from auvgym.reproduction.raster_astar import raster_astar

Array = NDArray[np.float64]
#: A run has arrived where it is within this of what it ends with, or of the exact optimum.
_NEAR = 1.01
#: Paths are looked at this often, m.
_SPACING_M = 0.1


def plan_in_harbor(
    world: auvgym.World, planner: str, seed: int, parameters: dict[str, Any]
) -> tuple[auvgym.Plan, dict[str, float]]:
    """Plan once, and measure the path.

    Args:
        world: a harbour.
        planner: a planner's name, or "raster-astar".
        seed: of the planner.
        parameters: the planner's own.

    Returns:
        The plan, and its measures: see :data:`auvgym.reproduction.measures.MEASURES`.
    """
    plan = harbor_plan(world, planner, seed, parameters)
    zones = parameters.get("zones", {})
    best = auvgym.plan(world, "visibility", zones=zones)
    shortest = length_m(best.waypoints)
    length = length_m(plan.waypoints)
    time, least_time = (travel_time_s(world, path) for path in (plan.waypoints, best.waypoints))
    points = resampled(plan.waypoints)
    measures = {
        "length_m": length,
        "gap_percent": 100.0 * (length / shortest - 1.0),
        "time_s": time,
        "time_loss_percent": 100.0 * (time / least_time - 1.0),
        "inside_m": inside_m(auvgym.maklink(world, **zones), points, length),
        "clearance_m": float(world.clearance(points).min()),
        "turn_deg": sharpest_turn_deg(plan.waypoints),
        "free": float(plan.feasible),
        **progress(plan, shortest),
    }
    # The exact answers agree to a ten millionth of a metre: what is beyond is noise.
    return plan, {name: round(value, 5) + 0.0 for name, value in measures.items()}


def harbor_plan(
    world: auvgym.World, planner: str, seed: int, parameters: dict[str, Any]
) -> auvgym.Plan:
    """A plan of any planner or of A* on a raster, as the cards name them."""
    if planner not in harbors.PLANNERS:
        # Common to all columns of a card, and nothing to those that know no zones.
        parameters = {key: one for key, one in parameters.items() if key != "zones"}
    if planner != "raster-astar":
        return auvgym.plan(world, planner, seed=seed, **parameters)
    path = raster_astar(world, **parameters)
    cost = auvgym.path_cost(world, path, collision="segment")
    return auvgym.Plan(planner, path, cost["block"] == 0.0, cost, 0, np.empty((0, 2)))


def progress(plan: auvgym.Plan, shortest_m: float) -> dict[str, float]:
    """How fast a swarm came near its own end and the exact optimum; F counts half a metre."""
    if plan.harbor is None or len(plan.harbor.trace) < 2:
        fitness = 0.5 * length_m(plan.waypoints)
        return {"iteration": 0.0, "evaluations_1": float(plan.evaluations), "fitness": fitness}
    spent, best = plan.harbor.trace.T
    own = int(np.argmax(best <= _NEAR * best[-1]))
    near = np.flatnonzero(2.0 * best <= _NEAR * shortest_m)
    return {
        # The first of a trace is the swarm as it was drawn, before any iteration.
        "iteration": float(own),
        "evaluations_1": float(spent[near[0]] if len(near) else plan.evaluations),
        "fitness": float(best[-1]),
    }


def length_m(path: Array) -> float:
    """Length of a path, m."""
    return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())


def travel_time_s(world: auvgym.World, path: Array) -> float:
    """Time to follow a path through the current, s (velocity synthesis, eq. 9)."""
    return auvgym.path_cost(world, path, cost="time")["time_s"]


def resampled(path: Array) -> Array:
    """Points every tenth of a metre along a path, (n, 3) m."""
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    places = np.linspace(0.0, along[-1], max(int(along[-1] / _SPACING_M), 1) + 1)
    return np.column_stack([np.interp(places, along, path[:, axis]) for axis in range(3)])


def inside_m(chart: auvgym.Maklink, points: Array, length: float) -> float:
    """Way inside danger zones, m, of a path of that length seen at evenly spaced points."""
    inside = np.zeros(len(points), dtype=bool)
    for ring in chart.zones:
        edges = np.roll(ring, -1, axis=0) - ring
        offsets = points[:, None, :2] - ring[None]
        left = edges[:, 0] * offsets[:, :, 1] - edges[:, 1] * offsets[:, :, 0]
        inside |= np.all(left > 1e-6 * np.linalg.norm(edges, axis=1), axis=1)
    return float(inside.mean()) * length


def sharpest_turn_deg(path: Array) -> float:
    """The sharpest change of direction along a path, degrees."""
    steps = np.diff(path, axis=0)
    steps = steps[np.linalg.norm(steps, axis=1) > 1e-9]
    steps /= np.linalg.norm(steps, axis=1)[:, None]
    cosines = np.sum(steps[1:] * steps[:-1], axis=1)
    return float(np.rad2deg(np.arccos(np.clip(cosines, -1.0, 1.0)).max(initial=0.0)))
