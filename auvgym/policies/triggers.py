"""Triggers: when to plan anew, in environments with ``action_mode="replan"``."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

from auvgym.policies.base import Knows, Observation, PolicyError

#: Window -> the action that plans it anew.
WINDOWS = {"short": 1, "long": 2, "full": 3}
GO_ON = 0


class Trigger(ABC):
    """Goes on with the plan, or asks for another within a window.

    Args:
        seed: unused; every policy takes one.
        window: "short", "long" or "full": what is planned anew.

    Raises:
        PolicyError: for a window that there is not.
    """

    name = "trigger"
    knows: Knows = "sensors"
    description = ""

    def __init__(self, seed: int = 0, window: str = "full") -> None:
        self.seed = seed
        if window not in WINDOWS:
            raise PolicyError(f"window = {window!r}: must be one of {', '.join(WINDOWS)}")
        self.window = window

    def reset(self, env: Any) -> None:
        """Forget the last episode.

        Raises:
            PolicyError: if the environment is not in re-plan mode.
        """
        core = env.unwrapped
        if core.action_mode != "replan":
            raise PolicyError(f'{self.name} needs an environment with action_mode="replan"')
        self._layout = core.observation_layout
        self._range_m = float(core.world.scenario.to_dict()["episode"]["sonar_range_m"])

    def act(self, observation: Observation, info: dict[str, Any]) -> int:
        """The next action, 0 .. 3."""
        return WINDOWS[self.window] if self.due(observation, info) else GO_ON

    @abstractmethod
    def due(self, observation: Observation, info: dict[str, Any]) -> bool:
        """Whether to plan anew now."""

    def entry(self, observation: Observation, block: str) -> float:
        """The first entry of a block of the observation."""
        return float(observation[self._layout[block].start])


class Never(Trigger):
    """Flies the first plan to its end, whatever happens."""

    name = "never"
    knows: Knows = "nothing"
    description = "trigger: fly the first plan to its end"

    def due(self, observation: Observation, info: dict[str, Any]) -> bool:
        """Never."""
        return False


class EveryChange(Trigger):
    """Plans anew at each map change (LFHH's own rule).

    A change that comes while the vehicle keeps station for a plan calls for another one.
    """

    name = "every-change"
    description = "trigger: plan anew at each map change"

    def due(self, observation: Observation, info: dict[str, Any]) -> bool:
        """If the last step ended with a change."""
        return bool(info["map_changed"])


class EveryK(Trigger):
    """Plans anew at every k-th map change, or at every k-th leg.

    Args:
        seed: unused.
        window: as :class:`Trigger`.
        k: how many, 1 or more.
        of: "changes" or "legs".

    Raises:
        PolicyError: for a value that is not allowed.
    """

    name = "every-k"
    description = "trigger: plan anew at every k-th map change"

    def __init__(
        self, seed: int = 0, window: str = "full", k: int = 2, of: str = "changes"
    ) -> None:
        super().__init__(seed, window)
        if isinstance(k, bool) or not isinstance(k, int) or k < 1:
            raise PolicyError(f"k = {k!r}: must be an integer, 1 or more")
        if of not in ("changes", "legs"):
            raise PolicyError(f"of = {of!r}: must be 'changes' or 'legs'")
        self.k = k
        self.of = of

    def reset(self, env: Any) -> None:
        """Forget the last episode."""
        super().reset(env)
        self._legs = 0

    def due(self, observation: Observation, info: dict[str, Any]) -> bool:
        """If the k-th change, or leg, has just ended."""
        if self.of == "changes":
            return bool(info["map_changed"]) and info["map_changes"] % self.k == 0
        self._legs += 1
        return self._legs > 1 and (self._legs - 1) % self.k == 0


class OnPredictedCollision(Trigger):
    """Plans anew where the plan ahead conflicts with what is sensed now.

    Args:
        seed: unused.
        window: as :class:`Trigger`.
        distance_m: a conflict counts within this along the plan, m; None for the sonar range,
            beyond which nothing is sensed.

    Raises:
        PolicyError: for a value that is not allowed.
    """

    name = "on-predicted-collision"
    description = "trigger: plan anew when the plan ahead is blocked"

    def __init__(
        self, seed: int = 0, window: str = "full", distance_m: float | None = None
    ) -> None:
        super().__init__(seed, window)
        if distance_m is not None and not distance_m > 0.0:
            raise PolicyError(f"distance_m = {distance_m!r}: must be None or above 0, m")
        self.distance_m = distance_m

    def due(self, observation: Observation, info: dict[str, Any]) -> bool:
        """If there is a conflict near enough."""
        conflict = self.entry(observation, "plan_conflict")
        if conflict <= 0.0:
            return False
        return self.distance_m is None or (1.0 - conflict) * self._range_m <= self.distance_m


TRIGGERS: dict[str, type[Trigger]] = {
    trigger.name: trigger for trigger in (Never, EveryChange, EveryK, OnPredictedCollision)
}
