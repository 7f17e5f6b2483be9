"""Scenarios: what is wrong is named, and nothing is let in."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any

import fresh_python
import pytest
from everything import EVERYTHING
from hypothesis import given, settings
from hypothesis import strategies as st
from small_worlds import open_water

import auvgym
from auvgym import Scenario, ScenarioError, World

SHIPPED = auvgym.list_scenarios()

# --- bad input ---------------------------------------------------------------------------------

# Edits of EVERYTHING: what is replaced, by what, and what the message must name.
EDITS: dict[str, tuple[str, str, list[str]]] = {
    "schema": ("schema = 1", "schema = 2", ["schema = 2", "schema 1"]),
    "name": ('name = "everything"', 'name = ""', ["name", "must not be empty"]),
    "dimensions": ("dimensions = 3", "dimensions = 4", ["dimensions = 4", "2 or 3"]),
    "flat box": (
        "max_m = [20000, 20000, 4000]",
        "max_m = [20000, 20000, 0]",
        ["domain.max_m[2] = 0"],
    ),
    "inverted box": ("max_m = [20000,", "max_m = [-20000,", ["domain.max_m[0] = -20000", "min_m"]),
    "box in the air": (
        "min_m = [0.0, 0.0, 0.0]",
        "min_m = [0.0, 0.0, -5.0]",
        ["domain.min_m[2] = -5"],
    ),
    "goal radius": ("goal_radius_m = 250.0", "goal_radius_m = 0", ["limits.goal_radius_m = 0"]),
    "time factor": (
        "time_factor = 2.0",
        "time_factor = 0.9",
        ["limits.time_factor = 0.9", "at least 1"],
    ),
    "speed": (
        "speed_mps = 1.5",
        "speed_mps = -1.5",
        ["vehicle.speed_mps = -1.5", "greater than 0"],
    ),
    "tick": ("tick_s = 10.0", "tick_s = 0", ["episode.tick_s = 0", "greater than 0"]),
    "tiny tick": ("tick_s = 10.0", "tick_s = 1e-9", ["episode.tick_s", "million"]),
    "zero sections": ("count = 20", "count = 0", ["sections.count = 0", "2 .. "]),
    "sections too long": (
        "spacing_m = 1000.0",
        "spacing_m = 2e3",
        ["sections.spacing_m = 2000", "20000"],
    ),
    "section frame": (
        "count = 20",
        'frame = "mission"\ncount = 20',
        ["sections.frame", "half_width_m"],
    ),
    "peak": ("sigma_m = 1800", "sigma_m = 0", ["seabed.peaks[0].sigma_m = 0"]),
    "change distance": (
        "every_m = 6000.0",
        "every_m = 0",
        ["change.every_m = 0", "greater than 0"],
    ),
    "change table": (
        "vortices_m = [[9000, 9000]]",
        "vortices_m = []",
        ["phases[0].vortices_m", "needs 1"],
    ),
    "start in an obstacle": (
        "start_m = [10000.0, 0.0, 1000.0]",
        "start_m = [6000.0, 12000.0, 1500.0]",
        ["missions[0].start_m = [6000", "inside rock or an obstacle", "-800"],
    ),
    "start in rock": (
        "start_m = [10000.0, 0.0, 1000.0]",
        "start_m = [5000.0, 8000.0, 3000.0]",
        ["missions[0].start_m", "inside rock"],
    ),
    "goal outside": (
        "goal_m = [10000.0, 19000.0, 1000.0]",
        "goal_m = [10000.0, 21000.0, 1000.0]",
        ["missions[0].goal_m[1] = 21000", "0 .. 20000"],
    ),
    "goal at the start": (
        "goal_m = [10000.0, 19000.0, 1000.0]",
        "goal_m = [10000.0, 100.0, 1000.0]",
        ["missions[0].goal_m = 100 m away", "goal radius, 250"],
    ),
    "infinite goal": (
        "goal_m = [10000.0,",
        "goal_m = [inf,",
        ["missions[0].goal_m = inf", "finite"],
    ),
    "negative radius": ("radius_m = 800.0", "radius_m = -800.0", ["obstacles[0].radius_m = -800"]),
    "NaN radius": ("radius_m = 800.0", "radius_m = nan", ["obstacles[0].radius_m = NaN", "finite"]),
    "monstrous radius": (
        "radius_m = 800.0",
        "radius_m = 1e300",
        ["obstacles[0].radius_m = 1", "at most"],
    ),
    "NaN drift": (
        "drift_mps = [0.1,",
        "drift_mps = [nan,",
        ["vortices[0].drift_mps = NaN", "finite"],
    ),
    "core radius": (
        "core_radius_m = 1200.0",
        "core_radius_m = 0",
        ["currents[1].core_radius_m = 0"],
    ),
    "jet scale": (
        "length_scale_m = 2000.0",
        "length_scale_m = 0",
        ["currents[2].length_scale_m = 0"],
    ),
    "axis": (
        "x_m = [0, 10000, 20000]",
        "x_m = [0, 20000, 10000]",
        ["currents[3].x_m = 20000, 10000", "ascend"],
    ),
    "short axis": (
        "x_m = [0, 10000, 20000]",
        "x_m = [0]",
        ["currents[3].x_m = 1 values", "at least 2"],
    ),
    "times": ("time_s = [0, 3600]", "time_s = [0, 0]", ["currents[3].time_s = 0, 0", "ascend"]),
    "degrees": (
        "x_m = [0, 10000, 20000]",
        "longitude_deg = [0, 1, 2]",
        ["currents[3]", "longitude_deg"],
    ),
    "too few data": ("v_mps = [0, ", "v_mps = [", ["currents[3].v_mps = 23 values", "needs 24"]),
    "infinite data": ("v_mps = [0, ", "v_mps = [inf, ", ["currents[3].v_mps = inf", "NaN"]),
    "base64": ('u_mps = "f32le:zczM', 'u_mps = "f32le:!!!!', ["currents[3].u_mps", "base64"]),
    "packing": ('u_mps = "f32le:', 'u_mps = "f64le:', ["currents[3].u_mps", "f32le:"]),
    "cylinder": (
        "top_m = 500.0",
        "top_m = 2500.0",
        ["obstacles[2].top_m = 2500", "bottom_m = 2500"],
    ),
    "superquadric": (
        "[2.0, 4.0, 2.0]",
        "[0.5, 4.0, 2.0]",
        ["obstacles[3].exponents = 0.5", "1 .. 100"],
    ),
    "bow tie": (
        "[[2000, 15000], [6000, 15000], [6000, 17000], [4000, 16000], [2000, 17000]]",
        "[[2000, 15000], [6000, 17000], [6000, 15000], [2000, 17000]]",
        ["obstacles[4].vertices_m = 4 corners", "touch itself"],
    ),
    "a line": (
        "[[2000, 15000], [6000, 15000], [6000, 17000], [4000, 16000], [2000, 17000]]",
        "[[2000, 15000], [3000, 15000], [4000, 15000]]",
        ["obstacles[4].vertices_m = 3 corners", "on a line"],
    ),
    "two corners": (
        "[[2000, 15000], [6000, 15000], [6000, 17000], [4000, 16000], [2000, 17000]]",
        "[[2000, 15000], [3000, 15000]]",
        ["obstacles[4].vertices_m = 2 corners", "3 .. "],
    ),
    "unknown key": (
        "[vehicle]\nspeed_mps",
        "[vehicle]\nspeed",
        ["vehicle.speed", "unknown field `speed`", "expected one of", "speed_mps"],
    ),
    "unknown key above": (
        "schema = 1",
        "schema = 1\nseabeds = 3",
        ["unknown field `seabeds`", "`seabed`"],
    ),
    "unknown key in an obstacle": (
        "radius_m = 800.0",
        "radius = 800.0",
        ["obstacles[0]", "unknown field `radius`", "`radius_m`"],
    ),
    "unknown kind": ('kind = "sphere"', 'kind = "ball"', ["obstacles[0]", "`ball`", "`sphere`"]),
    "missing key": ("tick_s", "station_radius_m", []),  # every episode key has a default
    "missing name": ('name = "everything"\n', "", ["missing field `name`"]),
    "wrong type": ("count = 20", 'count = "twenty"', ["sections.count", '"twenty"', "expected"]),
    "fraction": ("count = 20", "count = 20.5", ["sections.count", "20.5", "expected"]),
    "short vector": (
        "velocity_mps = [0.1, -0.2]",
        "velocity_mps = [0.1]",
        ["currents[0]", "length"],
    ),
    "twice": ("schema = 1", "schema = 1\nschema = 1", ["duplicate key"]),
    "malformed": ("schema = 1", "schema = = 1", ["line 2", "schema = = 1"]),
}


@pytest.mark.parametrize("case", EDITS)
def test_what_is_wrong_in_a_file_is_said_by_name(case: str, tmp_path: Path) -> None:
    old, new, fragments = EDITS[case]
    assert EVERYTHING.count(old) >= 1
    path = tmp_path / "wrong.toml"
    path.write_text(EVERYTHING.replace(old, new, 1))
    if not fragments:
        Scenario.load(path)
        return
    with pytest.raises(ScenarioError) as error:
        Scenario.load(path)
    message = str(error.value)
    assert message.startswith(f"{path}: ")
    for fragment in fragments:
        assert fragment in message
    with pytest.raises(ScenarioError, match=re.escape(fragments[0])):
        Scenario.from_toml(path.read_text())


def test_no_missions_and_no_numbers() -> None:
    mapping = open_water()
    with pytest.raises(ScenarioError, match=r"missions = \[\]: at least one"):
        Scenario.from_dict({**mapping, "missions": []})
    with pytest.raises(ScenarioError, match="not a mapping of plain finite numbers"):
        Scenario.from_dict({**mapping, "domain": {"min_m": [0.0, 0.0, float("nan")]}})
    with pytest.raises(ScenarioError, match="not a mapping of plain finite numbers"):
        Scenario.from_dict({**mapping, "domain": object()})
    with pytest.raises(ScenarioError, match="expected"):
        Scenario.from_dict([1, 2])  # type: ignore[arg-type]
    with pytest.raises(ScenarioError, match="missing field `schema`"):
        Scenario.from_dict({})
    with pytest.raises(ScenarioError, match="missing field"):
        Scenario.from_toml("")
    with pytest.raises(TypeError):
        Scenario.from_toml(b"schema = 1")  # type: ignore[arg-type]


ODD = [
    "",
    "\0",
    "\n",
    '"',
    "'",
    "#",
    "=",
    "[",
    "]",
    "{",
    ",",
    ".",
    "-",
    "9",
    "e",
    "\\",
    "é",
    "☃",
    "\ufeff",
]


@settings(max_examples=150, deadline=None)
@given(end=st.integers(0, len(EVERYTHING) - 1))
def test_truncated_text_is_refused_or_whole(end: int) -> None:
    # Cut between two tables a text may still be a scenario; nothing else may happen.
    try:
        assert Scenario.from_toml(EVERYTHING[:end]).name == "everything"
    except ScenarioError as error:
        assert str(error)  # noqa: PT017


@settings(max_examples=150, deadline=None)
@given(at=st.integers(0, len(EVERYTHING) - 1), char=st.sampled_from(ODD))
def test_a_wrong_character_is_refused_or_read(at: int, char: str) -> None:
    try:
        Scenario.from_toml(EVERYTHING[:at] + char + EVERYTHING[at + 1 :])
    except ScenarioError as error:
        assert str(error)  # noqa: PT017


def test_files_that_cannot_be_read_are_named(tmp_path: Path) -> None:
    missing = tmp_path / "missing.toml"
    with pytest.raises(FileNotFoundError, match=re.escape(str(missing))):
        Scenario.load(missing)
    with pytest.raises(OSError, match=re.escape(str(tmp_path))):
        Scenario.load(tmp_path)
    binary = tmp_path / "binary.toml"
    binary.write_bytes(EVERYTHING.encode() + b"\xff\xfe")
    with pytest.raises(
        OSError, match=rf"{re.escape(str(binary))}: not UTF-8 text \(byte {len(EVERYTHING)}\)"
    ):
        Scenario.load(binary)
    for world in (lambda: World(str(missing)), lambda: World(missing)):
        with pytest.raises(FileNotFoundError, match=re.escape(str(missing))):
            world()


def test_huge_files_are_refused_without_being_read(tmp_path: Path) -> None:
    huge = tmp_path / "huge.toml"
    with huge.open("wb") as file:
        file.truncate(8 << 40)  # sparse: takes no room; reading it would take hours
    with pytest.raises(
        OSError, match=rf"{re.escape(str(huge))}: {8 << 40} bytes: at most {64 << 20} are read"
    ):
        Scenario.load(huge)
    with pytest.raises(ScenarioError, match=f"at most {64 << 20} are read"):
        Scenario.from_toml("#" * ((64 << 20) + 1))


@pytest.mark.skipif(os.name != "posix", reason="needs devices and pipes")
def test_files_without_an_end_are_refused(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe.toml"
    os.mkfifo(pipe)
    for endless in (Path("/dev/zero"), pipe):
        # In a process of its own with little memory, lest a regression take the machine along.
        code = f"""
import resource, auvgym
resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))
try:
    auvgym.Scenario.load({str(endless)!r})
except OSError as error:
    print(error)
"""
        found = fresh_python.run(code, timeout=20)
        assert found.stdout == f"{endless}: not a regular file\n", found.stderr[-500:]


def test_unknown_names_are_listed_with_the_nearest() -> None:
    with pytest.raises(
        ValueError, match=r"unknown scenario 'lfhh-2d1'; did you mean 'lfhh-2d-1'\?"
    ) as error:
        World("lfhh-2d1")
    for name in SHIPPED:
        assert name in str(error.value)
    with pytest.raises(ValueError, match=r"unknown scenario 'zzz' \(there are: .*lfhh-2d-1"):
        World("zzz")
    with pytest.raises(
        ValueError, match=r"unknown family 'lfhh2d'; did you mean 'lfhh-2d'\? .*lfhh-3d"
    ):
        Scenario.generate("lfhh2d", 0)
    with pytest.raises(
        TypeError, match="scenario is a int: must be a Scenario, a name or the path"
    ):
        World(5)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("arguments", "fragments"),
    [
        ({"obstacle": 3}, ["unknown field `obstacle`", "`obstacles`", "`vortex_drift_mps`"]),
        ({"obstacles": -1}, ["-1"]),
        ({"obstacles": 2.5}, ["2.5"]),
        ({"obstacles": 20_000}, ["obstacles = 20000", "at most 10000"]),
        ({"obstacles": object()}, ["obstacles = <object", "number, text or flag"]),
        ({"current_ratio": -0.1}, ["current_ratio = -0.1", "not negative"]),
        ({"current_ratio": float("nan")}, ["current_ratio = nan", "finite"]),
        ({"current_ratio": float("inf")}, ["current_ratio = inf", "finite"]),
        ({"current_ratio": 0.1, "ring_ratio": 0.1}, ["ring_ratio", "current_ratio", "not both"]),
        ({"difficulty": "nomal"}, ["`nomal`", "`easy`", "`normal`", "`hard`"]),
        ({"variant": "biased"}, ["`biased`", "`debiased`", "`paper`"]),
        ({"peaks": 3}, ["peaks", "only families in 3-D"]),
    ],
)
def test_wrong_parameters_of_a_family_are_named(arguments: Any, fragments: list[str]) -> None:
    with pytest.raises(ValueError) as error:  # noqa: PT011
        Scenario.generate("lfhh-2d", 0, **arguments)
    for fragment in fragments:
        assert fragment in str(error.value)


def test_an_unknown_parameter_suggests_the_nearest() -> None:
    with pytest.raises(ValueError, match=r"did you mean `?'?obstacles"):
        Scenario.generate("lfhh-2d", 0, obstacle=3)
    with pytest.raises(ScenarioError, match=r"did you mean `?'?radius_m"):
        Scenario.from_toml(EVERYTHING.replace("radius_m = 800.0", "radius = 800.0"))


@pytest.mark.parametrize(
    ("name", "value"), [("obstacles", "x"), ("time_factor", "x"), ("variant", 3)]
)
def test_a_parameter_of_the_wrong_type_is_named(name: str, value: Any) -> None:
    with pytest.raises(ValueError, match=name):
        Scenario.generate("lfhh-2d", 0, **{name: value})


@pytest.mark.parametrize(
    ("arguments", "fragments"),
    [
        ({"vehicle_speed_mps": 0}, ["speed_mps = 0", "greater than 0"]),
        ({"time_factor": 0.5}, ["time_factor = 0.5", "at least 1"]),
    ],
)
def test_nothing_is_drawn_that_would_not_load_back(arguments: Any, fragments: list[str]) -> None:
    with pytest.raises(ValueError) as error:  # noqa: PT011
        Scenario.generate("lfhh-2d", 0, **arguments)
    for fragment in fragments:
        assert fragment in str(error.value)


@pytest.mark.parametrize("seed", [-1, 2**64, 1.5, "1", None])
def test_wrong_seeds_are_named(seed: Any) -> None:
    with pytest.raises(ValueError, match=f"seed = {seed!r}: must"):
        Scenario.generate("lfhh-2d", seed)
    with pytest.raises(ValueError, match=f"seed = {seed!r}: must"):
        World("lfhh-2d-1", seed=seed)


@pytest.mark.parametrize("mission", [-1, 3, 1.5, "0", True])
def test_wrong_missions_are_named(mission: Any) -> None:
    with pytest.raises(ValueError, match=f"mission = {mission!r}: "):
        World("lfhh-2d-1", mission=mission)
