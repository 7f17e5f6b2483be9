"""Running a suite from the command line: progress bar, Ctrl-C, tables."""

from __future__ import annotations

import enum
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from auvgym.cli.console import INTERRUPTED, messages, output
from auvgym.cli.progress import progress_bar

if TYPE_CHECKING:
    from auvgym.evaluation import EpisodeResult, PolicySpec, Store, Suite
    from auvgym.evaluation.runner import Flies


# That of auvgym.evaluation.runner, which is imported only where it is used.
STEP_LIMIT_S = 120.0


class Engine(enum.Enum):
    """Where episodes are flown."""

    processes = "processes"
    ray = "ray"


EngineOption = Annotated[
    Engine,
    typer.Option(help="Processes here, or a Ray cluster (RAY_ADDRESS, else one on this machine)."),
]
StepLimitOption = Annotated[
    float, typer.Option(help="Seconds that one call of a policy may take before it loses.")
]


def fly_with_progress(
    suite: Suite,
    specs: Sequence[PolicySpec],
    store: Store,
    workers: int,
    engine: Literal["processes", "ray"] = "processes",
    step_limit_s: float = STEP_LIMIT_S,
    flies: Flies | None = None,
) -> list[EpisodeResult]:
    """Run ``suite``; on Ctrl-C say what is kept and how to go on, and exit with 130."""
    from auvgym import evaluation
    from auvgym.evaluation.store import key

    console = messages()
    bar = progress_bar(console)
    wanted = [
        key(suite, spec, one)
        for spec in specs
        for one in suite.instances
        if flies is None or flies(spec, one)
    ]
    total = len(wanted)

    def kept() -> int:
        return len(store.finished(suite).intersection(wanted))

    with bar:
        # What an earlier run left is no measure of this one's speed: it is there from the start.
        progress = bar.add_task(suite.name, total=total, completed=kept())

        def on_episode(result: EpisodeResult, done: int, total: int) -> None:
            bar.update(progress, completed=done)

        try:
            return evaluation.run(
                suite, specs, store, workers, on_episode, engine, step_limit_s, flies
            )
        except KeyboardInterrupt:
            bar.stop()
            text = (
                "Stopped. Nothing is kept without --out."
                if store.path is None
                else f"Stopped. {kept()} of {total} episodes are kept in {store.path}; "
                "the same command goes on from there."
            )
            console.print(text, style="yellow", markup=False, soft_wrap=True)
            raise typer.Exit(INTERRUPTED) from None


def show(results: Sequence[EpisodeResult]) -> None:
    """Print the ranked tables, and the first error of each policy that had one."""
    from auvgym import evaluation
    from auvgym.cli.tables import explanation, fitting_columns, ranked_tables

    console = output()
    summaries = evaluation.summarise(results)
    columns = fitting_columns(summaries, console.width)
    for table in ranked_tables(summaries, columns):
        console.print(table)
        console.print()
    console.print(explanation(columns), style="dim")
    failed = {result.policy: result for result in reversed(results) if result.policy_failed}
    for policy, result in sorted(failed.items()):
        text = f"{policy}: {result.outcome} in {result.instance.label}: {result.error}"
        messages().print(text, style="yellow", markup=False, soft_wrap=True)
