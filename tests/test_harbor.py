"""Planners of harbours: the promises of all planners, in the worlds that they know."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from typer.testing import CliRunner

import auvgym
from auvgym.cli import app
from auvgym.evaluation import Instance, PolicySpec, Store, Suite, run, summarise

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


# --- the chart ---------------------------------------------------------------------------------

# Zones, links, cells, links of the route, and its length (m).
CHARTS = {
    "harbor-p": (5, 23, 19, 8, 252.262),
    "harbor-a": (4, 21, 18, 8, 252.259),
    "harbor-b": (6, 26, 21, 8, 252.237),
    "harbor-book": (4, 15, 12, 4, 187.703),
}


def area(ring: np.ndarray) -> float:
    x, y = ring.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


@pytest.mark.parametrize("name", CHARTS)
def test_the_chart_is_the_known_one(name: str) -> None:
    world = auvgym.World(name)
    chart = auvgym.maklink(world)
    zones, links, cells, crossed, length = CHARTS[name]
    assert (len(chart.zones), len(chart.links), len(chart.cells)) == (zones, links, cells)
    assert len(chart.route) == crossed + 2
    assert chart.route_length_m == pytest.approx(length, abs=1e-3)
    # They fill the basin, and every link parts two cells.
    assert sum(map(area, (*chart.zones, *chart.cells))) == pytest.approx(200.0**2, abs=1e-3)
    sides = np.bincount([link for cell in chart.cell_links for link in cell], minlength=links)
    assert np.all(sides == 2)
    assert sorted(one for zone in chart.zone_obstacles for one in zone) == list(
        range(len(world.snapshot()["obstacles"]))
    )
    assert np.array_equal(chart.nodes[-2:], [world.start[:2], world.goal[:2]])
    assert np.allclose(chart.nodes[:-2], chart.links.mean(axis=1))
    ways = np.linalg.norm(np.diff(chart.nodes[chart.edges], axis=1)[:, 0], axis=1)
    assert np.allclose(chart.lengths, ways)
    route = auvgym.plan(world, "maklink-dijkstra").waypoints[:, :2]
    assert np.array_equal(chart.nodes[chart.route], route)


def test_a_chart_that_cannot_be_says_why() -> None:
    with pytest.raises(auvgym.PlanningError, match=r"no third dimension"):
        auvgym.maklink(auvgym.World("lfhh-3d-1"))
    world = auvgym.World("harbor-book")
    with pytest.raises(auvgym.PlanningError, match=r"zones.distance_m = -1"):
        auvgym.maklink(world, distance_m=-1)
    with pytest.raises(auvgym.PlanningError, match=r"did you mean `distance_m`"):
        auvgym.maklink(world, distance=1)
    with pytest.raises(auvgym.PlanningError, match=r"goal .* danger zone of polygon \[0\]"):
        auvgym.maklink(world, goal=(60.0, 140.0, 0.0), snap=False)
    with pytest.raises(auvgym.PlanningError, match=r"start .* outside the area"):
        auvgym.maklink(world, start=(-50.0, 140.0, 0.0))


def test_parted_water_has_no_route() -> None:
    scenario = auvgym.World("harbor-p").scenario.to_dict()
    scenario["obstacles"].append(
        {
            "kind": "polygon",
            "vertices_m": [[98.0, -5.0], [104.0, -5.0], [104.0, 205.0], [98.0, 205.0]],
            "top_m": -1.0,
            "bottom_m": 1.0,
        }
    )
    world = auvgym.World(auvgym.Scenario.from_dict(scenario))
    assert len(auvgym.maklink(world).route) == 0
    plan = auvgym.plan(world, "rmpso")
    assert not plan.feasible
    assert plan.harbor is not None
    assert plan.harbor.gap_m is None
    assert plan.harbor.barriers == [5]
    assert auvgym.gap(world, plan) == np.inf


# --- gap, smoothing, rasters -------------------------------------------------------------------


@every_planner
def test_a_plan_carries_its_gap_and_its_progress(planner: str) -> None:
    world = auvgym.World("harbor-a")
    plan = auvgym.plan(world, planner, seed=2, zones={"distance_m": 1.5})
    report = plan.harbor
    assert report is not None
    assert report.gap_m is not None
    assert report.gap_m == pytest.approx(auvgym.gap(world, plan, distance_m=1.5), abs=1e-9)
    assert report.gap_m >= -1e-9
    assert report.depth_m == 0.0
    assert np.array_equal(report.corners, plan.waypoints)
    assert np.all(np.diff(report.trace[:, 0]) > 0)
    assert np.all(np.diff(report.trace[:, 1]) <= 0)
    swarm = len(report.trace) > 1
    assert swarm == (planner in ("maklink-aco", "maklink-pso", "rmpso"))
    least = 2 * report.trace[-1, 1] if swarm else report.trace[-1, 1]
    assert least == pytest.approx(length_m(plan), abs=1e-9)
    assert auvgym.plan(world, "astar").harbor is None


@every_planner
@pytest.mark.parametrize("name", BASINS)
def test_fillets_keep_the_distance(planner: str, name: str) -> None:
    world = auvgym.World(name)
    plan = auvgym.plan(world, planner, seed=1, smoothing="fillet", cut_m=0.4)
    assert plan.feasible
    assert plan.harbor is not None
    assert plan.harbor.depth_m <= 1e-6
    fine = np.vstack(
        [np.linspace(a, b, 20) for a, b in zip(plan.waypoints, plan.waypoints[1:], strict=False)]
    )
    assert world.clearance(fine).min() >= 1.875 - 1e-6
    corners = plan.harbor.corners
    assert len(plan.waypoints) > len(corners)
    assert length_m(plan) < np.linalg.norm(np.diff(corners, axis=0), axis=1).sum()


def test_one_bezier_says_how_deep_it_cuts() -> None:
    for name in BASINS:
        world = auvgym.World(name)
        plan = auvgym.plan(world, "funnel", smoothing="bezier")
        assert plan.harbor is not None
        assert plan.harbor.depth_m > 1.0
        assert not plan.feasible
        assert plan.harbor.gap_m is not None
        assert plan.harbor.gap_m < 0.0
    # Where start sees goal there is nothing to cut.
    straight = auvgym.plan(world, "funnel", goal=world.start + [3.0, 0.0, 0.0], smoothing="bezier")
    assert straight.feasible


def test_swarms_find_ways_on_a_raster() -> None:
    world = auvgym.World("harbor-raster")
    reading = {"places": "line", "reach_m": 16.0, "bounds": "clamp", "zones": {"distance_m": 0.01}}
    best = length_m(auvgym.plan(world, "visibility", zones=reading["zones"]))
    assert best == pytest.approx(46.560, abs=2e-3)
    for planner in ("maklink-pso", "rmpso"):
        plans = [auvgym.plan(world, planner, seed=seed, **reading) for seed in range(8)]
        assert all(plan.feasible for plan in plans)
        assert all(best < length_m(plan) < 50.5 for plan in plans)
        # Eq. 7 gives no gradient: some never leave a blocked beginning.
        binary = [
            auvgym.plan(world, planner, seed=seed, penalty="binary", **reading).feasible
            for seed in range(20)
        ]
        assert 0 < sum(binary) < 20
    with pytest.raises(auvgym.PlanningError, match=r"points = 0"):
        auvgym.plan(world, "rmpso", points=0)
    assert 46.5 < length_m(auvgym.plan(world, "astar", inflation_m=0.01)) < 50.53


# --- the environment ---------------------------------------------------------------------------


def fly(env: Any, policy: Any, seed: int) -> dict[str, Any]:
    observation, info = env.reset(seed=seed)
    policy.reset(env)
    ended = False
    while not ended:
        observation, _, ended, _, info = env.step(policy.act(observation, info))
    return dict(info)


def test_vessels_are_under_way_and_replanning_matters() -> None:
    env: Any = gymnasium.make("auvgym:AUVHarbor2D-v0", vessels=10)
    env.reset(seed=1)
    before, after = (env.unwrapped.world.snapshot(t)["obstacles"] for t in (0.0, 10.0))
    discs = [i for i, one in enumerate(before) if one["kind"] == "disc"]
    assert len(discs) == 10
    for i in discs:
        assert before[i]["position_m"] != after[i]["position_m"]
    once, anew = (
        [fly(env, auvgym.policies.make("funnel", replan_every_s=every), seed) for seed in range(40)]
        for every in (None, 3.0)
    )
    assert all(info["replans"] == 0 for info in once)
    assert all(info["replans"] > 0 for info in anew)
    arrived = [sum(info["is_success"] for info in infos) for infos in (once, anew)]
    assert arrived[1] >= arrived[0] + 4, arrived
    with pytest.raises(auvgym.policies.PolicyError, match=r"replan_every_s = 0"):
        auvgym.policies.make("funnel", replan_every_s=0)


@pytest.mark.parametrize("name", auvgym.list_scenarios())
def test_a_harbour_scenario_is_flown_with_its_own_current(name: str) -> None:
    if not name.startswith("harbor"):
        return
    env = gymnasium.make("auvgym:AUVHarbor2D-v0", scenario=name)
    parameters = {"zones": {"distance_m": 0.4}} if name == "harbor-raster" else {}
    assert fly(env, auvgym.policies.make("funnel", **parameters), 0)["outcome"] == "goal"


def test_other_currents_are_allowed() -> None:
    scenario = auvgym.World("harbor-a").scenario.to_dict()
    scenario["currents"] = [
        {
            "kind": "vortices",
            "vortices": [{"x_m": 80.0, "y_m": 150.0, "circulation_m2ps": 60.0}],
            "core_radius_m": 20.0,
        }
    ]
    world = auvgym.Scenario.from_dict(scenario)
    env = gymnasium.make("auvgym:AUVHarbor2D-v0", scenario=world)
    assert fly(env, auvgym.policies.make("rmpso"), 0)["outcome"] == "goal"
    with pytest.raises(auvgym.PlanningError, match=r"objective = .*not the same everywhere"):
        auvgym.plan(auvgym.World(world), "rmpso", objective="time")


def test_the_board_has_gaps_in_metres() -> None:
    suite = Suite("gap", tuple(Instance("AUVHarbor2D-v0", seed) for seed in (1, 2, 3)))
    specs = [PolicySpec(name) for name in ("visibility", "maklink-dijkstra", "straight")]
    with Store(None) as store:
        gaps = {row.policy: row.gap for row in summarise(run(suite, specs, store))}
    assert gaps["straight"] is None
    assert gaps["visibility"] == pytest.approx(0.0, abs=1e-9)
    assert gaps["maklink-dijkstra"] is not None
    assert gaps["maklink-dijkstra"] > 1.0


def test_the_command_draws_the_chart_and_says_the_gap(tmp_path: Path) -> None:
    page = tmp_path / "plan.html"
    command = ["plan", "harbor-a", "--planner", "rmpso", "--gap", "--plot", str(page)]
    done = CliRunner().invoke(app, [*command, "--set", "smoothing=bezier"])
    assert done.exit_code == 0, done.output
    assert "m above the shortest path round the danger zones" in done.output
    assert "entered, " in done.output
    text = page.read_text(encoding="utf-8")
    for trace in ("danger zones", "links", "cells", "MAKLINK route", "before smoothing"):
        assert f'"{trace}"' in text
