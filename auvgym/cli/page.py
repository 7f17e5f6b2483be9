"""HTML pages of what the commands found; the figures themselves are :mod:`auvgym.report`'s."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import auvgym
    from auvgym.evaluation import EpisodeResult, PolicySummary, Replay, Suite

# A figure is a few hundred kB of page: the best of each environment are enough to look at.
_SHOWN_PER_STRATUM = 5
_COLUMNS = {
    "policy": "policy",
    "knows": "knows",
    "solved": "solved",
    "interval": "95 %",
    "score": "score",
    "time_h": "time h",
    "time_or_limit_h": "all h",
    "energy_mj": "MJ",
    "cost": "cost",
    "min_clearance_m": "clear m",
    "evaluations": "evals",
    "gap": "gap",
    "planning_seconds": "plan s",
}


def write_leaderboard_page(
    suite: Suite, results: Sequence[EpisodeResult], path: Path, *, figures: bool = True
) -> Path:
    """Write ranked tables and, with ``figures``, one episode per policy and stratum to watch.

    Raises:
        ImportError: figures without plotly; says which extra brings it.
    """
    from auvgym import __version__, evaluation, report
    from auvgym.cli.tables import explanation
    from auvgym.evaluation.suite import stratum_label

    summaries = evaluation.summarise(results)
    episodes: dict[str, Any] = {}
    if figures:
        shown = [(evaluation.replay(row), row) for row in _worth_watching(summaries, results)]
        # Space before plane: the page opens on the first.
        shown.sort(key=lambda pair: -pair[0].flight.maps[0][1].dimensions)
        for replayed, row in shown:
            label = f"{stratum_label(row.stratum)} · {row.policy}"
            episodes[label] = episode_drawing(replayed, row)
    page = report.leaderboard_page(
        [_cells(summary) for summary in summaries],
        episodes,
        f"auvgym leaderboard: {suite.name}",
        columns=_COLUMNS,
        introduction=f"{suite.description} {explanation()} Suite {suite.name}, hash {suite.hash}, "
        f"{len(suite.instances)} instances; auvgym {__version__}.".strip(),
    )
    return _write(path, page)


def write_episode_page(row: EpisodeResult, path: Path) -> Replay:
    """Replay a stored episode and write it as a page of its own."""
    from auvgym import evaluation, report

    replayed = evaluation.replay(row)
    _write(path, report.figure_page(episode_drawing(replayed, row), f"{row.policy}: {row.outcome}"))
    return replayed


def write_plan_page(
    world: auvgym.World, plan: auvgym.Plan, path: Path, chart: auvgym.Maklink | None = None
) -> Path:
    """Write a plan on its map, and on the chart on which it was planned if there is one."""
    import numpy as np

    from auvgym import report

    title = f"{plan.planner} on {world.scenario.name}"
    corners = None if plan.harbor is None else plan.harbor.corners
    if corners is not None and np.array_equal(corners, plan.waypoints):
        corners = None
    return _write(path, report.figure_page(report.plan_figure(world, plan, chart, corners), title))


def episode_drawing(replayed: Replay, row: EpisodeResult) -> dict[str, Any]:
    """The interactive figure of a replayed episode, as plotly.js reads it."""
    import numpy as np

    from auvgym.evaluation.plans import plans_of
    from auvgym.report.episode import episode_drawing

    core: Any = replayed.flight.env.unwrapped
    return episode_drawing(
        replayed.flight.worlds,
        np.asarray(core.episode.trail, dtype=np.float64),
        plans=plans_of(row),
        title=f"{row.policy} · {row.environment}",
        subtitle=f"seed {row.seed}: {row.outcome} after {row.time_s / 3600:.2f} h",
    )


def _worth_watching(
    summaries: Sequence[PolicySummary], results: Sequence[EpisodeResult]
) -> list[EpisodeResult]:
    """Per stratum, the best policies on one instance: where the best of all did middling."""
    chosen: list[EpisodeResult] = []
    for stratum, group in groupby(summaries, key=lambda summary: summary.stratum):
        ranked = [summary.policy for summary in group]
        flown = [row for row in results if row.stratum == stratum and row.steps]
        by_winner = sorted(
            (row for row in flown if row.policy == ranked[0]), key=lambda row: row.score
        )
        if by_winner:
            seed = by_winner[len(by_winner) // 2].seed
            same = {row.policy: row for row in flown if row.seed == seed}
            chosen += [same[policy] for policy in ranked if policy in same][:_SHOWN_PER_STRATUM]
    return chosen


def _cells(summary: PolicySummary) -> dict[str, Any]:
    from auvgym.evaluation.suite import stratum_label

    return {
        "environment": stratum_label(summary.stratum),
        "policy": summary.policy,
        "knows": summary.knows,
        "solved": f"{summary.solved}/{summary.episodes}",
        "interval": f"{summary.success_low:.0%} to {summary.success_high:.0%}",
        "score": summary.score,
        "time_h": _scaled(summary.time_s, 3600.0),
        "time_or_limit_h": summary.time_or_limit_s / 3600.0,
        "energy_mj": _scaled(summary.energy_j, 1e6),
        "cost": summary.cost,
        "min_clearance_m": summary.min_clearance_m,
        "evaluations": summary.evaluations,
        "gap": summary.gap,
        "planning_seconds": summary.planning_seconds,
    }


def _scaled(value: float | None, unit: float) -> float | None:
    return None if value is None else value / unit


def _write(path: Path, page: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(page, encoding="utf-8")
    return path
