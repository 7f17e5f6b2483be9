"""Flying one episode and measuring it; the runner and the replay share every line of this."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

import auvgym
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
    maps: list[tuple[int, Any]] = field(default_factory=list)


def fly(flight: Flight, seed: int, start: Start, choose: Choose) -> None:
    """Reset with ``seed``, call ``start``, then step with ``choose`` until the episode ends.

    Both are called with the latest observation and info.
    """
    env = flight.env
    core: Any = env.unwrapped
    observation, flight.info = env.reset(seed=seed)
    flight.maps.append((0, core.world))
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
            flight.maps.append((len(core.episode.trail), core.world))


def measures(flight: Flight) -> dict[str, Any]:
    """Every figure of an :class:`~auvgym.evaluation.result.EpisodeResult` the engine decides."""
    core: Any = flight.env.unwrapped
    info = flight.info
    world = core.world
    distance_m = float(np.linalg.norm(np.asarray(world.goal) - np.asarray(world.start)))
    reference_s = distance_m / float(world.scenario.to_dict()["vehicle"]["speed_mps"])
    success = bool(info["is_success"])
    time_s = float(info["time_s"])
    slowness = min(max(time_s / reference_s, 1.0), SLOWEST_COUNTED)
    return {
        "scenario_hash": str(world.scenario.hash),
        "outcome": str(info["outcome"]),
        "success": int(success),
        "score": 1.0 / slowness if success else 0.0,
        "time_s": time_s,
        "energy_j": float(info["energy_j"]),
        "path_length_m": float(info["path_length_m"]),
        "min_clearance_m": _finite(info["min_clearance_m"]),
        "distance_to_goal_m": float(info["distance_to_goal_m"]),
        "cost": cost(flight),
        "time_limit_s": float(core.episode.time_limit_s),
        "still_water_time_s": reference_s,
        "steps": len(flight.actions),
        "reward": flight.reward,
    }


def cost(flight: Flight) -> float | None:
    """The LFHH paper's cost (eq. 6-10) of the flown path; None if nothing was flown.

    The path is cut where the map changed, each piece is resampled to the section spacing and
    costed in the map it was flown in, and the pieces are averaged by their length.
    """
    core: Any = flight.env.unwrapped
    trail = np.asarray(core.episode.trail, dtype=np.float64)
    if len(trail) < 2:
        return None
    spacing_m = _section_spacing_m(flight.maps[0][1])
    ends = [length for length, _ in flight.maps[1:]] + [len(trail)]
    total, weight = 0.0, 0.0
    for (begin, world), end in zip(flight.maps, ends, strict=True):
        piece = trail[max(begin - 1, 0) : end]
        length_m = float(np.linalg.norm(np.diff(piece, axis=0), axis=1).sum())
        if length_m < 1.0:
            continue
        total += length_m * auvgym.path_cost(world, resample(piece, spacing_m))["total"]
        weight += length_m
    return _finite(total / weight) if weight > 0.0 else None


def resample(path_m: NDArray[np.float64], spacing_m: float) -> NDArray[np.float64]:
    """``path_m`` (n, 3) cut anew into equal steps of about ``spacing_m`` along its length."""
    steps_m = np.linalg.norm(np.diff(path_m, axis=0), axis=1)
    along_m = np.concatenate([[0.0], np.cumsum(steps_m)])
    pieces = max(1, round(float(along_m[-1]) / spacing_m))
    targets_m = np.linspace(0.0, along_m[-1], pieces + 1)
    return np.column_stack([np.interp(targets_m, along_m, path_m[:, axis]) for axis in range(3)])


def _section_spacing_m(world: Any) -> float:
    """The section planners' step: the scenario's spacing, else 39 steps from start to goal."""
    sections = world.scenario.to_dict().get("sections") or {}
    if sections.get("spacing_m"):
        return float(sections["spacing_m"])
    distance_m = float(np.linalg.norm(np.asarray(world.goal) - np.asarray(world.start)))
    return distance_m / (int(sections.get("count", 40)) - 1)


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
