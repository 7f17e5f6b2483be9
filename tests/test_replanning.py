"""Re-planning: the window, the papers' protocol, and what is refused."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from small_worlds import disc, world

import auvgym
from auvgym import PlanningError, World


def test_a_window_grows_until_there_is_a_way() -> None:
    # Waypoints 8 and 9 of the old path lie inside the disc: no window can end there.
    sections = {"count": 20, "spacing_m": 1_000.0}
    ocean = world(obstacles=[disc(10_000, 8_500, 1_000)], sections=sections)
    straight = np.linspace(ocean.start, ocean.goal, 20)
    plan = auvgym.replan(ocean, straight, straight[2], "lfhh", seed=0, window=6)
    assert plan.window == 8
    assert plan.cost["block"] == 0
    free = auvgym.replan(world(sections=sections), straight, straight[2])
    assert free.window == 17  # 20 sections reach beyond the goal


@pytest.mark.parametrize("name", ["lfhh-2d-1", "lfhh-3d-1"])
def test_the_protocol_has_six_phases(name: str) -> None:
    ocean = World(name)
    phases = auvgym.run_phases(ocean, "lfhh", seed=1)
    assert len(phases) == 6
    assert np.array_equal(phases[0].position, ocean.start)
    assert phases[0].window == 39
    for before, phase in itertools.pairwise(phases):
        assert phase.position.shape == (3,)
        assert phase.position[1] > before.position[1]
        assert 1 <= phase.window <= 39
    for phase in phases:
        assert phase.evaluations > 0
        assert phase.feasible == (phase.cost < 2)
    assert ocean.changes == 0, "the protocol runs on a copy"
    again = auvgym.run_phases(ocean, "lfhh", seed=1)
    assert [(p.cost, p.evaluations, p.position.tolist()) for p in again] == [
        (p.cost, p.evaluations, p.position.tolist()) for p in phases
    ]
    # LFHH's level in the paper: about 0.7 where it is feasible.
    costs = [phase.cost for phase in phases[1:] if phase.feasible]
    assert len(costs) >= 3
    assert 0.3 < np.mean(costs) < 1.2


# --- bad input ---------------------------------------------------------------------------------

PATHS: dict[str, tuple[Any, str]] = {
    "one point": ([[0, 0, 0]], r"has shape \(1, 3\): must be \(n, 3\) with n >= 2"),
    "flat": ([[0, 0], [1, 1]], r"has shape \(2, 2\)"),
    "a point": ([0, 0, 0], r"has shape \(3,\)"),
    "NaN": ([[0, 0, 0], [0, np.nan, 0]], r"\[1, 1\] = nan: must be finite"),
    "infinite": ([[0, 0, np.inf], [0, 0, 0]], r"\[0, 2\] = inf: must be finite"),
    "text": ("path", "must be numbers"),
    "None": (None, "must be numbers"),
    "ragged": ([[0, 0, 0], [1]], "must be numbers"),
}


@pytest.mark.parametrize("case", PATHS)
def test_a_wrong_path_is_named(case: str) -> None:
    path, message = PATHS[case]
    ocean = World("lfhh-2d-1")
    with pytest.raises(PlanningError, match=f"^waypoints.*{message}"):
        auvgym.path_cost(ocean, path)
    with pytest.raises(PlanningError, match=f"^path.*{message}"):
        auvgym.replan(ocean, path, ocean.start)


@pytest.mark.parametrize("window", [0, -1, 2.5, "all", None, True])
def test_a_wrong_window_is_named(window: Any) -> None:
    ocean = World("lfhh-2d-1")
    with pytest.raises(PlanningError, match=f"window = {window!r}: must be an integer, 1"):
        auvgym.replan(ocean, [ocean.start, ocean.goal], ocean.start, window=window)


@pytest.mark.parametrize("position", [[0, 0], [0, np.nan, 0], "here", None])
def test_a_wrong_position_is_named(position: Any) -> None:
    ocean = World("lfhh-2d-1")
    with pytest.raises(PlanningError, match=r"^position"):
        auvgym.replan(ocean, [ocean.start, ocean.goal], position)


def test_phases_need_changes() -> None:
    with pytest.raises(PlanningError, match="change"):
        auvgym.run_phases(world(sections={"count": 20, "spacing_m": 1_000.0}), "lfhh")
