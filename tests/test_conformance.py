"""What every planner promises, whoever wrote it: one suite over all that are listed.

How planners differ is said once, in the table of kinds; no test asks for a planner's name.
"""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import fresh_python
import gymnasium
import numpy as np
import pytest
from planner_kinds import (
    COSTS,
    KIND_OF,
    KINDS,
    PLANNERS,
    WORLDS,
    Parameters,
    brief,
    check,
    clearance,
    every_planner,
    on,
    same,
    those,
)
from small_worlds import pen, wall, world

import auvgym
from auvgym import PlanningError, World, policies


def test_every_planner_has_a_kind() -> None:
    assert set(PLANNERS) == set(KIND_OF)
    assert len(PLANNERS) == len(set(PLANNERS)) == sum(len(kind.planners) for kind in KINDS.values())


# --- plans -------------------------------------------------------------------------------------


@on("name", WORLDS)
@pytest.mark.parametrize("cost", COSTS)
def test_a_plan_is_what_it_says(planner: str, name: str, cost: str) -> None:
    ocean = WORLDS[name]()
    before = (ocean.time_s, ocean.changes)
    plan = auvgym.plan(ocean, planner, seed=1, cost=cost, **brief(planner, ocean))
    check(ocean, plan, ocean.start, ocean.goal, cost)
    assert plan.planner == planner
    assert plan.window is None
    assert (ocean.time_s, ocean.changes) == before, "planning must not touch the world"
    if KIND_OF[planner].clear:
        assert not plan.feasible or clearance(ocean, plan.waypoints) > 0
    else:
        assert plan.feasible == bool(plan.cost["feasible"])


@on("name", ["lfhh-2d-1", "lfhh-3d-1, changed", "gridded sea"])
def test_the_same_seed_gives_the_same_bytes_in_two_threads_as_in_one(
    planner: str, name: str
) -> None:
    ocean = WORLDS[name]()

    def plan(seed: int) -> auvgym.Plan:
        return auvgym.plan(ocean, planner, seed=seed, **brief(planner, ocean))

    seeds = [2**63, 5, 2**63, 5]
    alone = [plan(seed) for seed in seeds]
    with ThreadPoolExecutor(2) as threads:
        together = list(threads.map(plan, seeds))
    assert all(same(one, other) for one, other in zip(alone, together, strict=True))
    assert same(alone[0], alone[2])
    assert same(alone[0], alone[1]) != KIND_OF[planner].random


@on("name", ["lfhh-2d-1", "lfhh-3d-1, changed", "afhh-1"])
def test_start_and_goal_can_be_anywhere(planner: str, name: str) -> None:
    ocean = WORLDS[name]()
    low, high = ocean.domain
    # Between two sections, backwards, beyond the last section, on top of each other's section.
    for a, b in [((0.3, 0.333), (0.7, 0.87)), ((0.4, 0.9), (0.5, 0.2)), ((0.2, 0.5), (0.8, 0.501))]:
        start, goal = (low + (high - low) * np.array([*place, 0.1]) for place in (a, b))
        options = brief(planner, ocean)
        plan = auvgym.plan(ocean, planner, start=start, goal=goal, seed=1, **options)
        check(ocean, plan, start, goal)


@every_planner
def test_start_and_goal_can_be_one_place(planner: str) -> None:
    ocean = World("lfhh-2d-1" if KIND_OF[planner].plane else "lfhh-3d-1")
    options = brief(planner, ocean)
    plan = auvgym.plan(ocean, planner, goal=ocean.start, seed=1, **options)
    check(ocean, plan, ocean.start, ocean.start)


# --- budgets -----------------------------------------------------------------------------------


@those(lambda kind: kind.counted)
@pytest.mark.parametrize("limit", [1, 2, 5, 41, 137])
def test_a_budget_is_kept(planner: str, limit: int) -> None:
    ocean = World("lfhh-2d-1")
    options = {**brief(planner, ocean), "max_evaluations": limit}
    plan = auvgym.plan(ocean, planner, seed=4, **options)
    check(ocean, plan, ocean.start, ocean.goal)
    assert plan.evaluations <= limit


@those(lambda kind: kind.exhaust is not None)
@pytest.mark.parametrize("limit", [1, 2, 39, 40, 41, 137])
@pytest.mark.parametrize("name", ["lfhh-2d-1", "lfhh-3d-1, changed"])
def test_a_budget_is_spent_to_the_last_evaluation(planner: str, limit: int, name: str) -> None:
    ocean = WORLDS[name]()
    options = {**(KIND_OF[planner].exhaust or {}), "max_evaluations": limit}
    plan = auvgym.plan(ocean, planner, seed=4, **options)
    check(ocean, plan, ocean.start, ocean.goal)
    assert plan.evaluations == limit


@pytest.mark.parametrize("planner", KINDS["population"].planners)
def test_generations_limit_the_search(planner: str) -> None:
    ocean = World("lfhh-2d-1")
    parameters = {"population": 60, "stop": "exhaust"}
    for generations in (0, 1, 5):
        plan = auvgym.plan(ocean, planner, seed=4, generations=generations, **parameters)
        assert plan.evaluations == 60 * (generations + 1)
        assert len(plan.history) == generations + 1


# --- no way ------------------------------------------------------------------------------------


@on("dimensions", [2, 3])
@pytest.mark.parametrize("closed", [lambda: [wall()], pen], ids=["wall", "pen"])
def test_no_way_is_an_answer(
    planner: str, dimensions: int, closed: Callable[[], list[dict[str, Any]]]
) -> None:
    ocean = world(dimensions, obstacles=closed())
    plan = auvgym.plan(ocean, planner, seed=0, **brief(planner, ocean))
    check(ocean, plan, ocean.start, ocean.goal)
    assert plan.feasible is False
    assert plan.cost["feasible"] == 0.0
    assert auvgym.path_cost(ocean, plan.waypoints, collision="segment")["block"] > 2


@those(lambda kind: kind.exhaust is not None)
def test_no_way_takes_no_more_than_the_budget(planner: str) -> None:
    ocean = world(obstacles=[wall()])
    options = {**(KIND_OF[planner].exhaust or {}), "max_evaluations": 150}
    plan = auvgym.plan(ocean, planner, seed=0, **options)
    assert not plan.feasible
    assert plan.evaluations == 150


@every_planner
def test_a_current_that_cannot_be_beaten_is_an_answer(planner: str) -> None:
    ocean = world(currents=[{"kind": "uniform", "velocity_mps": [0.0, -2.5]}])
    plan = auvgym.plan(ocean, planner, seed=0, cost="time", **brief(planner, ocean))
    check(ocean, plan, ocean.start, ocean.goal, "time")
    assert plan.feasible is False
    assert plan.cost["current"] > 2


# --- Ctrl-C ------------------------------------------------------------------------------------

SCRIPT = """
import time, auvgym
world = auvgym.World("{name}")
print("planning", flush=True)
try:
    auvgym.{ask}, **{parameters})
except KeyboardInterrupt:
    print(time.monotonic(), flush=True)
    assert auvgym.plan(world, "lfhh", generations=1).evaluations > 0  # and goes on
"""


def stop_within_a_second(ask: str, parameters: Parameters, name: str = "lfhh-3d-1") -> None:
    """Send Ctrl-C to a process that asks for this; ``ask`` is a call without its end."""
    with subprocess.Popen(
        fresh_python.command(SCRIPT.format(ask=ask, parameters=parameters, name=name)),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=fresh_python.environment(),
    ) as process:
        try:
            assert process.stdout is not None
            assert process.stdout.readline() == "planning\n"
            time.sleep(0.3)
            sent = time.monotonic()  # one clock for all processes
            process.send_signal(signal.SIGINT)
            out, err = process.communicate(timeout=20)
        finally:
            process.kill()
    assert process.returncode == 0, err
    assert out, "it ended by itself"
    assert float(out) - sent < 1.0


@pytest.mark.skipif(os.name != "posix", reason="sends SIGINT")
@those(lambda kind: kind.endless)
def test_ctrl_c_stops_planning_within_a_second(planner: str) -> None:
    name = "harbor-a" if KIND_OF[planner].plane else "lfhh-3d-1"
    stop_within_a_second(f"plan(world, '{planner}'", KIND_OF[planner].endless, name)


@pytest.mark.skipif(os.name != "posix", reason="sends SIGINT")
@pytest.mark.parametrize(
    "ask",
    ["replan(world, [world.start, world.goal], world.start, 'lfhh'", "run_phases(world, 'lfhh'"],
)
def test_ctrl_c_stops_replanning_within_a_second(ask: str) -> None:
    stop_within_a_second(ask, KIND_OF["lfhh"].endless)


# --- re-planning and flying --------------------------------------------------------------------


@on("name", ["lfhh-2d-1", "lfhh-3d-1"])
def test_a_replan_changes_only_its_window(planner: str, name: str) -> None:
    ocean = World(name)
    first = auvgym.plan(ocean, "lfhh", seed=1, generations=40).waypoints
    vehicle = first[6]
    assert ocean.apply_change(vehicle)

    def replan(window: int) -> auvgym.Plan:
        options = brief(planner, ocean)
        return auvgym.replan(
            ocean, first, vehicle, planner, seed=2, window=window, cost="time", **options
        )

    plan = replan(5)
    check(ocean, plan, vehicle, ocean.goal, "time")
    assert plan.window is not None
    assert 5 <= plan.window <= 33
    rest = first[6 + plan.window :]
    assert np.array_equal(plan.waypoints[len(plan.waypoints) - len(rest) :], rest)
    assert same(plan, replan(5))
    # In a window that reaches to the goal it is a plan like any other.
    whole = replan(100)
    check(ocean, whole, vehicle, ocean.goal, "time")
    options = brief(planner, ocean)
    alone = auvgym.plan(ocean, planner, start=vehicle, seed=2, cost="time", **options)
    assert np.array_equal(whole.waypoints, alone.waypoints)
    assert whole.feasible == alone.feasible


@those(lambda kind: kind.exhaust is not None)
def test_all_attempts_of_a_replan_share_its_budget(planner: str) -> None:
    ocean = world(obstacles=[wall()], sections={"count": 20, "spacing_m": 1_000.0})
    path = np.linspace(ocean.start, ocean.goal, 20)
    options = {**(KIND_OF[planner].exhaust or {}), "generations": 2, "max_evaluations": 333}
    plan = auvgym.replan(ocean, path, path[3], planner, seed=2, window=10, **options)
    check(ocean, plan, path[3], ocean.goal)
    assert not plan.feasible
    assert plan.evaluations <= 333


@on("environment", ["AUVDynamic2D-v0", "AUVStatic3D-v0", "AUVHarbor2D-v0"])
def test_every_planner_flies_an_episode_to_its_end(planner: str, environment: str) -> None:
    env = gymnasium.make(f"auvgym:{environment}")
    observation, info = env.reset(seed=2)
    core: Any = env.unwrapped
    policy = policies.make(planner, seed=1, **brief(planner, core.world))
    policy.reset(env)
    ended = False
    while not ended:
        action = policy.act(observation, info)
        assert env.action_space.contains(action)
        observation, _, ended, _, info = env.step(action)
    assert info["outcome"] in ("goal", "collision", "out_of_bounds", "energy", "timeout")
    assert info["evaluations"] > 0
    # A change that ends the episode too leaves nobody to plan again.
    assert info["map_changes"] - 1 <= info["replans"] <= info["map_changes"]


# --- bad input ---------------------------------------------------------------------------------

PARAMETERS: dict[str, tuple[Parameters, list[str]]] = {
    "no budget": ({"max_evaluations": 0}, ["max_evaluations = 0", "1 .. "]),
    "negative": ({"generations": -3}, ["generations", "-3"]),
    "fraction": ({"max_evaluations": 1.5}, ["max_evaluations", "1.5"]),
    "text": ({"generations": "many"}, ["generations", '"many"']),
    "NaN": ({"target_cost": float("nan")}, ["target_cost = nan", "finite"]),
    "an object": ({"generations": object()}, ["generations = <object"]),
    "stop rule": ({"stop": "never"}, ["stop", "`never`", "`first-feasible`", "`exhaust`"]),
    "cost": ({"cost": "money"}, ["cost", "`money`", "`lfhh`", "`afhh`", "`time`", "`energy`"]),
    "reading": (
        {"cost_options": {"angle": "right"}},
        ["cost_options.angle", "`right`", "`turning`"],
    ),
    "unknown reading": ({"cost_options": {"margin": 3}}, ["`margin`", "`margin_m`"]),
    "margin on cells": (
        {"cost_options": {"margin_m": 3, "collision": "cells"}},
        ["margin_m = 3", "segment"],
    ),
    "unknown": ({"max_evaluation": 3}, ["`max_evaluation`", "did you mean `max_evaluations`?"]),
}


def refusal(planner: str, parameters: Parameters) -> str:
    """What a plan and a re-plan with these parameters are refused with."""
    ocean = World("lfhh-2d-1")
    path = [ocean.start, ocean.goal]
    with pytest.raises(PlanningError) as error:
        auvgym.plan(ocean, planner, **parameters)
    with pytest.raises(PlanningError) as again:
        auvgym.replan(ocean, path, path[0], planner, **parameters)
    assert str(error.value) == str(again.value)
    return str(error.value)


@every_planner
@pytest.mark.parametrize("case", PARAMETERS)
def test_wrong_parameters_are_named(planner: str, case: str) -> None:
    parameters, fragments = PARAMETERS[case]
    message = refusal(planner, parameters)
    for fragment in fragments:
        assert fragment in message


@every_planner
def test_wrong_parameters_of_its_own_are_named(planner: str) -> None:
    ((name, value),) = KIND_OF[planner].wrong.items()
    assert f"{name} = {value}: must lie in" in refusal(planner, {name: value})
    assert f"{name}" in refusal(planner, {name: "much"})
    unknown = refusal(planner, {f"{name}s": 1})
    assert f"parameters of {planner}: unknown field `{name}s`" in unknown
    assert f"did you mean `{name}`" in unknown


PLACES: dict[str, tuple[Any, str]] = {
    "NaN": ([0.0, np.nan, 0.0], r"\[1\] = nan: must be finite"),
    "infinite": ([np.inf, 0.0, 0.0], r"\[0\] = inf: must be finite"),
    "out of the box": ([0.0, 90_000.0, 0.0], r"90000.*must lie in -500 .. 40500"),
    "left of the box": ([-600.0, 0.0, 0.0], r"-600.*must lie in -500 .. 20500"),
    "under the plane": ([9_000.0, 20_000.0, 50.0], r"50.*must lie in 0 .. 0"),
    "flat": ([0.0, 0.0], "must be three numbers"),
    "a table": ([[0.0, 0.0, 0.0]], "must be three numbers"),
    "text": ("here", "must be numbers"),
    "flags": ([True, False, True], "must be numbers, not bool"),
}


@every_planner
@pytest.mark.parametrize("case", PLACES)
@pytest.mark.parametrize("end", ["start", "goal"])
def test_a_wrong_place_is_named(planner: str, case: str, end: str) -> None:
    place, message = PLACES[case]
    with pytest.raises(PlanningError, match=f"^{end}.*{message}"):
        auvgym.plan(World("lfhh-2d-1"), planner, **{end: place})
