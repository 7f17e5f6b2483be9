"""Planners one by one: what they find, and questions that are refused whoever is asked.

What all planners promise alike is in test_conformance.py.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from small_worlds import disc, other_obstacles, world

import auvgym
from auvgym import PlanningError, World

PLANNERS = auvgym.list_planners()

every_world = pytest.mark.parametrize("name", ["lfhh-2d-1", "lfhh-3d-1"])


@every_world
def test_lfhh_and_astar_find_a_way(name: str) -> None:
    for planner in ("lfhh", "astar"):
        ocean = World(name, mission=2 if name == "lfhh-2d-1" else 0)
        # LFHH's first plan, over all 39 sections, often fails in 2-D; the paper re-plans.
        plans = (auvgym.plan(ocean, planner, seed=seed) for seed in range(6))
        plan = next(plan for plan in plans if plan.feasible)
        along = np.linspace(plan.waypoints[:-1], plan.waypoints[1:], 50).reshape(-1, 3)
        clearance = ocean.clearance(along)
        # The section planners' 3-D map is made of cells of 1 km: they may cut its corners.
        slack = 0.0 if ocean.dimensions == 2 or planner == "astar" else -1_000.0
        assert clearance.min() > slack


def test_a_plan_is_for_the_present_map_and_time() -> None:
    ocean = World("lfhh-2d-1")
    before = auvgym.plan(ocean, "lfhh", seed=0)
    assert ocean.apply_change(ocean.start)
    after = auvgym.plan(ocean, "lfhh", seed=0)
    assert not np.array_equal(before.waypoints, after.waypoints)
    assert auvgym.path_cost(ocean, before.waypoints)["total"] != before.cost["total"]
    assert ocean.time_s == 0.0
    assert ocean.changes == 1, "planning must not touch the world"

    moving = world(obstacles=[disc(5_000, 9_500, 3_000, (1.0, 0.0))])
    straight = [moving.start, moving.goal]
    assert auvgym.path_cost(moving, straight)["block"] == 0
    moving.time_s = 5_000.0
    assert auvgym.path_cost(moving, straight)["block"] > 2


# Those whose ways do not change with the generations that a budget allows.
@pytest.mark.parametrize("planner", ["lfhh", "fhh", "fhh-lts", "eda-g", "pso"])
def test_a_larger_budget_goes_on_from_a_smaller_one(planner: str) -> None:
    ocean = World("lfhh-2d-1")
    totals = [
        auvgym.plan(
            ocean, planner, seed=4, max_evaluations=limit, stop="exhaust", population=60
        ).cost["total"]
        for limit in (1, 60, 600, 3_000)
    ]
    assert totals == sorted(totals, reverse=True)
    assert totals[-1] < totals[0]


@pytest.mark.parametrize(("planner", "parameters"), [("lfhh", {"generations": 600}), ("astar", {})])
@pytest.mark.parametrize("dimensions", [2, 3])
def test_other_obstacles_are_gone_round(
    planner: str, parameters: dict[str, Any], dimensions: int
) -> None:
    ocean = world(dimensions, obstacles=other_obstacles())
    assert auvgym.path_cost(ocean, [ocean.start, ocean.goal])["block"] > 2
    options: dict[str, Any] = {"cost_options": {"collision": "segment"}, **parameters}
    # LFHH does not find its way at every attempt.
    plans = (auvgym.plan(ocean, planner, seed=seed, **options) for seed in range(4))
    plan = next(plan for plan in plans if plan.feasible)
    along = np.linspace(plan.waypoints[:-1], plan.waypoints[1:], 100).reshape(-1, 3)
    assert ocean.clearance(along).min() > 0


def test_a_margin_is_kept() -> None:
    ocean = world(obstacles=[disc(10_000, 9_000, 1_500)])
    plan = auvgym.plan(ocean, "lfhh", seed=0, cost_options={"margin_m": 700.0})
    assert plan.feasible
    along = np.linspace(plan.waypoints[:-1], plan.waypoints[1:], 100).reshape(-1, 3)
    assert ocean.clearance(along).min() >= 699.9


# --- bad input ---------------------------------------------------------------------------------

PARAMETERS: dict[str, tuple[dict[str, Any], list[str]]] = {
    "unknown": ({"populaton": 3}, ["populaton", "`population`", "`max_evaluations`"]),
    "negative": ({"population": -3}, ["population", "-3"]),
    "fraction": ({"bins": 1.5}, ["bins", "1.5"]),
    "NaN": ({"learning_rate": float("nan")}, ["learning_rate = nan", "finite"]),
    "too large": ({"learning_rate": 1.5}, ["learning_rate = 1.5", "0 .. 1"]),
    "more selected than there are": (
        {"population": 10, "selected": 11},
        ["selected = 11", "2 .. 10"],
    ),
}


@pytest.mark.parametrize("case", PARAMETERS)
def test_wrong_parameters_of_lfhh_are_named(case: str) -> None:
    parameters, fragments = PARAMETERS[case]
    ocean = World("lfhh-2d-1")
    path = [ocean.start, ocean.goal]
    for ask in (
        lambda: auvgym.plan(ocean, "lfhh", **parameters),
        lambda: auvgym.replan(ocean, path, path[0], "lfhh", **parameters),
        lambda: auvgym.run_phases(ocean, "lfhh", **parameters),
    ):
        with pytest.raises(PlanningError) as error:
            ask()
        for fragment in fragments:
            assert fragment in str(error.value)


def test_an_unknown_parameter_suggests_the_nearest() -> None:
    with pytest.raises(PlanningError, match=r"did you mean `?'?population"):
        auvgym.plan(World("lfhh-2d-1"), "lfhh", populaton=3)
    with pytest.raises(PlanningError, match=r"did you mean `?'?margin_m"):
        auvgym.path_cost(World("lfhh-2d-1"), [[0, 0, 0], [1, 1, 0]], margin=3)


def test_an_unknown_planner_lists_the_known_ones() -> None:
    ocean = World("lfhh-2d-1")
    path = [ocean.start, ocean.goal]
    for ask in (
        lambda: auvgym.plan(ocean, "lfh"),
        lambda: auvgym.replan(ocean, path, path[0], "lfh"),
        lambda: auvgym.run_phases(ocean, "lfh"),
    ):
        with pytest.raises(
            PlanningError, match=r"unknown planner 'lfh'; did you mean 'lfhh'\?"
        ) as error:
            ask()
        for planner in PLANNERS:
            assert planner in str(error.value)


@pytest.mark.parametrize("seed", [-1, 2**64, 0.5, "0"])
def test_a_wrong_seed_is_named(seed: Any) -> None:
    with pytest.raises(ValueError, match=f"seed = {seed!r}: must"):
        auvgym.plan(World("lfhh-2d-1"), seed=seed)
