"""Flying a stored episode again from its seed and action log, and holding it to its row."""

from __future__ import annotations

import zlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, cast

import gymnasium
import numpy as np
from numpy.typing import NDArray

from auvgym.envs import AUVEnv
from auvgym.evaluation.flight import Flight, fly, make_environment, measures
from auvgym.evaluation.result import EpisodeResult

OnStep = Callable[[gymnasium.Env[Any, Any], dict[str, Any]], None]
_UNFINISHED = "actions: the log ends after {}, the episode does not"
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
    actions = action_log(stored)
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
            differences.append(_UNFINISHED.format(len(actions)))
    else:
        if on_step is not None:
            on_step(flight.env, flight.info)
    differences += _differences(stored, len(actions), len(flight.actions), flight.measures())
    return Replay(flight, differences)


def replay_differences(stored: EpisodeResult, env: gymnasium.Env[Any, Any]) -> list[str]:
    """What :func:`replay` finds different, from one call of the engine: nothing looks meanwhile.

    Raises:
        ReplayError: the action log is damaged.
    """
    actions, core = action_log(stored), cast(AUVEnv, env.unwrapped)
    episode, reward, flown, maps = core.replay(stored.seed, actions)
    differences: list[str] = []
    if episode.outcome == "running" and not stored.policy_failed:
        differences.append(_UNFINISHED.format(len(actions)))
    return differences + _differences(
        stored, len(actions), flown, measures(episode, maps, flown, reward)
    )


def action_log(stored: EpisodeResult) -> NDArray[np.float32]:
    """The row's actions, (steps, d) float32.

    Raises:
        ReplayError: the action log is damaged.
    """
    try:
        return stored.action_log()
    except (zlib.error, ValueError) as error:
        raise ReplayError(f"the action log is damaged ({error})") from error


def _differences(
    stored: EpisodeResult, logged: int, flown: int, measured: dict[str, Any]
) -> list[str]:
    found = [f"actions: the episode ends {logged - flown} before the log does"]
    return (found if logged > flown else []) + [
        f"{name}: stored {getattr(stored, name)!r}, replayed {value!r}"
        for name, value in measured.items()
        if value != getattr(stored, name) and not (stored.policy_failed and name in _AFTER_AN_ERROR)
    ]
