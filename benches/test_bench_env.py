"""What a step, a reset, a question to the world, a plan and the import cost.

Run with ``make bench``. Times are per round; batches say how much is in one.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest

import auvgym

IDS = ["AUVDynamic2D-v0", "AUVDynamic3D-v0"]
BATCH = 1024
STEPS = 512

both = pytest.mark.parametrize("env_id", IDS)


class Flight:
    """Random actions, made beforehand, and a reset wherever an episode ends."""

    def __init__(self, env_id: str, wrapped: bool = False) -> None:
        env = gymnasium.make(env_id)
        self.env: Any = env if wrapped else env.unwrapped
        self.core: Any = env.unwrapped
        shape = (STEPS, self.core.dimensions)
        random = np.random.default_rng(0)
        self.actions = list(random.uniform(-1, 1, shape).astype(np.float32))
        self.env.reset(seed=0)
        self.next = 0

    def action(self) -> Any:
        self.next = (self.next + 1) % STEPS
        return self.actions[self.next]

    def next_step(self) -> tuple[tuple[Any], dict[str, Any]]:
        """Arguments of the next step, in a new episode if the last one is over; not timed."""
        if self.core.episode.outcome != "running":
            self.env.reset()
        return (self.action(),), {}

    def step(self) -> None:
        if self.env.step(self.action())[2]:
            self.env.reset()


@both
def test_step(benchmark: Any, env_id: str) -> None:
    """One step of the bare environment: the engine's leg and observation, and Python's share."""
    flight = Flight(env_id)
    benchmark.pedantic(flight.env.step, setup=flight.next_step, rounds=5_000)


@both
def test_step_in_the_engine(benchmark: Any, env_id: str) -> None:
    """The same without Python's share: the difference to ``test_step`` is what Python adds."""
    flight = Flight(env_id)

    def engine(action: Any) -> None:
        flight.core.episode.step(action)

    benchmark.pedantic(engine, setup=flight.next_step, rounds=5_000)


@both
def test_step_through_gymnasiums_wrappers(benchmark: Any, env_id: str) -> None:
    """As users get it from ``gymnasium.make``: its checks cost more than the step."""
    flight = Flight(env_id, wrapped=True)
    benchmark.pedantic(flight.env.step, setup=flight.next_step, rounds=5_000)


@both
def test_overhead_of_python(benchmark: Any, env_id: str) -> None:
    """Python's share alone: ``env.step`` on an engine that answers at once."""

    class Answer:
        outcome = "running"

        def __init__(self, core: Any) -> None:
            self.observation, self.told = core.episode.observe(), core.episode.info()

        def step(self, action: Any) -> tuple[Any, float, bool]:
            return self.observation, 0.0, False

        def info(self) -> dict[str, Any]:
            return self.told

    flight = Flight(env_id)
    flight.core._episode = Answer(flight.core)
    benchmark(flight.core.step, flight.actions[0])


@both
def test_steps_with_resets(benchmark: Any, env_id: str) -> None:
    """512 steps of random actions, with the resets that they need."""
    flight = Flight(env_id)

    def fly() -> None:
        for _ in range(STEPS):
            flight.step()

    benchmark(fly)


@both
def test_reset(benchmark: Any, env_id: str) -> None:
    """A new world of the family and its first observation."""
    env = gymnasium.make(env_id).unwrapped
    env.reset(seed=0)
    benchmark(env.reset)


def points(world: auvgym.World) -> Any:
    low, high = world.domain
    return low + np.random.default_rng(0).random((BATCH, 3)) * (high - low)


@pytest.mark.parametrize("name", ["lfhh-2d-1", "lfhh-3d-1"])
def test_current_of_1024_points(benchmark: Any, name: str) -> None:
    world = auvgym.World(name)
    benchmark(world.current, points(world))


@pytest.mark.parametrize("name", ["lfhh-2d-1", "lfhh-3d-1"])
def test_clearance_of_1024_points(benchmark: Any, name: str) -> None:
    world = auvgym.World(name)
    benchmark(world.clearance, points(world))


@pytest.mark.parametrize("name", ["lfhh-2d-1", "lfhh-3d-1"])
def test_plan_lfhh(benchmark: Any, name: str) -> None:
    """A first plan over all sections; seeds in turn, as it stops at the first feasible path."""
    world, seed = auvgym.World(name), iter(range(10**6))
    benchmark.pedantic(lambda: auvgym.plan(world, "lfhh", seed=next(seed)), rounds=10)


@pytest.mark.parametrize("name", ["lfhh-2d-1", "lfhh-3d-1"])
def test_run_phases_lfhh(benchmark: Any, name: str) -> None:
    """The papers' whole run of six phases; seeds in turn."""
    world, seed = auvgym.World(name), iter(range(10**6))
    benchmark.pedantic(lambda: auvgym.run_phases(world, "lfhh", seed=next(seed)), rounds=10)


@pytest.mark.parametrize("code", ["pass", "import gymnasium", "import auvgym"])
def test_import(benchmark: Any, tmp_path: Path, code: str) -> None:
    """A fresh interpreter with bytecode: the import's time is the difference to ``pass``."""
    command = [sys.executable, "-c", code]
    environment = {**os.environ, "PYTHONPYCACHEPREFIX": str(tmp_path)}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)

    def start() -> None:
        subprocess.run(command, check=True, env=environment)

    benchmark.pedantic(start, rounds=5, warmup_rounds=1)
