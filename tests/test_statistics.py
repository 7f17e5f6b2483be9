"""Statistics of the board, against closed forms, scipy by another way."""

from __future__ import annotations

import numpy as np
import pytest
from board_rows import row

from auvgym.evaluation import statistics
from auvgym.evaluation.result import EpisodeResult
from auvgym.evaluation.statistics import OVERALL, compare, interquartile_mean, performance_profile

pytest.importorskip("scipy")


def board(**scores: list[float]) -> list[EpisodeResult]:
    return [
        row(policy, seed, score)
        for policy, values in scores.items()
        for seed, score in enumerate(values)
    ]


def drawn(seed: int, count: int = 40) -> list[float]:
    random = np.random.default_rng(seed)
    return [float(one) for one in random.uniform(0.2, 1.0, count) * (random.random(count) < 0.8)]


def test_the_interquartile_mean_is_that_of_the_middle_half() -> None:
    assert interquartile_mean(np.array([0.0, 0.4, 0.6, 9.0])) == pytest.approx(0.5)


def test_intervals_are_scipy_s_within_the_noise_of_drawing() -> None:
    from scipy import stats

    scores = np.array(drawn(3, 120))
    theirs = stats.bootstrap(
        (scores,), interquartile_mean, n_resamples=2000, method="percentile",
        random_state=np.random.default_rng(1),
    ).confidence_interval  # fmt: skip
    (ours,) = compare(board(one=list(scores)))
    assert (ours.iqm.low, ours.iqm.high) == pytest.approx((theirs.low, theirs.high), abs=0.012)


def test_profiles_count_what_reaches_a_threshold() -> None:
    profile = performance_profile(np.array([[0.0, 0.5, 1.0, 0.5]]), np.array([0.1, 0.5, 0.6, 1.0]))
    assert profile.tolist() == [[0.75, 0.75, 0.25, 0.25]]


def test_improvement_wins_and_the_virtual_best_by_hand() -> None:
    found = {one.policy: one for one in compare(
        board(a=[1.0, 0.5, 0.0, 0.8], b=[0.5, 0.5, 0.5, 0.0], c=[0.0] * 4), reference="b"
    )}  # fmt: skip
    assert found["a"].improvement is not None
    assert found["a"].improvement.value == pytest.approx((1 + 0.5 + 0 + 1) / 4)
    assert found["b"].improvement is None
    assert (found["a"].wins, found["b"].wins, found["c"].wins) == (3, 2, 0)
    assert found["a"].virtual_best_ratio == pytest.approx(2.3 / (1.0 + 0.5 + 0.5 + 0.8))
    assert found["c"].virtual_best_ratio == 0.0
    assert found["a"].difference == pytest.approx(2.3 / 4 - 1.5 / 4)
    assert found["c"].iqm.value == 0.0


def test_signs_are_those_of_the_signed_rank_test() -> None:
    from scipy import stats

    base, worse, same = drawn(4), [one * 0.7 for one in drawn(4)], list(drawn(4))
    found = {one.policy: one for one in compare(
        board(base=base, worse=worse, same=same, other=drawn(9)), reference="base"
    )}  # fmt: skip
    assert [found[name].sign for name in ("base", "worse", "same")] == ["", "-", "="]
    assert found["same"].p_value == 1.0
    raw = stats.wilcoxon(np.array(worse) - np.array(base), zero_method="pratt").pvalue
    assert found["worse"].p_value == pytest.approx(min(1.0, 3 * raw))
    (better,) = [one for one in compare(board(base=base, worse=worse), "worse") if one.sign]
    assert (better.policy, better.sign) == ("base", "+")


def test_a_difference_of_the_detectable_size_is_found_four_times_in_five() -> None:
    random = np.random.default_rng(11)
    base = random.uniform(0.4, 0.6, 100)
    noise = random.normal(0.0, 0.1, (300, 100))
    (_, other) = sorted(
        compare(board(a=list(base), b=list(base + noise[0])), "a", resamples=10),
        key=lambda one: one.policy,
    )
    assert other.detectable is not None
    found = []
    for one in noise[1:]:
        shifted = base + one + other.detectable
        test = statistics._wilcoxon(shifted - base)
        found.append(test.p_value < 0.05 and test.direction > 0)
    assert np.mean(found) == pytest.approx(0.8, abs=0.12)


def test_pairing_narrows_what_instances_share() -> None:
    """Two policies that differ by a constant: surely better, however much the instances vary."""
    hard = drawn(5)
    found = compare(board(a=hard, b=[one * 0.99 for one in hard]), reference="b")
    first = next(one for one in found if one.policy == "a")
    assert first.sign == "+"
    assert first.improvement is not None
    assert first.improvement.low > 0.7
    assert first.iqm.low < found[1].iqm.value < first.iqm.high


def test_strata_are_drawn_apart_and_put_together() -> None:
    rows = board(a=[1.0] * 12, b=[0.5] * 12)
    rows += [
        row(policy, seed, 0.2, environment="AUVDynamic3D-v0")
        for policy in ("a", "b")
        for seed in range(12)
    ]
    rows.append(row("visitor", 0, 1.0))
    found = compare(rows, "b", resamples=200)
    overall = {one.policy: one for one in found if one.stratum == OVERALL}
    assert set(overall) == {"a", "b"}
    # Each draw has twelve of each stratum: the middle half of twelve 1.0 and twelve 0.2 is 0.6.
    assert overall["a"].iqm == pytest.approx((0.6, 0.6, 0.6))
    # Who has flown hardly anything is left out, and takes nothing from the others.
    flat = [one for one in found if one.stratum[0] == "AUVDynamic2D-v0"]
    assert [(one.policy, one.instances) for one in flat] == [("a", 12), ("b", 12)]
    assert [one.instances for one in compare([*rows[:10], *rows[12:24]], resamples=50)] == [10, 10]


def test_the_same_rows_give_the_same_figures_in_any_order() -> None:
    rows = board(a=drawn(1), b=drawn(2), c=drawn(3))
    assert compare(rows) == compare(rows[::-1])


def test_nothing_to_compare_is_said() -> None:
    with pytest.raises(ValueError, match="no episodes"):
        compare([])
    with pytest.raises(ValueError, match="did you mean 'straight'"):
        compare([row("straight")], "strait")


@pytest.mark.parametrize("count", [1, 3, 4, 17])
def test_counts_of_a_draw_stand_for_the_draw(count: int) -> None:
    values = np.array(drawn(count, count))
    counts = statistics._draws(np.zeros(count, dtype=np.int64), 50, 2)
    assert (counts.sum(axis=0) == count).all()
    draws = [np.repeat(values, one.astype(int)) for one in counts.T]
    low, high = np.percentile([interquartile_mean(one) for one in draws], [2.5, 97.5])
    found = statistics._estimate_iqm(values, counts)
    assert found == pytest.approx((interquartile_mean(values), low, high))
