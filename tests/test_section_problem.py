"""The section problem as any optimiser sees it."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import auvgym


@pytest.mark.parametrize("name", ["lfhh-2d-1", "lfhh-3d-1", "afhh-1"])
@pytest.mark.parametrize("cost", ["lfhh", "afhh", "time"])
def test_it_costs_what_path_cost_says(name: str, cost: str) -> None:
    world = auvgym.World(name)
    problem = auvgym.SectionProblem(world, cost=cost)
    assert problem.low.shape == problem.high.shape == (38 * (world.dimensions - 1),)
    genes = np.random.default_rng(1).uniform(problem.low, problem.high, (50, len(problem.low)))
    totals = problem.evaluate(genes)
    for candidate, total in zip(genes, totals, strict=True):
        path = problem.path(candidate)
        assert np.array_equal(path[[0, -1]], [world.start, world.goal])
        assert auvgym.path_cost(world, path, cost)["total"] == total
    assert problem.evaluate(genes[7])[0] == totals[7]
    with ThreadPoolExecutor(2) as pool:
        both = list(pool.map(problem.evaluate, [genes, genes]))
    assert np.array_equal(both[0], totals)
    assert np.array_equal(both[1], totals)


def test_ends_and_options_are_passed_on() -> None:
    world = auvgym.World("lfhh-2d-1")
    problem = auvgym.SectionProblem(
        world, start=[5e3, 3e3, 0], goal=[9e3, 9e3, 0], turn_limit_rad=3.1
    )
    assert problem.low.shape == (5,)
    zigzag = np.array([2e3, 9e3, 2e3, 9e3, 2e3])
    sharp = auvgym.SectionProblem(world, start=[5e3, 3e3, 0], goal=[9e3, 9e3, 0])
    assert sharp.evaluate(zigzag)[0] > problem.evaluate(zigzag)[0] + 2.0


def test_what_is_wrong_is_named() -> None:
    world = auvgym.World("lfhh-2d-1")
    with pytest.raises(auvgym.PlanningError, match="did you mean"):
        auvgym.SectionProblem(world, cost="tiem")
    with pytest.raises(auvgym.PlanningError, match="margin"):
        auvgym.SectionProblem(world, margin_m=-1.0)
    with pytest.raises(auvgym.PlanningError, match="goal"):
        auvgym.SectionProblem(world, goal=[1e9, 0, 0])
    problem = auvgym.SectionProblem(world)
    with pytest.raises(ValueError, match=r"must be \(n, 38\)"):
        problem.evaluate(np.zeros((2, 5)))
    genes = np.zeros((2, 38))
    genes[1, 3] = np.nan
    with pytest.raises(ValueError, match=r"genes\[1, 3\] = NaN"):
        problem.evaluate(genes)
    with pytest.raises(ValueError, match=r"must be \(38,\)"):
        problem.path(np.zeros(5))
