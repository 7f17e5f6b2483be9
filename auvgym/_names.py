"""Errors about unknown names: what exists, and what was perhaps meant."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


def unknown(kind: str, name: object, known: Iterable[str]) -> str:
    """Say that ``name`` is no ``kind``, suggest the nearest known one and list them all."""
    names = sorted(known)
    near = difflib.get_close_matches(str(name), names, n=1, cutoff=0.5)
    suggestion = f"; did you mean {near[0]!r}?" if near else ""
    return f"unknown {kind} {name!r}{suggestion} (there are: {', '.join(names)})"
