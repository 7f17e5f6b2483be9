"""Runs what a card asks for and its journal does not have yet."""

from __future__ import annotations

from collections.abc import Callable

from auvgym.evaluation.workers import ProcessDiedError, run_tasks
from auvgym.reproduction.card import Card
from auvgym.reproduction.journal import Journal
from auvgym.reproduction.runs import execute


class RunError(ValueError):
    """A run that failed; those before it are kept."""


def run_card(
    card: Card,
    journal: Journal,
    seeds: int,
    workers: int = 1,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> None:
    """Run a card; stopped at any time, it goes on from there.

    Args:
        card: the card.
        journal: where outcomes are kept.
        seeds: seeds 0 .. seeds - 1 of every cell.
        workers: processes.
        progress: told how many runs are done, and of how many.

    Raises:
        RunError: a run failed; its text names the run.
    """
    runs = card.runs(seeds)
    waiting = [run for run in dict.fromkeys(runs) if run not in journal.outcomes]
    total = len(set(runs))
    progress(total - len(waiting), total)
    for done, (run, outcome) in enumerate(run_tasks(execute, waiting, workers), 1):
        if isinstance(outcome, str | ProcessDiedError):
            raise RunError(f"{run}: {outcome}")
        journal.add(run, outcome)
        progress(total - len(waiting) + done, total)
