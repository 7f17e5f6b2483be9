"""Suites: data that are checked, and worlds that are what they were when they were frozen."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pytest
from ocean_files import DATA, real
from typer.testing import CliRunner

from auvgym import evaluation
from auvgym.cli import app
from auvgym.evaluation import Instance, PolicySpec, Store, SuiteError, load_suite, run
from auvgym.evaluation.suite_file import lock_text, world_hashes

TOML = """
schema = 1
name = "mine"
[[instances]]
environment = "AUVDynamic2D-v0"
difficulty = "easy"
settings = { variant = "paper" }
seeds = [1, 2]
"""


@pytest.fixture
def mine(tmp_path: Path) -> Path:
    """A suite's file, frozen."""
    path = tmp_path / "mine.toml"
    path.write_text(TOML)
    assert CliRunner().invoke(app, ["suite", str(path), "--freeze"]).exit_code == 0
    return path


@pytest.mark.parametrize("name", ["demo", "paper", "replan", "standard", "strong-currents"])
def test_every_world_of_the_shipped_suites_is_as_it_was_frozen(name: str) -> None:
    suite = load_suite(name)
    assert suite.frozen
    # Every instance of the small ones, every 19th of the large one, each stratum among them.
    some = suite.instances[:: 19 if len(suite.instances) > 500 else 1]
    assert {one.stratum for one in some} == set(suite.strata)
    for instance, digest in zip(
        some, world_hashes(dataclasses.replace(suite, instances=some)), strict=True
    ):
        assert instance.change(digest) == ""


def test_the_suites_hold_what_they_promise() -> None:
    assert set(evaluation.list_suites()) == {
        "demo",
        "ocean",
        "paper",
        "replan",
        "standard",
        "strong-currents",
    }
    paper, standard = load_suite("paper"), load_suite("standard")
    assert set(paper.strata.values()) == {30}
    by_environment: dict[str, int] = {}
    for (environment, difficulty, _, _), count in standard.strata.items():
        assert difficulty in ("easy", "normal", "hard")
        by_environment[environment] = by_environment.get(environment, 0) + count
    assert set(by_environment.values()) == {500}
    assert set(by_environment) == {one.environment for one in paper.instances}


def test_real_oceans_are_frozen_too(monkeypatch: pytest.MonkeyPatch) -> None:
    real("gulf_stream_cmems_20240101.nc")
    monkeypatch.setenv("AUVGYM_DATA", str(DATA))
    ocean = load_suite("ocean")
    assert ocean.frozen
    some = ocean.instances[:1]
    (digest,) = world_hashes(dataclasses.replace(ocean, instances=some))
    assert some[0].change(digest) == ""


def test_a_real_ocean_without_its_files_says_what_is_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    suite = dataclasses.replace(load_suite("ocean"), instances=load_suite("ocean").instances[:1])
    monkeypatch.delenv("AUVGYM_DATA", raising=False)
    with Store(None) as store:
        with pytest.raises(SuiteError, match="set AUVGYM_DATA to the folder of gulf_stream"):
            run(suite, [PolicySpec("straight")], store)
        monkeypatch.setenv("AUVGYM_DATA", str(tmp_path))
        with pytest.raises(SuiteError, match=f"no gulf_stream_cmems_20240101.nc in {tmp_path}"):
            run(suite, [PolicySpec("straight")], store)


def test_a_changed_world_stops_the_run_and_is_named(mine: Path) -> None:
    suite = load_suite(mine)
    changed = dataclasses.replace(suite.instances[1], scenario_hash="0123456789abcdef")
    other = dataclasses.replace(suite, instances=(suite.instances[0], changed))
    assert other.hash != suite.hash
    for workers in (1, 2):
        with Store(None) as store, pytest.raises(SuiteError, match="variant paper seed 2: the wor"):
            run(other, [PolicySpec("straight")], store, workers)
    lock = mine.with_suffix(".lock")
    lock.write_text(lock.read_text().replace(suite.instances[1].scenario_hash, "0" * 16))
    checked = CliRunner().invoke(app, ["suite", str(mine), "--check"])
    assert checked.exit_code == 1
    assert "seed 2: the world has changed" in checked.output.replace("\n", " ")


def test_a_lock_of_other_instances_is_refused(mine: Path) -> None:
    assert load_suite(mine).frozen
    mine.write_text(TOML.replace("[1, 2]", "[1, 3]"))
    with pytest.raises(SuiteError, match="freeze it anew"):
        load_suite(mine)
    mine.write_text(TOML.replace("[1, 2]", "[1, 2, 3]"))
    with pytest.raises(SuiteError, match="2 lines, the suite 3 instances"):
        load_suite(mine)


def test_the_hash_of_a_suite_is_computed_once() -> None:
    suite = load_suite("demo")
    assert suite.hash is suite.hash  # every row of a results file is held to it


def test_freezing_twice_gives_the_same(mine: Path) -> None:
    suite = load_suite(mine)
    assert lock_text(suite, world_hashes(suite)) == mine.with_suffix(".lock").read_text()


def test_settings_make_another_world(mine: Path) -> None:
    paper = load_suite(mine).instances[0]
    plain = dataclasses.replace(paper, settings="")
    assert paper != plain
    suite = dataclasses.replace(load_suite(mine), instances=(paper, plain))
    first, second = world_hashes(suite)
    assert first != second


@pytest.mark.parametrize(
    ("instance", "message"),
    [
        (Instance("os:AUVDynamic2D-v0", 1), "unknown environment"),
        (Instance("AUVDynamic2D-v0", 1, settings='{"depth": 3}'), "unknown setting"),
        (Instance("AUVDynamic2D-v0", 1, settings="[]"), "settings is"),
        (Instance("AUVDynamic2D-v0", 1, "", "ocean:mars"), "unknown ocean mission"),
    ],
)
def test_an_instance_that_cannot_be_made_says_why(instance: Instance, message: str) -> None:
    suite = evaluation.Suite("odd", (instance,))
    with Store(None) as store, pytest.raises(SuiteError, match=message):
        run(suite, [PolicySpec("straight")], store)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("schema = 1", "name is missing"),
        ('name = "x"', "schema is None"),
        ('schema = 1\nname = "x"', "no \\[\\[instances\\]\\]"),
        ('schema = 1\nname = "x"\nseed = 3', "unknown key 'seed'"),
        ('schema = 1\nname = "x"\n[[instances]]\nseeds = [1]', "environment is missing"),
        ('schema = 1\nname = "x"\n[[instances]]\nenvironment = "A"', "seeds is None"),
        ('schema = 1\nname = "x"\n[[instances]]\nenvironment = "A"\nseeds = [-1]', "seeds is"),
        ('schema = 1\nname = "x"\n[[instances]]\nenvironment = "A"\nseeds = [1, 1]', "twice"),
        ("schema = ", "suite .*toml"),
    ],
)
def test_a_suite_that_makes_no_sense_says_why(text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "suite.toml"
    path.write_text(text)
    with pytest.raises(SuiteError, match=message):
        load_suite(path)


def test_a_suite_that_is_not_there() -> None:
    with pytest.raises(SuiteError, match="did you mean 'demo'"):
        load_suite("demos")
    with pytest.raises(SuiteError, match="cannot be read"):
        load_suite("/no/such/suite.toml")
