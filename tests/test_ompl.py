"""OMPL's planners on our worlds."""

from __future__ import annotations

import itertools
import os
import signal
import threading
import time

import gymnasium
import numpy as np
import pytest

import auvgym
from auvgym import ompl, policies

pytest.importorskip("ompl")
NAMES = list(ompl.PLANNERS)


@pytest.fixture(scope="module", params=["lfhh-2d-1", "lfhh-3d-1"])
def world(request: pytest.FixtureRequest) -> auvgym.World:
    return auvgym.World(request.param)


def is_free(world: auvgym.World, waypoints: np.ndarray, margin: float = 0.0) -> bool:
    """Whether points 5 m apart on every segment keep the margin."""
    legs = itertools.pairwise(waypoints)
    parts = [np.linspace(a, b, 2 + int(np.linalg.norm(b - a) / 5.0)) for a, b in legs]
    return bool((world.clearance(np.vstack(parts)) >= margin - 1e-6).all())


@pytest.mark.parametrize("name", NAMES)
def test_paths_are_free_and_counted(world: auvgym.World, name: str) -> None:
    plan = auvgym.plan(world, name, seed=3, max_evaluations=8_000)
    assert plan.planner == name
    assert plan.feasible
    assert plan.evaluations == 8_000
    assert (plan.waypoints[0] == world.start).all()
    assert (plan.waypoints[-1] == world.goal).all()
    assert is_free(world, plan.waypoints)
    direct = float(np.linalg.norm(world.goal - world.start))
    assert direct <= plan.cost["path_length_m"] < 1.35 * direct
    assert plan.history[-1].tolist() == [8_000, pytest.approx(plan.cost["path_length_m"])]
    assert plan.cost == auvgym.path_cost(world, plan.waypoints)


@pytest.mark.parametrize("name", NAMES)
def test_the_same_seed_gives_the_same_plan(world: auvgym.World, name: str) -> None:
    first, again, other = (
        auvgym.plan(world, name, seed=seed, max_evaluations=3_000) for seed in (1, 1, 2)
    )
    assert first.waypoints.tobytes() == again.waypoints.tobytes()
    assert first.waypoints.tobytes() != other.waypoints.tobytes()


@pytest.mark.parametrize("name", NAMES)
def test_a_budget_of_one_finds_nothing_and_says_so(world: auvgym.World, name: str) -> None:
    plan = auvgym.plan(world, name, max_evaluations=1)
    assert not plan.feasible
    assert plan.waypoints.tolist() == [world.start.tolist(), world.goal.tolist()]


def test_a_margin_is_kept(world: auvgym.World) -> None:
    plan = auvgym.plan(world, "ompl:rrtstar", max_evaluations=8_000, margin_m=200.0)
    assert plan.feasible
    assert is_free(world, plan.waypoints, margin=200.0)


def test_replanning_runs_to_the_goal(world: auvgym.World) -> None:
    path = auvgym.plan(world, "ompl:rrtstar", max_evaluations=4_000).waypoints
    again = auvgym.replan(world, path, path[1], "ompl:rrtstar", max_evaluations=4_000)
    assert again.feasible
    assert (again.waypoints[0] == path[1]).all()
    assert (again.waypoints[-1] == world.goal).all()


def test_as_a_policy() -> None:
    env = gymnasium.make("AUVDynamic2D-v0", difficulty="easy")
    policy = policies.make("ompl:rrtstar", seed=1, max_evaluations=2_000)
    observation, info = env.reset(seed=5)
    policy.reset(env)
    ended = False
    while not ended:
        observation, _, terminated, truncated, info = env.step(policy.act(observation, info))
        ended = terminated or truncated
    assert info["outcome"] in ("goal", "timeout", "collision")
    assert policy.evaluations >= 2_000


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"population": 9}, "unknown parameter 'population'"),
        ({"max_evaluations": 0}, "max_evaluations = 0"),
        ({"max_evaluations": 2.5}, "max_evaluations = 2.5"),
        ({"margin_m": -1.0}, "margin_m = -1.0"),
        ({"margin_m": float("nan")}, "margin_m = nan"),
    ],
)
def test_mistakes_are_named(parameters: dict[str, float], message: str) -> None:
    with pytest.raises(auvgym.PlanningError, match=message):
        auvgym.plan(auvgym.World("lfhh-2d-1"), "ompl:rrtstar", **parameters)


def test_unknown_planners_are_told_of_all() -> None:
    with pytest.raises(auvgym.PlanningError, match=r"ompl:rrtstar"):
        auvgym.plan(auvgym.World("lfhh-2d-1"), "ompl:rrtstarr")


@pytest.mark.parametrize("ours", ["rrt-star", "prm-star"])
@pytest.mark.parametrize("scenario", ["lfhh-2d-1", "lfhh-3d-1", "afhh-1"])
def test_the_engines_own_are_as_good(scenario: str, ours: str) -> None:
    """Mean length over three seeds, with OMPL's clearance queries against our tested motions."""
    asked = auvgym.World(scenario)

    def mean_length(planner: str) -> float:
        plans = [auvgym.plan(asked, planner, seed=seed) for seed in range(3)]
        for plan in plans:
            assert plan.feasible
            fine = np.vstack([np.linspace(a, b, 50) for a, b in itertools.pairwise(plan.waypoints)])
            assert asked.clearance(fine).min() >= 0.0
        lengths = [np.linalg.norm(np.diff(plan.waypoints, axis=0), axis=1).sum() for plan in plans]
        return float(np.mean(lengths))

    straight = float(np.linalg.norm(asked.goal - asked.start))
    theirs = mean_length("ompl:" + ours.replace("-", ""))
    assert straight < mean_length(ours) <= 1.01 * theirs


@pytest.mark.parametrize("name", NAMES)
def test_ctrl_c_stops_it(name: str) -> None:
    world = auvgym.World("lfhh-2d-1")
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    began = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        auvgym.plan(world, name, max_evaluations=50_000_000)
    assert time.monotonic() - began < 10.0
