"""Reproduction cards: they say what the papers say, keep every run, and print both side by side."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import pytest
from typer.testing import CliRunner

import auvgym
from auvgym import reproduction
from auvgym.cli import app
from auvgym.reproduction import Card, Journal, Outcome, Run, load_card, run_card
from auvgym.reproduction.card import Case, Column, Sweep, swept
from auvgym.reproduction.cells import Cell, cells, sign
from auvgym.reproduction.page import markdown
from auvgym.reproduction.runs import CURVE_POINTS, checkpoints, execute

QUICK = {"cost": "afhh", "max_evaluations": 600, "stop": "exhaust", "population": 20}
CARD = Card(
    name="quick-card",
    title="A quick card",
    source="Nobody 2026, Table 0",
    view="costs",
    protocol="plan",
    columns=(Column("first", "rwde"), Column("second", "pso")),
    cases=(Case("case", "afhh-1", 0, mean=(0.5, 3.0), deviation=(0.1, 0.2), seconds=(1.0, 2.0)),),
    parameters=QUICK,
    why="Because.",
)


@pytest.mark.parametrize(
    "name", [name for name in reproduction.list_cards() if not name.startswith(("iifds", "rmpso"))]
)
def test_a_card_is_whole(name: str) -> None:
    card = load_card(name)
    for column in card.columns:
        assert column.planner in auvgym.list_planners()
    for case in card.cases:
        scenario = auvgym.World(case.scenario, mission=case.mission).scenario
        for figures in (case.mean, case.deviation, case.seconds, case.sign):
            assert len(figures) in (0, len(card.columns)), case.label
        # The label names start and target as the paper does: x, y and, in 3-D, the height.
        unit = 1000.0 if case.scenario.startswith("lfhh") else 1.0
        mission = scenario.to_dict()["missions"][case.mission]
        ends = case.label.partition("S ")[2].split(" T ")
        for text, end in zip(ends, (mission["start_m"], mission["goal_m"]), strict=True):
            wanted = [unit * float(number) for number in text.split(",")]
            found = [*end[:2], 20.0 * unit - end[2]][: len(wanted)]
            assert found == pytest.approx(wanted), case.label
    assert len(card.runs(2)) == 2 * len(card.runs(1)) > 0


@pytest.mark.parametrize(
    "name", [name for name in reproduction.list_cards() if name.startswith("rmpso")]
)
def test_a_harbours_card_is_whole(name: str, tmp_path: Path) -> None:
    card = load_card(name)
    assert (card.view, card.protocol, card.journal) == ("distributions", "harbor", "rmpso")
    for case in card.cases:
        for figures in case.paper.values():
            assert len(figures) == len(card.columns)
    outcomes = {}
    for run in set(card.runs(2)):
        done = execute(run)
        assert isinstance(done, Outcome), f"{run}: {done}"
        assert set(card.measures) <= set(done.measures)
        # Nothing that keeps out of the zones is shorter than the exact answer.
        if done.measures["inside_m"] == 0.0 and done.feasible and name != "rmpso-table3":
            assert done.measures["gap_percent"] > -1e-6
        outcomes[run] = done
    page = reproduction.write_card(card, outcomes, 2, tmp_path).read_text(encoding="utf-8")
    for word in ("mean ± sd", "median", "95 %", "## Why", f"({name}-maps.png)"):
        assert word in page
    assert (tmp_path / f"{name}-maps.png").stat().st_size > 20_000


def test_the_raster_of_table_3_is_the_papers_length() -> None:
    card = load_card("rmpso-table3")
    done = execute(card.run(card.cases[0], card.columns[0], 0))
    assert isinstance(done, Outcome)
    assert done.measures["length_m"] == pytest.approx(23 * math.sqrt(2) + 18)


def test_cards_of_one_paper_share_their_runs() -> None:
    table, times = load_card("afhh-table1"), load_card("afhh-table2")
    assert table.journal == times.journal == "afhh"
    assert set(times.runs(3)) < set(table.runs(3))
    lfhh = load_card("lfhh-table2")
    assert len(set(lfhh.runs(1)) & set(load_card("lfhh-table4").runs(1))) == 3


def test_runs_are_kept_and_gone_on_with(tmp_path: Path) -> None:
    path = tmp_path / "runs" / "quick.jsonl"
    told: list[tuple[int, int]] = []
    run_card(CARD, Journal(path), seeds=1, progress=lambda done, total: told.append((done, total)))
    assert told == [(0, 2), (1, 2), (2, 2)]
    first = path.read_text(encoding="utf-8")
    # A process that died while it wrote leaves half a line.
    path.write_text(first + '{"version": "0.', encoding="utf-8")
    journal = Journal(path)
    assert path.read_text(encoding="utf-8") == first
    told.clear()
    run_card(CARD, journal, seeds=2, workers=2, progress=lambda *both: told.append(both))
    assert told[0] == (2, 4)
    assert told[-1] == (4, 4)
    again = Journal(path).outcomes
    assert again == journal.outcomes
    for run, outcome in again.items():
        repeated = execute(run)
        assert isinstance(repeated, Outcome)
        assert dataclasses.replace(repeated, seconds=outcome.seconds) == outcome


def test_a_foreign_journal_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "quick.jsonl"
    path.write_text("{}\n", encoding="utf-8")
    with pytest.raises(reproduction.JournalError, match="line 1: is no run"):
        Journal(path)
    run_card(CARD, Journal(tmp_path / "other.jsonl"), seeds=1)
    text = (tmp_path / "other.jsonl").read_text(encoding="utf-8")
    path.write_text(text.replace(f'"version":"{auvgym.__version__}"', '"version":"0.0.0"'))
    with pytest.raises(reproduction.JournalError, match=r"a run of auvgym 0\.0\.0"):
        Journal(path)


def test_a_run_that_fails_is_named_and_the_others_are_kept(tmp_path: Path) -> None:
    wrong = dataclasses.replace(CARD.columns[1], parameters={"bees": 3})
    card = dataclasses.replace(CARD, columns=(CARD.columns[0], wrong))
    journal = Journal(tmp_path / "quick.jsonl")
    with pytest.raises(reproduction.RunError, match=r"planner='pso'.*unknown field `bees`"):
        run_card(card, journal, seeds=1)
    assert len(Journal(tmp_path / "quick.jsonl").outcomes) == 1


JOURNALS = Path(__file__).parents[1] / "baselines" / "reproduction" / "runs"


@pytest.mark.parametrize("name", sorted(path.stem for path in JOURNALS.glob("*.jsonl")))
def test_runs_in_the_repository_come_out_again(name: str) -> None:
    """The quickest run of each planner: what the cards print is what this engine does."""
    outcomes = Journal(JOURNALS / f"{name}.jsonl").outcomes
    quickest: dict[str, Run] = {}
    for run, outcome in sorted(outcomes.items(), key=lambda item: item[1].seconds):
        if outcome.evaluations <= 100_000 or name == "afhh":
            quickest.setdefault(run.planner, run)
    for planner in [*quickest][:3] if name == "afhh" else quickest:
        again = execute(quickest[planner])
        assert isinstance(again, Outcome)
        kept = outcomes[quickest[planner]]
        timed = {name: kept.measures[name] for name in ("step_us",) if name in kept.measures}
        again = dataclasses.replace(
            again, seconds=kept.seconds, measures={**again.measures, **timed}
        )
        assert again == kept, planner


def outcome(cost: float) -> Outcome:
    return Outcome(cost, cost < 2.0, 100, 0.5, (cost,) * CURVE_POINTS)


def made_up(card: Card, first: list[float], second: list[float]) -> dict[Run, Outcome]:
    return {
        card.run(card.cases[0], column, seed): outcome(cost)
        for column, costs in zip(card.columns, (first, second), strict=True)
        for seed, cost in enumerate(costs)
    }


def test_a_cell_is_mean_deviation_and_rank_sum_sign() -> None:
    first, second = [0.4, 0.5, 0.6, 0.5, 0.4], [2.5, 2.6, 1.9, 2.5, 2.6]
    ((left, right),) = cells(CARD, CARD.columns, made_up(CARD, first, second), 5)
    assert left.mean == pytest.approx(0.48)
    assert left.deviation == pytest.approx(math.sqrt(0.028 / 4))
    assert (left.feasible, right.feasible) == (5, 1)
    assert sign(left, right) == "+"
    assert sign(right, left) == "-"
    assert sign(left, left) == "="
    assert Cell(left.case, left.column, left.outcomes[:1]).deviation == 0.0


def test_a_page_has_paper_and_ours_and_says_where_they_differ() -> None:
    good, bad = [0.4, 0.5, 0.6, 0.5, 0.4], [2.5, 2.6, 2.4, 2.5, 2.6]
    page = markdown(CARD, made_up(CARD, good, bad), 5, ["quick-card.png"])
    assert "| case | paper | 0.5 (0.1) | 3 (0.2) |" in page
    assert "|  | ours | 0.480 (0.084) 5/5 | 2.520 (0.084) + 0/5 |" in page
    assert "first costs less on average than second in 1 of 1 cases, as in the paper." in page
    assert "| case | paper | 1 (1.00) | 2 (2.00) |" in page
    assert page.rstrip().endswith("Because.")
    page = markdown(CARD, made_up(CARD, bad, good), 5, [])
    assert "in 0 of 1 cases, **otherwise than in the paper** (1)." in page


def test_every_view_is_drawn(tmp_path: Path) -> None:
    outcomes = made_up(CARD, [0.4, 0.5], [2.5, 2.6])
    for view in ("costs", "seconds", "curves"):
        card = dataclasses.replace(CARD, name=f"quick-{view}", view=view)
        path = reproduction.write_card(card, outcomes, 2, tmp_path)
        assert (tmp_path / f"quick-{view}.png").stat().st_size > 5000
        assert f"(quick-{view}.png)" in path.read_text(encoding="utf-8")
    sweeps = (
        Sweep("Factor", {"factor": [0.1, 0.5]}),
        Sweep("Both", {"factor": [0.1, 0.5], "crossover": [0.2, 0.3, 0.4]}),
    )
    card = dataclasses.replace(CARD, name="quick-sweeps", view="sweeps", sweeps=sweeps)
    columns = [column for sweep in sweeps for column in swept(card, sweep)]
    assert [column.parameters for column in columns][3] == {"factor": 0.1, "crossover": 0.3}
    outcomes |= {card.run(card.cases[0], column, 0): outcome(1.5) for column in columns}
    text = reproduction.write_card(card, outcomes, 1, tmp_path).read_text(encoding="utf-8")
    assert "| factor | 0.1 | 0.5 |\n| --- | --- | --- |\n| cost | 1.500 1/1 | 1.500 1/1 |" in text
    assert "| factor / crossover | 0.2 | 0.3 | 0.4 |" in text
    assert (tmp_path / "quick-sweeps.png").stat().st_size > 5000


def test_curves_are_read_at_the_evaluations_that_they_say() -> None:
    run = CARD.run(CARD.cases[0], CARD.columns[0], 0)
    result = execute(run)
    assert isinstance(result, Outcome)
    world = auvgym.World(run.scenario, seed=0, mission=0)
    history = auvgym.plan(world, "rwde", seed=0, **QUICK).history
    for spent, best in zip(checkpoints(600), result.curve, strict=True):
        assert best == pytest.approx(history[history[:, 0] <= spent][-1, 1], rel=1e-3)


def test_the_command_prints_a_card_and_goes_on(tmp_path: Path) -> None:
    command = ["reproduce", "lfhh-table4", "--seeds", "1", "--out", str(tmp_path)]
    done = CliRunner().invoke(app, command)
    assert done.exit_code == 0, done.output
    assert "Components of LFHH in 2-D" in done.output
    journal = (tmp_path / "runs" / "lfhh.jsonl").read_text(encoding="utf-8")
    assert journal.count("\n") == 12
    page = (tmp_path / "lfhh-table4.md").read_text(encoding="utf-8")
    # The order that reproduces: without smoothing nothing is feasible.
    assert "- LFHH costs less on average than without smoothing in 3 of 3 cases" in page
    again = CliRunner().invoke(app, command)
    assert again.exit_code == 0
    assert (tmp_path / "runs" / "lfhh.jsonl").read_text(encoding="utf-8") == journal


def test_an_unknown_card_lists_the_known_ones() -> None:
    with pytest.raises(reproduction.CardError, match=r"did you mean 'lfhh-table\d'"):
        load_card("lfhh-table")
