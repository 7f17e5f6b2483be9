"""Flying one episode and measuring it; the runner and the replay share every line of this."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

import auvgym
from auvgym import _core
from auvgym._names import unknown
from auvgym.evaluation.oceans import PREFIX, ocean_scenario
from auvgym.evaluation.suite import Instance, SuiteError
from auvgym.registration import ENVIRONMENTS

Choose = Callable[[NDArray[np.float32], dict[str, Any]], Any]
Start = Callable[[NDArray[np.float32], dict[str, Any]], None]
# T_ref / T stops counting here: slower than eight times the reference is all the same.
SLOWEST_COUNTED = 8.0


def make_environment(instance: Instance, render_mode: str | None = None) -> gymnasium.Env[Any, Any]:
    """The environment an instance is flown in; its seed is left to ``reset``.

    Only auvgym's own environments: Gymnasium would import the module that an id names, and a
    results file or suite may be a stranger's.

    Raises:
        ValueError: there is no such environment, difficulty, scenario or setting.
    """
    if instance.environment not in ENVIRONMENTS:
        raise SuiteError(unknown("environment", instance.environment, ENVIRONMENTS))
    scenario: Any = instance.scenario
    if instance.scenario.startswith(PREFIX):
        scenario = ocean_scenario(instance.scenario.removeprefix(PREFIX))
    arguments = {"difficulty": instance.difficulty, "scenario": scenario}
    given: dict[str, Any] = {name: value for name, value in arguments.items() if value}
    if instance.settings:
        given |= _settings(instance)
    try:
        return gymnasium.make(
            instance.environment, render_mode=render_mode, disable_env_checker=True, **given
        )
    except (gymnasium.error.Error, TypeError) as error:
        raise SuiteError(f'environment "{instance.environment}": {error}') from error


def _settings(instance: Instance) -> dict[str, Any]:
    try:
        settings = json.loads(instance.settings)
    except ValueError:
        settings = None
    if not isinstance(settings, dict) or {"render_mode", "difficulty", "scenario"} & set(settings):
        raise SuiteError(f"{instance.environment}: settings is {instance.settings!r}")
    return settings


@dataclass
class Flight:
    """An episode in the air or just landed; :func:`fly` fills it as it goes.

    Attributes:
        env: the environment.
        info: the latest info.
        reward: the sum of rewards so far.
        actions: the actions so far, each (d,) float32.
        maps: (trail length when it came, world) for each map the vehicle has met.
    """

    env: gymnasium.Env[Any, Any]
    info: dict[str, Any] = field(default_factory=dict)
    reward: float = 0.0
    actions: list[NDArray[np.float32]] = field(default_factory=list)
    maps: list[tuple[int, _core.World]] = field(default_factory=list)

    def measures(self) -> dict[str, Any]:
        """:func:`measures` of the episode as it stands."""
        core: Any = self.env.unwrapped
        return measures(core.episode, self.maps, len(self.actions), self.reward)

    @property
    def worlds(self) -> list[auvgym.World]:
        """The maps, as the rest of auvgym takes them."""
        return [auvgym.World._of(world) for _, world in self.maps]


def fly(flight: Flight, seed: int, start: Start, choose: Choose) -> None:
    """Reset with ``seed``, call ``start``, then step with ``choose`` until the episode ends.

    Both are called with the latest observation and info.
    """
    env = flight.env
    core: Any = env.unwrapped
    observation, flight.info = env.reset(seed=seed)
    flight.maps.append((0, core.episode.world))
    start(observation, flight.info)
    ended = False
    while not ended:
        action = choose(observation, flight.info)
        before = flight.info["map_changes"]
        observation, reward, terminated, truncated, flight.info = env.step(action)
        flight.actions.append(np.array(action, dtype=np.float32).reshape(-1))
        flight.reward += float(reward)
        ended = bool(terminated or truncated)
        if flight.info["map_changes"] != before:
            flight.maps.append((len(core.episode.trail), core.episode.world))


def measures(
    episode: _core.Episode, maps: Sequence[tuple[int, _core.World]], steps: int, reward: float
) -> dict[str, Any]:
    """Every figure of an :class:`~auvgym.evaluation.result.EpisodeResult` the engine decides.

    Args:
        episode: as it stands after its last step.
        maps: (trail length when it came, world) for each map the vehicle has met.
        steps: environment steps flown.
        reward: the sum of rewards.
    """
    info = episode.info()
    reference_s = episode.still_water_time_s
    success = bool(info["is_success"])
    time_s = float(info["time_s"])
    slowness = min(max(time_s / reference_s, 1.0), SLOWEST_COUNTED)
    cost = episode.flown_cost(list(maps))
    return {
        "scenario_hash": maps[0][1].scenario.hash,
        "outcome": str(info["outcome"]),
        "success": int(success),
        "score": 1.0 / slowness if success else 0.0,
        "time_s": time_s,
        "energy_j": float(info["energy_j"]),
        "path_length_m": float(info["path_length_m"]),
        "min_clearance_m": _finite(info["min_clearance_m"]),
        "distance_to_goal_m": float(info["distance_to_goal_m"]),
        "cost": None if cost is None else _finite(cost),
        "time_limit_s": episode.time_limit_s,
        "still_water_time_s": reference_s,
        "steps": steps,
        "reward": reward,
    }


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
