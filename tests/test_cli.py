"""The command line: each command, each mistake in one line, and Ctrl-C in the middle of a run."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner, Result

import auvgym
from auvgym.cli import app
from auvgym.evaluation import Instance, PolicySpec, Store, Suite, run
from auvgym.registration import ENVIRONMENTS

SUITE_TOML = """
schema = 1
name = "{name}"
[[instances]]
environment = "AUVDynamic2D-v0"
seeds = {{ first = 21, count = {count} }}
"""


def call(*arguments: str | Path) -> Result:
    return CliRunner().invoke(
        app, [str(one) for one in arguments], env={"COLUMNS": "100", "NO_COLOR": "1"}
    )


def suite_file(folder: Path, count: int) -> Path:
    path = folder / "suite.toml"
    path.write_text(SUITE_TOML.format(name="own", count=count))
    return path


def test_version() -> None:
    assert call("--version").output.strip() == f"auvgym {auvgym.__version__}"


@pytest.mark.parametrize(
    "command",
    [
        "list",
        "plan",
        "evaluate",
        "leaderboard",
        "replay",
        "verify",
        "report",
        "export",
        "suite",
    ],
)
def test_help_has_an_example(command: str) -> None:
    result = call(command, "--help")
    assert result.exit_code == 0
    assert f"auvgym {command}" in result.output


def test_list_names_everything() -> None:
    result = call("list")
    assert result.exit_code == 0
    names = [*auvgym.list_scenarios(), *auvgym.list_planners(), *auvgym.list_policies()]
    for name in [*names, *ENVIRONMENTS, "demo"]:
        assert name in result.output
    assert "lfhh-2d-1" not in call("list", "policies").output


def test_plan_writes_what_it_found(tmp_path: Path) -> None:
    for name in ("plan.json", "plan.csv"):
        result = call("plan", "lfhh-2d-1", "--seed", "1", "--out", tmp_path / name)
        assert result.exit_code == 0, result.output
        assert "feasible" in result.output
    content = json.loads((tmp_path / "plan.json").read_text())
    plan = auvgym.plan(auvgym.World("lfhh-2d-1", seed=1), "lfhh", seed=1)
    assert content["evaluations"] == plan.evaluations
    assert [list(one.values()) for one in content["waypoints"]] == plan.waypoints.tolist()
    with (tmp_path / "plan.csv").open() as file:
        rows = list(csv.reader(file))
    assert rows[0] == ["x_m", "y_m", "z_m"]
    assert [[float(one) for one in row] for row in rows[1:]] == plan.waypoints.tolist()


def test_plan_between_points_of_ones_own(tmp_path: Path) -> None:
    out = tmp_path / "plan.json"
    result = call(
        "plan", "lfhh-2d-1", "--start", "4000,0", "--goal", "9000,39000", "--out", out
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    waypoints = json.loads(out.read_text())["waypoints"]
    assert (waypoints[0]["x_m"], waypoints[0]["y_m"]) == (4000.0, 0.0)
    assert (waypoints[-1]["x_m"], waypoints[-1]["y_m"]) == (9000.0, 39000.0)


def test_plan_through_a_real_ocean_gives_longitudes_and_latitudes(tmp_path: Path) -> None:
    xarray = pytest.importorskip("xarray")
    coordinates = {
        "latitude": ("latitude", np.linspace(35.0, 36.0, 11), {"units": "degrees_north"}),
        "longitude": ("longitude", np.linspace(-71.0, -69.0, 21), {"units": "degrees_east"}),
    }

    def write(path: Path, units: dict[str, str], **values: float) -> None:
        fields = {
            name: (("latitude", "longitude"), np.full((11, 21), value), units)
            for name, value in values.items()
        }
        xarray.Dataset(fields, coords=coordinates).to_netcdf(path)

    write(tmp_path / "currents.nc", {"units": "m s-1"}, uo=0.2, vo=0.2)
    write(tmp_path / "depth.nc", {"units": "m", "positive": "down"}, deptho=3000.0)
    result = call(
        "plan", "--currents", tmp_path / "currents.nc", "--bathymetry", tmp_path / "depth.nc",
        "--start", "-70.5,35.5", "--goal", "-69.5,35.5", "--speed", "1.0", "--planner", "astar",
        "--out", tmp_path / "plan.csv",
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    # 90.5 km eastward; 0.2 m/s help along, and 0.2 m/s to crab against: 1.18 m/s over ground.
    assert "in still water 25.15 h" in result.output
    assert "travel time  21.3" in result.output
    with (tmp_path / "plan.csv").open() as file:
        rows = list(csv.DictReader(file))
    ends = [(float(row["longitude_deg"]), float(row["latitude_deg"])) for row in rows]
    assert ends[0] == pytest.approx((-70.5, 35.5), abs=1e-6)
    assert ends[-1] == pytest.approx((-69.5, 35.5), abs=1e-6)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["plan"], "give a SCENARIO"),
        (["plan", "lfhh-2d-9"], "lfhh-2d-1"),
        (["plan", "lfhh-2d-1", "--planner", "lfh"], "lfhh"),
        (["plan", "lfhh-2d-1", "--start", "1,2,3,4"], "2 or 3 numbers"),
        (["plan", "lfhh-2d-1", "--start", "here,there"], "2 or 3 numbers"),
        (["plan", "lfhh-2d-1", "--out", "plan.txt"], "must end in .json or .csv"),
        (["plan", "lfhh-2d-1", "--set", "generations"], "written key=value"),
        (["plan", "lfhh-2d-1", "--depth", "3"], "goes with --currents"),
        (["plan", "lfhh-2d-1", "--currents", "x.nc"], "not both"),
        (["plan", "--currents", "x.nc"], "needs --start"),
        (["evaluate", "--policy", "strait"], "did you mean 'straight'"),
        (["evaluate", "--policy", "straight", "--env", "AUVDynamic9D-v0"], "AUVDynamic9D"),
        (["evaluate", "--policy", "straight", "--difficulty", "heroic"], "heroic"),
        (["evaluate", "--policy", "straight", "--episodes", "0"], "at least 1"),
        (["leaderboard", "--suite", "demos"], "did you mean 'demo'"),
        (["leaderboard", "--policies", ","], "names none"),
        (["leaderboard", "--out", "/proc/auvgym"], "cannot be kept there"),
        (["replay", "/no/such/results.db"], "no such file"),
    ],
)
def test_a_mistake_is_one_line_and_code_2(
    arguments: list[str], message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    result = call(*arguments)
    assert result.exit_code == 2, result.output
    assert message in result.output
    assert result.output.startswith("Error: ")
    assert "Traceback" not in result.output
    assert result.output.count("\n") == 1
    assert not list(tmp_path.rglob("results.db"))


def test_a_traceback_on_request(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("AUVGYM_TRACEBACK", "1")
    assert isinstance(call("plan", "lfhh-2d-9").exception, ValueError)


def test_evaluate_prints_one_row(tmp_path: Path) -> None:
    result = call(
        "evaluate", "--policy", "sonar-rule", "--episodes", "2", "--set", "tube_radius_m=300",
        "--out", tmp_path,
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    assert 'sonar-rule {"tube_radius_m": 300}' in result.output
    with Store(tmp_path / "results.db") as store:
        assert len(store.results()) == 2


def test_leaderboard_ranks_writes_and_replays(tmp_path: Path) -> None:
    suite = suite_file(tmp_path, 2)
    arguments = ("leaderboard", "--suite", suite, "--policies", "straight,lane", "--out", tmp_path)
    first = call(*arguments)
    assert first.exit_code == 0, first.output
    assert "AUVDynamic2D-v0 · normal · 2 episodes" in first.output
    page = (tmp_path / "leaderboard.html").read_text()
    assert "straight" in page
    assert "<script src=" not in page, "the page must work offline"
    again = call(*arguments)
    assert again.output == first.output
    replayed = call("replay", tmp_path / "results.db", "--policy", "lane", "--seed", "21")
    assert replayed.exit_code == 0, replayed.output
    assert "Every figure is as stored." in replayed.output
    many = call("replay", tmp_path / "results.db")
    assert many.exit_code == 2
    assert "4 stored episodes match" in many.output


def test_replay_names_a_forged_figure(tmp_path: Path) -> None:
    import dataclasses

    suite = Suite("own", (Instance("AUVDynamic2D-v0", 21),))
    with Store(None) as memory, Store(tmp_path / "results.db") as store:
        (result,) = run(suite, [PolicySpec("straight")], memory)
        store.add(dataclasses.replace(result, energy_j=1.0))
    replayed = call("replay", tmp_path / "results.db")
    assert replayed.exit_code == 1
    assert "differs: energy_j: stored 1.0" in replayed.output


@pytest.mark.skipif(os.name == "nt", reason="signals are sent the POSIX way")
@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGKILL])
def test_a_stopped_leaderboard_goes_on(how: signal.Signals, tmp_path: Path) -> None:
    suite = suite_file(tmp_path, 2000)
    database = tmp_path / "results.db"
    process = subprocess.Popen(
        [sys.executable, "-c", "from auvgym.cli import main; main()", "leaderboard",
         "--suite", str(suite), "--policies", "straight,sonar-rule", "--workers", "2",
         "--out", str(tmp_path)],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip
    try:
        _wait_for_rows(database, process, 5)
        process.send_signal(how)
        stopped = time.monotonic()
        _, messages = process.communicate(timeout=20)
        seconds = time.monotonic() - stopped
    finally:
        if process.poll() is None:
            process.kill()
    with Store(database) as store:
        kept = store.results()
    assert 5 <= len(kept) < 4000
    if how is signal.SIGINT:
        assert process.returncode == 130, messages
        assert seconds < 5.0  # a second on an idle machine
        assert f"{len(kept)} of 4000 episodes are kept" in messages
        assert "Traceback" not in messages
    # What was kept is what an undisturbed run gives.
    again = Suite("again", tuple(one.instance for one in kept if one.policy == "straight")[:2])
    with Store(None) as memory:
        for one in run(again, [PolicySpec("straight")], memory):
            stored = next(x for x in kept if (x.policy, x.seed) == ("straight", one.seed))
            assert (stored.time_s, stored.actions) == (one.time_s, one.actions)


def _wait_for_rows(database: Path, process: subprocess.Popen[str], rows: int) -> None:
    deadline = time.monotonic() + 60.0
    while time.monotonic() < deadline:
        assert process.poll() is None, process.communicate()
        if database.exists():
            with Store(database, read_only=True) as store:
                if len(store.results()) >= rows:
                    return
        time.sleep(0.1)
    raise AssertionError("no episode was stored in 60 s")
