"""Flies the shipped triggers beside scripted ones on the test seeds, and writes ``triggers.md``.

``python baselines/agents/judge_triggers.py --workers 2``; what was flown is kept in
results/triggers and not flown again, unless a network has changed.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import shuffled_blocks
from judge_agents import AGENT, Flown, interval, recipes, report

from auvgym import policies
from auvgym.cli.flying import fly_with_progress
from auvgym.evaluation import (
    EpisodeResult,
    PolicySpec,
    Store,
    seeds_of,
    single_suite,
    wilson_interval,
)

HERE = Path(__file__).parent
DIFFICULTY = "hard"
#: What follows the environment's id where an agent chooses when to plan.
TRIGGER = "/replan"
#: Episodes of the table that says what a trigger rests on.
SHUFFLED = 500
#: Scripted triggers, and the windows that they plan in.
RIVALS = {
    "never": ("full",),
    "every-change": ("full", "long", "short"),
    "on-predicted-collision": ("full", "short"),
}
HEADER = """# The shipped triggers on the test seeds

Written by `python baselines/agents/judge_triggers.py --workers 2`: {episodes} episodes each at
`{difficulty}` with `action_mode="replan"`, the first of the range `test`, which no choice was made
on. Planning takes its default time: 600 s to the goal, 300 s in a long window, 120 s in a short
one; time is travel and planning together, over that of the straight line in still water, a failure
counted as the time limit. Solved in %, with Wilson's 95 % interval; plans are means per episode.
Differences are the agent less the other, paired by instance, with 95 % intervals of their means.

| environment | trigger | solved | time | plans: short | long | full | agent: solved | time |
|---|---|---|---|---|---|---|---|---|
"""


def main() -> None:
    """Fly what is missing, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--episodes", type=int, default=1000)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--env", action="append", help="only this one, without the page")
    options = parser.parse_args()
    trained = {
        task: path for task, path in policies.list_agents()[AGENT].items() if task.endswith(TRIGGER)
    }
    page = HEADER.format(episodes=options.episodes, difficulty=DIFFICULTY)
    with Store(Path("results") / "triggers" / "results.db") as store:
        for task, network in trained.items():
            environment = task.removesuffix(TRIGGER)
            if environment in (options.env or [environment]):
                flown = fly(store, environment, network, options.episodes, options.workers)
                page += report(rows(environment, flown))
    if not options.env:
        page += shuffled_blocks.HEADER.format(episodes=SHUFFLED)
        for task, network in trained.items():
            environment = task.removesuffix(TRIGGER)
            page += report(shuffled_blocks.table(environment, DIFFICULTY, network, SHUFFLED))
        (HERE / "triggers.md").write_text(page + "\n" + recipes(trained), encoding="utf-8")


def fly(store: Store, environment: str, network: Path, episodes: int, workers: int) -> Flown:
    """Trigger -> its episodes, in the order of the seeds."""
    first = seeds_of("test", episodes).start
    settings = {"action_mode": "replan"}
    suite = single_suite(environment, episodes, DIFFICULTY, first_seed=first, settings=settings)
    specs = {AGENT: PolicySpec(str(network))}  # of a file: held to its hash
    for name, windows in RIVALS.items():
        for window in windows:
            label = name if windows == ("full",) else f"{name}, {window}"
            specs[label] = PolicySpec(name, parameters={"window": window})
    results = fly_with_progress(suite, list(specs.values()), store, workers)
    flown: Flown = {}
    for label, spec in specs.items():
        window = spec.parameters.get("window")
        mine = [
            one
            for one in results
            if one.policy == spec.name and (window is None or f'"{window}"' in one.parameters)
        ]
        flown[label] = sorted(mine, key=lambda one: one.seed)
    return flown


def rows(environment: str, flown: Flown) -> list[str]:
    """The page's lines of one environment."""
    lines = []
    agent = flown[AGENT]
    for label, episodes in flown.items():
        solved = np.array([one.success for one in episodes])
        low, high = wilson_interval(int(solved.sum()), len(solved))
        plans = [np.concatenate([one.action_log() for one in episodes]) == 1 + i for i in range(3)]
        cells = [
            f"{100 * solved.mean():.1f} [{100 * low:.1f}, {100 * high:.1f}]",
            f"{times(episodes).mean():.3f}",
            *(f"{asked.sum() / len(episodes):.1f}" for asked in plans),
        ]
        if label == AGENT:
            cells += ["", ""]
        else:
            gained = 100.0 * (np.array([one.success for one in agent]) - solved)
            cells += [interval(gained, 1), interval(times(agent) - times(episodes), 3)]
        lines.append(f"| {environment} | {label} | " + " | ".join(cells) + " |")
    return lines


def times(episodes: list[EpisodeResult]) -> np.ndarray:
    """Total times over the straight line's in still water, failures counted as the limit."""
    spent = [one.time_s if one.success else one.time_limit_s for one in episodes]
    return np.array(spent) / np.array([one.still_water_time_s for one in episodes])


if __name__ == "__main__":
    main()
