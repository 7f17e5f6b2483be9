"""Harbours: danger zones, free links, convex cells and the MAKLINK graph, for looking at."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from auvgym import _core
from auvgym.planning import _parameters, _point
from auvgym.world import World

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

#: The planners that plan round danger zones.
PLANNERS = ("maklink-dijkstra", "maklink-aco", "maklink-pso", "rmpso", "funnel", "visibility")


@dataclass(frozen=True, eq=False)
class Maklink:
    """The chart of a harbour (Habib and Asama 1991; Huang and Jin 2021, section 2).

    Attributes:
        zones: corners of each danger zone, (n, 2) float64 m, counter-clockwise.
        zone_obstacles: for each zone the obstacles that it holds, by their number among those
            that have an outline at the vehicle's depth.
        links: ends of the free links, (m, 2, 2) float64 m, shortest first.
        cells: corners of each convex cell, (n, 2) float64 m, counter-clockwise.
        cell_links: for each cell the links on its border, by number.
        nodes: of the graph: the middles of the links in their order, then start and goal;
            (m + 2, 2) float64 m. Start and goal are the nearest points outside zones.
        edges: pairs of nodes that share a cell, (e, 2) int64, each once.
        lengths: of the edges, (e,) float64 m.
        route: the nodes of the shortest way over edges, (r,) int64; empty if there is none.
    """

    zones: tuple[Array, ...]
    zone_obstacles: tuple[tuple[int, ...], ...]
    links: Array
    cells: tuple[Array, ...]
    cell_links: tuple[tuple[int, ...], ...]
    nodes: Array
    edges: Indices
    lengths: Array
    route: Indices

    @property
    def route_length_m(self) -> float:
        """Length of the route, m; infinite if there is none."""
        if len(self.route) == 0:
            return float("inf")
        return float(np.linalg.norm(np.diff(self.nodes[self.route], axis=0), axis=1).sum())


def maklink(
    world: World,
    *,
    start: npt.ArrayLike | None = None,
    goal: npt.ArrayLike | None = None,
    **zones: Any,
) -> Maklink:
    """The MAKLINK chart and graph of a harbour as it is now: what ``maklink-dijkstra`` plans on.

    Args:
        world: a 2-D world of polygons, discs and cylinders.
        start: (3,) m; the mission's start if None.
        goal: (3,) m; the mission's goal if None.
        **zones: how danger zones are made: ``distance_m``, ``mitre_limit``, ``sides``, ``snap``, as
            the planners' parameter ``zones`` has them (``docs/planners.md``).

    Returns:
        Zones, links, cells and graph.

    Raises:
        PlanningError: a world that has no outlines (3-D, a sea floor, spheres, superquadrics), a
            polygon that is none, a start or goal outside the box (with ``snap=False`` also inside
            a zone; the zone's polygons are named), or a setting that is not allowed.
    """
    found_zones, links, cells, nodes, edges, route = _core.maklink(
        world._core,
        None if start is None else _point("start", start),
        None if goal is None else _point("goal", goal),
        _parameters(zones),
    )
    return Maklink(
        zones=tuple(ring for ring, _ in found_zones),
        zone_obstacles=tuple(tuple(obstacles) for _, obstacles in found_zones),
        links=links,
        cells=tuple(ring for ring, _ in cells),
        cell_links=tuple(tuple(numbers) for _, numbers in cells),
        nodes=nodes,
        edges=edges,
        lengths=np.linalg.norm(nodes[edges[:, 0]] - nodes[edges[:, 1]], axis=1),
        route=route,
    )
