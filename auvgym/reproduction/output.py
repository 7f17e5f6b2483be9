"""Writes a card: Markdown and its plot."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from auvgym.reproduction.card import Card
from auvgym.reproduction.page import markdown
from auvgym.reproduction.plots import draw
from auvgym.reproduction.runs import Outcome, Run


def write_card(card: Card, outcomes: Mapping[Run, Outcome], seeds: int, folder: Path) -> Path:
    """Write ``folder/NAME.md`` and its plot.

    Args:
        card: the card.
        outcomes: at least the card's runs.
        seeds: seeds of each cell that are shown.
        folder: made if it does not exist.

    Raises:
        ImportError: without matplotlib or scipy; it says what to install.
    """
    folder.mkdir(parents=True, exist_ok=True)
    pictures = draw(card, outcomes, seeds, folder)
    path = folder / f"{card.name}.md"
    path.write_text(markdown(card, outcomes, seeds, pictures), encoding="utf-8")
    return path
