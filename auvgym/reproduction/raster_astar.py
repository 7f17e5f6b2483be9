"""A rival in a paper that is no planner of ours: A* on a raster."""

from __future__ import annotations

import heapq
import itertools
from typing import Any

import numpy as np
from numpy.typing import NDArray

import auvgym
from auvgym._names import unknown

Array = NDArray[np.float64]
_STRAIGHT = [(0, -1), (-1, 0), (1, 0), (0, 1)]
_NEIGHBOURS = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j]
_CONNECTED = {4: _STRAIGHT, 8: _NEIGHBOURS}
_HEURISTICS = ("manhattan", "octile")


def raster_astar(
    world: auvgym.World,
    nodes: int = 100,
    heuristic: str = "manhattan",
    cells: bool = False,
    connectivity: int = 8,
    corner_cutting: bool = True,
) -> Array:
    """A* over nodes x nodes points of the box at the start's depth (Hart et al. 1968).

    Args:
        world: the world.
        nodes: along each side of the box, 2 .. 2000.
        heuristic: "manhattan", which overestimates where diagonals are allowed, or "octile".
        cells: whether nodes are the middles of cells instead of points from wall to wall.
        connectivity: 4 or 8 neighbours.
        corner_cutting: whether a diagonal may pass between two nodes of which one is not free.

    Returns:
        (n, 3) m.

    Raises:
        PlanningError: there is no way on the raster; or naming the argument, its value and what
            was allowed.
    """
    if not 2 <= nodes <= 2000:
        raise auvgym.PlanningError(f"nodes = {nodes}: must lie in 2 .. 2000")
    if heuristic not in _HEURISTICS:
        raise auvgym.PlanningError(unknown("heuristic", heuristic, list(_HEURISTICS)))
    if connectivity not in _CONNECTED:
        raise auvgym.PlanningError(f"connectivity = {connectivity}: must be 4 or 8")
    low, high = world.domain
    inset = (high - low) / (2 * nodes) if cells else np.zeros(3)
    low, high = low + inset, high - inset
    xs, ys = (np.linspace(low[axis], high[axis], nodes) for axis in (0, 1))
    points = np.array([[x, y, world.start[2]] for x in xs for y in ys])
    free = (world.clearance(points) > 0.0).reshape(nodes, nodes)
    start, goal = (
        (int(np.abs(xs - end[0]).argmin()), int(np.abs(ys - end[1]).argmin()))
        for end in (world.start, world.goal)
    )

    def left(node: tuple[int, int]) -> float:
        a, b = sorted((abs(node[0] - goal[0]), abs(node[1] - goal[1])))
        return float(a + b) if heuristic == "manhattan" else b + (np.sqrt(2.0) - 1.0) * a

    order = itertools.count()
    queue = [(left(start), next(order), start)]
    spent, came = {start: 0.0}, {start: start}
    closed: set[tuple[int, int]] = set()
    while queue:
        _, _, node = heapq.heappop(queue)
        if node == goal:
            return np.array([points[i * nodes + j] for i, j in _back(came, node)])
        if node in closed:
            continue
        closed.add(node)
        for i, j in _CONNECTED[connectivity]:
            other = (node[0] + i, node[1] + j)
            if not (0 <= other[0] < nodes and 0 <= other[1] < nodes and free[other]):
                continue
            beside = free[node[0] + i, node[1]] and free[node[0], node[1] + j]
            if not (corner_cutting or beside):
                continue
            cost = spent[node] + float(np.hypot(i, j))
            if other not in closed and cost < spent.get(other, np.inf):
                spent[other], came[other] = cost, node
                heapq.heappush(queue, (cost + left(other), next(order), other))
    raise auvgym.PlanningError(f"{world.scenario.name}: no way on a raster of {nodes} x {nodes}")


def _back(came: dict[tuple[int, int], tuple[int, int]], node: Any) -> list[tuple[int, int]]:
    way = [node]
    while came[node] != node:
        node = came[node]
        way.append(node)
    return way[::-1]
