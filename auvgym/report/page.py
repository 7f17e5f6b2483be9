"""Whole HTML pages: style, scripts, plotly.js and the figures' data in one file."""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Mapping, Sequence
from html import escape
from importlib.resources import files
from typing import Any

from numpy.typing import NDArray

from auvgym._extras import require
from auvgym.report.tables import Row, ranked_tables

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
{body}
</main>
{scripts}
</body>
</html>
"""


def leaderboard_page(
    rows: Sequence[Row],
    episodes: Mapping[str, Any],
    title: str,
    *,
    columns: Sequence[str] | Mapping[str, str] | None = None,
    rank_by: str = "score",
    ascending: bool = False,
    introduction: str = "",
) -> str:
    """A leaderboard: a ranked table per environment, and below them episodes to watch.

    Args:
        rows: one mapping per policy and environment. ``"environment"`` groups them; all other
            values are shown: numbers to four figures, ``"n/N"`` as a share, None as a dash.
        episodes: label -> figure, as from :func:`auvgym.report.episode_figure`; may be empty.
        title: of the page.
        columns: which keys to show, in order, or key -> heading; by default every key of the
            rows, the unit at its end (``travel_time_s``) in brackets.
        rank_by: the key that ranks the rows of an environment, ties in the order given.
        ascending: the smallest value is the best.
        introduction: a paragraph below the title; plain text.

    Returns:
        A complete HTML document that asks for nothing from a network. All text is escaped.

    Raises:
        ImportError: with episodes but without plotly; says which extra brings it.
    """
    paragraph = f'<p class="introduction">{escape(introduction)}</p>' if introduction else ""
    body = f"{paragraph}\n{ranked_tables(rows, columns, rank_by, ascending)}"
    return _document(title, body, episodes)


def figure_page(figure: Any, title: str) -> str:
    """One figure as a complete HTML document that asks for nothing from a network.

    Args:
        figure: a plotly figure, as from :func:`auvgym.report.plan_figure`.
        title: of the page; escaped.

    Raises:
        ImportError: without plotly; says which extra brings it.
    """
    return _document(title, "", {title: figure})


def _document(title: str, body: str, figures: Mapping[str, Any]) -> str:
    scripts = [f"<script>{resource('page.js')}</script>"]
    if figures:
        body = f"{body}\n{_viewer(list(figures))}"
        plotly_js = require("plotly.offline", "report").get_plotlyjs()
        data = [
            f'<script type="application/json" id="figure-{index}">{figure_json(figure)}</script>'
            for index, figure in enumerate(figures.values())
        ]
        scripts = [f"<script>{plotly_js}</script>", *data, *scripts]
    return _PAGE.format(
        title=escape(title), style=resource("page.css"), body=body, scripts="\n".join(scripts)
    )


def _viewer(labels: Sequence[str]) -> str:
    """The place of the figures, and with several a box to choose from."""
    choice = ""
    if len(labels) > 1:
        options = "".join(
            f'<option value="{index}">{escape(label)}</option>'
            for index, label in enumerate(labels)
        )
        choice = f'<label class="choice">Episode <select id="episode">{options}</select></label>'
    return f'<section class="viewer">{choice}<div id="figure"></div></section>'


def figure_json(figure: Any) -> str:
    """The data of a figure, or of the dict that one is made of, safe inside a script element."""
    shown = figure if isinstance(figure, dict) else figure.to_dict()
    # Templates only repeat plotly's defaults, 7 kB a figure.
    layout = {name: value for name, value in shown["layout"].items() if name != "template"}
    text = json.dumps({**shown, "layout": layout}, separators=(",", ":"), default=_typed_array)
    return text.replace("<", "\\u003c")


def _typed_array(array: NDArray[Any]) -> dict[str, str]:
    """An array as plotly.js reads it without parsing its numbers."""
    packed = {
        "dtype": array.dtype.str.lstrip("<|"),
        "bdata": b64encode(array.tobytes()).decode("ascii"),
    }
    return packed if array.ndim == 1 else {**packed, "shape": ", ".join(map(str, array.shape))}


def resource(name: str) -> str:
    """A style or script that lies beside this file."""
    return files("auvgym.report").joinpath(name).read_text(encoding="utf-8")
