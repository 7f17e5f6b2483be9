"""The report of a board: a folder that works from disk, each episode in a file of its own.

``index.html`` has tables and charts; ``plotly.js`` and ``episodes/N.js`` lie beside it and are read
when they are looked at, so that a board of thousands of episodes opens at once.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from html import escape
from itertools import count
from pathlib import Path
from typing import Any

from auvgym._extras import require
from auvgym.evaluation.board import BoardColumn, BoardRow
from auvgym.evaluation.statistics import Table
from auvgym.evaluation.suite import Stratum, stratum_label
from auvgym.report.charts import pareto_chart, profile_chart
from auvgym.report.page import resource
from auvgym.report.tables import Shown, ranked_tables

# Called with the number of episodes drawn so far, and the number in all.
OnEpisode = Callable[[int, int], None]


def write_board(
    folder: Path,
    title: str,
    introduction: str,
    boards: Mapping[Stratum, Sequence[BoardRow]],
    columns: Mapping[Stratum, Sequence[BoardColumn]],
    tables: Mapping[Stratum, Table],
    watched: Mapping[Stratum, Sequence[str]],
    figures: Iterable[tuple[int, str]],
    on_episode: OnEpisode | None = None,
) -> Path:
    """Write the report.

    Args:
        folder: where; made if it does not exist.
        title: plain text.
        introduction: a paragraph below it; plain text.
        boards: rows by stratum, as of :func:`auvgym.evaluation.board.board`.
        columns: what to show of each stratum.
        tables: the scores behind the profiles.
        watched: what the episodes to watch are called, by stratum; may be empty.
        figures: of these episodes, as of :func:`auvgym.report.page.figure_json`, in any order, each
            with its number: they are counted through from 0 in the order of ``boards``.
        on_episode: called after each is written.

    Returns:
        The path of ``index.html``.

    Raises:
        ImportError: without plotly; says which extra brings it.
    """
    (folder / "episodes").mkdir(parents=True, exist_ok=True)
    for old in (folder / "episodes").glob("*.js"):
        old.unlink()
    plotly_js = require("plotly.offline", "report").get_plotlyjs()
    (folder / "plotly.js").write_text(plotly_js, encoding="utf-8")
    total = sum(map(len, watched.values()))
    for drawn, (number, figure) in enumerate(figures, start=1):
        text = f"auvgymEpisode({number}, {figure});"
        (folder / "episodes" / f"{number}.js").write_text(text, encoding="utf-8")
        if on_episode is not None:
            on_episode(drawn, total)
    sections, numbers = [], count()
    for number, (stratum, rows) in enumerate(boards.items()):
        options = [
            f'<option value="{next(numbers)}">{escape(label)}</option>'
            for label in watched.get(stratum, ())
        ]
        sections.append(_section(number, stratum, rows, columns[stratum], tables, options))
    page = _PAGE.format(
        title=escape(title),
        style=f"{resource('page.css')}\n{resource('board.css')}",
        introduction=escape(introduction),
        notes="".join(
            f"<li><b>{escape(heading)}</b> {escape(note)}</li>"
            for heading, note in dict.fromkeys(
                (one.heading, one.note) for some in columns.values() for one in some if one.note
            )
        ),
        contents="".join(
            f'<a href="#stratum-{number}">{escape(stratum_label(stratum))}</a>'
            for number, stratum in enumerate(boards)
        ),
        sections="\n".join(sections),
        scripts=f"{resource('page.js')}\n{resource('board.js')}",
    )
    path = folder / "index.html"
    path.write_text(page, encoding="utf-8")
    return path


def _section(
    number: int,
    stratum: Stratum,
    rows: Sequence[BoardRow],
    columns: Sequence[BoardColumn],
    tables: Mapping[Stratum, Table],
    options: Sequence[str],
) -> str:
    cells = [
        {
            "environment": stratum_label(stratum),
            **{column.heading: Shown(column.text(row), column.order(row)) for column in columns},
            "score": row.summary.score,
        }
        for row in rows
    ]
    headings = {column.heading: column.heading for column in columns}
    parts = [ranked_tables(cells, headings, "score", ascending=False)]
    charts = {}
    if stratum in tables:
        charts["Performance profile"] = profile_chart(tables[stratum], rows)
    if any(column.heading == "MJ" for column in columns):
        charts["Time, energy, planning"] = pareto_chart(rows)
    parts.append(
        '<div class="charts">'
        + "".join(
            f'<figure><figcaption>{escape(name)}</figcaption><div class="chart"></div>'
            f'<script type="application/json">{_plain(chart)}</script></figure>'
            for name, chart in charts.items()
        )
        + "</div>"
    )
    if options:
        parts.append(
            '<section class="viewer"><label class="choice">Watch <select class="watch">'
            f'<option value="">choose an episode</option>{"".join(options)}</select></label>'
            '<div class="episode" hidden></div></section>'
        )
    return f'<div class="stratum" id="stratum-{number}">{"".join(parts)}</div>'


def _plain(chart: dict[str, Any]) -> str:
    return json.dumps(chart, separators=(",", ":")).replace("<", "\\u003c")


_PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{title}</title>
<style>
{style}
</style>
</head>
<body>
<main>
<h1>{title}</h1>
<p class="introduction">{introduction}</p>
<details><summary>What the columns say</summary><ul>{notes}</ul></details>
<nav>{contents}</nav>
{sections}
</main>
<script src="plotly.js"></script>
<script>
{scripts}
</script>
</body>
</html>
"""
