"""Several batches as one ``VecEnv``: a training that meets more than one distribution at once."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from stable_baselines3.common.vec_env import VecEnv

Indices = int | Iterable[int] | None


class MixedVecEnv(VecEnv):  # type: ignore[misc]  # SB3 is not looked into
    """Batches of the same spaces side by side, the first one's environments first.

    Args:
        parts: the batches, :class:`auvgym.sb3.AUVVecEnv`.
    """

    def __init__(self, parts: Sequence[Any]) -> None:
        self.parts = list(parts)
        self._starts = np.cumsum([0, *(part.num_envs for part in self.parts)]).tolist()
        first = self.parts[0]
        super().__init__(self._starts[-1], first.observation_space, first.action_space)

    def seed(self, seed: int | None = None) -> Sequence[int | None]:
        """Seed environment i with seed + i."""
        seeds: list[int | None] = []
        for part, start in zip(self.parts, self._starts, strict=False):
            seeds += part.seed(None if seed is None else seed + start)
        return seeds

    def reset(self) -> npt.NDArray[np.float32]:
        """Begin an episode in every environment."""
        return np.concatenate([part.reset() for part in self.parts])

    def step_async(self, actions: npt.NDArray[Any]) -> None:
        """Take the actions, (n, d)."""
        for part, rows in zip(self.parts, np.split(actions, self._starts[1:-1]), strict=True):
            part.step_async(rows)

    def step_wait(self) -> Any:
        """Fly one leg in every environment."""
        columns = zip(*(part.step_wait() for part in self.parts), strict=True)
        observations, rewards, ended, infos = columns
        return (
            np.concatenate(observations),
            np.concatenate(rewards),
            np.concatenate(ended),
            [info for some in infos for info in some],
        )

    def close(self) -> None:
        """Close every batch."""
        for part in self.parts:
            part.close()

    def _located(self, indices: Indices) -> list[tuple[Any, int]]:
        """The batch of each environment, and its place there."""
        found = []
        for index in self._get_indices(indices):
            which = int(np.searchsorted(self._starts, index, side="right")) - 1
            found.append((self.parts[which], index - self._starts[which]))
        return found

    def get_attr(self, attr_name: str, indices: Indices = None) -> list[Any]:
        """The attribute of each environment."""
        return [part.get_attr(attr_name, place)[0] for part, place in self._located(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: Indices = None) -> None:
        """Set the attribute of each environment."""
        for part, place in self._located(indices):
            part.set_attr(attr_name, value, place)

    def env_method(
        self, method_name: str, *method_args: Any, indices: Indices = None, **method_kwargs: Any
    ) -> list[Any]:
        """Call the method of each environment."""
        return [
            part.env_method(method_name, *method_args, indices=place, **method_kwargs)[0]
            for part, place in self._located(indices)
        ]

    def env_is_wrapped(self, wrapper_class: type, indices: Indices = None) -> list[bool]:
        """Whether the environments are wrapped."""
        return [
            part.env_is_wrapped(wrapper_class, place)[0] for part, place in self._located(indices)
        ]
