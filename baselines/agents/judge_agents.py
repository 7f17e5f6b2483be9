"""Flies the shipped agents on the test seeds beside scripted policies, and writes ``agents.md``.

``python baselines/agents/judge_agents.py --workers 2``; what was flown is kept in results/agents
and not flown again. Remove that folder when a network was trained anew.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np

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
#: Environment -> difficulties, and the best scripted planner there.
JUDGED = {
    "AUVDynamic2D-v0": (("normal", "hard"), "astar-replan"),
    "AUVDynamic3D-v0": (("normal", "hard"), "astar-replan"),
    "AUVHarbor2D-v0": (("normal", "hard"), "visibility"),
    "AUVStatic3D-v0": (("normal", "hard"), "astar-replan"),
    "AUVThreat3D-v0": (("normal", "hard"), "iifds-reactive"),
}
AGENT, RULE = "ppo", "sonar-rule"
HEADER = """# The shipped agents on the test seeds

Written by `python baselines/agents/judge_agents.py --workers 2`: {episodes} episodes each, the
first of the range `test`, which no choice was made on. Solved in %, with Wilson's 95 % interval;
time/limit is the mean over all episodes of travel time over the time limit, a failure counted as
the limit; energy over all episodes. Differences are the agent less the other, paired by instance,
with 95 % intervals of their means.

| environment | difficulty | policy | solved | time/limit | MJ | agent solves | agent's time/limit |
|---|---|---|---|---|---|---|---|
"""


def main() -> None:
    """Fly what is missing, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--episodes", type=int, default=1000)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--env", action="append", help="only this one, without the page")
    options = parser.parse_args()
    lines = []
    with Store(Path("results") / "agents" / "results.db") as store:
        for environment, (difficulties, planner) in JUDGED.items():
            if environment not in policies.list_agents()[AGENT]:
                continue
            if options.env and environment not in options.env:
                continue
            for difficulty in difficulties:
                flown = fly(store, environment, difficulty, planner, options)
                lines += rows(environment, difficulty, flown)
                print("\n".join(lines[-len(flown) :]), flush=True)
    if not options.env:
        text = HEADER.format(episodes=options.episodes) + "\n".join(lines) + "\n\n" + recipes()
        (HERE / "agents.md").write_text(text, encoding="utf-8")


def fly(
    store: Store, environment: str, difficulty: str, planner: str, options: argparse.Namespace
) -> dict[str, list[EpisodeResult]]:
    """Policy -> its episodes, in the order of the seeds."""
    first = seeds_of("test", options.episodes).start
    suite = single_suite(environment, options.episodes, difficulty, first_seed=first)
    specs = [PolicySpec(name) for name in (AGENT, RULE, planner)]
    results = fly_with_progress(suite, specs, store, options.workers)
    flown: dict[str, list[EpisodeResult]] = {spec.name: [] for spec in specs}
    for result in sorted(results, key=lambda one: one.seed):
        flown[result.policy].append(result)
    return flown


def rows(environment: str, difficulty: str, flown: dict[str, list[EpisodeResult]]) -> list[str]:
    """The page's lines of one environment and difficulty."""
    lines = []
    for name, episodes in flown.items():
        solved = [one.success for one in episodes]
        low, high = wilson_interval(sum(solved), len(solved))
        energy = np.mean([one.energy_j for one in episodes]) / 1e6
        cells = [
            f"{100 * np.mean(solved):.1f} [{100 * low:.1f}, {100 * high:.1f}]",
            f"{times(episodes).mean():.3f}",
            f"{energy:.3g}",
        ]
        if name == AGENT:
            cells += ["", ""]
        else:
            agent = flown[AGENT]
            gained = 100.0 * (np.array([one.success for one in agent]) - np.array(solved))
            cells += [interval(gained, 1), interval(times(agent) - times(episodes), 3)]
        lines.append(f"| {environment} | {difficulty} | {name} | " + " | ".join(cells) + " |")
    return lines


def times(episodes: list[EpisodeResult]) -> np.ndarray:
    """Travel times over the time limit, failures counted as the limit."""
    return np.array([one.time_s / one.time_limit_s if one.success else 1.0 for one in episodes])


def interval(differences: np.ndarray, digits: int) -> str:
    """The mean of paired differences and its 95 % interval."""
    mean = differences.mean()
    half = 1.96 * differences.std(ddof=1) / len(differences) ** 0.5
    return f"{mean:+.{digits}f} [{mean - half:+.{digits}f}, {mean + half:+.{digits}f}]"


def recipes() -> str:
    """How each network was made, out of its card."""
    lines = [
        "## How they were made\n",
        "Each by one command, one thread for the networks; the card has the curve.\n",
        "| network | command | legs | minutes | best on validation |",
        "|---|---|---|---|---|",
    ]
    for task, path in policies.list_agents()[AGENT].items():
        card = json.loads(path.with_suffix(".json").read_text(encoding="utf-8"))
        best = card["best"]
        commands = "<br>".join(f"`{command}`" for command in card["commands"])
        lines.append(
            f"| {task} | {commands} | {card['timesteps']} | {card['seconds'] / 60:.0f} | "
            f"{100 * best['success']:.1f} % after {best['timesteps']} legs |"
        )
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
