"""Honest statistics of a board: paired by instance, failures counted, intervals beside each figure.

Every policy of a stratum meets the same instances, so that policies are compared instance by
instance. The figure compared is the score (0 for a failure). Intervals are 95 % percentile
bootstraps that draw instances anew within each stratum (Agarwal et al. 2021, *Deep reinforcement
learning at the edge of the statistical precipice*), the same draw for every policy.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from auvgym._extras import require
from auvgym._names import unknown
from auvgym.evaluation.result import EpisodeResult
from auvgym.evaluation.suite import Instance, Stratum
from auvgym.evaluation.summary import Entrant

Scores = NDArray[np.float64]
OVERALL: Stratum = ("all environments", "", "", "")
RESAMPLES = 2000
LEVEL = 0.05
_Z_TEST, _Z_POWER = 1.959963984540054, 0.8416212335729143  # two-sided 5 %, power 80 %
_PERCENTILES = (2.5, 97.5)


class Estimate(NamedTuple):
    """A figure and the bounds of its 95 % interval."""

    value: float
    low: float
    high: float


class Table(NamedTuple):
    """Scores of a stratum.

    ``scores`` (entrants, instances); ``groups`` (instances,) the stratum of each column by number:
    0 throughout, but for the table of all strata together.
    """

    stratum: Stratum
    entrants: list[Entrant]
    instances: list[Instance]
    scores: Scores
    groups: NDArray[np.int64]


@dataclass(frozen=True)
class Comparison:
    """How one policy stands in one stratum, or over all of them (``OVERALL``).

    Attributes:
        stratum, policy, policy_seed, parameters: which.
        instances: how many instances are compared, see :func:`score_tables`.
        iqm: interquartile mean of the score, the mean of its middle half.
        improvement: probability of a better score than the reference's on an instance, equal ones
            counted half; None for the reference itself.
        p_value: of the Wilcoxon signed-rank test against the reference (Pratt's zeros), by Holm's
            method for the number of policies compared in the stratum; None for the reference.
        sign: ``"+"`` significantly better than the reference, ``"-"`` worse, ``"="`` neither at
            5 %, ``""`` the reference.
        difference: mean score less the reference's.
        detectable: the least true difference of mean scores that so many instances show with a
            probability of 80 % at 5 %; a smaller one may be there and not be seen. None for the
            reference.
        wins: instances on which no policy has a better score, and this one arrives.
        virtual_best_ratio: mean score over that of the virtual best, which picks the best policy
            for each instance.
    """

    stratum: Stratum
    policy: str
    policy_seed: int
    parameters: str
    instances: int
    iqm: Estimate
    improvement: Estimate | None
    p_value: float | None
    sign: str
    difference: float
    detectable: float | None
    wins: int
    virtual_best_ratio: float

    @property
    def entrant(self) -> Entrant:
        """Policy, seed, parameters."""
        return self.policy, self.policy_seed, self.parameters


def score_tables(results: Iterable[EpisodeResult]) -> list[Table]:
    """The scores by stratum, and with several strata the table of all of them last.

    Policies that have flown less than half of what another has flown in a stratum are left out of
    its table; an instance counts if all others have flown it. The last table has the policies that
    stand in every stratum.
    """
    strata: dict[Stratum, dict[Entrant, dict[Instance, float]]] = {}
    for row in results:
        entrant = (row.policy, row.policy_seed, row.parameters)
        stratum = strata.setdefault(row.stratum, {})
        stratum.setdefault(entrant, {})[row.instance] = row.score
    tables = [_table(stratum, entrants) for stratum, entrants in sorted(strata.items())]
    if len(tables) > 1 and (together := _together(tables)):
        tables.append(together)
    return tables


def compare(
    results: Iterable[EpisodeResult],
    reference: str | None = None,
    *,
    resamples: int = RESAMPLES,
    seed: int = 0,
) -> list[Comparison]:
    """Compare the policies of a board, stratum by stratum and over all.

    Args:
        results: episodes of one suite.
        reference: name of the policy that the others are held to; by default the one with the best
            mean score of each stratum.
        resamples: draws of the bootstrap.
        seed: of these draws.

    Returns:
        Each stratum's policies, best IQM first; the whole board last.

    Raises:
        ValueError: the reference has flown nothing, or there is nothing to compare.
        ImportError: without scipy; says which extra brings it.
    """
    return compare_tables(score_tables(results), reference, resamples=resamples, seed=seed)


def compare_tables(
    tables: Sequence[Table],
    reference: str | None = None,
    *,
    resamples: int = RESAMPLES,
    seed: int = 0,
) -> list[Comparison]:
    """:func:`compare`, of the tables that :func:`score_tables` gives."""
    if not tables:
        raise ValueError("there are no episodes to compare")
    names = {entrant[0] for table in tables for entrant in table.entrants}
    if reference is not None and reference not in names:
        raise ValueError(unknown("reference policy", reference, names))
    return [one for table in tables for one in _compare(table, reference, resamples, seed)]


def interquartile_mean(scores: Scores) -> Any:
    """Mean of the middle half along the last axis."""
    return require("scipy.stats", "report").trim_mean(scores, 0.25, axis=-1)


def performance_profile(scores: Scores, thresholds: Scores) -> Scores:
    """Share of instances with a score of at least each threshold: (entrants, thresholds).

    The score is reference time over travel time, so that this is the share solved within
    1 / threshold times the straight line's time in still water.
    """
    reached = scores[:, None, :] >= thresholds[None, :, None]
    return np.asarray(reached.mean(axis=-1), dtype=np.float64)


def _table(stratum: Stratum, entrants: dict[Entrant, dict[Instance, float]]) -> Table:
    most = max(len(flown) for flown in entrants.values())
    order = sorted(one for one, flown in entrants.items() if 2 * len(flown) >= most)
    common = set.intersection(*(set(entrants[one]) for one in order))
    instances = sorted(common, key=lambda one: one.seed)
    scores = np.array([[entrants[one][instance] for instance in instances] for one in order])
    groups = np.zeros(len(instances), dtype=np.int64)
    return Table(stratum, order, instances, scores.reshape(len(order), len(instances)), groups)


def _together(tables: Sequence[Table]) -> Table | None:
    entrants = sorted(set.intersection(*(set(table.entrants) for table in tables)))
    if not entrants:
        return None
    scores = np.concatenate(
        [table.scores[[table.entrants.index(one) for one in entrants]] for table in tables], axis=1
    )
    groups = np.repeat(np.arange(len(tables)), [len(table.instances) for table in tables])
    instances = [instance for table in tables for instance in table.instances]
    return Table(OVERALL, entrants, instances, scores, groups)


def _compare(table: Table, reference: str | None, resamples: int, seed: int) -> list[Comparison]:
    scores, count = table.scores, len(table.instances)
    if count == 0:
        return []
    means = scores.mean(axis=1)
    candidates = [index for index, one in enumerate(table.entrants) if one[0] == reference]
    # A stratum that the chosen reference has not flown is held to its own best.
    held_to = max(candidates or range(len(means)), key=lambda index: (means[index], -index))
    best = scores.max(axis=0)
    draws = _draws(table.groups, resamples, seed)
    tests = [_wilcoxon(one - scores[held_to]) for one in scores]
    p_values = _holm([test.p_value for test in tests], held_to)
    found = []
    for index, (policy, policy_seed, parameters) in enumerate(table.entrants):
        own, difference = scores[index], scores[index] - scores[held_to]
        better = np.where(difference > 0.0, 1.0, np.where(difference < 0.0, 0.0, 0.5))
        itself = index == held_to
        p_value = p_values[index]
        spread = float(difference.std(ddof=1)) if count > 1 else float("nan")
        found.append(
            Comparison(
                stratum=table.stratum,
                policy=policy,
                policy_seed=policy_seed,
                parameters=parameters,
                instances=count,
                iqm=_estimate_iqm(own, draws),
                improvement=None if itself else _estimate_mean(better, draws),
                p_value=None if itself else p_value,
                sign="" if itself else _sign(p_value, tests[index].direction),
                difference=float(difference.mean()),
                detectable=None if itself else (_Z_TEST + _Z_POWER) * spread / count**0.5,
                wins=int(((own >= best) & (own > 0.0)).sum()),
                virtual_best_ratio=float(own.mean() / best.mean()) if best.any() else 0.0,
            )
        )
    return sorted(found, key=lambda one: -one.iqm.value)


def _draws(groups: NDArray[np.int64], resamples: int, seed: int) -> Scores:
    """How often each draw has each instance, (instances, resamples).

    Within each group as many are drawn as it has, with replacement.
    """
    random = np.random.default_rng(seed)
    count = len(groups)
    drawn = []
    for group in np.unique(groups):
        members = np.flatnonzero(groups == group)
        drawn.append(members[random.integers(0, len(members), (resamples, len(members)))])
    places = np.concatenate(drawn, axis=1) + count * np.arange(resamples)[:, None]
    counts = np.bincount(places.ravel(), minlength=resamples * count)
    return np.ascontiguousarray(counts.reshape(resamples, count).T, dtype=np.float64)


def _estimate_iqm(values: Scores, draws: Scores) -> Estimate:
    """The interquartile mean of each draw, from its counts in the order of the values."""
    order = np.argsort(values, kind="stable")
    ranked, cut = values[order], len(values) // 4
    half = len(values) - 2 * cut
    # How many of the middle half are better than each value but the last: a step up for each.
    better = draws[order]
    np.cumsum(better, axis=0, out=better)
    np.clip(len(values) - cut - better[:-1], 0.0, half, out=better[:-1])
    drawn = ranked[0] + np.diff(ranked) @ better[:-1] / half
    return _estimate(float(interquartile_mean(values)), drawn)


def _estimate_mean(values: Scores, draws: Scores) -> Estimate:
    return _estimate(float(values.mean()), values @ draws / len(values))


def _estimate(value: float, drawn: Scores) -> Estimate:
    low, high = np.percentile(drawn, _PERCENTILES)
    return Estimate(value, float(low), float(high))


class _Test(NamedTuple):
    p_value: float
    direction: float


def _wilcoxon(difference: Scores) -> _Test:
    """The signed-rank test, and which side has the higher ranks."""
    if not difference.any():
        return _Test(1.0, 0.0)
    stats = require("scipy.stats", "report")
    ranks = stats.rankdata(np.abs(difference))
    p_value = float(stats.wilcoxon(difference, zero_method="pratt").pvalue)
    return _Test(p_value, float((np.sign(difference) * ranks).sum()))


def _holm(p_values: Sequence[float], held_to: int) -> list[float]:
    """Holm's correction over all but the reference."""
    others = sorted((p, index) for index, p in enumerate(p_values) if index != held_to)
    corrected, least = list(p_values), 0.0
    for rank, (p, index) in enumerate(others):
        least = max(least, min(1.0, p * (len(others) - rank)))
        corrected[index] = least
    return corrected


def _sign(p_value: float, direction: float) -> str:
    if p_value >= LEVEL:
        return "="
    return "+" if direction > 0.0 else "-"
