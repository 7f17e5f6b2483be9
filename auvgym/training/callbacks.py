"""What happens while a model learns: the progress is told, the validation seeds are flown."""

from __future__ import annotations

import math
from collections.abc import Callable
from statistics import fmean
from typing import Any

from stable_baselines3.common.callbacks import BaseCallback

from auvgym.training.actor import Actor
from auvgym.training.curve import Curve, Row
from auvgym.training.flights import Examination

#: Called with legs done, legs in all.
OnProgress = Callable[[int, int], None]
#: Called with each new row of the learning curve.
OnRow = Callable[[Row], None]


class Progress(BaseCallback):  # type: ignore[misc]  # SB3 is not looked into
    """Tells how far the training is, after each step of the batch."""

    def __init__(self, tell: OnProgress, total: int) -> None:
        super().__init__()
        self._tell, self._total = tell, total

    def _on_step(self) -> bool:
        self._tell(min(self.num_timesteps, self._total), self._total)
        return True


class Validation(BaseCallback):  # type: ignore[misc]
    """Flies the validation seeds every so many legs and at the end, and keeps the best network.

    Args:
        examination: the seeds.
        every: legs between two looks.
        curve: where rows go.
        seconds: the clock: wall seconds of the training so far.
        keep: called with whether the network is the best so far.
        on_row: called with each row.
        least: shortest distance of a waypoint, or None.
    """

    def __init__(
        self,
        examination: Examination,
        every: int,
        curve: Curve,
        seconds: Callable[[], float],
        keep: Callable[[bool], None],
        on_row: OnRow,
        least: float | None = None,
    ) -> None:
        super().__init__()
        self._least = least
        self._examination, self._every, self._curve = examination, every, curve
        self._seconds, self._keep, self._on_row = seconds, keep, on_row
        self._next = every

    def _on_training_start(self) -> None:
        self._next = (self.num_timesteps // self._every + 1) * self._every

    def _on_step(self) -> bool:
        if self.num_timesteps >= self._next:
            self._next = (self.num_timesteps // self._every + 1) * self._every
            self.look()
        return True

    def _on_training_end(self) -> None:
        self.look()

    def look(self) -> None:
        """Fly the validation seeds now, unless that has just been done."""
        rows = self._curve.rows
        if rows and rows[-1].timesteps == self.num_timesteps:
            return
        normalizer = self.model.get_vec_normalize_env()
        flown = self._examination.fly(Actor(self.model, normalizer, self._least))
        found = flown.summary()
        best = self._curve.best
        is_best = best is None or found["return"] > best.return_
        row = Row(
            timesteps=self.num_timesteps,
            seconds=self._seconds(),
            train_success=self._recent("is_success"),
            train_return=self._recent("r"),
            success=found["success"],
            success_low=found["success_low"],
            success_high=found["success_high"],
            return_=found["return"],
            time_share=found["time_share"],
            steps=found["steps"],
            best=int(is_best),
        )
        self._curve.add(row)
        self._keep(is_best)
        for name, value in found.items():
            self.logger.record(f"validation/{name}", value)
        self.logger.dump(self.num_timesteps)
        self._on_row(row)

    def _recent(self, key: str) -> float:
        episodes: list[dict[str, Any]] = list(self.model.ep_info_buffer or [])
        return fmean(float(episode[key]) for episode in episodes) if episodes else math.nan
