"""What the batch behind ``make_vec`` does a second, beside EnvPool's classics (extra ``bench``).

Run with ``make bench``, or ``pytest benches/test_bench_batch.py --benchmark-only -s``. A round is
ROUND steps of all COUNT environments on THREADS threads; the rates stand under ``extra_info``
(``--benchmark-json``) and are printed at the end (``-s``): steps a second in the fastest of ROUNDS,
and for each second of processor time in all of them.
"""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from typing import Any

import gymnasium
import numpy as np
import pytest

import auvgym

COUNT = 256
THREADS = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else 2
ROUND = 64
ROUNDS = 24


@pytest.fixture(scope="module")
def table() -> Iterator[list[str]]:
    """Lines that are printed after the last benchmark."""
    lines: list[str] = []
    yield lines
    print(f"\n{COUNT} environments, {THREADS} threads unless said")
    print("\n".join(lines))


def measure(benchmark: Any, step: Any, name: str, table: list[str], ticks: Any = None) -> None:
    """Benchmark rounds of ``step(i)``; ``ticks()`` tells how many were flown so far."""

    def steps() -> None:
        for i in range(ROUND):
            step(i)

    steps()
    began = time.process_time()
    benchmark.pedantic(steps, rounds=ROUNDS)
    spent = time.process_time() - began
    # Of a machine that others use too the fastest round tells most.
    rate = COUNT * ROUND / benchmark.stats.stats.min
    of_processor = COUNT * ROUND * ROUNDS / spent
    benchmark.extra_info["steps_per_s"] = round(rate)
    benchmark.extra_info["steps_per_processor_s"] = round(of_processor)
    line = f"{name:32} {rate:12,.0f} steps/s {of_processor:12,.0f} steps/processor s"
    if ticks is not None:
        each = ticks() / (COUNT * ROUND * (ROUNDS + 1))
        benchmark.extra_info["ticks_per_s"] = round(rate * each)
        line += f" {rate * each:14,.0f} ticks/s"
    table.append(line)


@pytest.mark.parametrize("threads", sorted({1, THREADS}))
@pytest.mark.parametrize("env_id", sorted(auvgym.registration.ENVIRONMENTS))
def test_batch_of_256(benchmark: Any, table: list[str], env_id: str, threads: int) -> None:
    """Random waypoints, with the resets that they need: each step is a whole leg."""
    envs: Any = gymnasium.make_vec(
        env_id, num_envs=COUNT, autoreset_mode="SameStep", threads=threads
    )
    envs.reset(seed=0)
    tick_s = envs.members[0].episode.tick_s
    random = np.random.default_rng(0)
    shape = (ROUND, *envs.action_space.shape)
    actions = random.uniform(-1, 1, shape).astype(np.float32)
    flown = np.zeros(COUNT)
    before = np.zeros(COUNT)

    def step(i: int) -> None:
        *_, ended, _, infos = envs.step(actions[i])
        after = infos["time_s"]
        now = np.where(ended, infos["final_info"]["time_s"], after) if ended.any() else after
        flown[:] += now - before
        before[:] = after

    measure(benchmark, step, f"{env_id}, {threads} threads", table, lambda: flown.sum() / tick_s)


@pytest.mark.parametrize("env_id", ["AUVDynamic2D-v0", "AUVDynamic3D-v0"])
def test_stable_baselines_batch_of_256(benchmark: Any, table: list[str], env_id: str) -> None:
    """The same through ``auvgym.sb3``."""
    pytest.importorskip("stable_baselines3")
    from auvgym.sb3 import make_vec_env

    envs = make_vec_env(env_id, n_envs=COUNT, seed=0)
    envs.reset()
    shape = (ROUND, COUNT, *envs.action_space.shape)
    actions = np.random.default_rng(0).uniform(-1, 1, shape).astype(np.float32)
    measure(benchmark, lambda i: envs.step(actions[i]), f"sb3 {env_id}", table)


@pytest.mark.filterwarnings("ignore")  # about its own spaces
@pytest.mark.parametrize("env_id", ["Pendulum-v1", "LunarLanderContinuous-v3"])
def test_envpool_batch_of_256(benchmark: Any, table: list[str], env_id: str) -> None:
    """EnvPool's own engine, for comparison: a step of these is one tick of physics."""
    envpool = pytest.importorskip("envpool")
    envs = envpool.make_gymnasium(env_id, num_envs=COUNT, num_threads=THREADS)
    envs.reset()
    low, high = envs.action_space.low, envs.action_space.high
    shape = (ROUND, COUNT, *envs.action_space.shape)
    actions = np.random.default_rng(0).uniform(low, high, shape).astype(np.float32)
    measure(benchmark, lambda i: envs.step(actions[i]), f"EnvPool {env_id}", table)


def test_reset_of_4096(benchmark: Any) -> None:
    """New worlds for all."""
    envs = gymnasium.make_vec("AUVDynamic3D-v0", num_envs=4096)
    envs.reset(seed=0)
    benchmark.pedantic(envs.reset, rounds=3)
