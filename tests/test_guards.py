"""What keeps the board honest: canaries score nothing, and reward and score say the same."""

from __future__ import annotations

from functools import lru_cache
from itertools import combinations
from statistics import fmean

import pytest

from auvgym.evaluation import EpisodeResult, Instance, PolicySpec, Store, Suite, run

ENVIRONMENTS = ["AUVDynamic2D-v0", "AUVDynamic3D-v0", "AUVStatic3D-v0", "AUVThreat3D-v0",
                "AUVHarbor2D-v0"]  # fmt: skip
CANARIES = ["hold", "random", "canaries:Spin", "canaries:HugTheWall"]
# They know nothing, and arrive where nothing happens to be in the way.
BLIND = ["straight", "lane"]
REFERENCES = ["sonar-rule", "astar-replan"]
SEEDS = range(700, 706)


@lru_cache
def flown(environment: str) -> dict[str, list[EpisodeResult]]:
    suite = Suite("guard", tuple(Instance(environment, seed) for seed in SEEDS))
    specs = [PolicySpec(name) for name in [*CANARIES, *BLIND, *REFERENCES]]
    with Store(None) as store:
        results = run(suite, specs, store)
    found: dict[str, list[EpisodeResult]] = {}
    for row in results:
        assert not row.policy_failed, row.error
        found.setdefault(row.policy, []).append(row)
    return found


def score(rows: list[EpisodeResult]) -> float:
    return fmean(row.score for row in rows)


@pytest.mark.parametrize("environment", ENVIRONMENTS)
def test_canaries_score_at_the_floor(environment: str) -> None:
    rows = flown(environment)
    for name in CANARIES:
        assert score(rows[name]) == 0.0, name
        assert all(row.reward < 0.0 for row in rows[name]), name


@pytest.mark.parametrize("environment", ENVIRONMENTS[:3])
def test_the_blind_are_far_below_those_that_see(environment: str) -> None:
    rows = flown(environment)
    best = max(score(rows[name]) for name in REFERENCES)
    for name in BLIND:
        assert score(rows[name]) < 0.5 * best, name


@pytest.mark.parametrize("environment", ENVIRONMENTS)
def test_reward_and_score_rank_policies_alike(environment: str) -> None:
    rows = flown(environment)
    points = [(score(one), fmean(row.reward for row in one)) for one in rows.values()]
    told_apart = [
        (first[0] - second[0]) * (first[1] - second[1]) > 0.0
        for first, second in combinations(points, 2)
        if first[0] != second[0]
    ]
    # Goodman and Kruskal's gamma: a rank correlation that leaves out the floor's ties.
    assert 2.0 * fmean(told_apart) - 1.0 > 0.9
    episodes = [row for one in rows.values() for row in one]
    assert all((row.reward > 0.0) == bool(row.success) for row in episodes)
