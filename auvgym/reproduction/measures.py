"""What is measured of a path, beside its cost."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

import auvgym

Array = NDArray[np.float64]

#: Name -> what it is, in words.
MEASURES = {
    "length_km": "Length (km)",
    "angle_rad": "Mean angle to the current (rad)",
    "objective": "A = eta1 A1 + eta2 A2",
    "lambda": "lambda, the share of the way to the goal in the flow",
    "time_s": "Travel time (s) of a vehicle that crabs along the path",
    "clearance_km": "Least clearance (km), at least; negative inside",
    "threat_km": "Least distance to a threat's surface (km); negative inside",
    "hits": "Points of the path inside something solid",
    "turn_deg": "Sharpest turn (degrees)",
    "reached": "Share that arrived",
    "evaluations": "Evaluations",
    "length_m": "Length (m)",
    "gap_percent": "Length above the exact optimum (%)",
    "iteration": "First iteration within 1 % of its own end",
    "evaluations_1": "Evaluations until within 1 % of the exact optimum; all if never",
    "fitness": "F, as the planner minimises it",
    "time_loss_percent": "Travel time above the fastest (%)",
    "inside_m": "Way inside danger zones (m)",
    "clearance_m": "Least clearance to polygons (m); negative inside",
    "free": "Share of free paths",
    "step_us": "Time of a step (microseconds, median)",
}
#: Paths are looked at this often, m.
_SPACING_M = 10.0
_KM = 1e3


def of_path(world: auvgym.World, path: Array, objective: dict[str, Any]) -> dict[str, float]:
    """Measures of a path (n, 3) m through a world as it is now.

    Args:
        world: the world.
        path: start, waypoints, goal.
        objective: weights ``eta1`` and ``eta2`` of length (km) and mean angle (rad).
    """
    steps = np.diff(path, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    directions = steps[lengths > 0.0] / lengths[lengths > 0.0, None]
    clearances = world.clearance(_resampled(path, lengths))
    cosines = np.sum(directions[1:] * directions[:-1], axis=1)
    sharpest = np.arccos(np.clip(cosines, -1.0, 1.0)).max(initial=0.0)
    return {
        **flow_terms(world, path, objective),
        "time_s": auvgym.path_cost(world, path, cost="time")["time_s"],
        "clearance_km": float(clearances.min()) / _KM,
        "hits": float(np.count_nonzero(clearances <= 0.0)),
        "turn_deg": float(np.rad2deg(sharpest)),
    }


def flow_terms(world: auvgym.World, path: Array, objective: dict[str, Any]) -> dict[str, float]:
    """Eq. 20-22: length, mean angle to the current (to still water a right one), and the sum."""
    steps = np.diff(path, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    moved = lengths > 0.0
    current = world.current(0.5 * (path[1:] + path[:-1])[moved])
    product = lengths[moved] * np.linalg.norm(current, axis=1)
    cosines = np.zeros(len(product))
    along = np.sum(current * steps[moved], axis=1)
    np.divide(along, product, out=cosines, where=product > 0.0)
    length_km = float(lengths.sum()) / _KM
    angle = float(np.mean(np.arccos(np.clip(cosines, -1.0, 1.0))))
    total = objective.get("eta1", 1.0) * length_km + objective.get("eta2", 20.0) * angle
    return {"length_km": length_km, "angle_rad": angle, "objective": total}


def _resampled(path: Array, lengths: Array) -> Array:
    along = np.concatenate([[0.0], np.cumsum(lengths)])
    places = np.linspace(0.0, along[-1], max(int(along[-1] / _SPACING_M), 1) + 1)
    return np.column_stack([np.interp(places, along, path[:, axis]) for axis in range(3)])
