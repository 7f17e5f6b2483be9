"""What a policy planned on the way: a log does not tell, another flight does."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from auvgym import policies
from auvgym.evaluation.flight import Flight, fly
from auvgym.evaluation.result import EpisodeResult
from auvgym.evaluation.task import environment
from auvgym.policies.registry import is_shipped

#: Planning that took longer is not done again for a picture, s.
LONGEST_S = 10.0

Plan = tuple[float, NDArray[np.float64]]


def plans_of(row: EpisodeResult, longest_s: float = LONGEST_S) -> list[Plan]:
    """The plans of an episode: when each was made, s, and its waypoints, (n, 3) m, in order.

    The policy flies the episode again. Only auvgym's own do, whose plans are what they were; and
    only if all its planning took no more than ``longest_s``, and it flies as the log says.

    Returns:
        Nothing for other policies, those that do not plan, and where the flights differ.

    Raises:
        ValueError, zlib.error: the row names what does not exist, or its log is damaged.
    """
    # Who plans is charged for evaluations; a rule that decides at every tick plans nothing.
    if not is_shipped(row.policy) or not row.evaluations or row.planning_seconds > longest_s:
        return []
    policy: Any = policies.make(row.policy, row.policy_seed, **json.loads(row.parameters))
    flight = Flight(environment(replace(row.instance, seed=0)))
    core: Any = flight.env.unwrapped
    log, found, last = row.action_log(), [], None

    def look() -> None:
        nonlocal last
        if core.plan is not last and core.plan is not None:
            last = core.plan
            found.append((float(core.episode.time_s), np.array(last, dtype=np.float64)))

    def start(observation: Any, info: dict[str, Any]) -> None:
        policies.begin(policy, flight.env, observation, info)
        look()

    def choose(observation: Any, info: dict[str, Any]) -> Any:
        action = policy.act(observation, info)
        look()
        if not np.array_equal(action, log[len(flight.actions)]):
            raise _DiffersError
        return action

    try:
        fly(flight, row.seed, start, choose)
    except (_DiffersError, IndexError):
        return []
    return found


class _DiffersError(Exception):
    """The policy flies otherwise than its log."""
