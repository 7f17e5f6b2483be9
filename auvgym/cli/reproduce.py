"""``auvgym reproduce``: a paper's table or figure, run again."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from auvgym.cli.console import INTERRUPTED, messages, output
from auvgym.cli.progress import progress_bar

if TYPE_CHECKING:
    from auvgym.reproduction import Card, Journal


def reproduce(
    name: Annotated[str, typer.Argument(help="A card: `auvgym list cards`.")],
    seeds: Annotated[
        int | None,
        typer.Option(
            min=1,
            help="Seeds of each cell; as many as the paper has unless given, and 1 where nothing "
            "is random.",
        ),
    ] = None,
    workers: Annotated[int, typer.Option(min=1, help="Processes to run in.")] = 1,
    out: Annotated[
        Path, typer.Option(help="Folder of the card, its plot and the journal of its runs.")
    ] = Path("baselines/reproduction"),
    fresh: Annotated[
        bool, typer.Option("--fresh", help="Forget the runs of the whole experiment first.")
    ] = False,
) -> None:
    """Run a paper's table or figure again and print paper and ours side by side.

    Stop it at any time: every run is kept, and the same command goes on. Cards of one paper share
    their runs.

    [dim]Example:[/] auvgym reproduce lfhh-table2 --seeds 5 --workers 2
    """
    from auvgym.reproduction import Journal, load_card, write_card

    card = load_card(name)
    seeds = card.seeds if seeds is None else seeds
    path = out / "runs" / f"{card.journal}.jsonl"
    if fresh:
        path.unlink(missing_ok=True)
    journal = Journal(path)
    _run(card, journal, seeds, workers)
    page = write_card(card, journal.outcomes, seeds, out)
    _print(page)
    output().print(f"Card: {page}", soft_wrap=True)


def _run(card: Card, journal: Journal, seeds: int, workers: int) -> None:
    from auvgym.reproduction import run_card

    bar = progress_bar(messages())
    with bar:
        task = bar.add_task(card.name)
        try:
            run_card(
                card,
                journal,
                seeds,
                workers,
                lambda done, total: bar.update(task, completed=done, total=total),
            )
        except KeyboardInterrupt:
            bar.stop()
            text = f"Stopped. What was run is kept in {journal.path}; the same command goes on."
            messages().print(text, style="yellow", markup=False, soft_wrap=True)
            raise typer.Exit(INTERRUPTED) from None


def _print(page: Path) -> None:
    from rich.markdown import Markdown

    text = page.read_text(encoding="utf-8")
    output().print(Markdown(text))
