"""The learning curve: a row for each look at the validation seeds, as CSV and in TensorBoard."""

from __future__ import annotations

import csv
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Row:
    """A point of the learning curve.

    Attributes:
        timesteps: legs flown in training.
        seconds: wall clock of the training so far, validation included.
        train_success, train_return: of the last episodes of training, exploring (NaN: no).
        success, success_low, success_high: of the validation seeds, with Wilson's 95 % bounds.
        return_: mean sum of rewards of the validation seeds.
        time_share: their mean travel time over the time limit, failures counted as the limit.
        steps: their mean number of legs.
        best: 1 where this network was the best so far, by mean return.
    """

    timesteps: int
    seconds: float
    train_success: float
    train_return: float
    success: float
    success_low: float
    success_high: float
    return_: float
    time_share: float
    steps: float
    best: int


_COLUMNS = [field.name.rstrip("_") for field in fields(Row)]


class Curve:
    """The rows of a training, kept in a CSV file."""

    def __init__(self, path: Path, timesteps: int | None = None) -> None:
        """Read what is there; rows beyond ``timesteps`` are of a part that was not kept."""
        self.path = path
        self.rows: list[Row] = []
        if path.is_file() and timesteps is not None:
            with path.open(newline="", encoding="utf-8") as file:
                read = [_row(line) for line in csv.DictReader(file)]
            self.rows = [row for row in read if row.timesteps <= timesteps]
        self._write()

    @property
    def best(self) -> Row | None:
        """The row of the network that is kept."""
        return next((row for row in reversed(self.rows) if row.best), None)

    def add(self, row: Row) -> None:
        """Keep a row, on the disk at once."""
        self.rows.append(row)
        self._write()

    def _write(self) -> None:
        with self.path.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(_COLUMNS)
            writer.writerows(_rounded(row) for row in self.rows)


def _rounded(row: Row) -> list[float]:
    return [round(value, 6) for value in asdict(row).values()]


def _row(line: dict[str, str]) -> Row:
    whole = {"timesteps", "best"}
    values: list[Any] = [
        int(line[name]) if name in whole else float(line[name]) for name in _COLUMNS
    ]
    return Row(*values)
