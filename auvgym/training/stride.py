"""Waypoints that are never where the vehicle already is.

A network without memory that asks for its own place sees the same again and asks for the same
again, to the time limit. While it explores it is shaken loose, so that it does not unlearn that.
``least_waypoint`` moves such a waypoint out along its direction, in training and ever after. What
begins with it learns worse than what gets it late: ``least_waypoint_from``.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from stable_baselines3.common.vec_env import VecEnvWrapper

#: Forward is ``OFFSET[0] + SCALE[0] a`` reaches (docs/environments.md, "Action").
OFFSET, SCALE = (0.25, 0.0, 0.0), (0.75, 1.0, 1.0)
#: Shorter than any ``least_waypoint``: a direction is not told from less.
SHORTEST = 1e-6
#: Longer ones would not fit the box of actions in every direction.
LONGEST = 0.5


def stride(actions: npt.NDArray[np.float32], least: float) -> npt.NDArray[np.float32]:
    """Actions (n, d) whose waypoints are ``least`` reaches away, or farther."""
    wide = actions.shape[1]
    offset, scale = (np.array(one[:wide], np.float32) for one in (OFFSET, SCALE))
    clipped = np.clip(actions, -1.0, 1.0)
    asked = clipped * scale + offset
    length = np.linalg.norm(asked, axis=1, keepdims=True)
    moved = (asked * (np.float32(least) / np.maximum(length, SHORTEST)) - offset) / scale
    return np.where(length < least, moved, clipped).astype(np.float32)


class StrideVecEnv(VecEnvWrapper):  # type: ignore[misc]  # SB3 is not looked into
    """Environments that move near waypoints away.

    Args:
        venv: the environments.
        least: shortest distance of a waypoint, in reaches.
        free: legs to fly before that holds.
    """

    def __init__(self, venv: Any, least: float, free: int = 0) -> None:
        super().__init__(venv)
        self._least, self._free = least, free

    def reset(self) -> Any:
        """Begin an episode in every environment."""
        return self.venv.reset()

    def step_async(self, actions: npt.NDArray[np.float32]) -> None:
        """Take the actions, (n, d)."""
        self._free -= self.num_envs
        self.venv.step_async(actions if self._free >= 0 else stride(actions, self._least))

    def step_wait(self) -> Any:
        """Fly one leg in every environment."""
        return self.venv.step_wait()
