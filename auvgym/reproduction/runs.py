"""One run of an experiment: a planner, a scenario, a seed; and what came out."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

import numpy as np

import auvgym
from auvgym.reproduction.harbors import plan_in_harbor
from auvgym.reproduction.measures import of_path
from auvgym.reproduction.raster_astar import raster_astar
from auvgym.reproduction.threats import fly_among_threats

#: Points of a convergence curve: evenly spaced in the logarithm of the evaluations.
CURVE_POINTS = 24
Protocol = Literal["plan", "phases", "path", "threats", "harbor"]


@dataclass(frozen=True)
class Run:
    """What is run; two equal runs have equal outcomes, their time apart.

    Attributes:
        protocol: "plan" plans once; "phases" is LFHH's experiment, see :func:`auvgym.run_phases`;
            "path" plans once and measures the path; "threats" flies among what moves; "harbor"
            plans once and measures the path against the exact optimum of its harbour.
        scenario: a shipped scenario.
        mission: its start/goal pair.
        planner: a planner's name; for "path" and "harbor" also "raster-astar", for "threats"
            "navigator".
        parameters: the planner's, as a JSON object with sorted keys.
        window: sections of the planning window, 0 for the whole rest of the path; for "phases".
        seed: of the planner's random streams.
    """

    protocol: Protocol
    scenario: str
    mission: int
    planner: str
    parameters: str
    window: int
    seed: int


@dataclass(frozen=True)
class Outcome:
    """What a run gave.

    Attributes:
        cost: total cost of the plan, or the mean over the re-plans of all phases.
        feasible: whether the plan, or every re-plan, breaks no constraint.
        evaluations: fitness evaluations spent.
        seconds: processor time of the run on this machine, the only figure but the measure
            ``step_us`` that differs from run to run; other work on the machine hardly lengthens it.
        curve: for "plan" the best cost after :func:`checkpoints` evaluations.
        measures: for "path", "threats" and "harbor" what is measured, by name.
    """

    cost: float
    feasible: bool
    evaluations: int
    seconds: float
    curve: tuple[float, ...] = ()
    measures: dict[str, float] = field(default_factory=dict)

    def to_dict(self) -> dict[str, Any]:
        """As JSON has it."""
        return asdict(self)


def parameters_text(parameters: dict[str, Any]) -> str:
    """Parameters as :class:`Run` keeps them."""
    return json.dumps(parameters, sort_keys=True)


def checkpoints(evaluations: int) -> np.ndarray[Any, np.dtype[np.int64]]:
    """Evaluations at which a curve is read, (CURVE_POINTS,) from 200 to the last."""
    return np.rint(np.geomspace(200, max(evaluations, 200), CURVE_POINTS)).astype(np.int64)


def execute(run: Run) -> Outcome | str:
    """The outcome of a run, or what went wrong in words; importable for other processes."""
    try:
        return _PROTOCOLS[run.protocol](run)
    except ValueError as error:
        return str(error)


def _plan(run: Run) -> Outcome:
    world = auvgym.World(run.scenario, seed=run.seed, mission=run.mission)
    began = time.process_time()
    plan = auvgym.plan(world, run.planner, seed=run.seed, **json.loads(run.parameters))
    seconds = time.process_time() - began
    spent, best = plan.history[:, 0], plan.history[:, 1]
    last = np.searchsorted(spent, checkpoints(plan.evaluations), side="right") - 1
    curve = tuple(float(f"{cost:.4g}") for cost in best[np.maximum(last, 0)])
    return Outcome(plan.cost["total"], plan.feasible, plan.evaluations, seconds, curve)


def _phases(run: Run) -> Outcome:
    world = auvgym.World(run.scenario, seed=run.seed, mission=run.mission)
    began = time.process_time()
    window = run.window or None
    parameters = json.loads(run.parameters)
    phases = auvgym.run_phases(world, run.planner, seed=run.seed, window=window, **parameters)
    seconds = time.process_time() - began
    replans = phases[1:]
    return Outcome(
        cost=float(np.mean([phase.cost for phase in replans])),
        feasible=all(phase.feasible for phase in replans),
        evaluations=sum(phase.evaluations for phase in phases),
        seconds=seconds,
    )


def _path(run: Run) -> Outcome:
    world = auvgym.World(run.scenario, seed=run.seed, mission=run.mission)
    parameters = json.loads(run.parameters)
    objective = parameters.get("objective", {})
    evaluations, feasible, coefficients = 0, True, {}
    began = time.process_time()
    if run.planner == "raster-astar":
        path = raster_astar(world, **parameters)
    else:
        plan = auvgym.plan(world, run.planner, seed=run.seed, **parameters)
        path, feasible, evaluations = plan.waypoints, plan.feasible, plan.evaluations
        coefficients = plan.coefficients
    seconds = time.process_time() - began
    found = of_path(world, path, objective)
    measures = {**coefficients, **found, "evaluations": float(evaluations)}
    return Outcome(measures["objective"], feasible, evaluations, seconds, measures=measures)


def _threats(run: Run) -> Outcome:
    world = auvgym.World(run.scenario, seed=run.seed, mission=run.mission)
    began = time.process_time()
    measures = fly_among_threats(world, **json.loads(run.parameters))
    seconds = time.process_time() - began
    unharmed = measures["reached"] == 1.0 and measures["hits"] == 0.0
    return Outcome(measures["length_km"], unharmed, 0, seconds, measures=measures)


def _harbor(run: Run) -> Outcome:
    world = auvgym.World(run.scenario, seed=run.seed, mission=run.mission)
    began = time.process_time()
    plan, measures = plan_in_harbor(world, run.planner, run.seed, json.loads(run.parameters))
    seconds = time.process_time() - began
    return Outcome(measures["length_m"], plan.feasible, plan.evaluations, seconds, (), measures)


_PROTOCOLS: dict[str, Callable[[Run], Outcome]] = {
    "plan": _plan,
    "phases": _phases,
    "path": _path,
    "threats": _threats,
    "harbor": _harbor,
}
