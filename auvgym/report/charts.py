"""Charts of a board: performance profiles, and time against energy against planning seconds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from auvgym.evaluation.board import BoardRow, policy_label
from auvgym.evaluation.statistics import Table, performance_profile
from auvgym.report import theme

# Colours that differ for colour-blind readers, too (Okabe and Ito 2008), then dashes.
_COLOURS = ("#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#8a7a10")
_DASHES = ("solid", "dash", "dot", "dashdot")
_SLOWEST = 4.0
_POINTS = 120
_AXIS = {"gridcolor": theme.RULE, "zerolinecolor": theme.RULE, "linecolor": theme.RULE}


def profile_chart(table: Table, rows: Sequence[BoardRow]) -> dict[str, Any]:
    """Share of instances solved within a multiple of the straight line's still-water time."""
    slowness = np.geomspace(0.5, _SLOWEST, _POINTS)
    shares = performance_profile(table.scores, np.minimum(1.0 / slowness, 1.0))
    traces = []
    for index, row in enumerate(rows):
        if row.summary.entrant not in table.entrants:
            continue
        share = shares[table.entrants.index(row.summary.entrant)]
        beyond = slowness >= 1.0
        traces.append(
            {
                "type": "scatter",
                "mode": "lines",
                "name": policy_label(row.summary),
                "x": np.round(slowness[beyond], 4).tolist(),
                "y": np.round(share[beyond], 4).tolist(),
                "line": {"shape": "hv", "width": 2, **_look(index)},
            }
        )
    return {
        "data": traces,
        "layout": _layout(
            "times the straight line in still water", "share solved", range=[0, 1.02]
        ),
    }


def pareto_chart(rows: Sequence[BoardRow]) -> dict[str, Any]:
    """Time against energy, planning seconds as colour; ringed: nobody is better in all three.

    Time counts failures as the limit; energy is the mean over the solved.
    """
    shown = [row.summary for row in rows if row.summary.energy_j is not None]
    figures = np.array(
        [[one.time_or_limit_s / 3600, (one.energy_j or 0.0) / 1e6, one.planning_seconds]
         for one in shown]
    ).reshape(-1, 3)  # fmt: skip
    front = pareto_front(figures)
    labels = [policy_label(one) for one in shown]
    notes = [
        f"{label}<br>{hours:.3g} h, {megajoules:.3g} MJ, {seconds:.3g} s planning"
        f"<br>solved {one.solved}/{one.episodes}"
        for label, one, (hours, megajoules, seconds) in zip(labels, shown, figures, strict=True)
    ]
    colour = np.log10(np.maximum(figures[:, 2], 1e-4))
    trace = {
        "type": "scatter",
        "mode": "markers+text",
        "x": np.round(figures[:, 0], 5).tolist(),
        "y": np.round(figures[:, 1], 5).tolist(),
        "text": labels,
        "textposition": "top center",
        "cliponaxis": False,
        "textfont": {"size": 11},
        "hovertext": notes,
        "hoverinfo": "text",
        "marker": {
            "size": [15 if first else 10 for first in front],
            "color": np.round(colour, 3).tolist(),
            "colorscale": "Viridis",
            "line": {"width": [3 if first else 0 for first in front], "color": theme.GOAL},
            "colorbar": {"title": {"text": "plan s"}, "tickvals": [-4, -3, -2, -1, 0, 1, 2],
                         "ticktext": ["≤0.0001", "0.001", "0.01", "0.1", "1", "10", "100"],
                         "thickness": 12},
        },
    }  # fmt: skip
    return {"data": [trace], "layout": _layout("hours, failures as the limit", "MJ, solved")}


def pareto_front(figures: np.ndarray[Any, np.dtype[np.float64]]) -> list[bool]:
    """Which rows of (n, k) figures, the smaller the better, no other row beats."""
    return [
        not any((other <= own).all() and (other < own).any() for other in figures)
        for own in figures
    ]


def _look(index: int) -> dict[str, str]:
    return {
        "color": _COLOURS[index % len(_COLOURS)],
        "dash": _DASHES[index // len(_COLOURS) % len(_DASHES)],
    }


def _layout(across: str, upwards: str, **vertical: Any) -> dict[str, Any]:
    return {
        "xaxis": {"title": {"text": across}, **_AXIS},
        "yaxis": {"title": {"text": upwards}, **_AXIS, **vertical},
        "font": {"family": theme.FONT, "color": theme.INK, "size": 12},
        "paper_bgcolor": "rgba(0,0,0,0)",
        "plot_bgcolor": "rgba(0,0,0,0)",
        "margin": {"l": 56, "r": 10, "t": 12, "b": 48},
        "legend": {"font": {"size": 11}},
        "hovermode": "closest",
    }
