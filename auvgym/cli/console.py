"""What every command shares: where it prints, and how it says that something is wrong."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any

import typer
from typer.core import TyperGroup

if TYPE_CHECKING:
    from rich.console import Console

INTERRUPTED = 130  # the shell's code for a command ended by Ctrl-C
MISTAKE = 2
# What bad input raises here: every auvgym error is a ValueError, a file's is an OSError, and a
# library that is not installed an ImportError. Anything else is a bug and shows its traceback.
_MISTAKES = (ValueError, OSError, ImportError)


def output() -> Console:
    """The console for results; made on each call, so that a test's capture is honoured."""
    from rich.console import Console

    return Console(highlight=False)


def messages() -> Console:
    """The console for errors and progress: standard error."""
    from rich.console import Console

    return Console(stderr=True, highlight=False)


class FriendlyGroup(TyperGroup):
    """Commands whose mistakes end in one red line and exit code 2, never in a traceback."""

    def invoke(self, ctx: Any) -> Any:
        """Run the chosen command."""
        try:
            return super().invoke(ctx)
        except _MISTAKES as error:
            if os.environ.get("AUVGYM_TRACEBACK"):
                raise
            fail(str(error))
        except KeyboardInterrupt:
            messages().print("Stopped.", style="yellow")
            raise typer.Exit(INTERRUPTED) from None


def fail(text: str) -> None:
    """Print one red line and exit with code 2."""
    messages().print(f"Error: {text}", style="red", markup=False, soft_wrap=True)
    raise typer.Exit(MISTAKE)


def print_version(wanted: bool) -> None:
    """Callback of ``--version``."""
    if wanted:
        import auvgym

        typer.echo(f"auvgym {auvgym.__version__}")
        raise typer.Exit


def parse_settings(settings: list[str] | None, option: str = "--set") -> dict[str, Any]:
    """``["window=10", "cost=time"]`` as ``{"window": 10, "cost": "time"}``: JSON, else text."""
    parsed: dict[str, Any] = {}
    for setting in settings or []:
        key, equals, value = setting.partition("=")
        if not equals or not key.isidentifier():
            text = f'{option} "{setting}": it is written key=value, e.g. {option} window=10'
            raise ValueError(text)
        try:
            parsed[key] = json.loads(value)
        except json.JSONDecodeError:
            parsed[key] = value
    return parsed
