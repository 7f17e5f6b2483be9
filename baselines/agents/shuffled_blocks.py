"""What a shipped trigger rests on: the same flights with a part of what it sees taken from others.

In each step the blocks of a group are handed round among the episodes that are flown side by side:
they stay as likely as they were, but tell nothing of this one. What that costs is what the trigger
draws from them. :mod:`judge_triggers` writes the table.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from judge_agents import interval

from auvgym._extras import require
from auvgym.evaluation import SEEDS
from auvgym.training.flights import Examination, Flown

#: What is handed round together, and what it is called.
GROUPS = {
    "what the present current costs against the plan's": ("plan_error", "plan_loss"),
    "the currents that the plan's map promises": ("plan_current",),
    "the current round the vehicle": ("current",),
    "the conflict ahead": ("plan_conflict",),
    "sonar and obstacles": ("sonar", "obstacles"),
    "way and time since the last change": ("change_distance", "change_time"),
    "the plan's age": ("plan_changes", "plan_age"),
    "time, energy and way left": (
        "time_left",
        "energy_left",
        "goal_distance",
        "goal_near",
        "plan_left",
    ),
}
#: After the validation seeds that the network was chosen on.
SKIPPED = 256
HEADER = """
## What they rest on

{episodes} validation seeds that no network was chosen on, flown as they are and with blocks of the
observation handed round among the episodes in flight (`baselines/agents/shuffled_blocks.py`);
differences to the first line are paired.

| environment | handed round | solved | time/limit | plans | solved | time/limit |
|---|---|---|---|---|---|---|
"""


def table(environment: str, difficulty: str, network: Path, episodes: int) -> list[str]:
    """The lines of one network."""
    settings = {"difficulty": difficulty, "action_mode": "replan"}
    first = SEEDS["validation"].start + SKIPPED
    examination = Examination(environment, range(first, first + episodes), settings)
    core: Any = gymnasium.make(environment, **settings).unwrapped
    layout = core.observation_layout
    session = require("onnxruntime", "agents").InferenceSession(str(network))
    name = session.get_inputs()[0].name

    def fly(blocks: tuple[str, ...]) -> tuple[Flown, float]:
        generator = np.random.default_rng(0)
        columns = np.concatenate([np.arange(0), *(np.arange(500)[layout[one]] for one in blocks)])
        flying = np.ones(episodes, np.bool_)
        plans, begun = 0, False

        def act(seen: Any, begins: Any) -> Any:
            nonlocal plans, begun, flying
            if begun:  # whoever begins again has landed
                flying &= ~begins
            begun = True
            given = seen.copy()
            given[:, columns] = seen[generator.permutation(len(seen))][:, columns]
            actions = session.run(None, {name: given})[0]
            plans += int((actions[flying] > 0).sum())
            return actions

        return examination.fly(act), plans / episodes

    true, plans = fly(())
    lines = [line(environment, "nothing", true, plans) + " | |"]
    for group, blocks in GROUPS.items():
        flown, plans = fly(blocks)
        gained = 100.0 * (flown.success.astype(float) - true.success)
        differences = (interval(gained, 1), interval(flown.time_share - true.time_share, 3))
        lines.append(line(environment, group, flown, plans) + f" {' | '.join(differences)} |")
    return lines


def line(environment: str, group: str, flown: Flown, plans: float) -> str:
    """The line without its differences."""
    solved, share = 100.0 * flown.success.mean(), flown.time_share.mean()
    return f"| {environment} | {group} | {solved:.1f} | {share:.3f} | {plans:.1f} |"
