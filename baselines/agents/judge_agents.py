"""Flies the shipped agents beside scripted policies, and writes ``agents.md``.

``python baselines/agents/judge_agents.py --workers 2``; what was flown is kept in results/agents
and not flown again, unless a network has changed. The suite ``ocean`` is judged where $AUVGYM_DATA
has its files.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from auvgym import policies
from auvgym.cli.flying import fly_with_progress
from auvgym.evaluation import (
    EpisodeResult,
    PolicySpec,
    Store,
    Suite,
    SuiteError,
    load_suite,
    seeds_of,
    single_suite,
    wilson_interval,
)

HERE = Path(__file__).parent
#: Environment -> the scripted planner that is best there on the board of the suite ``paper``.
PLANNERS = {
    "AUVDynamic2D-v0": "astar-replan",
    "AUVDynamic3D-v0": "astar-replan",
    "AUVHarbor2D-v0": "astar",
    "AUVStatic3D-v0": "rrt-star",
    "AUVThreat3D-v0": "iifds-reactive",
}
DIFFICULTIES = ("normal", "hard")
AGENT, RULE = "ppo", "sonar-rule"
HEADER = """# The shipped agents on the test seeds

Written by `python baselines/agents/judge_agents.py --workers 2`: {episodes} episodes each, the
first of the range `test`, which no choice was made on. Solved in %, with Wilson's 95 % interval;
time/limit is the mean over all episodes of travel time over the time limit, a failure counted as
the limit; energy over all episodes. Differences are the agent less the other, paired by instance,
with 95 % intervals of their means. The planner is the one that is best in the environment on the
board of `paper`; it is given the map, the agent and the rule have sensors only.

"""
COLUMNS = """| environment | difficulty | policy | solved | time/limit | MJ | agent: solved | time |
|---|---|---|---|---|---|---|---|
"""
SUITES = {
    "strong-currents": "Currents half as strong again as at hard, and currents in the tanks, which "
    "are still in training.",
    "ocean": "Missions through real currents, one each.",
}
Flown = dict[str, list[EpisodeResult]]


def main() -> None:
    """Fly what is missing, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--episodes", type=int, default=1000)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--env", action="append", help="only this one, without the page")
    options = parser.parse_args()
    trained = policies.list_agents()[AGENT]
    chosen = [one for one in PLANNERS if one in trained and one in (options.env or PLANNERS)]
    with Store(Path("results") / "agents" / "results.db") as store:
        page = HEADER.format(episodes=options.episodes) + COLUMNS
        gaps = []
        for environment in chosen:
            for difficulty in DIFFICULTIES:
                first = seeds_of("test", options.episodes).start
                suite = single_suite(environment, options.episodes, difficulty, first_seed=first)
                flown = fly(store, suite, environment, options.workers)
                page += report(rows(environment, difficulty, flown))
                gaps.append(f"| {environment} | {difficulty} | {closed(flown)} |\n")
        page += GAP + "".join(gaps)
        for name in () if options.env else SUITES:
            page += judged_suite(store, name, options.workers)
    if not options.env:
        (HERE / "agents.md").write_text(page + "\n" + recipes(trained), encoding="utf-8")


def judged_suite(store: Store, name: str, workers: int) -> str:
    """The section of a suite outside of what agents are trained on."""
    try:
        suite = load_suite(name)
        text = f"\n## `{name}`\n\n{SUITES[name]}\n\n{COLUMNS}"
        for environment in sorted({one.environment for one in suite.instances}):
            here = [one for one in suite.instances if one.environment == environment]
            part = Suite(f"{name}-{environment}", tuple(here))
            text += report(rows(environment, name, fly(store, part, environment, workers)))
    except SuiteError as error:
        print(f"{name} is left out: {error}")
        return ""
    return text


def report(lines: Sequence[str]) -> str:
    """Print the lines as they come."""
    text = "".join(f"{line}\n" for line in lines)
    print(text, end="", flush=True)
    return text


def fly(store: Store, suite: Suite, environment: str, workers: int) -> Flown:
    """Policy -> its episodes, in the order of the instances."""
    network = str(policies.list_agents()[AGENT][environment])
    names = {network: AGENT, RULE: RULE, PLANNERS[environment]: PLANNERS[environment]}
    specs = [PolicySpec(name) for name in names]  # of a file: held to its hash
    results = fly_with_progress(suite, specs, store, workers)
    flown: Flown = {name: [] for name in names.values()}
    for result in sorted(results, key=lambda one: (one.scenario, one.settings, one.seed)):
        flown[names[result.policy]].append(result)
    return flown


def rows(environment: str, difficulty: str, flown: Flown) -> list[str]:
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
    if len(differences) < 2:
        return f"{mean:+.{digits}f}"
    half = 1.96 * differences.std(ddof=1) / len(differences) ** 0.5
    return f"{mean:+.{digits}f} [{mean - half:+.{digits}f}, {mean + half:+.{digits}f}]"


GAP = """
## How much of the gap between rule and planner the agents close

(agent - rule) / (planner - rule) in share of episodes solved; 95 % interval of 10 000 bootstrap
draws of the instances. `hard` is worth reading: at `normal` the gap is a few episodes wide.

| environment | difficulty | closed |
|---|---|---|
"""


def closed(flown: Flown) -> str:
    """The share of the gap, with its interval."""
    agent, rule, planner = (
        np.array([one.success for one in episodes]) for episodes in flown.values()
    )
    generator = np.random.default_rng(0)
    counts = generator.multinomial(len(agent), np.full(len(agent), 1 / len(agent)), 10_000)
    gaps = counts @ (planner - rule)
    shares = (counts @ (agent - rule))[gaps > 0] / gaps[gaps > 0]
    if 20 * len(shares) < 19 * len(gaps):
        return "there is no gap"
    low, high = np.quantile(shares, (0.025, 0.975))
    share = (agent - rule).sum() / (planner - rule).sum()
    return f"{share:.2f} [{low:.2f}, {high:.2f}]"


def recipes(trained: Mapping[str, Path]) -> str:
    """How each network was made, out of its card."""
    lines = [
        "## How they were made\n",
        "By these commands, one thread for the networks; the card has the curve.\n",
        "| network | command | legs | minutes | best on validation |",
        "|---|---|---|---|---|",
    ]
    for task, path in trained.items():
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
