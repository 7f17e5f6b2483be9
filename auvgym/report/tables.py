"""Rows of results as ranked HTML tables, one per environment."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from html import escape
from typing import Any, NamedTuple

Row = Mapping[str, Any]


class Shown(NamedTuple):
    """A cell that shows a text and sorts by a number (NaN: last) or by another text."""

    text: str
    order: float | str


_SHARE = re.compile(r"\s*(\d+(?:\.\d+)?)\s*/\s*(\d+(?:\.\d+)?)\s*")
_UNITS = {"_mps": "m/s", "_m": "m", "_km": "km", "_s": "s", "_h": "h", "_j": "J", "_kj": "kJ"}


def ranked_tables(
    rows: Sequence[Row],
    columns: Sequence[str] | Mapping[str, str] | None,
    rank_by: str,
    ascending: bool,
) -> str:
    """HTML of a table for each environment, in order of appearance, best row first."""
    headings = _headings(rows, columns)
    environments = list(dict.fromkeys(str(row.get("environment", "")) for row in rows))
    return "\n".join(
        _table(
            name,
            ranked([r for r in rows if str(r.get("environment", "")) == name], rank_by, ascending),
            headings,
            rank_by,
        )
        for name in environments
    )


def ranked(rows: Sequence[Row], rank_by: str, ascending: bool = False) -> list[Row]:
    """Rows in order of their value in ``rank_by``; those without one last, ties as given."""

    def place(row: Row) -> tuple[int, float]:
        value = sort_value(row.get(rank_by))
        if not isinstance(value, float) or math.isnan(value):
            return 1, 0.0
        return 0, value if ascending else -value

    return sorted(rows, key=place)


def sort_value(value: Any) -> float | str:
    """What a cell sorts by: a number, the share of an ``"n/N"`` text, NaN for nothing, or text."""
    if value is None:
        return math.nan
    if isinstance(value, Shown):
        return value.order
    if isinstance(value, str):
        share = _SHARE.fullmatch(value)
        if share is None:
            return value
        return float(share[1]) / float(share[2]) if float(share[2]) else math.nan
    try:
        return float(value)
    except (TypeError, ValueError):
        return str(value)


def _headings(
    rows: Sequence[Row], columns: Sequence[str] | Mapping[str, str] | None
) -> dict[str, str]:
    if isinstance(columns, Mapping):
        return dict(columns)
    if columns is None:
        columns = list(dict.fromkeys(key for row in rows for key in row))
    return {key: _heading(key) for key in columns if key != "environment"}


def _heading(key: str) -> str:
    """``travel_time_s`` reads ``travel time (s)``."""
    for suffix, unit in _UNITS.items():
        if key.endswith(suffix) and len(key) > len(suffix):
            return f"{key[: -len(suffix)].replace('_', ' ')} ({unit})"
    return key.replace("_", " ")


def _table(environment: str, rows: Sequence[Row], headings: dict[str, str], rank_by: str) -> str:
    head = ['<th class="rank" scope="col">#</th>']
    for key, heading in headings.items():
        kind = ' class="number"' if any(_is_number(row.get(key)) for row in rows) else ""
        order = ' aria-sort="other"' if key == rank_by else ""
        head.append(f'<th scope="col"{kind}{order}><button>{escape(heading)}</button></th>')
    body = []
    for rank, row in enumerate(rows, start=1):
        cells = [f'<td class="rank">{rank}</td>', *(_cell(row.get(key)) for key in headings)]
        body.append(f"<tr>{''.join(cells)}</tr>")
    return (
        f'<section><h2>{escape(environment)}</h2><div class="scroll"><table class="ranked">'
        f"<thead><tr>{''.join(head)}</tr></thead><tbody>{''.join(body)}</tbody>"
        "</table></div></section>"
    )


def _cell(value: Any) -> str:
    order = sort_value(value)
    if isinstance(value, Shown):
        kind = "" if isinstance(order, str) else ' class="number"'
        return f'<td{kind} data-value="{escape(str(order))}">{escape(value.text)}</td>'
    if isinstance(order, str):
        return f'<td data-value="{escape(order)}">{escape(order)}</td>'
    if isinstance(value, str):  # n/N, with a bar of the share behind it
        share = f' style="--share:{order:.4f}"' if 0.0 <= order <= 1.0 else ""
        return f'<td class="number share" data-value="{order!r}"{share}>{escape(value)}</td>'
    return f'<td class="number" data-value="{order!r}">{_number(value, order)}</td>'


def _is_number(value: Any) -> bool:
    return value is not None and isinstance(sort_value(value), float)


def _number(value: Any, number: float) -> str:
    if not math.isfinite(number):
        return "-"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int):
        return f"{value:,}"
    return f"{number:,.0f}" if abs(number) >= 1e4 else f"{number:.4g}"
