"""One axis of a grid: brought to ascending order, turned to the mission's longitudes, cropped."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Axis:
    """``values`` (n,) ascend; ``order`` (n,) says where in the file's dimension each one lies."""

    dimension: str
    values: FloatArray
    order: NDArray[np.intp]

    @property
    def low(self) -> float:
        """The first value."""
        return float(self.values[0])

    @property
    def high(self) -> float:
        """The last value."""
        return float(self.values[-1])

    def part(self, first: int, last: int) -> Axis:
        """The nodes ``first`` to ``last``, both included."""
        return replace(
            self, values=self.values[first : last + 1], order=self.order[first : last + 1]
        )

    def crop(self, low: float, high: float) -> Axis:
        """The nodes that hold ``low`` to ``high`` between them, as far as there are any."""
        first = max(int(np.searchsorted(self.values, low, side="right")) - 1, 0)
        last = min(int(np.searchsorted(self.values, high, side="left")), self.values.size - 1)
        return self.part(min(first, self.values.size - 1), max(last, 0))


def make_axis(dimension: str, values: FloatArray, what: str) -> Axis:
    """An axis from a file's coordinate, ascending or descending there.

    ``what`` names it in errors. Raises ValueError on values that are missing or repeat.
    """
    if not np.isfinite(values).all():
        raise ValueError(f"{what} has missing values: every node needs one")
    order = np.argsort(values, kind="stable")
    ascending = values[order]
    if (np.diff(ascending) <= 0.0).any():
        twice = ascending[1:][np.diff(ascending) <= 0.0][0]
        raise ValueError(f"{what} has the value {twice} twice: its values must differ")
    return Axis(dimension, ascending, order)


def recentre(axis: Axis, longitude_deg: float) -> Axis:
    """The longitudes as numbers near ``longitude_deg``, whichever turn of the circle they are on.

    0 .. 360, -180 .. 180 and 20 .. 380 become one convention, and a mission may cross the
    180th meridian. A grid around the whole Earth is cut opposite to ``longitude_deg``.
    """
    values = axis.values
    steps = np.diff(values)
    if values.size < 2:
        return axis
    # Files that jump from 180 to -180 come out of sorting with one gap: close it.
    widest = int(np.argmax(steps))
    if axis.high - axis.low <= 360.0 and steps[widest] > 180.0:
        values = np.where(np.arange(values.size) <= widest, values + 360.0, values)
        around = np.argsort(values, kind="stable")
        axis = replace(axis, values=values[around], order=axis.order[around])
        values, steps = axis.values, np.diff(axis.values)
    spacing = float(np.median(steps))
    if axis.high - axis.low + 1.5 * spacing < 360.0:
        middle = (axis.low + axis.high) / 2.0
        turns = np.round((longitude_deg - middle) / 360.0)
        return replace(axis, values=values + 360.0 * turns)
    west = longitude_deg - 180.0
    around_values = west + np.mod(values - west, 360.0)
    around = np.argsort(around_values, kind="stable")
    sorted_values = around_values[around]
    # The seam of a closed circle is stored twice, not always to the last digit.
    keep = np.concatenate([[True], np.diff(sorted_values) > 0.01 * spacing])
    return replace(axis, values=sorted_values[keep], order=axis.order[around][keep])
