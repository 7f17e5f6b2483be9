"""Flying a stored episode again from its seed and action log, and holding it to its row."""

from __future__ import annotations

import zlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from auvgym.evaluation.flight import Flight, fly, make_environment, measures
from auvgym.evaluation.result import EpisodeResult

OnStep = Callable[[gymnasium.Env[Any, Any], dict[str, Any]], None]
_AFTER_AN_ERROR = ("outcome", "success", "score")


class ReplayError(ValueError):
    """An episode whose log cannot be flown."""


@dataclass(frozen=True)
class Replay:
    """What a replay found: the flight, and each figure that differs from the stored row."""

    flight: Flight
    differences: list[str]


def replay(
    stored: EpisodeResult,
    on_step: OnStep | None = None,
    env: gymnasium.Env[Any, Any] | None = None,
) -> Replay:
    """Fly ``stored`` again and compare every figure, bit for bit.

    Args:
        stored: the row.
        on_step: called after the reset and after each step, with the environment and its info.
        env: where to fly it (one that renders, say); by default one is made for the row.

    Raises:
        ReplayError: the action log is damaged.
    """
    flight = Flight(env if env is not None else make_environment(stored.instance))
    try:
        actions = stored.action_log()
    except (zlib.error, ValueError) as error:
        raise ReplayError(f"the action log is damaged ({error})") from error
    log = iter(actions)

    def choose(observation: NDArray[np.float32], info: dict[str, Any]) -> NDArray[np.float32]:
        if on_step is not None:
            on_step(flight.env, info)
        return next(log)

    differences: list[str] = []
    try:
        fly(flight, stored.seed, lambda observation, info: None, choose)
    except StopIteration:
        # A policy that failed left its episode in the air; any other log ends with its episode.
        if not stored.policy_failed:
            differences.append(f"actions: the log ends after {len(actions)}, the episode does not")
    else:
        if on_step is not None:
            on_step(flight.env, flight.info)
    left = len(actions) - len(flight.actions)
    if left:
        differences.append(f"actions: the episode ends {left} before the log does")
    for name, value in measures(flight).items():
        if stored.policy_failed and name in _AFTER_AN_ERROR:
            continue
        if value != getattr(stored, name):
            differences.append(f"{name}: stored {getattr(stored, name)!r}, replayed {value!r}")
    return Replay(flight, differences)
