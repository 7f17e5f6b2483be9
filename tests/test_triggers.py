"""Triggers: when to plan anew, alone, on boards and on the command line."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from replan_episodes import fly, make
from typer.testing import CliRunner

from auvgym import policies
from auvgym.cli import app
from auvgym.evaluation import Instance, PolicySpec, Store, Suite, run, verify
from auvgym.policies import PolicyError

REPLAN = '{"action_mode": "replan"}'


def test_never_flies_the_first_plan() -> None:
    env = make()
    env.reset(seed=5)
    plan = env.unwrapped.plan
    info, taken = fly(env, 5, "never")
    assert set(taken) == {0}
    assert np.array_equal(env.unwrapped.plan, plan)
    assert (info["replans"], info["planning_s"]) == (0, 0.0)


def test_every_change_plans_once_for_each() -> None:
    env = make(planning_s=0)
    info, taken = fly(env, 5, "every-change", window="long")
    assert set(taken) == {0, 2}
    assert info["replans"] in (info["map_changes"], info["map_changes"] - 1)
    assert info["replans"] > 3


def test_every_k() -> None:
    env = make(planning_s=0)
    info, _ = fly(env, 5, "every-k", k=3)
    assert info["replans"] in (info["map_changes"] // 3, (info["map_changes"] - 1) // 3)
    _, taken = fly(env, 5, "every-k", k=4, of="legs", window="short")
    assert taken[:9] == [0, 0, 0, 0, 1, 0, 0, 0, 1]


def test_on_predicted_collision() -> None:
    env = make(planning_s=0)
    replans, arrived = [], []
    for distance_m in (1.0, 2000.0, None):
        infos = [fly(env, s, "on-predicted-collision", distance_m=distance_m)[0] for s in range(12)]
        replans.append(sum(info["replans"] for info in infos))
        arrived.append(sum(info["outcome"] != "collision" for info in infos))
    assert replans[0] < replans[1] <= replans[2]
    assert arrived[0] < arrived[1]
    assert arrived[2] >= 11


def test_they_are_named_and_refuse_what_they_cannot() -> None:
    known = ["never", "every-change", "every-k", "on-predicted-collision"]
    assert policies.list_triggers() == known
    for name in policies.list_triggers():
        assert isinstance(policies.make(name), policies.Policy)
    for name, wrong in [
        ("every-change", {"window": "wide"}),
        ("every-k", {"k": 0}),
        ("every-k", {"of": "ticks"}),
        ("on-predicted-collision", {"distance_m": 0.0}),
        ("never", {"k": 2}),
    ]:
        with pytest.raises(PolicyError, match=next(iter(wrong))):
            policies.make(name, **wrong)
    waypoint = gymnasium.make("AUVDynamic2D-v0")
    waypoint.reset(seed=1)
    with pytest.raises(PolicyError, match="replan"):
        policies.make("never").reset(waypoint)


# --- trained ones ---------------------------------------------------------------------------------


def total_times(environment: str, seeds: range, name: str, **parameters: Any) -> np.ndarray:
    """Travel and planning together over the time limit, failures counted as the limit."""
    env = gymnasium.make(environment, action_mode="replan", difficulty="hard")
    shares = []
    for seed in seeds:
        info, _ = fly(env, seed, name, **parameters)
        limit_s = env.unwrapped.episode.time_limit_s
        shares.append(info["time_s"] / limit_s if info["is_success"] else 1.0)
    return np.array(shares)


@pytest.mark.parametrize(("environment", "episodes"), [("AUVDynamic2D-v0", 30)])
def test_the_shipped_trigger_beats_planning_to_the_goal(environment: str, episodes: int) -> None:
    pytest.importorskip("onnxruntime")
    seeds = range(90_000, 90_000 + episodes)
    agent = total_times(environment, seeds, "ppo")
    for name in ("every-change", "on-predicted-collision"):
        gained = total_times(environment, seeds, name) - agent
        assert gained.mean() > 2.0 * gained.std(ddof=1) / episodes**0.5, name


def test_the_judgement_of_the_shipped_triggers(tmp_path: Path) -> None:
    pytest.importorskip("onnxruntime")
    script = Path(__file__).parents[1] / "baselines" / "agents" / "judge_triggers.py"
    done = subprocess.run(
        [sys.executable, script, "--episodes", "3", "--workers", "1", "--env", "AUVDynamic2D-v0"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    agent, *others = (line.split(" | ") for line in done.stdout.splitlines())
    assert [agent[1], others[0][1], others[3][1]] == ["ppo", "never", "every-change, short"]
    assert len(others) == 6
    assert others[0][4:7] == ["0.0", "0.0", "0.0"]
    assert float(others[1][6]) > 3.0
    assert others[3][5:7] == ["0.0", "0.0"]
    for other in others:
        gained, faster = (float(cell.split()[0]) for cell in other[7:9])
        solved = float(agent[2].split()[0]) - float(other[2].split()[0])
        assert gained == pytest.approx(solved, abs=0.11)
        assert faster == pytest.approx(float(agent[3]) - float(other[3]), abs=2e-3)


# --- on the board ---------------------------------------------------------------------------------


def test_boards_fly_verify_and_fly_again(tmp_path: Path) -> None:
    names = ["never", "every-change", "every-k", "on-predicted-collision", "random"]
    suite = Suite("mine", tuple(Instance("AUVDynamic2D-v0", s, settings=REPLAN) for s in (4, 5)))
    path = tmp_path / "results.db"
    with Store(path) as store:
        rows = run(suite, [PolicySpec(name) for name in names], store)
    assert {row.policy: row.error for row in rows} == dict.fromkeys(names, "")
    assert all(row.evaluations > 0 for row in rows)
    assert all((row.replans > 0) == (row.policy != "never") for row in rows)
    found = verify(path, refly=len(rows))
    assert (found.rows, found.reflown, found.differences) == (10, 10, [])


def test_who_flies_where() -> None:
    from auvgym.evaluation import fitting

    replan = Instance("AUVDynamic2D-v0", 1, settings=REPLAN)
    waypoint = Instance("AUVDynamic2D-v0", 1)
    for name, here, there in [
        ("never", True, False),
        ("random", True, True),
        ("straight", False, True),
        ("lfhh", False, True),
        ("ppo", True, True),
    ]:
        assert fitting(PolicySpec(name), replan) is here
        assert fitting(PolicySpec(name), waypoint) is there
    assert not fitting(PolicySpec("ppo"), replace(replan, environment="AUVHarbor2D-v0"))


def test_on_the_command_line(tmp_path: Path) -> None:
    command = ["evaluate", "--policy", "every-change", "--set", "window=short", "--episodes", "2"]
    command += ["--env-set", "action_mode=replan", "--env-set", "planning_s=300"]
    runner = CliRunner()
    found = runner.invoke(app, [*command, "--out", str(tmp_path)])
    assert found.exit_code == 0, found.output
    found = runner.invoke(app, ["verify", str(tmp_path / "results.db"), "--refly", "2"])
    assert found.exit_code == 0, found.output
    found = runner.invoke(app, ["evaluate", "--policy", "never", "--episodes", "1"])
    assert "replan" in found.output
    listed = runner.invoke(app, ["list", "policies"]).output
    assert "on-predicted-collision" in listed
