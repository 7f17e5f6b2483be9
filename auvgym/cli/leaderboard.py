"""``auvgym leaderboard``: every policy meets the same instances, ranked."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from auvgym.cli.console import messages, output
from auvgym.cli.flying import STEP_LIMIT_S, Engine, EngineOption, StepLimitOption

if TYPE_CHECKING:
    from auvgym.evaluation import EpisodeResult, Suite


def leaderboard(
    suite: Annotated[
        str, typer.Option(help="A shipped suite (`auvgym list suites`) or a TOML file.")
    ] = "demo",
    policies: Annotated[
        str | None,
        typer.Option(help="Names, comma-separated, or all; by default the suite's own choice."),
    ] = None,
    workers: Annotated[int, typer.Option(help="Processes to fly in.")] = 1,
    engine: EngineOption = Engine.processes,
    step_limit: StepLimitOption = STEP_LIMIT_S,
    out: Annotated[
        Path | None,
        typer.Option(help="Folder of results.db and leaderboard.html (default: results/SUITE)."),
    ] = None,
    fresh: Annotated[
        bool, typer.Option("--fresh", help="Forget the suite's stored episodes first.")
    ] = False,
) -> None:
    """Rank policies on a suite; stop it at any time, the same command goes on.

    [dim]Example:[/] auvgym leaderboard --suite demo --policies lfhh,straight --workers 2
    """
    from auvgym import evaluation
    from auvgym.cli.flying import fly_with_progress, show

    instances = evaluation.load_suite(suite)
    folder = out if out is not None else Path("results") / instances.name
    specs = [evaluation.PolicySpec(name) for name in _names(policies, instances)]
    with evaluation.Store(folder / "results.db") as store:
        if fresh:
            store.forget(instances)
        # All there is: each where it can fly at all. Who is named flies everywhere.
        flies = evaluation.fitting if policies == "all" else None
        results = fly_with_progress(
            instances, specs, store, workers, engine.value, step_limit, flies
        )
    show(results)
    output().print(f"Episodes: {folder / 'results.db'}", soft_wrap=True)
    page = _write_page(instances, results, folder / "leaderboard.html")
    output().print(f"Page:     {page}", soft_wrap=True)


def _write_page(suite: Suite, results: list[EpisodeResult], path: Path) -> Path:
    from auvgym.cli.page import write_leaderboard_page

    try:
        return write_leaderboard_page(suite, results, path)
    except ImportError as error:
        messages().print(f"The page has no episodes to watch: {error}", style="yellow")
        return write_leaderboard_page(suite, results, path, figures=False)


def _names(policies: str | None, suite: Suite) -> list[str]:
    import auvgym
    from auvgym.policies import list_triggers

    if policies is None and suite.policies:
        return list(suite.policies)
    if policies is None or policies == "all":
        return [*auvgym.list_policies(), *list_triggers()]
    names = [name.strip() for name in policies.split(",") if name.strip()]
    if not names:
        raise ValueError("--policies names none; give names, comma-separated, or all")
    return list(dict.fromkeys(names))
