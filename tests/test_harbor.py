"""Planners of harbours: the promises of all planners, in the worlds that they know."""

from __future__ import annotations

import numpy as np
import pytest

import auvgym

PLANNERS = ["maklink-dijkstra", "maklink-aco", "maklink-pso", "rmpso", "funnel", "visibility"]
BASINS = ["harbor-p", "harbor-a", "harbor-b", "harbor-book"]

every_planner = pytest.mark.parametrize("planner", PLANNERS)


def length_m(plan: auvgym.Plan) -> float:
    return float(np.linalg.norm(np.diff(plan.waypoints, axis=0), axis=1).sum())


@every_planner
@pytest.mark.parametrize("name", BASINS)
def test_a_plan_is_what_it_says(planner: str, name: str) -> None:
    world = auvgym.World(name)
    plan = auvgym.plan(world, planner, seed=3)
    assert plan.feasible
    assert np.array_equal(plan.waypoints[[0, -1]], [world.start, world.goal])
    low, high = world.domain
    assert np.all((plan.waypoints >= low) & (plan.waypoints <= high))
    for cost in ("lfhh", "time"):
        again = auvgym.plan(world, planner, seed=3, cost=cost)
        assert again.cost == auvgym.path_cost(world, again.waypoints, cost)
        assert again.history[-1].tolist() == [again.evaluations, again.cost["total"]]
        assert np.all(np.diff(again.history[:, 0]) > 0)
        assert np.all(np.diff(again.history[:, 1]) <= 0)
        assert again.waypoints.tobytes() == plan.waypoints.tobytes() or cost == "time"
    fine = np.vstack(
        [np.linspace(a, b, 200) for a, b in zip(plan.waypoints, plan.waypoints[1:], strict=False)]
    )
    assert world.clearance(fine).min() > -1e-6


@every_planner
def test_a_budget_of_one_works(planner: str) -> None:
    plan = auvgym.plan(auvgym.World("harbor-a"), planner, max_evaluations=1)
    assert plan.evaluations == 1
    assert len(plan.history) == 1


@pytest.mark.parametrize("name", BASINS)
def test_nothing_is_shorter_than_the_references(name: str) -> None:
    world = auvgym.World(name)
    best = length_m(auvgym.plan(world, "visibility"))
    corridor = length_m(auvgym.plan(world, "funnel"))
    graph = length_m(auvgym.plan(world, "maklink-dijkstra"))
    assert np.linalg.norm(world.goal - world.start) < best <= corridor + 1e-6
    assert corridor < graph
    for planner in ("maklink-pso", "rmpso"):
        found = length_m(auvgym.plan(world, planner, seed=1))
        assert corridor - 1e-6 <= found <= graph + 1e-6


@every_planner
def test_a_third_dimension_is_refused_plainly(planner: str) -> None:
    with pytest.raises(auvgym.PlanningError, match=r"world = lfhh-3d-1: .* only 2-D worlds"):
        auvgym.plan(auvgym.World("lfhh-3d-1"), planner)


def test_random_harbours_have_ways() -> None:
    for seed in range(20):
        world = auvgym.World(auvgym.Scenario.generate("harbor", seed))
        plan = auvgym.plan(world, "visibility")
        assert plan.feasible
        assert length_m(plan) <= length_m(auvgym.plan(world, "rmpso", seed=seed)) + 1e-6
