"""Every policy of a run meets every instance of a suite; what ends is stored at once."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import replace
from functools import lru_cache
from typing import Any, Literal

import auvgym
from auvgym import policies
from auvgym.evaluation.result import EpisodeResult, PolicySpec
from auvgym.evaluation.store import Store, key, result_key
from auvgym.evaluation.suite import Instance, Suite, SuiteError
from auvgym.evaluation.task import Task, environment, lost, run_task
from auvgym.evaluation.workers import ProcessDiedError, run_tasks
from auvgym.policies.registry import is_shipped

# Called with each episode as it is stored, the number stored so far, and the number in all.
OnEpisode = Callable[[EpisodeResult, int, int], None]
# Whether a policy flies an instance.
Flies = Callable[[PolicySpec, Instance], bool]
Engine = Literal["processes", "ray"]
STEP_LIMIT_S = 120.0
# Waiting for the disk costs more than a cheap episode. What ends so soon after the last write that
# a kill takes no more flying with it than this, is written with the next.
WRITE_EVERY_S = 0.05


def run(
    suite: Suite,
    specs: Sequence[PolicySpec],
    store: Store,
    workers: int = 1,
    on_episode: OnEpisode | None = None,
    engine: Engine = "processes",
    step_limit_s: float | None = STEP_LIMIT_S,
    flies: Flies | None = None,
) -> list[EpisodeResult]:
    """Fly every (policy, instance) pair that ``store`` does not hold yet.

    Results depend neither on ``workers`` nor on ``engine``. A policy that raises, gives an action
    that is none, takes longer than ``step_limit_s`` or ends its process loses that episode, with an
    outcome that says so, and the run goes on. On ``KeyboardInterrupt`` the processes are stopped
    and what had ended is in the store.

    Args:
        suite: what is flown.
        specs: who flies.
        store: where results go, and what need not be flown again.
        workers: processes to fly in. With 1, auvgym's own policies fly in this process; anybody
            else's always have one of their own, which they may end.
        on_episode: called as each episode is stored.
        engine: ``"processes"`` on this machine, or ``"ray"``: a Ray cluster (extra ``ray``), that
            which ``ray.init()`` finds or this machine, with ``workers`` tasks at a time.
        step_limit_s: wall clock that one call of a policy may take; None for no limit. It does not
            hold for auvgym's own policies in this process.
        flies: which pairs are flown; by default all. :func:`fitting` leaves out planners where they
            cannot plan.

    Returns:
        The results of these policies on this suite, those of earlier runs included.

    Raises:
        ValueError: an unknown policy, environment or setting, or results that do not go with
            this suite or engine; before any episode is flown.
        SuiteError: a world is not what it was when the suite was frozen; what was flown before it
            was noticed is kept.
        ImportError: a library that a policy or the engine needs.
    """
    if workers < 1:
        raise ValueError(f"workers is {workers}; at least 1 is needed")
    if engine not in ("processes", "ray"):
        raise ValueError(f"engine is {engine!r}; it is 'processes' or 'ray'")
    if step_limit_s is not None and not step_limit_s > 0.0:
        raise ValueError(f"step_limit_s is {step_limit_s}; it is seconds above 0, or None")
    store.check_same(suite, auvgym.__version__)
    specs = [
        replace(spec, parameters=policies.frozen_parameters(spec.name, spec.parameters))
        for spec in specs
    ]
    made = [policies.make(spec.name, spec.seed, **spec.parameters) for spec in specs]
    for instance in {replace(instance, seed=0) for instance in suite.instances}:
        environment(instance)
    suite_hash = suite.hash
    pairs = {
        key(suite, spec, instance): Task(
            suite.name,
            suite_hash,
            spec,
            str(getattr(policy, "knows", "map")),
            instance,
            step_limit_s,
        )
        for instance in suite.instances
        for spec, policy in zip(specs, made, strict=True)
        if flies is None or flies(spec, instance)
    }
    finished = store.finished(suite)
    tasks = [task for name, task in pairs.items() if name not in finished]
    done = len(pairs) - len(tasks)
    # closing: an interrupt that arrives here, outside the iteration, must end its processes too.
    ended: list[EpisodeResult] = []

    def keep() -> None:
        nonlocal done
        store.add(*ended)
        stored = ended.copy()
        ended.clear()
        for result in stored:
            done += 1
            if on_episode is not None:
                on_episode(result, done, len(pairs))

    try:
        with closing(_results(tasks, workers, engine)) as results:
            kept_s = -math.inf
            for result in results:
                if isinstance(result, SuiteError):
                    raise result
                ended.append(result)
                if time.monotonic() >= kept_s + WRITE_EVERY_S:
                    keep()
                    kept_s = time.monotonic()
    finally:
        keep()
    return [result for result in store.results(suite) if result_key(result) in pairs]


def fitting(spec: PolicySpec, instance: Instance) -> bool:
    """Whether a policy can fly an instance at all: a planner for harbours plans in no tank.

    A trained agent is asked for a network of the environment and its action mode. Of the others,
    triggers fly in re-plan mode, ``random`` in both. A planner is asked for a plan of one
    evaluation in a world of the instance's kind; everybody else can.
    """
    replans = '"action_mode": "replan"' in instance.settings
    agents = policies.list_agents()
    if spec.name in agents:
        task = f"{instance.environment}/replan" if replans else instance.environment
        return task in agents[spec.name]
    if spec.name != "random" and replans != (spec.name in policies.list_triggers()):
        return False
    if spec.name not in auvgym.list_planners():
        return True
    return _can_plan(spec.name, replace(instance, seed=0))


@lru_cache(maxsize=512)
def _can_plan(planner: str, instance: Instance) -> bool:
    env: Any = environment(instance)
    env.reset(seed=instance.seed)
    try:
        auvgym.plan(env.unwrapped.world, planner, max_evaluations=1)
    except auvgym.PlanningError:
        return False
    return True


def _results(
    tasks: Sequence[Task], workers: int, engine: Engine
) -> Generator[EpisodeResult | SuiteError, None, None]:
    if engine == "ray":
        from auvgym.evaluation.ray_engine import run_tasks_on_ray as fly
    elif workers == 1 and all(is_shipped(task.policy.name) for task in tasks):
        yield from map(run_task, tasks)
        return
    else:
        fly = run_tasks
    with closing(fly(run_task, tasks, workers)) as results:
        for task, result in results:
            yield lost(task, result) if isinstance(result, ProcessDiedError) else result
