"""Pages that stand alone: what they contain, and that nothing in them reaches out."""

from __future__ import annotations

import json
import re
from functools import lru_cache
from typing import Any

import gymnasium
import numpy as np
import pytest

import auvgym
from auvgym import report
from auvgym.report.meshes import merge, obstacle_mesh, triangulate
from auvgym.report.tables import ranked, sort_value

pytest.importorskip("plotly")

REACHES_OUT = re.compile(r"<(?:script|link|img|iframe)[^>]+(?:src|href)\s*=", re.IGNORECASE)
FLAT, DEEP = "AUVDynamic2D-v0", "AUVDynamic3D-v0"


@lru_cache
def episode(environment: str) -> tuple[list[Any], Any]:
    """(a copy of the world at each map, trail) of a flight straight at the goal."""
    env = gymnasium.make(environment)
    env.reset(seed=5)
    core: Any = env.unwrapped
    worlds, ended = [core.world], False
    while not ended:
        action = core.action_for(core.world.goal)
        _, _, terminated, truncated, info = env.step(action)
        ended = bool(terminated or truncated)
        if info["map_changed"]:
            worlds.append(core.world)
    return worlds, np.array(core.episode.trail)


def figures_in(page: str) -> list[dict[str, Any]]:
    found = re.findall(r'<script type="application/json"[^>]*>(.*?)</script>', page, re.DOTALL)
    return [json.loads(text) for text in found]


@pytest.mark.parametrize("environment", [FLAT, DEEP])
def test_an_episode_page_stands_alone(environment: str) -> None:
    worlds, trail = episode(environment)
    page = report.figure_page(report.episode_figure(worlds, trail), "An episode")
    assert not REACHES_OUT.search(page)
    assert page.count("<!doctype html>") == 1
    assert page.count("plotly.js v") == 1
    [figure] = figures_in(page)
    names = {trace["name"] for trace in figure["data"]}
    assert {"flown", "vehicle", "start", "goal"} <= names
    assert any("obstacles" in name for name in names)
    assert len(json.dumps(figure)) < 5_000_000


@pytest.mark.parametrize("environment", [FLAT, DEEP])
def test_each_frame_shows_the_map_of_its_time(environment: str) -> None:
    worlds, trail = episode(environment)
    figure = report.episode_figure(worlds, trail, frames=20)
    assert len(figure.frames) == 20
    assert len(figure.layout.sliders[0].steps) == 20
    kind = "Scatter3d" if environment == DEEP else "Scatter"
    for frame in figure.frames:
        assert len(frame.traces) == len(frame.data)
        moving = [figure.data[index] for index in frame.traces]
        shown = [
            update.visible
            for trace, update in zip(moving, frame.data, strict=True)
            if trace.name == "obstacles"
        ]
        assert len(shown) == len(worlds)
        assert sum(map(bool, shown)) == 1
    vehicles = [frame.data[-1] for frame in figure.frames]
    assert all(type(vehicle).__name__ == kind for vehicle in vehicles)
    scale = 1000.0
    np.testing.assert_allclose(vehicles[0].x[0] * scale, trail[0, 0], atol=0.5)
    np.testing.assert_allclose(vehicles[-1].y[0] * scale, trail[-1, 1], atol=0.5)


def test_a_page_is_the_same_every_time() -> None:
    worlds, trail = episode(FLAT)
    first, second = (
        report.figure_page(report.episode_figure(worlds, trail), "Again") for _ in range(2)
    )
    assert first == second


def test_an_episode_needs_a_world_and_a_trail() -> None:
    worlds, trail = episode(FLAT)
    with pytest.raises(ValueError, match="worlds is empty"):
        report.episode_figure([], trail)
    with pytest.raises(ValueError, match=r"\(1, 3\)"):
        report.episode_figure(worlds, trail[:1])


@pytest.mark.parametrize("scenario", ["lfhh-2d-1", "lfhh-3d-1"])
def test_a_plan_is_shown_on_its_map(scenario: str) -> None:
    world = auvgym.World(scenario)
    plan = auvgym.plan(world, "astar")
    figure = report.plan_figure(world, plan)
    way = next(trace for trace in figure.data if trace.name.startswith(plan.planner))
    np.testing.assert_allclose(np.asarray(way.y) * 1000.0, plan.waypoints[:, 1], atol=0.5)
    assert f"{plan.evaluations:,}" in figure.layout.title.subtitle.text
    page = report.figure_page(figure, f"<{scenario}>")
    assert f"<title>&lt;{scenario}&gt;</title>" in page
    assert not REACHES_OUT.search(page)


ROWS: list[dict[str, Any]] = [
    {"policy": "slow", "environment": "B", "success": "10/20", "travel_time_s": None, "score": 0.2},
    {"policy": "fast", "environment": "B", "success": "20/20", "travel_time_s": 9.5, "score": 0.9},
    {"policy": "<i>x</i>", "environment": "A", "success": "3/20", "score": 0.1},
    {"policy": "none", "environment": "B", "success": "0/20", "travel_time_s": 1e6, "score": None},
]


def test_a_leaderboard_ranks_each_environment() -> None:
    page = report.leaderboard_page(ROWS, {}, "Board")
    sections = re.findall(r"<section>.*?</section>", page, re.DOTALL)
    assert len(sections) == 2
    policies = re.findall(r'data-value="(slow|fast|none)"', sections[0])
    assert policies == ["fast", "slow", "none"]
    assert "travel time (s)" in page
    assert "Plotly.newPlot" in page
    assert "plotly.js v" not in page


def test_a_leaderboard_escapes_what_it_is_given() -> None:
    rows = [{**ROWS[2], "environment": "<script>alert(1)</script>", 'k"<': '"><b>'}]
    page = report.leaderboard_page(
        rows, {}, "A <b>title</b>", introduction="1 < 2 & <script>alert(2)</script>"
    )
    assert "<b>" not in page
    assert "alert(1)</script>" not in page
    assert "alert(2)</script>" not in page
    assert "&lt;i&gt;x&lt;/i&gt;" in page


def test_a_leaderboard_shows_its_episodes() -> None:
    worlds, trail = episode(FLAT)
    figure = report.episode_figure(worlds, trail, title="</script><script>alert(3)</script>")
    page = report.leaderboard_page(ROWS, {"one </option>": figure, "two": figure}, "Board")
    assert not REACHES_OUT.search(page)
    assert page.count('<option value="') == 2
    assert "one &lt;/option&gt;" in page
    assert "<script>alert(3)" not in page
    first, second = figures_in(page)
    assert first == second
    assert first["layout"]["title"]["text"].startswith("</script>")


def test_columns_can_be_chosen_and_named() -> None:
    page = report.leaderboard_page(
        ROWS, {}, "Board", columns={"policy": "who", "travel_time_s": "how long"},
        rank_by="travel_time_s", ascending=True,
    )  # fmt: skip
    assert re.findall(r"<button>(.*?)</button>", page)[:2] == ["who", "how long"]
    assert re.findall(r'data-value="(slow|fast|none)"', page) == ["fast", "none", "slow"]


def test_rows_without_a_value_come_last() -> None:
    rows = [{"score": None}, {"score": float("nan")}, {"score": 1.0}, {"score": 2.0}]
    assert [row["score"] for row in ranked(rows, "score")][:2] == [2.0, 1.0]
    assert sort_value("3/4") == 0.75
    assert sort_value("word") == "word"


def test_meshes_are_closed_and_face_outwards() -> None:
    obstacles: list[dict[str, Any]] = [
        {"kind": "sphere", "position_m": [0.0, 0.0, 5.0], "radius_m": 2.0},
        {"kind": "disc", "position_m": [1.0, 2.0], "radius_m": 2.0},
        {
            "kind": "polygon",
            "vertices_m": [[0, 0], [4, 0], [4, 4], [2, 1], [0, 4]],
            "top_m": 1.0,
            "bottom_m": 3.0,
        },
    ]
    for obstacle in obstacles:
        mesh = obstacle_mesh(obstacle, 0.0, 10.0)
        edges = np.sort(mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        _, counts = np.unique(edges, axis=0, return_counts=True)
        assert np.all(counts == 2)
    meshes = [obstacle_mesh(obstacle, 0.0, 10.0) for obstacle in obstacles]
    merged = merge(meshes)
    assert len(merged.faces) == sum(len(mesh.faces) for mesh in meshes)
    assert merged.faces.max() == len(merged.vertices) - 1


def test_triangles_fill_a_polygon() -> None:
    ring = np.array([[0, 0], [4, 0], [4, 4], [2, 1], [0, 4]], dtype=np.float64)
    for corners in (ring, ring[::-1]):
        a, b, c = (corners[triangulate(corners)[:, corner]] for corner in range(3))
        cross = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
        np.testing.assert_allclose(np.abs(0.5 * cross).sum(), 10.0)
