"""``auvgym verify``: hold a results file to its action logs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from auvgym.cli.console import messages, output

_LISTED = 20


def verify(
    results: Annotated[Path, typer.Argument(help="A results.db, anybody's.")],
    workers: Annotated[int, typer.Option(help="Processes to fly in.")] = 1,
    refly: Annotated[
        int,
        typer.Option(
            help="Have so many episodes of auvgym's own policies flown again by the policy, too."
        ),
    ] = 0,
) -> None:
    """Replay every action log and recompute every figure; no policy's code is run.

    Exit code 0: every figure is as stored. 1: what differs is named. 2: not a results file.

    [dim]Example:[/] auvgym verify results/demo/results.db --workers 2
    """
    from auvgym.cli.progress import progress_bar
    from auvgym.evaluation import verify as verify_file

    with progress_bar(messages()) as bar:
        replayed = bar.add_task("replayed", total=None)
        found = verify_file(
            results,
            workers,
            refly,
            lambda done, total: bar.update(replayed, completed=done, total=total),
        )
    console = output()
    for note in found.notes:
        console.print(f"note: {note}", style="yellow", markup=False, soft_wrap=True)
    for difference in found.differences[:_LISTED]:
        console.print(f"differs: {difference}", style="red", markup=False, soft_wrap=True)
    hidden = len(found.differences) - _LISTED
    if hidden > 0:
        console.print(f"and {hidden} more", style="red")
    if found.differences:
        console.print(f"{found.rows} episodes, {len(found.differences)} differences.", style="bold")
        raise typer.Exit(1)
    again = f", {found.reflown} flown again by their policy" if refly else ""
    console.print(
        f"{found.rows} episodes replayed{again}: every figure is as stored.", style="green"
    )
