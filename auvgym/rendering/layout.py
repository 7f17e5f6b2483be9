"""Which panel goes where: the chart gets what its shape can use, the others the rest."""

from __future__ import annotations

from dataclasses import dataclass

from auvgym.rendering.axes import Axes, Box, equal_axes
from auvgym.rendering.subjects import Facts

GAP = 12
SMALLEST = (720, 540)


@dataclass(frozen=True)
class Layout:
    """The cards of a frame (chart, panel, strip) and the chart's axes within its card."""

    chart: Box
    panel: Box
    strip: Box
    chart_axes: Axes


def arrange(size: tuple[int, int], facts: Facts) -> Layout:
    """Lay a frame of ``size`` out for a world: whichever arrangement shows a larger map."""
    return max(_tall(size, facts), _wide(size, facts), key=lambda layout: _area(layout.chart_axes))


def _area(axes: Axes) -> float:
    return axes.box.width * axes.box.height


def _chart_axes(card: Box, facts: Facts) -> Axes:
    return equal_axes(card.inset(58, 34, 74, 46), facts.minimum, facts.maximum)


def _tall(size: tuple[int, int], facts: Facts) -> Layout:
    """The chart on the left over the full height; panel above strip on the right."""
    width, height = size
    full = Box(GAP, GAP, 0.6 * width, height - 2 * GAP)
    axes = _chart_axes(full, facts)
    # The card closes round a narrow chart, and what it leaves goes to the panels.
    card = Box(GAP, GAP, min(full.width, axes.box.width + 132), full.height)
    rest = Box(card.right + GAP, GAP, width - card.right - 2 * GAP, full.height)
    panel = Box(rest.left, rest.top, rest.width, round(0.47 * rest.height))
    strip = Box(rest.left, panel.bottom + GAP, rest.width, rest.bottom - panel.bottom - GAP)
    return Layout(card, panel, strip, _chart_axes(card, facts))


def _wide(size: tuple[int, int], facts: Facts) -> Layout:
    """The chart top left, the panel beside it, the strip below over the full width."""
    width, height = size
    strip_height = round(0.27 * height)
    panel_width = max(300, round(0.27 * width))
    card = Box(GAP, GAP, width - panel_width - 3 * GAP, height - strip_height - 3 * GAP)
    panel = Box(card.right + GAP, GAP, panel_width, card.height)
    strip = Box(GAP, card.bottom + GAP, width - 2 * GAP, strip_height)
    return Layout(card, panel, strip, _chart_axes(card, facts))
