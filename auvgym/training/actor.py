"""A model as a function of observations: normalised, deterministic, with its memory."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from auvgym.training.stride import stride


class Actor:
    """What a model of Stable-Baselines3 does where it is not exploring.

    Args:
        model: the model.
        normalizer: its ``VecNormalize``, or None.
        least: shortest distance of a waypoint, in reaches, or None (:mod:`auvgym.training.stride`).
    """

    def __init__(self, model: Any, normalizer: Any = None, least: float | None = None) -> None:
        self._model = model
        self._normalizer = normalizer
        self._least = least
        self._state: Any = None

    def __call__(
        self, observations: npt.NDArray[np.float32], begins: npt.NDArray[np.bool_]
    ) -> npt.NDArray[Any]:
        """Actions for observations (n, k), of which ``begins`` (n,) are the first of an episode."""
        if self._normalizer is not None:
            observations = self._normalizer.normalize_obs(observations)
        actions, self._state = self._model.predict(
            observations, state=self._state, episode_start=begins, deterministic=True
        )
        return np.asarray(actions) if self._least is None else stride(actions, self._least)
