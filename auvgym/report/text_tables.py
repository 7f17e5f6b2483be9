"""The board as text for papers: Markdown and LaTeX."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from auvgym.evaluation.board import BoardColumn, BoardRow, columns_of
from auvgym.evaluation.suite import Stratum, stratum_label

_LATEX = {
    "\\": r"\textbackslash{}", "{": r"\{", "}": r"\}", "_": r"\_", "%": r"\%", "&": r"\&",
    "#": r"\#", "$": r"\$", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}",
    "·": r"$\cdot$", "<": r"\textless{}", ">": r"\textgreater{}",
}  # fmt: skip
_SIGNS = {"+": "$+$", "-": "$-$", "=": r"$\approx$", "ref": "ref."}


def markdown(boards: Mapping[Stratum, Sequence[BoardRow]]) -> str:
    """A table for each stratum under a heading of its own, of the columns that fit a paper."""
    parts = []
    for stratum, rows in boards.items():
        columns = columns_of(stratum, short=True)
        head = " | ".join(["#", *(column.heading for column in columns)])
        rule = "|".join(["--:", *("---" if not index else "--:" for index in range(len(columns)))])
        body = [
            " | ".join([str(row.summary.rank), *(_cell(column, row) for column in columns)])
            for row in rows
        ]
        lines = [f"| {line} |" for line in (head, *body)]
        lines.insert(1, f"|{rule}|")
        parts.append("\n".join([f"### {stratum_label(stratum)}", "", *lines]))
    return "\n\n".join(parts) + "\n"


def latex(boards: Mapping[Stratum, Sequence[BoardRow]]) -> str:
    r"""A ``tabular`` for each stratum, with the rules of the package booktabs."""
    parts = []
    for stratum, rows in boards.items():
        columns = columns_of(stratum, short=True)
        kinds = "rl" + "r" * (len(columns) - 1)
        head = " & ".join(["\\#", *(_escaped(column.heading) for column in columns)])
        body = [
            " & ".join([str(row.summary.rank), *(_latex_cell(column, row) for column in columns)])
            for row in rows
        ]
        lines = [
            f"% {stratum_label(stratum)}",
            rf"\begin{{tabular}}{{{kinds}}}",
            r"\toprule",
            rf"{head} \\",
            r"\midrule",
            *(rf"{line} \\" for line in body),
            r"\bottomrule",
            r"\end{tabular}",
        ]
        parts.append("\n".join(lines))
    return "\n\n".join(parts) + "\n"


def _cell(column: BoardColumn, row: BoardRow) -> str:
    return column.text(row).replace("|", "\\|")


def _latex_cell(column: BoardColumn, row: BoardRow) -> str:
    text = column.text(row)
    return _SIGNS.get(text, text) if column.heading == "sign" else _escaped(text)


def _escaped(text: str) -> str:
    return "".join(_LATEX.get(letter, letter) for letter in text)
