"""Flying many given seeds at once, each once: how good a policy is while it is being trained."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium.vector import AutoresetMode

from auvgym.evaluation.summary import wilson_interval
from auvgym.training.config import TrainingError

#: Observations (n, k) and which of them begin an episode (n,) -> actions (n, ...).
Act = Callable[[npt.NDArray[np.float32], npt.NDArray[np.bool_]], npt.NDArray[Any]]


@dataclass(frozen=True)
class Flown:
    """What came of a flight of n seeds, in their order.

    Attributes:
        success: (n,) bool.
        returns: (n,) sums of rewards.
        time_share: (n,) travel time over the time limit, failures counted as the limit.
        steps: (n,) legs.
    """

    success: npt.NDArray[np.bool_]
    returns: npt.NDArray[np.float64]
    time_share: npt.NDArray[np.float64]
    steps: npt.NDArray[np.int64]

    def summary(self) -> dict[str, float]:
        """Means, and Wilson's 95 % bounds of the success rate."""
        low, high = wilson_interval(int(self.success.sum()), len(self.success))
        return {
            "success": float(self.success.mean()),
            "success_low": low,
            "success_high": high,
            "return": float(self.returns.mean()),
            "time_share": float(self.time_share.mean()),
            "steps": float(self.steps.mean()),
        }


class Examination:
    """A batch that flies the same seeds again and again.

    Args:
        environment: a registered id.
        seeds: of ``reset``, one for each environment of the batch.
        settings: arguments of the environment.

    Raises:
        TrainingError, ValueError: a setting that the environment does not have, or refuses.
    """

    def __init__(self, environment: str, seeds: Sequence[int], settings: dict[str, Any]) -> None:
        self.seeds = list(seeds)
        try:
            made = gymnasium.make_vec(
                environment,
                num_envs=len(self.seeds),
                autoreset_mode=AutoresetMode.SAME_STEP,
                **settings,
            )
        except TypeError as error:  # a setting that the environment does not have
            raise TrainingError(f"{environment}: {error}") from error
        self._envs: Any = made.unwrapped

    def fly(self, act: Act) -> Flown:
        """Fly each seed to its end."""
        envs, count = self._envs, len(self.seeds)
        observations, _ = envs.reset(seed=self.seeds)
        limits_s = np.array([member.episode.time_limit_s for member in envs.members])
        flying = np.ones(count, np.bool_)
        begins = np.ones(count, np.bool_)
        flown = Flown(
            np.zeros(count, np.bool_), np.zeros(count), np.ones(count), np.zeros(count, np.int64)
        )
        while flying.any():
            # Who has landed flies other episodes on, which do not count.
            observations, rewards, ended, _, _ = envs.advance(act(observations, begins))
            flown.returns[flying] += rewards[flying]
            flown.steps[flying] += 1
            landed = flying & ended
            if landed.any():
                last = envs.columns(last=True)
                arrived = landed & last["is_success"].astype(np.bool_)
                flown.success[arrived] = True
                flown.time_share[arrived] = last["time_s"][arrived] / limits_s[arrived]
            flying &= ~ended
            begins = ended
        return flown


def wilson_text(success: float, low: float, high: float) -> str:
    """``95.3 % [92.4, 97.1]``."""
    if math.isnan(success):
        return "-"
    return f"{100 * success:.1f} % [{100 * low:.1f}, {100 * high:.1f}]"
