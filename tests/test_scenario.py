"""Scenarios: what is saved loads back to the same world, and what is wrong is said by name."""

from __future__ import annotations

import copy
import hashlib
import os
import pickle
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import fresh_python
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_worlds import answers, open_water

import auvgym
from auvgym import Scenario, ScenarioError, World

SHIPPED = auvgym.list_scenarios()

# One of everything that a file can say.
EVERYTHING = """
schema = 1
name = "everything"
description = "One of every kind."
dimensions = 3
notes = ["made by hand"]

[domain]
min_m = [0.0, 0.0, 0.0]
max_m = [20000, 20000, 4000]
margin_m = 400.0

[limits]
goal_radius_m = 250.0
time_factor = 2.0
energy_factor = 3.0

[vehicle]
speed_mps = 1.5

[episode]
tick_s = 10.0

[sections]
count = 20
spacing_m = 1000.0
cell_m = 500.0

[seabed]
kind = "peaks"
floor_depth_m = 4000.0
peaks = [{ x_m = 5000, y_m = 8000, height_m = 2500, a = 0.8, b = 1.1, sigma_m = 1800 }]

[change]
kind = "table"
every_m = 6000.0
hold_margin_m = 900.0
phases = [
  { obstacles_m = [[7000, 9000, 1000], [3000, 5000, 0], [15000, 5000, 500],
                   [16000, 15000, 1500], [4000, 16000, 500]], vortices_m = [[9000, 9000]] },
]

[[missions]]
start_m = [10000.0, 0.0, 1000.0]
goal_m = [10000.0, 19000.0, 1000.0]

[[currents]]
kind = "uniform"
velocity_mps = [0.1, -0.2]

[[currents]]
kind = "vortices"
core_radius_m = 1200.0
vortices = [{ x_m = 9000, y_m = 12000, circulation_m2ps = 2000, drift_mps = [0.1, 0.2] }]

[[currents]]
kind = "jet"
t = 3.0
c = 1.2
k = 0.8
e = 0.1
b0 = 2.2
omega = 0.4
chi = 1.5707963267948966
peak_speed_mps = 0.5
length_scale_m = 2000.0
time_scale_s = 3600.0
origin_m = [0.0, 10000.0]

[[currents]]
kind = "gridded"
x_m = [0, 10000, 20000]
y_m = [0, 20000]
depth_m = [0, 1000]
time_s = [0, 3600]
u_mps = "f32le:zczMPc3MTD6amZk+AADAf83MTD3NzMw9zczMPZqZGT7NzEw+AACAPgAAAD8AAIA+zczMPc3MTD6amZk+AADAf83MTD3NzMw9zczMPZqZGT7NzEw+AACAPgAAAD8AAIA+"
v_mps = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1]

[[obstacles]]
kind = "sphere"
position_m = [6000, 12000, 1500]
radius_m = 800.0
velocity_mps = [0.3, -0.1, 0.05]

[[obstacles]]
kind = "disc"
position_m = [3000, 4000]
radius_m = 700.0

[[obstacles]]
kind = "cylinder"
position_m = [15000, 4000]
radius_m = 600.0
top_m = 500.0
bottom_m = 2500.0

[[obstacles]]
kind = "superquadric"
position_m = [16000, 14000, 2000]
semi_axes_m = [900.0, 700.0, 500.0]
exponents = [2.0, 4.0, 2.0]

[[obstacles]]
kind = "polygon"
vertices_m = [[2000, 15000], [6000, 15000], [6000, 17000], [4000, 16000], [2000, 17000]]
top_m = -10.0
bottom_m = 1000.0
"""  # noqa: E501


# Families, and what can be asked of all they draw that moves or changes. The threats and the jet
# of iifds are what they are.
FAMILIES: dict[str, dict[str, Any]] = {
    "lfhh-2d": {"obstacle_speed_mps": 0.3, "vortex_drift_mps": 0.2},
    "lfhh-3d": {"obstacle_speed_mps": 0.3, "vortex_drift_mps": 0.2},
    "afhh": {
        "vortices": 3,
        "obstacle_speed_mps": 0.3,
        "vortex_drift_mps": 0.2,
        "change_every_m": 6,
    },
    "iifds": {},
    "harbor": {},
}


def drawn(family: str) -> Scenario:
    return Scenario.generate(family, 7, **FAMILIES[family])


SCENARIOS: dict[str, Callable[[], Scenario]] = {
    **{name: (lambda name=name: World(name).scenario) for name in SHIPPED},  # type: ignore[misc]
    **{name: (lambda name=name: drawn(name)) for name in auvgym.list_families()},  # type: ignore[misc]
    "everything": lambda: Scenario.from_toml(EVERYTHING),
}


def all_answers(scenario: Scenario) -> bytes:
    """What its world says, before and after a map change."""
    world = World(scenario, seed=3)
    before = answers(world)
    world.time_s = 600.0
    assert world.apply_change(world.start) == ("change" in scenario.to_dict())
    return before + answers(world)


def test_the_papers_worlds_are_shipped() -> None:
    assert set(SHIPPED) == {
        *("lfhh-2d-1", "lfhh-3d-1", "lfhh-3d-2", "lfhh-3d-3"),
        *("afhh-1", "afhh-2", "afhh-3", "afhh-4"),
        *("iifds-static-dense", "iifds-astar", "iifds-threat1", "iifds-threats3", "iifds-complex"),
        *("harbor-p", "harbor-a", "harbor-b", "harbor-book", "harbor-raster"),
    }
    assert auvgym.list_families() == list(FAMILIES)


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_scenarios_load_for_every_mission(name: str) -> None:
    scenario = World(name).scenario
    assert scenario.name == name
    assert scenario.dimensions == (2 if "2d" in name or name.startswith("harbor") else 3)
    assert scenario.description
    assert scenario.family in FAMILIES
    assert ("change" in scenario.to_dict()) == scenario.family.startswith("lfhh")
    for mission in range(scenario.missions):
        world = World(name, mission=mission)
        assert world.clearance([world.start, world.goal]).min() > 0
        low, high = world.domain
        assert np.linalg.norm(world.goal - world.start) > 0.75 * (high - low).max()


def test_start_and_goal_of_the_2d_world_are_the_papers() -> None:
    pairs = [
        (World("lfhh-2d-1", mission=i).start, World("lfhh-2d-1", mission=i).goal) for i in range(3)
    ]
    found = [(start[:2].tolist(), goal[:2].tolist()) for start, goal in pairs]
    assert found == [  # Table 2 of the LFHH paper, m
        ([13_000, 0], [6_000, 39_000]),
        ([6_000, 0], [8_000, 39_000]),
        ([5_000, 0], [12_000, 39_000]),
    ]


def test_hashes_are_those_of_the_text_and_the_same_in_another_process() -> None:
    hashes = {name: World(name).scenario.hash for name in SHIPPED}
    assert len(set(hashes.values())) == len(SHIPPED)
    for name in SHIPPED:
        text = World(name).scenario.to_toml()
        assert hashes[name] == hashlib.sha256(text.encode()).hexdigest()
    code = (
        "import auvgym; print({n: auvgym.World(n).scenario.hash for n in auvgym.list_scenarios()})"
    )
    other = fresh_python.run(code, PYTHONHASHSEED="77")
    assert other.stdout.strip() == str(hashes)


@pytest.mark.parametrize("name", SCENARIOS)
def test_every_way_out_leads_back_to_the_same_world(name: str, tmp_path: Path) -> None:
    scenario = SCENARIOS[name]()
    path = tmp_path / "saved.toml"
    scenario.save(path)
    ways = {
        "file": Scenario.load(path),
        "text": Scenario.from_toml(scenario.to_toml()),
        "mapping": Scenario.from_dict(scenario.to_dict()),
        "pickle": pickle.loads(pickle.dumps(scenario)),
        "deepcopy": copy.deepcopy(scenario),
    }
    wanted = all_answers(scenario)
    for way, again in ways.items():
        assert again == scenario, way
        assert hash(again) == hash(scenario), way
        assert again.hash == scenario.hash, way
        assert all_answers(again) == wanted, way
    assert os.listdir(tmp_path) == ["saved.toml"]


def test_missing_values_written_out_survive_every_way() -> None:
    parts = {"x_m": [0.0, 20_000.0], "y_m": [0.0, 20_000.0]}
    gridded = {"kind": "gridded", **parts, "u_mps": [0.1, 0.2, 0.3, 0.4], "v_mps": [0.0] * 4}
    text = Scenario.from_dict(open_water(currents=[gridded])).to_toml()
    with_hole = Scenario.from_toml(
        text.replace("0.30000000000000004", "nan").replace("0.3,", "nan,")
    )
    assert "nan" in with_hole.to_toml()
    assert Scenario.from_toml(with_hole.to_toml()) == with_hole
    assert Scenario.from_dict(with_hole.to_dict()) == with_hole


def test_scenarios_differ_when_a_number_does() -> None:
    one = Scenario.from_toml(EVERYTHING)
    other = Scenario.from_toml(EVERYTHING.replace("radius_m = 800.0", "radius_m = 800.1"))
    assert one != other
    assert one.hash != other.hash
    assert one != "everything"
    with pytest.raises(AttributeError):
        one.name = "renamed"  # type: ignore[misc]


@settings(max_examples=25, deadline=None)
@given(
    family=st.sampled_from([family for family, parts in FAMILIES.items() if parts]),
    seed=st.integers(0, 2**64 - 1),
    difficulty=st.sampled_from(["easy", "normal", "hard"]),
    variant=st.sampled_from(["debiased", "paper"]),
    counts=st.fixed_dictionaries({"obstacles": st.integers(0, 20), "vortices": st.integers(0, 8)}),
    speeds=st.fixed_dictionaries(
        {"obstacle_speed_mps": st.floats(0, 1), "vortex_drift_mps": st.floats(0, 1)}
    ),
)
def test_whatever_is_drawn_can_be_drawn_again_and_loads_back(
    family: str, seed: int, difficulty: str, variant: str, counts: Any, speeds: Any
) -> None:
    arguments = {"difficulty": difficulty, "variant": variant, **counts, **speeds}
    scenario = Scenario.generate(family, seed, **arguments)
    assert scenario == Scenario.generate(family, seed, **arguments)
    again = Scenario.from_toml(scenario.to_toml())
    assert again == scenario
    assert all_answers(again) == all_answers(scenario)
    numbers = scenario.to_dict()
    assert len(numbers.get("obstacles", [])) == counts["obstacles"]
    currents = numbers.get("currents", [{"vortices": []}])
    assert len(currents[0]["vortices"]) == counts["vortices"]
    assert scenario.family == family


@settings(max_examples=15, deadline=None)
@given(
    seed=st.integers(0, 2**64 - 1),
    difficulty=st.sampled_from(["easy", "normal", "hard"]),
    threats=st.integers(0, 12),
)
def test_threats_are_drawn_again_and_load_back(seed: int, difficulty: str, threats: int) -> None:
    scenario = Scenario.generate("iifds", seed, difficulty=difficulty, obstacles=threats)
    assert scenario == Scenario.generate("iifds", seed, difficulty=difficulty, obstacles=threats)
    again = Scenario.from_toml(scenario.to_toml())
    assert again == scenario
    assert all_answers(again) == all_answers(scenario)
    assert len(scenario.to_dict().get("obstacles", [])) == threats


def test_seeds_and_parameters_make_the_difference() -> None:
    draw = Scenario.generate
    scenarios = [
        draw("lfhh-2d", 1),
        draw("lfhh-2d", 2),
        draw("lfhh-2d", 1, difficulty="hard"),
        draw("lfhh-2d", 1, variant="paper"),
        draw("lfhh-2d", 1, vehicle_speed_mps=1.0),
        draw("lfhh-2d", 1, time_factor=3.0),
        draw("lfhh-2d", 1, change_every_m=0),
    ]
    assert len({scenario.hash for scenario in scenarios}) == len(scenarios)
    assert scenarios[4].to_dict()["vehicle"]["speed_mps"] == 1.0
    assert scenarios[5].to_dict()["limits"]["time_factor"] == 3.0
    assert "change" not in scenarios[6].to_dict()
    # None stands for "not given", and NumPy's numbers are numbers.
    assert draw("lfhh-2d", np.int64(1), obstacles=None) == scenarios[0]
    assert draw("lfhh-2d", 1, obstacles=np.int64(5), current_ratio=np.float32(0.5)) == draw(
        "lfhh-2d", 1, obstacles=5, current_ratio=0.5
    )


@pytest.mark.parametrize("ratio", [0.3, 0.9])
def test_the_fastest_current_is_the_ratio_of_the_vehicles_speed(ratio: float) -> None:
    world = World(Scenario.generate("lfhh-2d", 5, current_ratio=ratio, vehicle_speed_mps=1.5))
    x, y = np.meshgrid(np.arange(0, 20_001, 200.0), np.arange(0, 40_001, 200.0))
    points = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    fastest = np.linalg.norm(world.current(points), axis=1).max()
    # Scaled on eight points of each ring: a little more in between.
    assert 0.95 * ratio * 1.5 < fastest < 1.15 * ratio * 1.5


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


# --- saving ------------------------------------------------------------------------------------


def test_saving_over_a_folder_leaves_nothing_behind(tmp_path: Path) -> None:
    folder = tmp_path / "folder.toml"
    folder.mkdir()
    with pytest.raises(OSError, match=re.escape(str(folder))):
        Scenario.from_toml(EVERYTHING).save(folder)
    assert os.listdir(tmp_path) == ["folder.toml"]


def test_saving_into_no_folder_says_so(tmp_path: Path) -> None:
    path = tmp_path / "none" / "world.toml"
    with pytest.raises(OSError, match=re.escape(str(path))):
        Scenario.from_toml(EVERYTHING).save(path)
    assert os.listdir(tmp_path) == []


def unwritable(tmp_path: Path) -> Path:
    """A folder that nothing can be written to, even by root."""
    tmp_path.chmod(0o555)
    if not os.access(tmp_path, os.W_OK):
        return tmp_path
    system = Path("/proc")
    if not system.is_dir():
        pytest.skip("root writes everywhere here")
    return system


def test_a_read_only_folder_keeps_its_files(tmp_path: Path) -> None:
    scenario = Scenario.from_toml(EVERYTHING)
    old = tmp_path / "old.toml"
    World("lfhh-2d-1").scenario.save(old)
    whole = old.read_bytes()
    folder = unwritable(tmp_path)
    try:
        with pytest.raises(OSError, match=re.escape(str(folder / "new.toml"))):
            scenario.save(folder / "new.toml")
        assert not (folder / "new.toml").exists()
        assert old.read_bytes() == whole
    finally:
        tmp_path.chmod(0o755)
    assert os.listdir(tmp_path) == ["old.toml"]


def test_the_old_file_stays_whole_when_saving_fails(tmp_path: Path) -> None:
    path = tmp_path / "world.toml"
    World("lfhh-2d-1").scenario.save(path)
    whole = path.read_bytes()
    # Saving writes beside the file first: a folder of that name is in its way.
    (tmp_path / "world.toml.part").mkdir()
    with pytest.raises(OSError, match=re.escape(str(path))):
        Scenario.from_toml(EVERYTHING).save(path)
    assert path.read_bytes() == whole
