"""A rival in a paper that is no planner of ours: A* on a raster."""

from __future__ import annotations

import heapq
import itertools
from typing import Any

import numpy as np
from numpy.typing import NDArray

import auvgym

Array = NDArray[np.float64]
_NEIGHBOURS = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j]


def raster_astar(
    world: auvgym.World,
    nodes: int = 100,
    heuristic: str = "manhattan",
    cells: bool = False,
    cut_corners: bool = True,
) -> Array:
    """A* over nodes x nodes points of the box at the start's depth, with eight neighbours.

    Args:
        world: the world.
        nodes: along each side of the box.
        heuristic: "manhattan", which overestimates where diagonals are allowed, or "octile".
        cells: whether nodes are the middles of cells instead of points from wall to wall.
        cut_corners: whether a diagonal step may pass between two nodes of which one is not free.

    Returns:
        (n, 3) m.

    Raises:
        PlanningError: there is no way on the raster.
    """
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
        for i, j in _NEIGHBOURS:
            other = (node[0] + i, node[1] + j)
            if not (0 <= other[0] < nodes and 0 <= other[1] < nodes and free[other]):
                continue
            beside = ((node[0] + i, node[1]), (node[0], node[1] + j))
            if not (cut_corners or all(free[one] for one in beside)):
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
