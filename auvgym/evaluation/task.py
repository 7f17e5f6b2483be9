"""One episode, flown by a policy made for it: what every engine's processes run."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import gymnasium

import auvgym
from auvgym import policies
from auvgym.evaluation.flight import Flight, fly, make_environment
from auvgym.evaluation.result import EpisodeResult, PolicySpec, pack_actions
from auvgym.evaluation.suite import Instance, SuiteError
from auvgym.evaluation.workers import ProcessDiedError

# Windows has no alarm: there a policy may take its time.
_ALARM: int | None = getattr(signal, "SIGALRM", None)


@dataclass(frozen=True)
class Task:
    """One episode to fly.

    Attributes:
        suite, suite_hash: whose instance it is.
        policy, knows: who flies it.
        instance: what is flown.
        step_limit_s: wall clock that a call of the policy may take, where a process of its own
            makes that possible; None for no limit.
    """

    suite: str
    suite_hash: str
    policy: PolicySpec
    knows: str
    instance: Instance
    step_limit_s: float | None = None


def run_task(task: Task) -> EpisodeResult | SuiteError:
    """Fly one episode; a policy's failure becomes its outcome, a changed world is an error."""
    flight = Flight(environment(replace(task.instance, seed=0)))
    policy: Any = None
    outcome, error = "", ""

    def start(observation: Any, info: dict[str, Any]) -> None:
        with _limited(task.step_limit_s):
            policies.begin(policy, flight.env, observation, info)

    def choose(observation: Any, info: dict[str, Any]) -> Any:
        with _limited(task.step_limit_s):
            return policy.act(observation, info)

    try:
        policy = policies.make(task.policy.name, task.policy.seed, **task.policy.parameters)
        fly(flight, task.instance.seed, start, choose)
    except KeyboardInterrupt:
        raise
    except auvgym.ActionError as failure:
        outcome, error = "invalid_action", str(failure)
    except BaseException as failure:  # SystemExit and a panic of the engine are none of Exception
        outcome, error = "error", f"{type(failure).__name__}: {failure}"
    if outcome:
        environment.cache_clear()
    return _result(task, flight, policy, outcome, error)


def lost(task: Task, died: ProcessDiedError) -> EpisodeResult | SuiteError:
    """The row of an episode whose process died: the instance as it stood at its start."""
    flight = Flight(environment(replace(task.instance, seed=0)))
    if _ALARM is not None and died.exit_code == -_ALARM:
        outcome, error = "overtime", f"a step took longer than {task.step_limit_s:g} s"
    else:
        outcome, error = "exit", str(died)
    return _result(task, flight, None, outcome, error)


@lru_cache(maxsize=16)
def environment(instance: Instance) -> gymnasium.Env[Any, Any]:
    """One environment per process and setting; ``reset`` makes each episode anew."""
    return make_environment(instance)


@contextmanager
def _limited(seconds: float | None) -> Iterator[None]:
    """End this process by the alarm's signal if the block takes longer.

    The system does it: a policy that sleeps, loops or is deep in foreign code cannot hold it off
    by keeping the interpreter to itself.
    """
    if seconds is None or _ALARM is None:
        yield
        return
    signal.signal(_ALARM, signal.SIG_DFL)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)


def _result(
    task: Task, flight: Flight, policy: Any, failure: str, error: str
) -> EpisodeResult | SuiteError:
    if not flight.maps:
        _, flight.info = flight.env.reset(seed=task.instance.seed)
        flight.maps.append((0, flight.env.unwrapped.episode.world))  # type: ignore[attr-defined]
    measured = flight.measures()
    if changed := task.instance.change(measured["scenario_hash"]):
        return SuiteError(changed)
    if failure:
        measured |= {"outcome": failure, "success": 0, "score": 0.0}
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
        settings=task.instance.settings,
        seed=task.instance.seed,
        engine_version=auvgym.__version__,
        error=error,
        # Planning in re-plan mode is the environment's, not the policy's.
        evaluations=max(int(getattr(policy, "evaluations", 0)), flight.info["evaluations"]),
        replans=max(int(getattr(policy, "replans", 0)), flight.info["replans"]),
        gap=policy.gap() if hasattr(policy, "gap") and not failure else None,
        planning_seconds=float(getattr(policy, "planning_seconds", 0.0)),
        actions=pack_actions(flight.actions),
        **measured,
    )
