"""Which episodes the environments of a batch begin: for each the draws that it would make alone."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from gymnasium.utils import seeding


class EpisodeSeeds:
    """A random generator for each environment, and the seed of the episode that it begins next."""

    def __init__(self, count: int) -> None:
        self._generators: list[np.random.Generator | None] = [None] * count
        #: (n,) uint64: always drawn already, so that the engine can begin an episode by itself.
        self.next: npt.NDArray[np.uint64] = np.zeros(count, np.uint64)

    def _draw(self, index: int) -> None:
        generator = self._generators[index]
        if generator is None:
            self._generators[index] = generator = seeding.np_random()[0]
        # As ``AUVEnv.reset`` draws.
        self.next[index] = generator.integers(0, 2**63)

    def seed(self, seeds: Sequence[int | None], which: npt.NDArray[np.intp]) -> None:
        """Seed the generators of ``which``; those whose seed is None go on as they were."""
        for index in which.tolist():
            seed = seeds[index]
            if seed is not None:
                self._generators[index] = seeding.np_random(int(seed))[0]
                self._draw(index)
            elif self._generators[index] is None:
                self._draw(index)

    def used(self, which: npt.NDArray[np.intp]) -> None:
        """Draw anew for those whose seed has been used."""
        for index in which.tolist():
            self._draw(index)
