"""The words run: examples, and the code, files and links that README and docs show."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import auvgym

ROOT = Path(__file__).parents[1]
EXAMPLES = ROOT / "examples"
PAGES = [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")]
SUITE = """
schema = 1
name = "small"
[[instances]]
environment = "AUVDynamic2D-v0"
seeds = [1, 2]
"""


def run_example(name: str, *arguments: str, folder: Path) -> str:
    done = subprocess.run(
        [sys.executable, str(EXAMPLES / name), *arguments],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        timeout=300,  # a guard: Ray alone takes a minute to start on a busy machine
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def blocks(page: Path, language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)


def snippets() -> Iterator[tuple[str, str]]:
    """Python of all pages, but for what needs files of one's own."""
    for page in PAGES:
        for number, code in enumerate(blocks(page, "python")):
            if "ocean.load" not in code and "help(" not in code:
                yield f"{page.name}-{number}", code


def test_quickstart(tmp_path: Path) -> None:
    assert "after" in run_example("quickstart.py", folder=tmp_path)


def test_quickstart_is_what_the_readme_shows() -> None:
    assert blocks(ROOT / "README.md", "python")[0] == (EXAMPLES / "quickstart.py").read_text()


def test_own_policy(tmp_path: Path) -> None:
    suite = tmp_path / "small.toml"
    suite.write_text(SUITE)
    printed = run_example("own_policy.py", str(suite), folder=tmp_path)
    assert "ClearestBeam" in printed
    assert "sonar-rule" in printed
    assert printed.count("/2  score") == 3


def test_train_sb3(tmp_path: Path) -> None:
    pytest.importorskip("torch")
    printed = run_example(
        "train_sb3.py", "--timesteps", "512", "--envs", "8", "--tests", "4", folder=tmp_path
    )
    assert re.search(r"arrived: \d+\.\d%", printed)
    assert (tmp_path / "ppo.zip").is_file()


def test_ppo_in_one_file(tmp_path: Path) -> None:
    pytest.importorskip("torch")
    sizes = ["--envs", "8", "--steps", "32", "--batch", "128", "--timesteps", "512"]
    printed = run_example("ppo_single_file.py", *sizes, "--tests", "4", folder=tmp_path)
    assert re.search(r"^ +512 legs .* arrived \d+/\d+$", printed, re.MULTILINE)
    assert re.search(r"^arrived: \d+\.\d%$", printed, re.MULTILINE)


def test_train_rllib(tmp_path: Path) -> None:
    pytest.importorskip("torch")
    pytest.importorskip("ray")
    sizes = ["--iterations", "1", "--batch", "256", "--envs", "4", "--runners", "0"]
    printed = run_example("train_rllib.py", *sizes, folder=tmp_path)
    assert re.search(r"^ +0 +\d+ legs  return", printed, re.MULTILINE)


def test_plan_real_ocean(tmp_path: Path) -> None:
    ocean_files = pytest.importorskip("ocean_files")
    currents = ocean_files.write(ocean_files.current_file(), tmp_path / "currents.nc")
    floor = ocean_files.write(ocean_files.floor_file(), tmp_path / "floor.nc")
    start, goal = ([str(number) for number in end] for end in (ocean_files.START, ocean_files.GOAL))
    printed = run_example(
        "plan_real_ocean.py", str(currents), "--bathymetry", str(floor),
        "--start", *start, "--goal", *goal, "--out", "plan.csv", folder=tmp_path,
    )  # fmt: skip
    assert "astar, flown:   goal after" in printed
    assert (tmp_path / "plan.csv").read_text().startswith("longitude_deg,latitude_deg,depth_m\n")


@pytest.mark.parametrize("code", [pytest.param(code, id=name) for name, code in snippets()])
def test_python_in_the_pages_runs(
    code: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    exec(code, {"__name__": "page"})


def test_scenario_page_loads() -> None:
    first, *fragments = blocks(ROOT / "docs" / "scenario.md", "toml")
    auvgym.World(auvgym.Scenario.from_toml(first))
    assert len(fragments) >= 6
    for fragment in fragments:
        scenario = auvgym.Scenario.from_toml(f"{first}\n{fragment}")
        assert auvgym.World(scenario).clearance([5e3, 0.0, 50.0]) > 0.0


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if "://" in target:
            continue
        path, _, anchor = target.partition("#")
        file = page.parent / path if path else page
        assert file.exists(), f"{page.name}: {target}"
        if anchor:
            assert anchor in anchors(file), f"{page.name}: {target}"


def anchors(page: Path) -> set[str]:
    """The anchors of a page's headings, as GitHub makes them."""
    headings = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}
