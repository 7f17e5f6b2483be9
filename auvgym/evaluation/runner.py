"""Every policy of a run meets every instance of a suite; what ends is stored at once."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import gymnasium

import auvgym
from auvgym import policies
from auvgym.evaluation.flight import Flight, fly, make_environment, measures
from auvgym.evaluation.result import EpisodeResult, PolicySpec, pack_actions
from auvgym.evaluation.store import Store, key
from auvgym.evaluation.suite import Instance, Suite
from auvgym.evaluation.workers import ProcessDiedError, run_tasks

# Called with each episode as it is stored, the number stored so far, and the number in all.
OnEpisode = Callable[[EpisodeResult, int, int], None]


@dataclass(frozen=True)
class Task:
    """One episode to fly."""

    suite: str
    suite_hash: str
    policy: PolicySpec
    knows: str
    instance: Instance


def run(
    suite: Suite,
    specs: Sequence[PolicySpec],
    store: Store,
    workers: int = 1,
    on_episode: OnEpisode | None = None,
) -> list[EpisodeResult]:
    """Fly every (policy, instance) pair that ``store`` does not hold yet.

    Results do not depend on ``workers``; with 1 they are flown in this process. A policy that
    raises, or ends its process, loses that episode with outcome ``"error"`` and the run goes on.
    On ``KeyboardInterrupt`` the processes are stopped and what had ended is in the store.

    Returns:
        The results of these policies on this suite, those of earlier runs included.

    Raises:
        ValueError: an unknown policy, environment or setting, or results that do not go with
            this suite or engine; before any episode is flown.
    """
    if workers < 1:
        raise ValueError(f"workers is {workers}; at least 1 is needed")
    store.check_same(suite, auvgym.__version__)
    made = [policies.make(spec.name, spec.seed, **spec.parameters) for spec in specs]
    for instance in {replace(instance, seed=0) for instance in suite.instances}:
        _environment(instance)
    suite_hash = suite.hash
    pairs = {
        key(suite, spec, instance): Task(
            suite.name, suite_hash, spec, str(getattr(policy, "knows", "map")), instance
        )
        for instance in suite.instances
        for spec, policy in zip(specs, made, strict=True)
    }
    finished = store.finished(suite)
    tasks = [task for name, task in pairs.items() if name not in finished]
    done = len(pairs) - len(tasks)
    # closing: an interrupt that arrives here, outside the iteration, must end its processes too.
    with closing(_results(tasks, workers)) as results:
        for result in results:
            store.add(result)
            done += 1
            if on_episode is not None:
                on_episode(result, done, len(pairs))
    return [
        result
        for result in store.results(suite)
        if (
            result.suite, result.policy, result.policy_seed, result.parameters,
            result.environment, result.difficulty, result.scenario, result.seed,
        ) in pairs
    ]  # fmt: skip


def _results(tasks: Sequence[Task], workers: int) -> Generator[EpisodeResult, None, None]:
    if workers == 1:
        yield from map(run_task, tasks)
        return
    with closing(run_tasks(run_task, tasks, workers)) as results:
        for task, result in results:
            yield _lost(task, str(result)) if isinstance(result, ProcessDiedError) else result


def run_task(task: Task) -> EpisodeResult:
    """Fly one episode with a policy made for it; a policy's failure becomes its outcome."""
    flight = Flight(_environment(replace(task.instance, seed=0)))
    policy: Any = None
    error = ""
    try:
        policy = policies.make(task.policy.name, task.policy.seed, **task.policy.parameters)
        fly(flight, task.instance.seed, lambda: policy.reset(flight.env), policy.act)
    except KeyboardInterrupt:
        raise
    except BaseException as failure:  # SystemExit and a panic of the engine are none of Exception
        error = f"{type(failure).__name__}: {failure}"
        _environment.cache_clear()
    return _result(task, flight, policy, error)


@lru_cache(maxsize=16)
def _environment(instance: Instance) -> gymnasium.Env[Any, Any]:
    """One environment per process and setting; ``reset`` makes each episode anew."""
    return make_environment(instance)


def _lost(task: Task, error: str) -> EpisodeResult:
    """The row of an episode whose process died: the instance as it stood at its start."""
    flight = Flight(_environment(replace(task.instance, seed=0)))
    return _result(task, flight, None, error)


def _result(task: Task, flight: Flight, policy: Any, error: str) -> EpisodeResult:
    if not flight.maps:
        _, flight.info = flight.env.reset(seed=task.instance.seed)
        flight.maps.append((0, flight.env.unwrapped.world))  # type: ignore[attr-defined]
    measured = measures(flight)
    if error:
        measured |= {"outcome": "error", "success": 0, "score": 0.0}
    return EpisodeResult(
        suite=task.suite,
        suite_hash=task.suite_hash,
        policy=task.policy.name,
        policy_seed=task.policy.seed,
        parameters=task.policy.parameters_json,
        knows=task.knows,
        environment=task.instance.environment,
        difficulty=task.instance.difficulty,
        scenario=task.instance.scenario,
        seed=task.instance.seed,
        engine_version=auvgym.__version__,
        error=error,
        evaluations=int(getattr(policy, "evaluations", 0)),
        replans=int(getattr(policy, "replans", 0)),
        gap=policy.gap() if hasattr(policy, "gap") and not error else None,
        planning_seconds=float(getattr(policy, "planning_seconds", 0.0)),
        actions=pack_actions(flight.actions),
        **measured,
    )
