"""What evaluating costs beside flying: storing, ranking, verifying, reporting."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from board_rows import row

from auvgym import policies
from auvgym.evaluation import EpisodeResult, PolicySpec, Store, load_suite, run, verify
from auvgym.evaluation.board import board, columns_of
from auvgym.evaluation.statistics import score_tables
from auvgym.report.board_page import write_board

# 20 policies on the 2 500 instances of a suite of five environments at three difficulties.
POLICIES, STRATA, SEEDS = 20, 15, 167


def fifty_thousand() -> list[EpisodeResult]:
    scores = np.random.default_rng(1).uniform(0.0, 1.0, (STRATA, POLICIES, SEEDS))
    scores[scores < 0.3] = 0.0
    return [
        row(f"policy-{policy}", seed, float(scores[stratum, policy, seed]),
            environment=f"World{stratum // 3}", difficulty=("easy", "normal", "hard")[stratum % 3])
        for stratum in range(STRATA) for policy in range(POLICIES) for seed in range(SEEDS)
    ]  # fmt: skip


def test_report_of_fifty_thousand_episodes(benchmark: Any, tmp_path: Path) -> None:
    """Promised: 20 s; without episodes to watch, of which each is a replay and a figure."""
    rows = fifty_thousand()

    def report() -> None:
        tables = score_tables(rows)
        boards = board(rows, "policy-3", tables)
        columns = {stratum: columns_of(stratum) for stratum in boards}
        by_stratum = {table.stratum: table for table in tables}
        write_board(tmp_path, "benchmark", "", boards, columns, by_stratum, {}, [])

    benchmark.pedantic(report, rounds=1)


def test_a_row_on_the_disk(benchmark: Any, tmp_path: Path) -> None:
    numbers = iter(range(10**9))
    with Store(tmp_path / "results.db") as store:
        benchmark(lambda: store.add(row(seed=next(numbers))))


@pytest.mark.parametrize("policy", ["straight", "sonar-rule", "astar-replan", "lfhh"])
def test_running_against_flying(policy: str, benchmark: Any, tmp_path: Path) -> None:
    """extra_info: what measuring and keeping episodes takes beside flying them, a part of it."""
    suite = load_suite("demo")
    envs = {one.environment: gymnasium.make(one.environment) for one in suite.instances}
    numbers = iter(range(10**9))

    def fly() -> float:
        pilot = policies.make(policy)
        begin = time.process_time()
        for instance in suite.instances:
            env = envs[instance.environment]
            observation, info = env.reset(seed=instance.seed)
            policies.begin(pilot, env, observation, info)
            ended = False
            while not ended:
                observation, _, ended, _, info = env.step(pilot.act(observation, info))
        return time.process_time() - begin

    def run_it() -> float:
        begin = time.process_time()
        with Store(tmp_path / f"{next(numbers)}.db") as store:
            run(suite, [PolicySpec(policy)], store)
        return time.process_time() - begin

    run_it()
    flying = min(fly() for _ in range(3))
    running = benchmark.pedantic(lambda: min(run_it() for _ in range(3)), rounds=1)
    benchmark.extra_info["overhead"] = running / flying - 1.0
    benchmark.extra_info["overhead_ms_an_episode"] = 1e3 * (running - flying) / len(suite.instances)


@pytest.mark.parametrize("policy", ["straight", "sonar-rule", "lfhh"])
def test_verifying_against_flying(policy: str, benchmark: Any, tmp_path: Path) -> None:
    """extra_info: the run's seconds over the verification's."""
    path = tmp_path / "results.db"
    begin = time.perf_counter()
    with Store(path) as store:
        run(load_suite("demo"), [PolicySpec(policy)], store)
    flying = time.perf_counter() - begin
    benchmark.pedantic(lambda: verify(path), rounds=3)
    benchmark.extra_info["times_faster"] = flying / benchmark.stats.stats.min
