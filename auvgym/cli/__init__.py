"""The command line ``auvgym``: one file per command, heavy imports only where they are used."""

from __future__ import annotations

from typing import Annotated

import typer

from auvgym.cli.console import FriendlyGroup, print_version
from auvgym.cli.evaluate import evaluate
from auvgym.cli.export import export
from auvgym.cli.leaderboard import leaderboard
from auvgym.cli.listing import list_names
from auvgym.cli.plan import plan
from auvgym.cli.replay import replay
from auvgym.cli.report import report
from auvgym.cli.reproduce import reproduce
from auvgym.cli.suite import suite
from auvgym.cli.train import train
from auvgym.cli.verify import verify

app = typer.Typer(
    name="auvgym",
    cls=FriendlyGroup,
    help="Path planning for underwater vehicles in moving oceans: worlds, planners, evaluation.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
)


@app.callback()
def _root(
    version: Annotated[
        bool,
        typer.Option("--version", help="Print the version and exit.", callback=print_version),
    ] = False,
) -> None:
    """Path planning for underwater vehicles in moving oceans: worlds, planners, evaluation."""


app.command("list")(list_names)
app.command("plan")(plan)
app.command("evaluate")(evaluate)
app.command("train")(train)
app.command("leaderboard")(leaderboard)
app.command("replay")(replay)
app.command("reproduce")(reproduce)
app.command("suite")(suite)
app.command("verify")(verify)
app.command("report")(report)
app.command("export")(export)


def main() -> None:
    """Entry point of the console script."""
    app()
