"""The journal of an experiment: a line of JSON for each run, written as the run ends.

A run that stands in it is never done again, whichever card asks for it; a last line that was cut
off is forgotten.
"""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

import auvgym
from auvgym.reproduction.runs import Outcome, Run


class JournalError(ValueError):
    """A journal that cannot be gone on with."""


class Journal:
    """The outcomes known so far; made on first use.

    Raises:
        JournalError: a line that is no run's, or a run of another version of the engine.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.outcomes: dict[Run, Outcome] = {}
        text = path.read_text(encoding="utf-8") if path.exists() else ""
        # What follows the last line's end was being written when the process died.
        whole, _, cut = text.rpartition("\n")
        if cut:
            path.write_text(whole + "\n" if whole else "", encoding="utf-8")
        for number, line in enumerate(whole.splitlines(), 1):
            self._read(number, line)

    def _read(self, number: int, line: str) -> None:
        try:
            entry = json.loads(line)
            version, outcome = entry["version"], entry["outcome"]
            run = Run(**entry["run"])
            outcome = Outcome(**{**outcome, "curve": tuple(outcome["curve"])})
        except (ValueError, KeyError, TypeError) as error:
            raise JournalError(f"{self.path}, line {number}: is no run ({error})") from error
        if version != auvgym.__version__:
            raise JournalError(
                f"{self.path}, line {number}: a run of auvgym {version}, this is "
                f"{auvgym.__version__}; use another folder, or --fresh"
            )
        self.outcomes[run] = outcome

    def add(self, run: Run, outcome: Outcome) -> None:
        """Write a run down."""
        entry = {
            "version": auvgym.__version__,
            "run": asdict(run),
            "outcome": {**outcome.to_dict(), "curve": list(outcome.curve)},
        }
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with self.path.open("a", encoding="utf-8") as file:
            file.write(json.dumps(entry, separators=(",", ":")) + "\n")
        self.outcomes[run] = outcome
