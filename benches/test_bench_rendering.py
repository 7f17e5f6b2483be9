"""Frames per second of the viewer, on an episode under way."""

from __future__ import annotations

from typing import Any

import gymnasium
import pytest

import auvgym  # noqa: F401  (registers the environments)
from auvgym.rendering import Viewer

pytest.importorskip("pygame")


@pytest.mark.parametrize("environment", ["AUVDynamic2D-v0", "AUVDynamic3D-v0"])
def test_frame(benchmark: Any, environment: str) -> None:
    env = gymnasium.make(environment)
    env.reset(seed=1)
    core: Any = env.unwrapped
    for _ in range(12):
        _, _, terminated, truncated, _ = env.step(core.action_for(core.world.goal))
        if terminated or truncated:
            break
    viewer = Viewer("rgb_array")
    viewer.frame(core.world, core.episode)
    benchmark(viewer.frame, core.world, core.episode)
