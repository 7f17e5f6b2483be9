"""Which episodes the environments of a batch begin: for each the draws that it would make alone."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from gymnasium.utils import seeding

#: Drawn together, since a call of the generator takes longer than its draws.
_AT_ONCE = 32


class EpisodeSeeds:
    """A random generator for each environment, and the seed of the episode that it begins next."""

    def __init__(self, count: int) -> None:
        self._generators: list[np.random.Generator | None] = [None] * count
        #: (n,) uint64: always drawn already, so that the engine can begin an episode by itself.
        self.next: npt.NDArray[np.uint64] = np.zeros(count, np.uint64)
        #: What each generator has drawn ahead, the next one last.
        self._ahead: list[list[int]] = [[] for _ in range(count)]

    def seed(self, seeds: Sequence[int | None], which: npt.NDArray[np.intp]) -> None:
        """Seed the generators of ``which``; those whose seed is None go on as they were."""
        for index in which.tolist():
            if seeds[index] is not None or self._generators[index] is None:
                self._generators[index] = seeding.np_random(seeds[index])[0]
                self._ahead[index].clear()
                self._draw(index)

    def used(self, which: npt.NDArray[np.intp]) -> None:
        """Draw anew for those whose seed has been used."""
        for index in which.tolist():
            self._draw(index)

    def _draw(self, index: int) -> None:
        ahead = self._ahead[index]
        if not ahead:
            generator = self._generators[index]
            assert generator is not None, "seeded before the first episode"
            # As ``AUVEnv.reset`` draws, one after another.
            ahead.extend(generator.integers(0, 2**63, _AT_ONCE)[::-1].tolist())
        self.next[index] = ahead.pop()
