"""The papers' tables and figures, run again: ``auvgym reproduce``."""

from auvgym.reproduction.card import Card, CardError, list_cards, load_card
from auvgym.reproduction.journal import Journal, JournalError
from auvgym.reproduction.output import write_card
from auvgym.reproduction.raster_astar import raster_astar
from auvgym.reproduction.runner import RunError, run_card
from auvgym.reproduction.runs import Outcome, Run

__all__ = [
    "Card",
    "CardError",
    "Journal",
    "JournalError",
    "Outcome",
    "Run",
    "RunError",
    "list_cards",
    "load_card",
    "raster_astar",
    "run_card",
    "write_card",
]
