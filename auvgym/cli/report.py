"""``auvgym report``: a results file as pages to look at and tables for papers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from auvgym.cli.console import messages, output

if TYPE_CHECKING:
    from auvgym.evaluation import EpisodeResult
    from auvgym.evaluation.board import BoardRow
    from auvgym.evaluation.suite import Stratum
    from auvgym.report.board_page import Watched


def report(
    results: Annotated[Path, typer.Argument(help="A results.db, or a .parquet of `export`.")],
    out: Annotated[Path, typer.Option(help="The folder to write.")] = Path("report"),
    suite: Annotated[
        str | None, typer.Option(help="Which suite of the file; needed if it holds several.")
    ] = None,
    reference: Annotated[
        str | None,
        typer.Option(help="The policy that others are held to; by default the best of a table."),
    ] = None,
    replays: Annotated[
        int,
        typer.Option(
            help="How many policies of each table, from the top, have their median, best and worst "
            "episode to watch; -1: all. Each takes about a second and a megabyte."
        ),
    ] = 3,
) -> None:
    """Write a board: index.html with tables, charts and episodes, board.md and board.tex.

    The folder holds all it needs and opens from disk, without a network.

    [dim]Example:[/] auvgym report results/demo/results.db --out report --reference lfhh
    """
    from auvgym.evaluation.board import board, columns_of
    from auvgym.evaluation.statistics import score_tables
    from auvgym.report.board_page import write_board
    from auvgym.report.text_tables import latex, markdown

    rows = _rows(results, suite)
    boards = board(rows, reference)
    watched = _watched(rows, boards, replays)
    from auvgym.cli.progress import progress_bar

    with progress_bar(messages()) as bar:
        drawn = bar.add_task("episodes to watch", total=sum(map(len, watched.values())))
        page = write_board(
            out,
            f"auvgym board: {rows[0].suite}",
            _introduction(rows, reference),
            boards,
            {stratum: columns_of(stratum) for stratum in boards},
            {table.stratum: table for table in score_tables(rows)},
            watched,
            lambda done, total: bar.update(drawn, completed=done, total=total),
        )
    for name, write in (("board.md", markdown), ("board.tex", latex)):
        (out / name).write_text(write(boards), encoding="utf-8")
    console = output()
    console.print(f"Page:   {page}", markup=False, soft_wrap=True)
    console.print(f"Tables: {out / 'board.md'}, {out / 'board.tex'}", markup=False, soft_wrap=True)


def _rows(results: Path, suite: str | None) -> list[EpisodeResult]:
    from auvgym.evaluation import Store

    if results.suffix == ".parquet":
        from auvgym.evaluation.export import read_parquet

        rows = read_parquet(results)
    else:
        with Store(results, read_only=True) as store:
            rows = store.results()
    if not rows:
        raise ValueError(f"{results}: holds no episodes")
    suites = sorted({row.suite for row in rows})
    if suite is None and len(suites) > 1:
        raise ValueError(f"{results}: holds {', '.join(suites)}; choose one with --suite")
    if suite is not None and suite not in suites:
        raise ValueError(f"{results}: holds no suite {suite!r}, but {', '.join(suites)}")
    return [row for row in rows if row.suite == (suite or suites[0])]


def _introduction(rows: Sequence[EpisodeResult], reference: str | None) -> str:
    first = rows[0]
    held = f"the policy {reference}" if reference else "the best of each table"
    return (
        f"{len(rows):,} episodes of suite {first.suite}, hash {first.suite_hash}, flown by auvgym "
        f"{first.engine_version}. The reference of the comparisons is {held}. Every figure can be "
        "recomputed from the action logs: auvgym verify."
    )


def _watched(
    rows: Sequence[EpisodeResult], boards: dict[Stratum, list[BoardRow]], replays: int
) -> dict[Stratum, list[Watched]]:
    """Median, best and worst episode of the leading policies of each stratum."""
    from auvgym.evaluation.board import policy_label
    from auvgym.report.board_page import Watched

    flown: dict[Any, list[EpisodeResult]] = {}
    for row in rows:
        if row.steps and row.actions:
            key = row.instance.stratum, (row.policy, row.policy_seed, row.parameters)
            flown.setdefault(key, []).append(row)
    watched: dict[Stratum, list[Watched]] = {}
    for stratum, ranked in boards.items():
        leading = ranked if replays < 0 else ranked[:replays]
        for summary, _ in leading:
            for name, episode in _telling(flown.get((stratum, summary.entrant), [])):
                label = (
                    f"{policy_label(summary)}, {name}: seed {episode.seed}, {episode.outcome} "
                    f"after {episode.time_s / 3600:.2f} h"
                )
                watched.setdefault(stratum, []).append(Watched(label, _figure_of(episode)))
    return watched


def _telling(episodes: list[EpisodeResult]) -> list[tuple[str, EpisodeResult]]:
    """Median, best and worst by score, and among failures by the way still to go; each once."""
    ordered = sorted(episodes, key=lambda one: (-one.score, one.distance_to_goal_m, one.seed))
    if not ordered:
        return []
    chosen = {"median": ordered[len(ordered) // 2], "best": ordered[0], "worst": ordered[-1]}
    found: dict[int, tuple[str, EpisodeResult]] = {}
    for name, episode in chosen.items():
        found.setdefault(id(episode), (name, episode))
    return list(found.values())


def _figure_of(episode: EpisodeResult) -> Callable[[], Any]:
    def figure() -> Any:
        from auvgym import evaluation
        from auvgym.cli.page import episode_figure

        return episode_figure(evaluation.replay(episode), episode)

    return figure
