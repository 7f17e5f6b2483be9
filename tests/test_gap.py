"""The gap of a path to the exact reference of its problem."""

from __future__ import annotations

import numpy as np
import pytest
from typer.testing import CliRunner

import auvgym
from auvgym import planning
from auvgym.cli import app
from auvgym.evaluation import Instance, PolicySpec, Store, Suite, run, summarise


@pytest.mark.parametrize(
    ("name", "cost", "planner"),
    [("lfhh-2d-1", "lfhh", "lfhh"), ("lfhh-3d-1", "lfhh", "lfhh"), ("afhh-2", "afhh", "rwde")],
)
def test_no_population_beats_the_reference(name: str, cost: str, planner: str) -> None:
    world = auvgym.World(name)
    options = {"max_evaluations": 20_000, "stop": "exhaust", "cost": cost}
    plan = auvgym.plan(world, planner, seed=1, **options)
    best = auvgym.plan(world, "section-optimum", cost=cost)
    assert best.feasible
    gap = auvgym.gap(world, plan, cost)
    assert gap == plan.cost["total"] - best.cost["total"]
    assert gap > 0.0
    assert auvgym.gap(world, best.waypoints, cost) == 0.0


def test_the_reference_is_that_of_the_world_as_it_is() -> None:
    """It is worked out once for a problem, and anew for another: map, time, ends, cost, options."""
    world = auvgym.World("lfhh-2d-1")
    line = np.linspace(world.start, world.goal, 40)

    def problems() -> list[float]:
        return [
            auvgym.gap(world, line),
            auvgym.gap(world, line[2:]),
            auvgym.gap(world, line, "time"),
            auvgym.gap(world, line, "time", margin_m=200.0),
        ]

    before = problems()
    assert world.apply_change(world.start)
    after = problems()
    assert len({*before, *after}) == 8
    planning._least.cache_clear()
    assert problems() == after


def test_a_straight_line_in_still_water_has_no_gap() -> None:
    scenario = auvgym.Scenario.generate("lfhh-2d", 1, obstacles=0, vortices=0)
    world = auvgym.World(scenario)
    line = np.linspace(world.start, world.goal, 40)
    for cost in ("lfhh", "time"):
        assert auvgym.gap(world, line, cost) == pytest.approx(0.0, abs=1e-6)


def test_a_wrong_path_is_named() -> None:
    with pytest.raises(auvgym.PlanningError, match="path has shape"):
        auvgym.gap(auvgym.World("lfhh-2d-1"), np.zeros(3))


def test_the_command_says_it() -> None:
    done = CliRunner().invoke(app, ["plan", "lfhh-2d-1", "--planner", "section-optimum", "--gap"])
    assert done.exit_code == 0, done.output
    assert "gap: +0.0000 above the section optimum in cost lfhh" in done.output


def test_the_board_shows_it() -> None:
    suite = Suite("gap", tuple(Instance("AUVDynamic2D-v0", seed) for seed in (1, 2, 3)))
    specs = [PolicySpec("lfhh"), PolicySpec("section-optimum"), PolicySpec("straight")]
    with Store(None) as store:
        results = run(suite, specs, store)
    gaps = {row.policy: row.gap for row in summarise(results)}
    assert gaps["straight"] is None
    assert gaps["section-optimum"] == pytest.approx(0.0)
    known = [row.gap for row in results if row.policy == "lfhh" and row.gap is not None]
    assert known
    assert gaps["lfhh"] == pytest.approx(sum(known) / len(known))
    assert min(known) > 0.0
