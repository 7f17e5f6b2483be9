"""The report of a board: its tables, its charts, and the page in a real browser."""

from __future__ import annotations

import dataclasses
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from board_rows import row
from typer.testing import CliRunner

from auvgym.cli import app
from auvgym.cli.page import episode_drawing
from auvgym.evaluation import EpisodeResult, Instance, PolicySpec, Store, Suite, replay, run
from auvgym.evaluation.board import board
from auvgym.evaluation.plans import plans_of
from auvgym.evaluation.statistics import OVERALL
from auvgym.report.charts import pareto_front
from auvgym.report.text_tables import latex, markdown

pytest.importorskip("plotly")
pytest.importorskip("scipy")
SUITE = Suite(
    "mine",
    tuple(
        Instance(environment, seed)
        for environment in ("AUVDynamic2D-v0", "AUVThreat3D-v0")
        for seed in (4, 5, 6)
    ),
)
SPECS = [PolicySpec("straight"), PolicySpec("sonar-rule")]
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")


def made_up() -> list[EpisodeResult]:
    scores = {"quick": [1.0, 0.9, 0.0], "st_eady": [0.5, 0.5, 0.5], "never": [0.0, 0.0, 0.0]}
    return [
        row(policy, seed, score)
        for policy, all_ in scores.items()
        for seed, score in enumerate(all_)
    ]


def test_markdown_and_latex_count_the_solved_beside_each_mean() -> None:
    boards = board(made_up(), reference="st_eady")
    lines = markdown(boards).splitlines()
    assert lines[0] == "### AUVDynamic2D-v0 · normal"
    assert {line.count("|") for line in lines if line.startswith("|")} == {12}
    quick = next(line for line in lines if "quick" in line)
    assert "| 2/3 |" in quick
    assert "(2/3)" in quick
    assert "| - |" in next(line for line in lines if "never" in line)
    text = latex(boards)
    assert r"st\_eady" in text
    assert text.count(r"\\") == 4
    assert r"67\%" not in text.partition("\n")[0]
    assert text.count(r"\begin{tabular}") == text.count(r"\end{tabular}") == 1


def test_several_strata_are_put_together_last() -> None:
    rows = made_up() + [row(one.policy, one.seed, 0.3, difficulty="hard") for one in made_up()]
    boards = board(rows)
    assert list(boards)[-1] == OVERALL
    assert [one.summary.episodes for one in boards[OVERALL]] == [6, 6, 6]
    assert markdown(boards).count("###") == 3


def test_the_front_is_what_nobody_beats_in_everything() -> None:
    figures = np.array([[1.0, 5.0, 2.0], [2.0, 4.0, 2.0], [2.0, 5.0, 2.0], [1.0, 5.0, 2.0]])
    assert pareto_front(figures) == [True, True, False, True]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("board")
    with Store(place / "results.db") as store:
        run(SUITE, SPECS, store)
    done = CliRunner().invoke(
        app,
        ["report", str(place / "results.db"), "--out", str(place / "report"), "--replays", "1"],
    )
    assert done.exit_code == 0, done.output
    return place / "report"


def test_the_pages_do_not_depend_on_the_processes_that_draw_them(
    folder: Path, tmp_path: Path
) -> None:
    done = CliRunner().invoke(
        app,
        ["report", str(folder.parent / "results.db"), "--out", str(tmp_path), "--replays", "1",
         "--workers", "2"],
    )  # fmt: skip
    assert done.exit_code == 0, done.output
    written = {one.relative_to(folder): one.read_bytes() for one in folder.rglob("*.*")}
    assert written == {one.relative_to(tmp_path): one.read_bytes() for one in tmp_path.rglob("*.*")}


def test_an_episode_whose_log_is_damaged_is_named(folder: Path, tmp_path: Path) -> None:
    with Store(folder.parent / "results.db", read_only=True) as store:
        damaged = [dataclasses.replace(one, actions=b"none") for one in store.results()]
    with Store(tmp_path / "damaged.db") as store:
        store.add(*damaged)
    for workers in ("1", "2"):
        done = CliRunner().invoke(
            app,
            ["report", str(tmp_path / "damaged.db"), "--out", str(tmp_path), "--workers", workers],
        )
        assert done.exit_code == 2
        assert re.search(r"Dynamic2D.* seed \d+: the action log is damaged", done.output)


def test_the_folder_asks_for_nothing_outside_it(folder: Path) -> None:
    page = (folder / "index.html").read_text()
    sources = re.findall(r"<(?:script|link|img|iframe)[^>]+(?:src|href)\s*=\s*[\"']([^\"']+)", page)
    assert sources == ["plotly.js"]
    assert page.count('class="stratum"') == 3
    episodes = sorted((folder / "episodes").glob("*.js"))
    assert 4 <= len(episodes) <= 6
    assert all(one.read_text().startswith(f"auvgymEpisode({one.stem}, {{") for one in episodes)
    values = re.findall(r'<option value="(\d+)">', page)
    assert sorted(values) == sorted(one.stem for one in episodes)
    assert (folder / "board.md").read_text().count("###") == 3


def opened(url: str, profile: Path) -> str:
    """The page as it stands once a headless browser has run its scripts, none of which failed."""
    if CHROMIUM is None:
        pytest.skip("chromium is not installed (apt install chromium)")
    done = subprocess.run(
        [
            CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader",
            f"--user-data-dir={profile}", "--window-size=1400,3000", "--enable-logging=stderr",
            "--virtual-time-budget=15000", "--dump-dom", url,
        ],
        capture_output=True, text=True, timeout=120, check=True,
    )  # fmt: skip
    assert not re.search(r"CONSOLE.*(Uncaught|Error)", done.stderr), done.stderr
    return done.stdout


def test_the_page_works_in_a_browser(folder: Path, tmp_path: Path) -> None:
    """Opened from disk at an episode: charts are drawn, and the episode with its slider."""
    dom = opened(f"{(folder / 'index.html').as_uri()}#episode-0", tmp_path)
    assert 'data-shown="0"' in dom
    assert "slider-group" in dom
    assert dom.count('class="main-svg"') >= 4


def test_a_click_on_a_heading_sorts_by_it(folder: Path, tmp_path: Path) -> None:
    """Clicked by a script that is put into the page: once, twice, and on a column of texts."""
    script = """<script>
    const table = document.querySelector("table.ranked");
    const found = [];
    for (const name of ["score", "score", "policy"]) {
      const heading = [...table.tHead.rows[0].cells].find((one) => one.textContent === name);
      heading.querySelector("button").click();
      found.push([heading.getAttribute("aria-sort"),
        ...[...table.tBodies[0].rows].map((row) => row.cells[1].textContent)].join(" "));
    }
    document.body.dataset.found = found.join("; ");
    </script></body>"""
    page = (folder / "index.html").read_text()
    clicked = folder / "clicked.html"
    clicked.write_text(page.replace("</body>", script))
    found = re.search(r'data-found="([^"]*)"', opened(clicked.as_uri(), tmp_path))
    clicked.unlink()
    assert found is not None
    assert found[1].split("; ") == [
        "descending sonar-rule straight",
        "ascending straight sonar-rule",
        "ascending sonar-rule straight",
    ]


def test_an_episode_shows_each_plan_from_its_time_on() -> None:
    """Found by another flight of the policy, which flies as its log says, and by no other."""
    suite = Suite("mine", (Instance("AUVDynamic2D-v0", 4),))
    with Store(None) as store:
        (flown,) = run(suite, [PolicySpec("astar")], store)
    plans = plans_of(flown)
    assert len(plans) == 1 + flown.replans
    times = [moment_s for moment_s, _ in plans]
    assert times == sorted(times)
    assert times[0] == 0.0
    assert plans_of(flown, longest_s=0.0) == []
    assert plans_of(dataclasses.replace(flown, policy="rrt-star")) == []
    drawing = episode_drawing(replay(flown), flown)
    ways = [index for index, trace in enumerate(drawing["data"]) if trace["name"] == "plan"]
    assert len(ways) == len(plans)
    frames = drawing["frames"]
    for frame in (frames[0], frames[30], frames[-1]):
        shown = [frame["data"][frame["traces"].index(index)]["visible"] for index in ways]
        assert sum(shown) == 1
    first = frames[0]
    assert first["data"][first["traces"].index(ways[0])]["visible"]


def test_what_cannot_be_reported_says_why(folder: Path, tmp_path: Path) -> None:
    results = folder.parent / "results.db"
    for arguments, said in (
        ([str(results), "--suite", "other"], "holds no suite 'other', but mine"),
        ([str(results), "--reference", "strait"], "did you mean 'straight'"),
        ([str(tmp_path / "none.db")], "no such file"),
    ):
        done = CliRunner().invoke(app, ["report", *arguments, "--out", str(tmp_path / "out")])
        assert done.exit_code == 2
        assert said in done.output.replace("\n", " ")
    Store(tmp_path / "empty.db").close()
    done = CliRunner().invoke(app, ["report", str(tmp_path / "empty.db")])
    assert "holds no episodes" in done.output
