"""Small worlds for tests, and formulas of the papers in plain NumPy to hold the engine against."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import numpy.typing as npt

import auvgym

Array = npt.NDArray[np.float64]

WIDTH, LENGTH, DEPTH = 20_000.0, 20_000.0, 4_000.0
# Strength (m^2/s) and core radius (m) of a Lamb-Oseen vortex.
ETA, ZETA = 2000.0, 1200.0


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


def pen() -> list[dict[str, Any]]:
    """Walls round the goal at all depths, from outside the box to outside the box."""
    boxes = [(7e3, 16e3, 13e3, 17e3), (7e3, 16e3, 8e3, 23e3), (12e3, 16e3, 13e3, 23e3)]
    return [
        {
            "kind": "polygon",
            "vertices_m": [[west, south], [east, south], [east, north], [west, north]],
            "top_m": -2_000.0,
            "bottom_m": 9_000.0,
        }
        for west, south, east, north in boxes
    ]


def other_obstacles() -> list[dict[str, Any]]:
    """A cylinder, a superquadric and a polygon across the way, at all depths."""
    return [
        {
            "kind": "cylinder",
            "position_m": [10_000.0, 6_000.0],
            "radius_m": 2_000.0,
            "top_m": -10.0,
            "bottom_m": 9_000.0,
        },
        {
            "kind": "superquadric",
            "position_m": [7_000.0, 12_000.0, 0.0],
            "semi_axes_m": [2_500.0, 1_000.0, 5_000.0],
            "exponents": [4.0, 2.0, 2.0],
        },
        {
            "kind": "polygon",
            "vertices_m": [[9e3, 14e3], [14e3, 14e3], [14e3, 16e3], [11e3, 15e3], [9e3, 16e3]],
            "top_m": -10.0,
            "bottom_m": 9_000.0,
        },
    ]


def gridded_sea() -> auvgym.World:
    """A gridded current in two depths over gridded depths with an island, crossed aslant."""
    axis = np.linspace(0.0, WIDTH, 21)
    x, y = np.meshgrid(axis, axis)
    depths = 3_800.0 - 4_500.0 * np.exp(-((x - 9_000) ** 2 + (y - 10_000) ** 2) / 8e6)
    u = np.stack([0.4 * np.sin(y / 3_000.0), 0.1 * np.ones_like(x)])
    v = np.stack([0.3 * np.cos(x / 4_000.0), np.zeros_like(x)])
    axes = {"x_m": axis.tolist(), "y_m": axis.tolist()}
    currents = {"kind": "gridded", **axes, "depth_m": [0.0, DEPTH]}
    currents |= {"u_mps": u.ravel().tolist(), "v_mps": v.ravel().tolist()}
    return world(
        3,
        missions=[{"start_m": [2_000.0, 3_000.0, 500.0], "goal_m": [17_000.0, 16_000.0, 900.0]}],
        sections={"frame": "mission", "count": 20, "half_width_m": 6_000.0, "cell_m": 500.0},
        seabed={"kind": "gridded", **axes, "depth_m": depths.ravel().tolist()},
        currents=[currents],
    )


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
