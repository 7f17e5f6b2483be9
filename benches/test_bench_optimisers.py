"""Differential evolution on the same cost: this engine's, pygmo's and pymoo's.

``pip install "auvgym[bench]"``; run with ``make bench``. All search with rand/1/bin, F 0.5, CR 0.9
and 200 candidates for 100 generations; the others get the cost as a section problem, pymoo for a
whole generation at once, pygmo one candidate at a time, as its DE asks.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import auvgym

POPULATION, GENERATIONS = 200, 100
FACTOR, CROSSOVER = 0.5, 0.9

pytestmark = pytest.mark.benchmark(group="differential evolution")


@pytest.fixture(params=[("lfhh-2d-1", "lfhh"), ("lfhh-3d-1", "lfhh"), ("afhh-1", "afhh")])
def problem(request: pytest.FixtureRequest) -> tuple[auvgym.World, str]:
    name, cost = request.param
    return auvgym.World(name), cost


def measure(benchmark: Any, search: Any) -> None:
    evaluations = benchmark.pedantic(search, rounds=5, warmup_rounds=1)
    benchmark.extra_info["evaluations_per_second"] = round(evaluations / benchmark.stats["median"])


def test_ours(benchmark: Any, problem: tuple[auvgym.World, str]) -> None:
    world, cost = problem

    def search() -> int:
        plan = auvgym.plan(
            world,
            "rwde",
            cost=cost,
            stop="exhaust",
            generations=GENERATIONS,
            population=POPULATION,
            factor=FACTOR,
            crossover=CROSSOVER,
            walk_first=0.0,
            walk_last=0.0,
        )
        return plan.evaluations

    measure(benchmark, search)


def test_pygmo(benchmark: Any, problem: tuple[auvgym.World, str]) -> None:
    pygmo = pytest.importorskip("pygmo")
    sections = auvgym.SectionProblem(problem[0], cost=problem[1])

    class Sections:
        def get_bounds(self) -> Any:
            return sections.low, sections.high

        def fitness(self, genes: Any) -> Any:
            return sections.evaluate(genes)

    def search() -> int:
        population = pygmo.population(pygmo.problem(Sections()), POPULATION, seed=1)
        # Variant 7 is rand/1/bin.
        method = pygmo.de(
            gen=GENERATIONS, F=FACTOR, CR=CROSSOVER, variant=7, ftol=0.0, xtol=0.0, seed=1
        )
        return int(pygmo.algorithm(method).evolve(population).problem.get_fevals())

    measure(benchmark, search)


def test_pymoo(benchmark: Any, problem: tuple[auvgym.World, str]) -> None:
    core = pytest.importorskip("pymoo.core.problem")
    from pymoo.algorithms.soo.nonconvex.de import DE
    from pymoo.optimize import minimize

    sections = auvgym.SectionProblem(problem[0], cost=problem[1])

    class Sections(core.Problem):  # type: ignore[misc]
        def __init__(self) -> None:
            super().__init__(n_var=len(sections.low), n_obj=1, xl=sections.low, xu=sections.high)

        def _evaluate(self, genes: Any, out: Any, *args: Any, **kwargs: Any) -> None:
            out["F"] = sections.evaluate(np.ascontiguousarray(genes))[:, None]

    def search() -> int:
        method = DE(pop_size=POPULATION, variant="DE/rand/1/bin", CR=CROSSOVER, F=FACTOR)
        found = minimize(Sections(), method, ("n_gen", GENERATIONS + 1), seed=1)
        return int(found.algorithm.evaluator.n_eval)

    measure(benchmark, search)
