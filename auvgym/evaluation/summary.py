"""From episodes to a ranking: one line per policy and environment, failures counted."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from statistics import fmean

from auvgym.evaluation.result import EpisodeResult
from auvgym.evaluation.suite import Stratum

Entrant = tuple[str, int, str]  # policy, its seed, its parameters
WILSON_Z = 1.959963984540054  # two-sided 95 %


@dataclass(frozen=True)
class PolicySummary:
    """How one policy did in one environment. SI units.

    ``gap`` is the mean over the episodes that have one.

    ``time_s``, ``energy_j``, ``path_length_m``, ``cost`` and ``min_clearance_m`` are means over the
    episodes it solved (None if it solved none) and flatter a policy that fails on the long ones;
    ``time_or_limit_s`` counts each failure as the time limit. ``evaluations``, ``replans`` and
    ``planning_seconds`` are means over all episodes. ``success_low`` and ``success_high`` bound
    the success rate (Wilson, 95 %).
    """

    environment: str
    difficulty: str
    scenario: str
    settings: str
    policy: str
    policy_seed: int
    parameters: str
    knows: str
    rank: int
    episodes: int
    solved: int
    errors: int
    success_low: float
    success_high: float
    score: float
    reward: float
    time_s: float | None
    time_or_limit_s: float
    energy_j: float | None
    path_length_m: float | None
    cost: float | None
    min_clearance_m: float | None
    evaluations: float
    replans: float
    gap: float | None
    planning_seconds: float

    @property
    def stratum(self) -> Stratum:
        """What is ranked together: environment, difficulty, scenario, settings."""
        return self.environment, self.difficulty, self.scenario, self.settings

    @property
    def entrant(self) -> Entrant:
        """Policy, seed, parameters."""
        return self.policy, self.policy_seed, self.parameters


def summarise(
    results: Iterable[EpisodeResult],
    stratum_of: Callable[[EpisodeResult], Stratum] = lambda one: one.stratum,
) -> list[PolicySummary]:
    """One summary per stratum and policy, best first: by mean score, then by episodes solved."""
    strata: dict[Stratum, dict[Entrant, list[EpisodeResult]]] = {}
    for result in results:
        entrant = (result.policy, result.policy_seed, result.parameters)
        entrants = strata.setdefault(stratum_of(result), {})
        entrants.setdefault(entrant, []).append(result)
    summaries: list[PolicySummary] = []
    for stratum, entrants in sorted(strata.items()):
        entries = [episodes for _, episodes in sorted(entrants.items())]
        entries.sort(key=_standing, reverse=True)
        standings = [_standing(episodes) for episodes in entries]
        # Equals share the better place: 1, 2, 2, 4.
        summaries += [
            _summary(stratum, 1 + standings.index(standing), episodes)
            for standing, episodes in zip(standings, entries, strict=True)
        ]
    return summaries


def wilson_interval(solved: int, episodes: int) -> tuple[float, float]:
    """95 % bounds of a success rate (Wilson 1927), each in [0, 1]; (0, 1) where none was flown."""
    if episodes == 0:
        return 0.0, 1.0
    share, weight = solved / episodes, WILSON_Z**2 / episodes
    centre = (share + weight / 2.0) / (1.0 + weight)
    half = WILSON_Z * math.sqrt(share * (1.0 - share) / episodes + weight / (4.0 * episodes))
    half /= 1.0 + weight
    return max(0.0, centre - half), min(1.0, centre + half)


def _summary(stratum: Stratum, rank: int, episodes: Sequence[EpisodeResult]) -> PolicySummary:
    first = episodes[0]
    environment, difficulty, scenario, settings = stratum
    solved = [episode for episode in episodes if episode.success]
    low, high = wilson_interval(len(solved), len(episodes))
    return PolicySummary(
        environment=environment,
        difficulty=difficulty,
        scenario=scenario,
        settings=settings,
        policy=first.policy,
        policy_seed=first.policy_seed,
        parameters=first.parameters,
        knows=first.knows,
        rank=rank,
        episodes=len(episodes),
        solved=len(solved),
        errors=sum(episode.policy_failed for episode in episodes),
        success_low=low,
        success_high=high,
        score=_mean_score(episodes),
        reward=fmean(episode.reward for episode in episodes),
        time_s=_mean(episode.time_s for episode in solved),
        time_or_limit_s=fmean(
            episode.time_s if episode.success else episode.time_limit_s for episode in episodes
        ),
        energy_j=_mean(episode.energy_j for episode in solved),
        path_length_m=_mean(episode.path_length_m for episode in solved),
        cost=_mean(episode.cost for episode in solved),
        min_clearance_m=_mean(episode.min_clearance_m for episode in solved),
        evaluations=fmean(episode.evaluations for episode in episodes),
        replans=fmean(episode.replans for episode in episodes),
        gap=_mean(episode.gap for episode in episodes),
        planning_seconds=fmean(episode.planning_seconds for episode in episodes),
    )


def _mean(values: Iterable[float | None]) -> float | None:
    known = [value for value in values if value is not None]
    return fmean(known) if known else None


def _mean_score(episodes: Sequence[EpisodeResult]) -> float:
    return fmean(episode.score for episode in episodes)


def _standing(episodes: Sequence[EpisodeResult]) -> tuple[float, int]:
    return _mean_score(episodes), sum(episode.success for episode in episodes)
