"""Evaluation: the same results however they are flown, nothing lost, nothing mixed."""

from __future__ import annotations

import dataclasses
import sqlite3
from pathlib import Path

import numpy as np
import pytest

from auvgym import evaluation
from auvgym.evaluation import (
    EpisodeResult,
    Instance,
    PolicySpec,
    Store,
    StoreError,
    Suite,
    replay,
    run,
    summarise,
    wilson_interval,
)

SUITE = Suite(
    "small",
    tuple(
        Instance(environment, seed)
        for environment in ("AUVDynamic2D-v0", "AUVDynamic3D-v0")
        for seed in (11, 12)
    ),
)
SPECS = [PolicySpec("straight"), PolicySpec("sonar-rule"), PolicySpec("astar-replan")]
FAILING = """
import os
class Raises:
    name, knows = "raises", "nothing"
    def reset(self, env): self.env, self.left = env, 2
    def act(self, observation, info):
        self.left -= 1
        if self.left < 0: raise RuntimeError("lost my way")
        return self.env.action_space.low * 0
class Exits(Raises):
    def act(self, observation, info): os._exit(7)
class Nan(Raises):
    def act(self, observation, info): return self.env.action_space.low * float("nan")
class Quits(Raises):
    def act(self, observation, info): raise SystemExit(3)
class Sleeps(Raises):
    def act(self, observation, info): import time; time.sleep(60)
class Spins(Raises):
    def reset(self, env): sum(range(10**12))  # in C, and never lets go of the interpreter
"""


def comparable(results: list[EpisodeResult]) -> list[EpisodeResult]:
    """Wall clock is the one figure that may differ."""
    return [dataclasses.replace(result, planning_seconds=0.0) for result in results]


@pytest.fixture(scope="module")
def flown() -> list[EpisodeResult]:
    with Store(None) as store:
        return run(SUITE, SPECS, store)


@pytest.fixture
def failing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "failing_policies.py").write_text(FAILING)
    monkeypatch.syspath_prepend(tmp_path)


def test_the_number_of_workers_changes_nothing(flown: list[EpisodeResult]) -> None:
    with Store(None) as store:
        assert comparable(run(SUITE, SPECS, store, workers=2)) == comparable(flown)


def test_what_is_reported_is_stored(tmp_path: Path, flown: list[EpisodeResult]) -> None:
    """Cheap episodes are written together, and none counts before it is written."""
    counted: list[int] = []
    path = tmp_path / "results.db"

    def look(result: EpisodeResult, done: int, total: int) -> None:
        with Store(path, read_only=True) as other:
            assert result in other.results()
        counted.append(done)

    with Store(path) as store:
        run(SUITE, SPECS, store, on_episode=look)
    assert counted == list(range(1, len(flown) + 1))


def test_figures_make_sense(flown: list[EpisodeResult]) -> None:
    assert len(flown) == len(SUITE.instances) * len(SPECS)
    for result in flown:
        assert result.outcome in ("goal", "collision", "out_of_bounds", "energy", "timeout")
        assert bool(result.success) == (result.outcome == "goal")
        assert result.steps == len(result.action_log()) > 0
        assert result.cost is not None
        assert result.cost > 0.0
        assert 0.0 < result.still_water_time_s < result.time_limit_s
        slowness = max(1.0, result.time_s / result.still_water_time_s)
        assert result.score == (pytest.approx(1.0 / slowness) if result.success else 0.0)


def test_a_second_run_flies_only_what_is_missing(
    tmp_path: Path, flown: list[EpisodeResult]
) -> None:
    path = tmp_path / "results.db"
    flights: list[EpisodeResult] = []
    with Store(path) as store:
        run(SUITE, SPECS[:1], store)
    with Store(path) as store:
        all_of_them = run(SUITE, SPECS, store, on_episode=lambda one, *_: flights.append(one))
    assert comparable(all_of_them) == comparable(flown)
    assert {one.policy for one in flights} == {"sonar-rule", "astar-replan"}


@pytest.mark.parametrize("workers", [1, 2])
def test_an_interrupt_keeps_what_has_ended(
    workers: int, tmp_path: Path, flown: list[EpisodeResult]
) -> None:
    def stop(result: EpisodeResult, done: int, total: int) -> None:
        assert total == len(flown)
        if done == 3:
            raise KeyboardInterrupt

    path = tmp_path / "results.db"
    with Store(path) as store, pytest.raises(KeyboardInterrupt):
        run(SUITE, SPECS, store, workers, on_episode=stop)
    with Store(path) as store:
        assert 3 <= len(store.finished(SUITE)) < len(flown)
        assert comparable(run(SUITE, SPECS, store)) == comparable(flown)


@pytest.mark.usefixtures("failing")
def test_a_policy_that_fails_loses_its_episode_only() -> None:
    suite = Suite("one", SUITE.instances[:1])
    names = ["Raises", "Exits", "Nan", "Quits", "Sleeps", "Spins"]
    specs = [PolicySpec(f"failing_policies:{name}") for name in names] + [PolicySpec("straight")]
    with Store(None) as store:
        results = {one.policy: one for one in run(suite, specs, store, 2, step_limit_s=1.0)}
    errors = {name: results[f"failing_policies:{name}"] for name in names}
    assert all(one.policy_failed and one.score == 0.0 for one in errors.values())
    outcomes = {name: one.outcome for name, one in errors.items()}
    assert outcomes == {
        "Raises": "error", "Exits": "exit", "Nan": "invalid_action", "Quits": "error",
        "Sleeps": "overtime", "Spins": "overtime",
    }  # fmt: skip
    assert errors["Raises"].error == "RuntimeError: lost my way"
    assert errors["Raises"].steps == 2
    assert errors["Exits"].error == "the process ended with exit code 7"
    assert errors["Nan"].error
    assert errors["Quits"].error == "SystemExit: 3"
    assert results["straight"].outcome != "error"
    assert all(replay(one).differences == [] for one in errors.values())


@pytest.mark.usefixtures("failing")
def test_a_stranger_s_policy_cannot_end_the_only_process() -> None:
    suite = Suite("one", SUITE.instances[:1])
    specs = [PolicySpec("failing_policies:Exits"), PolicySpec("straight")]
    with Store(None) as store:
        results = {one.policy: one.outcome for one in run(suite, specs, store)}
    assert results.pop("failing_policies:Exits") == "exit"
    assert set(results) == {"straight"}


@pytest.mark.parametrize("spec", [PolicySpec("strait"), PolicySpec("straight", 0, {"speed": 3.0})])
def test_a_wrong_policy_is_refused_before_any_work(spec: PolicySpec) -> None:
    with Store(None) as store:
        with pytest.raises(ValueError, match="unknown"):
            run(SUITE, [PolicySpec("straight"), spec], store)
        assert not store.finished(SUITE)


@pytest.mark.parametrize("workers", [0, -1])
def test_no_workers_is_a_mistake(workers: int) -> None:
    with Store(None) as store, pytest.raises(ValueError, match="at least 1"):
        run(SUITE, SPECS, store, workers)


def test_every_stored_episode_flies_again_to_the_same_figures(
    tmp_path: Path, flown: list[EpisodeResult]
) -> None:
    with Store(tmp_path / "results.db") as store:
        for result in flown:
            store.add(result)
        stored = store.results(SUITE)
    assert stored == flown
    for result in stored:
        assert replay(result).differences == []


def test_a_forged_figure_or_log_is_named(flown: list[EpisodeResult]) -> None:
    result = next(one for one in flown if one.policy == "astar-replan")
    forged = dataclasses.replace(result, time_s=result.time_s - 1.0, energy_j=0.0)
    assert [text.partition(":")[0] for text in replay(forged).differences] == ["time_s", "energy_j"]
    actions = result.action_log().copy()
    actions[0] += np.float32(0.25) * np.where(actions[0] > 0, -1, 1)
    packed = evaluation.result.pack_actions(list(actions))
    assert replay(dataclasses.replace(result, actions=packed)).differences
    shorter = evaluation.result.pack_actions(list(result.action_log()[:-1]))
    cut = dataclasses.replace(result, actions=shorter, steps=result.steps - 1)
    assert any("the log ends" in text for text in replay(cut).differences)
    with pytest.raises(evaluation.ReplayError, match="damaged"):
        replay(dataclasses.replace(result, actions=b"not a log"))


def test_a_file_that_is_not_ours_is_left_alone(tmp_path: Path) -> None:
    text = tmp_path / "notes.db"
    text.write_text("shopping list\n" * 100)
    with pytest.raises(StoreError, match="not an auvgym results file"):
        Store(text)
    assert text.read_text().startswith("shopping list")
    other = tmp_path / "other.db"
    with sqlite3.connect(other) as database:
        database.execute("CREATE TABLE songs (name TEXT)")
    database.close()
    before = other.read_bytes()
    with pytest.raises(StoreError, match="but not auvgym's"):
        Store(other)
    assert other.read_bytes() == before


def test_a_folder_that_cannot_be_written_is_an_error_at_once(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(StoreError, match="cannot be kept there"):
        Store(tmp_path / "file" / "results.db")
    # /proc takes no files from anybody, root included.
    with pytest.raises(StoreError, match="cannot be kept there"):
        Store("/proc/auvgym/results.db")
    with pytest.raises(StoreError, match="cannot be kept there"):
        Store(tmp_path)


def test_results_of_another_suite_or_engine_are_not_mixed(
    tmp_path: Path, flown: list[EpisodeResult]
) -> None:
    path = tmp_path / "results.db"
    with Store(path) as store:
        store.add(dataclasses.replace(flown[0], engine_version="0.0.1"))
        with pytest.raises(StoreError, match=r"from auvgym 0\.0\.1"):
            run(SUITE, SPECS, store)
        store.forget(SUITE)
        store.add(flown[0])
        changed = Suite(SUITE.name, SUITE.instances[:1])
        with pytest.raises(StoreError, match="has changed"):
            run(changed, SPECS, store)


def test_an_episode_is_stored_once(tmp_path: Path, flown: list[EpisodeResult]) -> None:
    path = tmp_path / "results.db"
    with Store(path) as first, Store(path) as second:
        first.add(flown[0])
        second.add(dataclasses.replace(flown[0], score=9.0))
        assert first.results() == second.results() == [flown[0]]


def test_the_ranking_counts_failures(flown: list[EpisodeResult]) -> None:
    base = dataclasses.replace(flown[0], environment="E", still_water_time_s=100.0)

    def row(policy: str, seed: int, time_s: float, success: int) -> EpisodeResult:
        return dataclasses.replace(
            base, policy=policy, seed=seed, success=success, time_s=time_s, time_limit_s=150.0,
            score=success * 100.0 / time_s, outcome="goal" if success else "collision",
        )  # fmt: skip

    rows = [row("quick", 0, 100.0, 1), row("quick", 1, 10.0, 0)]
    rows += [row("steady", 0, 120.0, 1), row("steady", 1, 125.0, 1)]
    first, second = summarise(rows)
    assert (first.policy, first.rank, first.solved) == ("steady", 1, 2)
    assert (second.policy, second.time_s, second.time_or_limit_s) == ("quick", 100.0, 125.0)
    assert (second.solved, second.episodes) == (1, 2)
    assert first.score == pytest.approx((100 / 120 + 100 / 125) / 2)


@pytest.mark.parametrize(
    ("solved", "episodes", "low", "high"),
    [(0, 0, 0.0, 1.0), (0, 10, 0.0, 0.2775), (355, 512, 0.6521, 0.7317), (10, 10, 0.7225, 1.0)],
)
def test_wilson(solved: int, episodes: int, low: float, high: float) -> None:
    assert wilson_interval(solved, episodes) == pytest.approx((low, high), abs=5e-5)
