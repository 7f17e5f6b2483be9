"""``auvgym report``: a results file as pages to look at and tables for papers."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from auvgym.cli.console import messages, output

if TYPE_CHECKING:
    from auvgym.evaluation import EpisodeResult
    from auvgym.evaluation.board import BoardRow
    from auvgym.evaluation.suite import Stratum


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
            "episode to watch; -1: all. Each takes about 0.2 seconds and 0.7 megabytes."
        ),
    ] = 2,
    workers: Annotated[int, typer.Option(min=1, help="Processes to draw episodes in.")] = 1,
) -> None:
    """Write a board: index.html with tables, charts and episodes, board.md and board.tex.

    The folder holds all it needs and opens from disk, without a network.

    [dim]Example:[/] auvgym report results/demo/results.db --out report --reference lfhh --workers 2
    """
    from auvgym.evaluation.board import board, columns_of
    from auvgym.evaluation.statistics import score_tables
    from auvgym.report.board_page import write_board
    from auvgym.report.text_tables import latex, markdown

    rows = _rows(results, suite)
    tables = score_tables(rows)
    boards = board(rows, reference, tables)
    watched = _watched(rows, boards, replays)
    labels = {stratum: [label for label, _ in shown] for stratum, shown in watched.items()}
    episodes = [episode for stratum in boards for _, episode in watched.get(stratum, ())]
    from auvgym.cli.progress import progress_bar

    with progress_bar(messages()) as bar, closing(_figures(episodes, workers)) as figures:
        drawn = bar.add_task("episodes to watch", total=len(episodes))
        page = write_board(
            out,
            f"auvgym board: {rows[0].suite}",
            _introduction(rows, reference),
            boards,
            {stratum: columns_of(stratum) for stratum in boards},
            {table.stratum: table for table in tables},
            labels,
            figures,
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
) -> dict[Stratum, list[tuple[str, EpisodeResult]]]:
    """Median, best and worst episode of the leading policies of each stratum, and their names."""
    from auvgym.evaluation.board import policy_label

    flown: dict[Any, list[EpisodeResult]] = {}
    for row in rows:
        if row.steps and row.actions:
            key = row.stratum, (row.policy, row.policy_seed, row.parameters)
            flown.setdefault(key, []).append(row)
    watched: dict[Stratum, list[tuple[str, EpisodeResult]]] = {}
    for stratum, ranked in boards.items():
        leading = ranked if replays < 0 else ranked[:replays]
        for summary, _ in leading:
            for name, episode in _telling(flown.get((stratum, summary.entrant), [])):
                label = (
                    f"{policy_label(summary)}, {name}: seed {episode.seed}, {episode.outcome} "
                    f"after {episode.time_s / 3600:.2f} h"
                )
                watched.setdefault(stratum, []).append((label, episode))
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


def _figures(
    episodes: Sequence[EpisodeResult], workers: int
) -> Generator[tuple[int, str], None, None]:
    """The number of each episode, and its figure as JSON, as they are done."""
    from auvgym.evaluation.workers import run_tasks

    numbered = list(enumerate(episodes))
    if workers == 1:
        yield from ((number, _figure(episode)) for number, episode in numbered)
        return
    with closing(run_tasks(_figure_or_error, numbered, workers)) as done:
        for (number, _), figure in done:
            if isinstance(figure, Exception):
                raise figure
            yield number, figure


def _figure_or_error(numbered: tuple[int, EpisodeResult]) -> str | Exception:
    try:
        return _figure(numbered[1])
    except (ValueError, OSError, ImportError) as error:
        return error


def _figure(episode: EpisodeResult) -> str:
    from auvgym import evaluation
    from auvgym.cli.page import episode_drawing
    from auvgym.evaluation.replay import ReplayError
    from auvgym.report.page import figure_json

    try:
        replayed = evaluation.replay(episode)
    except ReplayError as error:
        raise ReplayError(f"{episode.policy} {episode.instance.label}: {error}") from error
    return figure_json(episode_drawing(replayed, episode))
