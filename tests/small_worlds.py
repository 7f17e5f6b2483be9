"""Small worlds for tests, and formulas of the papers in plain NumPy to hold the engine against."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import numpy.typing as npt

import auvgym

Array = npt.NDArray[np.float64]

WIDTH, LENGTH, DEPTH = 20_000.0, 20_000.0, 4_000.0


def open_water(dimensions: int = 2, **parts: Any) -> dict[str, Any]:
    """A box without anything in it, 20 x 20 (x 4) km, crossed along y; ``parts`` go on top."""
    depth = 0.0 if dimensions == 2 else 0.5 * DEPTH
    return copy.deepcopy(
        {
            "schema": 1,
            "name": "open-water",
            "dimensions": dimensions,
            "domain": {
                "min_m": [0.0, 0.0, 0.0],
                "max_m": [WIDTH, LENGTH, 0.0 if dimensions == 2 else DEPTH],
            },
            "missions": [
                {"start_m": [10_000.0, 0.0, depth], "goal_m": [10_000.0, 19_000.0, depth]}
            ],
            **parts,
        }
    )


def world(dimensions: int = 2, seed: int = 0, **parts: Any) -> auvgym.World:
    return auvgym.World(auvgym.Scenario.from_dict(open_water(dimensions, **parts)), seed=seed)


def vortices(*rows: tuple[float, float, float], core_radius_m: float = 1200.0) -> dict[str, Any]:
    """Vortices from (x, y, circulation)."""
    keys = ("x_m", "y_m", "circulation_m2ps")
    return {
        "kind": "vortices",
        "core_radius_m": core_radius_m,
        "vortices": [dict(zip(keys, row, strict=True)) for row in rows],
    }


def disc(x: float, y: float, radius: float, velocity: tuple[float, float] = (0.0, 0.0)) -> Any:
    return {
        "kind": "disc",
        "position_m": [x, y],
        "radius_m": radius,
        "velocity_mps": list(velocity),
    }


def sphere(position: Any, radius: float, velocity: Any = (0.0, 0.0, 0.0)) -> dict[str, Any]:
    return {
        "kind": "sphere",
        "position_m": list(position),
        "radius_m": radius,
        "velocity_mps": list(velocity),
    }


def wall(y: float = 9_000.0, thickness: float = 1_000.0) -> dict[str, Any]:
    """A polygon across the whole box at all depths, beyond its side walls and its bottom."""
    low, high = -2_000.0, WIDTH + 2_000.0
    corners = [[low, y], [high, y], [high, y + thickness], [low, y + thickness]]
    return {"kind": "polygon", "vertices_m": corners, "top_m": -2_000.0, "bottom_m": 9_000.0}


def answers(world: auvgym.World, count: int = 400) -> bytes:
    """What a world says about currents, clearance and floor at fixed points, bit for bit."""
    low, high = world.domain
    points = low + np.random.default_rng(0).random((count, 3)) * (high - low)
    everything = [
        world.current(points),
        world.clearance(points),
        world.floor_depth(points[:, :2]),
        world.current(points, 4321.0),
        world.clearance(points, 4321.0),
    ]
    return b"".join(array.tobytes() for array in everything)


def lamb_oseen(points: Array, x: float, y: float, eta: float, zeta: float) -> Array:
    """Velocity (n, 2) of one vortex: LFHH eq. 3-5, undefined at the centre."""
    dx, dy = points[:, 0] - x, points[:, 1] - y
    r2 = dx**2 + dy**2
    factor = eta / (2 * np.pi * r2) * -np.expm1(-r2 / zeta**2)
    return np.column_stack([-factor * dy, factor * dx])
