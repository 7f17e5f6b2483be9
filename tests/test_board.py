"""The published boards: their tables are what their kept results give."""

from __future__ import annotations

import importlib.util
import textwrap
from pathlib import Path
from types import ModuleType

import pytest

import auvgym
from auvgym import evaluation
from auvgym.evaluation.export import read_parquet

pytest.importorskip("polars")
HERE = Path(__file__).parents[1] / "baselines" / "board"


@pytest.fixture(scope="module")
def make_board() -> ModuleType:
    spec = importlib.util.spec_from_file_location("make_board", HERE / "make_board.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_something_is_published() -> None:
    assert (HERE / "demo.parquet").is_file()


@pytest.mark.parametrize("name", sorted(path.stem for path in HERE.glob("*.parquet")))
def test_the_tables_are_what_the_results_give(
    name: str, make_board: ModuleType, tmp_path: Path
) -> None:
    make_board.write_tables(name, make_board.definitions()[name], tmp_path)
    for ending in (".md", ".tex"):
        committed = (HERE / f"{name}{ending}").read_text(encoding="utf-8")
        assert (tmp_path / f"{name}{ending}").read_text(encoding="utf-8") == committed


@pytest.mark.parametrize("name", sorted(path.stem for path in HERE.glob("*.parquet")))
def test_the_results_are_of_the_suite_as_it_is(name: str) -> None:
    """A board is flown anew when its suite changes: every pair once, and of these worlds."""
    suite, rows = evaluation.load_suite(name), read_parquet(HERE / f"{name}.parquet")
    assert {row.suite_hash for row in rows} == {suite.hash}
    flown = {(row.policy, row.instance) for row in rows}
    assert len(flown) == len(rows)
    worlds = {one: one.scenario_hash for one in suite.instances}
    assert all(row.scenario_hash.startswith(worlds[row.instance]) for row in rows)
    assert all(not row.policy_failed for row in rows)


def test_every_board_is_of_a_shipped_suite(make_board: ModuleType) -> None:
    for name, definition in make_board.definitions().items():
        suite = evaluation.load_suite(name)
        environments = {instance.environment for instance in suite.instances}
        entered = make_board.entries(suite, definition)
        assert definition["reference"] in {spec.name for spec, _ in entered}
        assert len({spec.name for spec, _ in entered}) == len(entered)
        for spec, flown in entered:
            assert flown <= environments
            auvgym.policies.make(spec.name, **spec.parameters)


@pytest.mark.parametrize("name", ["paper", "standard"])
def test_every_policy_is_on_the_board(name: str, make_board: ModuleType) -> None:
    entered = make_board.entries(evaluation.load_suite(name), make_board.definitions()[name])
    assert {spec.name for spec, _ in entered} >= set(auvgym.list_policies())


def test_the_readme_s_table_is_what_the_results_give(make_board: ModuleType) -> None:
    (name,) = [name for name, one in make_board.definitions().items() if one.get("readme")]
    readme = make_board.README.read_text(encoding="utf-8")
    definition = make_board.definitions()[name]
    assert make_board.with_short_table(readme, name, definition) == readme
    table = readme.partition(make_board.BEGIN)[2].partition(make_board.END)[0]
    assert table.count("\n") > 5


def test_the_documents_policy_flies(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The submission of docs/leaderboard.md, as it stands there."""
    page = (HERE.parents[1] / "docs" / "leaderboard.md").read_text(encoding="utf-8")
    code = textwrap.dedent(page.partition("```python\n")[2].partition("```")[0])
    assert "class Forward" in code
    (tmp_path / "forward.py").write_text(code)
    monkeypatch.syspath_prepend(tmp_path)
    suite = evaluation.Suite("one", evaluation.load_suite("demo").instances[:1])
    with evaluation.Store(tmp_path / "results.db") as store:
        (row,) = evaluation.run(suite, [evaluation.PolicySpec("forward:Forward")], store)
    assert not row.policy_failed, row.error
    assert evaluation.verify(tmp_path / "results.db").differences == []
