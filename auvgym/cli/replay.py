"""``auvgym replay``: fly a stored episode again, hold it to its row, and look at it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from auvgym.cli.console import output

if TYPE_CHECKING:
    from auvgym.evaluation import EpisodeResult, Replay

_LISTED = 8


def replay(
    results: Annotated[Path, typer.Argument(help="A results.db.")],
    policy: Annotated[str | None, typer.Option(help="Only this policy.")] = None,
    environment: Annotated[str | None, typer.Option("--env", help="Only this environment.")] = None,
    difficulty: Annotated[str | None, typer.Option(help="Only this difficulty.")] = None,
    seed: Annotated[int | None, typer.Option(help="Only this seed.")] = None,
    out: Annotated[
        Path | None, typer.Option(help="Write an interactive view to this HTML file.")
    ] = None,
    window: Annotated[bool, typer.Option("--window", help="Show it in a window.")] = False,
) -> None:
    """Fly a stored episode again from its action log and check every figure against its row.

    [dim]Example:[/] auvgym replay results/demo/results.db --policy lfhh --seed 9001
    --env AUVDynamic3D-v0 --out episode.html
    """
    from auvgym import evaluation

    if not results.is_file():
        raise FileNotFoundError(f"{results}: there is no such file")
    with evaluation.Store(results) as store:
        stored = store.results()
    wanted = {
        "policy": policy, "environment": environment, "difficulty": difficulty, "seed": seed,
    }  # fmt: skip
    row = _choose(stored, {key: value for key, value in wanted.items() if value is not None})
    if out is not None:
        from auvgym.cli.page import write_episode_page

        found = write_episode_page(row, out)
    elif window:
        found = _in_window(row)
    else:
        found = evaluation.replay(row)
    console = output()
    console.print(f"{_describe(row)}: {row.outcome} after {row.time_s / 3600:.2f} h", markup=False)
    for difference in found.differences:
        console.print(f"differs: {difference}", style="red", markup=False, soft_wrap=True)
    if found.differences:
        raise typer.Exit(1)
    console.print("Every figure is as stored.", style="green")
    if out is not None:
        console.print(f"View: {out}", soft_wrap=True)


def _choose(stored: list[EpisodeResult], wanted: dict[str, object]) -> EpisodeResult:
    matching = [
        row for row in stored if all(getattr(row, key) == value for key, value in wanted.items())
    ]
    if len(matching) == 1:
        return matching[0]
    if not matching:
        asked = ", ".join(f"{key} {value}" for key, value in wanted.items()) or "any"
        raise ValueError(f"none of the {len(stored)} stored episodes matches: {asked}")
    shown = "; ".join(_describe(row) for row in matching[:_LISTED])
    more = f"; and {len(matching) - _LISTED} more" if len(matching) > _LISTED else ""
    raise ValueError(
        f"{len(matching)} stored episodes match; choose one with --policy, --env, --difficulty "
        f"and --seed: {shown}{more}"
    )


def _describe(row: EpisodeResult) -> str:
    return f"{row.policy} {row.instance.label}"


def _in_window(row: EpisodeResult) -> Replay:
    from auvgym import evaluation
    from auvgym.evaluation.flight import make_environment

    env = make_environment(row.instance, render_mode="human")
    try:
        return evaluation.replay(row, env=env)
    finally:
        env.close()
