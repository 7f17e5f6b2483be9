"""Kinds of planners, and how they keep the promises that all make; worlds to plan in."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest
from small_worlds import Array, gridded_sea, other_obstacles, world

import auvgym
from auvgym import World

Parameters = dict[str, Any]


@dataclass(frozen=True)
class Kind:
    """A kind of planners, and how its members keep the promises that all make.

    Attributes:
        planners: their names.
        brief: parameters with which a plan takes milliseconds, for boxes whose longest edge is
            of so many metres.
        endless: parameters with which a plan takes minutes; none if no plan does.
        random: whether another seed gives another plan.
        counted: whether ``max_evaluations`` applies; searches that are exact end by themselves.
        exhaust: parameters with which a budget is spent to the last evaluation; None if plans
            may end earlier.
        clear: whether ``feasible`` says that nothing solid is met, however much a path turns;
            otherwise it says that no constraint of the cost is broken.
        plane: whether it knows 2-D worlds of polygons, discs and cylinders only.
        wrong: a parameter of its own with a value that is not allowed.
    """

    planners: tuple[str, ...]
    brief: Callable[[float], Parameters]
    wrong: Parameters
    endless: Parameters = field(default_factory=dict)
    random: bool = True
    counted: bool = True
    exhaust: Parameters | None = None
    clear: bool = False
    plane: bool = False


KINDS = {
    "population": Kind(
        planners=("lfhh", "fhh", "fhh-lts", "afhh", "eda-g", "ade", "rwde", "pso"),
        brief=lambda edge: {"generations": 4, "population": 40},
        endless={"generations": 10**8, "stop": "exhaust"},
        exhaust={"population": 40, "stop": "exhaust"},
        wrong={"population": 3},
    ),
    "sampling": Kind(
        planners=("rrt-star", "prm-star"),
        brief=lambda edge: {"max_evaluations": 400, "objective": "time"},
        endless={"max_evaluations": 10**9, "objective": "time"},
        exhaust={"objective": "time"},
        clear=True,
        wrong={"radius_factor": 0},
    ),
    "graph": Kind(
        planners=("astar", "dijkstra"),
        brief=lambda edge: {"spacing_m": edge / 20},
        endless={"spacing_m": 1e-3},  # the finest that there is room for
        random=False,
        counted=False,
        clear=True,
        wrong={"spacing_m": -1},
    ),
    "fluid": Kind(
        planners=("iifds",),
        brief=lambda edge: {"flow": {"step_m": edge / 100}},
        random=False,
        clear=True,
        wrong={"rho": 0},
    ),
    # Children that resemble their parents cost nothing: a herd of twins never spends its budget.
    "genetic fluid": Kind(
        planners=("iifds-ga", "iifds-iga"),
        brief=lambda edge: {"generations": 1, "population": 4, "flow": {"step_m": edge / 100}},
        endless={"generations": 10**8, "stall": 0, "mutation": 1},
        clear=True,
        wrong={"rho_max": 0.5},
    ),
    "differential fluid": Kind(
        planners=("iifds-de",),
        brief=lambda edge: {"generations": 1, "population": 4, "flow": {"step_m": edge / 100}},
        endless={"generations": 10**8},
        exhaust={"population": 4, "flow": {"step_m": 1_000.0, "guard": False}},
        clear=True,
        wrong={"factor": 2.5},
    ),
    "optimum": Kind(
        planners=("section-optimum",),
        brief=lambda edge: {"lateral_m": edge / 20, "depth_m": edge / 20},
        endless={"lateral_m": 1e-3},
        random=False,
        wrong={"lateral_m": -1},
    ),
    # Where start sees goal, or there is no way, a swarm has nothing to search.
    "harbour swarms": Kind(
        planners=("maklink-aco", "maklink-pso", "rmpso"),
        brief=lambda edge: {"generations": 3, "population": 12},
        endless={"generations": 10**8},
        clear=True,
        plane=True,
        wrong={"population": 0},
    ),
    "harbour graphs": Kind(
        planners=("maklink-dijkstra", "funnel", "visibility"),
        brief=lambda edge: {},
        random=False,
        clear=True,
        plane=True,
        wrong={"cut_m": -1},
    ),
}
KIND_OF = {planner: kind for kind in KINDS.values() for planner in kind.planners}
PLANNERS = auvgym.list_planners()
COSTS = ["lfhh", "afhh", "time", "energy"]


def changed(name: str) -> World:
    """A shipped world with its second map, some time later."""
    ocean = World(name)
    ocean.time_s = 1_800.0
    assert ocean.apply_change(ocean.start)
    return ocean


WORLDS: dict[str, Callable[[], World]] = {
    "lfhh-2d-1": lambda: World("lfhh-2d-1"),
    "lfhh-3d-1, changed": lambda: changed("lfhh-3d-1"),
    "afhh-1": lambda: World("afhh-1"),
    "other obstacles, 2-D": lambda: world(2, obstacles=other_obstacles()),
    "other obstacles, 3-D": lambda: world(3, obstacles=other_obstacles()),
    "gridded sea": gridded_sea,
    "harbor-a": lambda: World("harbor-a"),
}
# What planners that know nothing but outlines can plan on; they refuse the others.
PLANE = ("lfhh-2d-1", "harbor-a", "AUVDynamic2D-v0", "AUVHarbor2D-v0", 2)


def on(argument: str, names: Iterable[str | int]) -> pytest.MarkDecorator:
    """Every planner on each of the worlds that it knows."""
    pairs = [
        (planner, name)
        for planner in PLANNERS
        for name in names
        if name in PLANE or not KIND_OF[planner].plane
    ]
    return pytest.mark.parametrize(("planner", argument), pairs)


every_planner = pytest.mark.parametrize("planner", PLANNERS)


def those(wanted: Callable[[Kind], Any]) -> pytest.MarkDecorator:
    """All planners of the kinds that are wanted."""
    return pytest.mark.parametrize("planner", [name for name in PLANNERS if wanted(KIND_OF[name])])


def brief(planner: str, ocean: World) -> Parameters:
    low, high = ocean.domain
    return KIND_OF[planner].brief(float((high - low).max()))


def same(one: auvgym.Plan, other: auvgym.Plan) -> bool:
    return (
        one.waypoints.tobytes() == other.waypoints.tobytes()
        and one.history.tobytes() == other.history.tobytes()
        and (one.cost, one.feasible, one.evaluations, one.window)
        == (other.cost, other.feasible, other.evaluations, other.window)
    )


def check(ocean: World, plan: auvgym.Plan, start: Array, goal: Array, cost: str = "lfhh") -> None:
    """Whatever was asked: where the path leads, and that everything said of it is true."""
    assert plan.waypoints.dtype == np.float64
    assert plan.waypoints.shape == (len(plan.waypoints), 3)
    assert np.array_equal(plan.waypoints[0], start)
    assert np.array_equal(plan.waypoints[-1], goal)
    low, high = ocean.domain
    rounding = 1e-9 * (high - low).max()  # where a mission's frame is turned
    assert np.all((plan.waypoints >= low - rounding) & (plan.waypoints <= high + rounding))
    # To the last bit what path_cost says of it.
    assert plan.cost == auvgym.path_cost(ocean, plan.waypoints, cost)
    assert np.isfinite(list(plan.cost.values())).all()
    assert isinstance(plan.feasible, bool)
    assert plan.evaluations >= KIND_OF[plan.planner].counted
    spent, totals = plan.history.T
    assert np.all(np.diff(spent) > 0)
    assert np.all(np.diff(totals) <= 0)
    assert (spent[-1], totals[-1]) == (plan.evaluations, plan.cost["total"])


def clearance(ocean: World, path: Array) -> float:
    along = np.linspace(path[:-1], path[1:], 40).reshape(-1, 3)
    return float(ocean.clearance(along).min())
