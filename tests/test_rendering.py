"""Frames of real episodes: their shape, that they show something, and that they repeat."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from typing import Any

import gymnasium
import numpy as np
import pytest
from numpy.typing import NDArray

import auvgym
from auvgym.rendering import Viewer
from auvgym.rendering.shapes import outline, section, vertical_extent

pytest.importorskip("pygame")

FLAT, DEEP = "AUVDynamic2D-v0", "AUVDynamic3D-v0"


def flown(environment: str, steps: int = 12, **settings: Any) -> gymnasium.Env[Any, Any]:
    """An environment some waypoints towards the goal."""
    env = gymnasium.make(environment, **settings)
    env.reset(seed=3)
    core: Any = env.unwrapped
    for _ in range(steps):
        _, _, terminated, truncated, _ = env.step(core.action_for(core.world.goal))
        if terminated or truncated:
            break
    return env


@pytest.fixture
def windowless(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A video driver without a screen."""
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    yield
    import pygame

    pygame.display.quit()


@pytest.mark.parametrize("environment", [FLAT, DEEP])
def test_a_frame_is_a_picture_of_the_asked_size(environment: str) -> None:
    env = flown(environment, render_mode="rgb_array")
    frame: Any = env.render()
    assert frame.shape == (800, 1120, 3)
    assert frame.dtype == np.uint8
    assert len(np.unique(frame.reshape(-1, 3), axis=0)) > 500
    env.close()


@pytest.mark.parametrize("environment", [FLAT, DEEP])
def test_the_same_episode_gives_the_same_frames(environment: str) -> None:
    frames = []
    for _ in range(2):
        env = flown(environment, steps=5, render_mode="rgb_array")
        frames.append(env.render())
        env.close()
    np.testing.assert_array_equal(frames[0], frames[1])


def test_a_frame_does_not_depend_on_those_drawn_before() -> None:
    env = flown(FLAT, steps=0)
    core: Any = env.unwrapped
    seasoned, fresh = Viewer("rgb_array"), Viewer("rgb_array")
    for _ in range(4):
        seasoned.frame(core.world, core.episode)
        env.step(core.action_for(core.world.goal))
    # The current under the arrows is repainted only now and then; all else must agree.
    first = seasoned.frame(core.world, core.episode)
    second = fresh.frame(core.world, core.episode)
    assert first is not None
    assert second is not None
    assert np.mean(np.any(first != second, axis=-1)) < 0.02


def test_frames_change_as_the_vehicle_moves() -> None:
    env = flown(DEEP, steps=1, render_mode="rgb_array")
    before: Any = env.render()
    env.step(env.action_space.sample() * 0.0 + 0.5)
    after: Any = env.render()
    assert np.any(before != after)


def test_a_plan_is_drawn() -> None:
    env = flown(FLAT, steps=3)
    core: Any = env.unwrapped
    viewer = Viewer("rgb_array")
    without = viewer.frame(core.world, core.episode)
    way = np.linspace(core.episode.position, core.world.goal, 9)
    drawn = viewer.frame(core.world, core.episode, way)
    assert without is not None
    assert drawn is not None
    assert np.any(without != drawn)


@pytest.mark.parametrize("size", [(720, 540), (901, 667), (1600, 900)])
@pytest.mark.parametrize("environment", [FLAT, DEEP])
def test_other_sizes_are_kept_to(environment: str, size: tuple[int, int]) -> None:
    core: Any = flown(environment, steps=2).unwrapped
    frame = Viewer("rgb_array", size=size).frame(core.world, core.episode)
    assert frame is not None
    assert frame.shape == (size[1], size[0], 3)


def test_a_new_episode_gets_its_own_map() -> None:
    env = flown(DEEP, steps=1, render_mode="rgb_array")
    first: Any = env.render()
    env.reset(seed=4)
    second: Any = env.render()
    env.reset(seed=4)
    again: Any = env.render()
    assert np.any(first != second)
    np.testing.assert_array_equal(second, again)


def test_a_frame_needs_no_display_and_opens_no_window() -> None:
    script = (
        "import gymnasium, auvgym, pygame\n"
        f"env = gymnasium.make({FLAT!r}, render_mode='rgb_array')\n"
        "env.reset(seed=0)\n"
        "assert env.render().any()\n"
        "assert not pygame.display.get_init()\n"
    )
    bare = {
        name: value
        for name, value in os.environ.items()
        if name not in ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER")
    }
    done = subprocess.run(
        [sys.executable, "-c", script], env=bare, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert "pygame" not in done.stdout


@pytest.mark.usefixtures("windowless")
def test_a_window_opens_and_closes() -> None:
    import pygame

    env = flown(FLAT, steps=2, render_mode="human")
    assert env.render() is None
    assert pygame.display.get_surface().get_size() == (1120, 800)
    env.close()
    assert not pygame.display.get_init()


@pytest.mark.usefixtures("windowless")
def test_frames_go_on_unseen_when_the_user_closes_the_window() -> None:
    import pygame

    core: Any = flown(FLAT, steps=1).unwrapped
    viewer = Viewer("human")
    viewer.frame(core.world, core.episode)
    pygame.event.post(pygame.event.Event(pygame.QUIT))
    viewer.frame(core.world, core.episode)
    assert viewer.frame(core.world, core.episode) is None
    assert not pygame.display.get_init()


@pytest.mark.parametrize("mode", ["human", "rgb_array"])
@pytest.mark.usefixtures("windowless")
def test_closing_twice_is_harmless(mode: str) -> None:
    core: Any = flown(FLAT, steps=1).unwrapped
    viewer = Viewer(mode)
    viewer.close()
    viewer.frame(core.world, core.episode)
    viewer.close()
    viewer.close()


def test_an_unknown_mode_is_refused() -> None:
    with pytest.raises(ValueError, match=r"'ansi'.*human, rgb_array"):
        Viewer("ansi")


def test_a_size_too_small_to_read_is_refused() -> None:
    with pytest.raises(ValueError, match="320"):
        Viewer("rgb_array", size=(320, 200))


OBSTACLES: list[dict[str, Any]] = [
    {"kind": "sphere", "position_m": [400.0, 300.0, 250.0], "radius_m": 150.0},
    {"kind": "disc", "position_m": [600.0, 500.0], "radius_m": 120.0},
    {
        "kind": "cylinder",
        "position_m": [300.0, 380.0],
        "radius_m": 90.0,
        "top_m": 100.0,
        "bottom_m": 300.0,
    },
    {
        "kind": "superquadric",
        "position_m": [500.0, 450.0, 260.0],
        "semi_axes_m": [160.0, 110.0, 140.0],
        "exponents": [2.0, 8.0, 4.0],
    },
    {
        "kind": "polygon",
        "vertices_m": [[200.0, 200.0], [700.0, 250.0], [650.0, 700.0], [450.0, 350.0]],
        "top_m": 50.0,
        "bottom_m": 320.0,
    },
]


def world_of(obstacle: dict[str, Any]) -> auvgym.World:
    return auvgym.World(
        auvgym.Scenario.from_dict(
            {
                "schema": 1,
                "name": "one-obstacle",
                "dimensions": 3,
                "domain": {
                    "min_m": [0.0, 0.0, 0.0],
                    "max_m": [1000.0, 1000.0, 500.0],
                    "margin_m": 10.0,
                },
                "missions": [{"start_m": [5.0, 5.0, 5.0], "goal_m": [990.0, 990.0, 5.0]}],
                "limits": {"goal_radius_m": 5.0},
                "obstacles": [obstacle],
            }
        )
    )


def within(ring: NDArray[np.float64], scale: float) -> NDArray[np.float64]:
    """The ring drawn in or out about its middle, so that it lies inside or outside."""
    middle = ring.mean(axis=0)
    return middle + scale * (ring - middle)


@pytest.mark.parametrize("obstacle", OBSTACLES, ids=lambda obstacle: str(obstacle["kind"]))
def test_cuts_lie_on_the_engine_s_surfaces(obstacle: dict[str, Any]) -> None:
    world = world_of(obstacle)
    drawn = world.snapshot()["obstacles"][0]
    depth = 240.0
    ring = section(drawn, depth)
    assert len(ring) >= 3
    clearance = world.clearance(np.column_stack([ring, np.full(len(ring), depth)]))
    np.testing.assert_allclose(clearance, 0.0, atol=0.5)
    if drawn["kind"] != "polygon":  # this one is not convex about its middle
        for scale, sign in ((0.9, -1.0), (1.1, 1.0)):
            points = within(ring, scale)
            column = np.full(len(points), depth)
            assert np.all(sign * world.clearance(np.column_stack([points, column])) > 0.0)


@pytest.mark.parametrize("obstacle", OBSTACLES, ids=lambda obstacle: str(obstacle["kind"]))
def test_profiles_lie_on_the_engine_s_surfaces(obstacle: dict[str, Any]) -> None:
    world = world_of(obstacle)
    drawn = world.snapshot()["obstacles"][0]
    line = np.stack([np.linspace(0.0, 1000.0, 401), np.linspace(100.0, 900.0, 401)], axis=-1)
    extent = vertical_extent(drawn, line)
    solid = ~np.isnan(extent[:, 0])
    assert solid.any()
    middle = np.clip(extent[solid], 0.0, 500.0).mean(axis=1)
    inside = world.clearance(np.column_stack([line[solid], middle]))
    assert np.all(inside <= 1e-6)
    beside = np.column_stack([line[~solid], np.full(np.count_nonzero(~solid), 240.0)])
    assert np.all(world.clearance(beside) >= -1e-6)


def test_a_cut_above_an_obstacle_is_empty() -> None:
    drawn = world_of(OBSTACLES[0]).snapshot()["obstacles"][0]
    assert section(drawn, 50.0).shape == (0, 2)
    assert outline(drawn).shape[1] == 2
