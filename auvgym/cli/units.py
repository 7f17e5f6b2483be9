"""Lengths and times in units that suit their size."""

from __future__ import annotations

from collections.abc import Sequence

_LENGTHS = ((1000.0, "km"), (1.0, "m"))
_TIMES = ((3600.0, "h"), (60.0, "min"), (1.0, "s"))


def length(metres: float) -> str:
    """``41.68 km`` or ``39.10 m``."""
    return _in_units(metres, _LENGTHS)


def duration(seconds: float) -> str:
    """``5.79 h``, ``12.30 min`` or ``78.00 s``."""
    return _in_units(seconds, _TIMES)


def _in_units(value: float, units: Sequence[tuple[float, str]]) -> str:
    """In the largest unit of which there is at least one, or the smallest."""
    size, unit = next((one for one in units if value >= one[0]), units[-1])
    return f"{value / size:.2f} {unit}"
