"""``random``: uniform actions, the floor below every floor."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium.spaces import Discrete

from auvgym.policies.base import Action, Observation, ScriptedPolicy


class RandomPolicy(ScriptedPolicy):
    """Draws every action uniformly from the action box."""

    name = "random"
    description = "uniform random actions"

    def reset(self, env: Any) -> None:
        """Restart the stream from the policy's seed and the episode's."""
        super().reset(env)
        # Both seeds: two episodes differ, and one episode is the same whatever was flown before it.
        self._generator = np.random.Generator(
            np.random.PCG64([abs(self.seed), int(self.env.episode.seed)])
        )

    def act(self, observation: Observation, info: dict[str, Any]) -> Action:
        """A point of the action box, (d,) float32; in re-plan mode one of the actions, (1,)."""
        space = self.env.action_space
        if isinstance(space, Discrete):
            return self._generator.integers(0, space.n, 1).astype(np.float32)
        shape = space.shape
        return self._generator.uniform(-1.0, 1.0, shape).astype(np.float32)
