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
from everything import EVERYTHING
from hypothesis import given, settings
from hypothesis import strategies as st
from small_worlds import answers, open_water

import auvgym
from auvgym import Scenario, World

SHIPPED = auvgym.list_scenarios()

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
