"""What a policy is, and what every scripted policy shares."""

from __future__ import annotations

import inspect
import time
from abc import ABC, abstractmethod
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Literal, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from auvgym.envs import AUVEnv

Knows = Literal["nothing", "sensors", "map"]
Vector = NDArray[np.float64]
Action = NDArray[np.float32]
Observation = NDArray[np.float32]


class PolicyError(ValueError):
    """A policy that does not exist, or was made with parameters it does not have."""


@runtime_checkable
class Policy(Protocol):
    """Anything that steers an auvgym environment.

    ``knows`` says what its choices may rest on, and the board prints it: ``"nothing"`` (its own
    position and the goal), ``"sensors"`` (the observation) or ``"map"`` (``env.unwrapped.world``,
    the present map; never the future).

    ``reset`` may take ``(observation, info)`` instead of the environment: such a policy is never
    given the environment, and knows what its observations tell.

    One object may fly many episodes: ``reset`` forgets the last one entirely, so that an episode
    depends on the policy's parameters, its seed and the episode alone, whatever was flown before.

    Optional attributes, read after an episode: ``evaluations`` (int, path evaluations counted),
    ``replans`` (int, plans made after the first), ``planning_seconds`` (float, wall clock spent
    planning, reported apart from the results).
    """

    @property
    def name(self) -> str:
        """The name on the board."""
        ...

    @property
    def knows(self) -> Knows:
        """What the choices rest on."""
        ...

    def reset(self, env: Any) -> None:
        """Start an episode. ``env`` (Gymnasium environment) has just been reset."""
        ...

    def act(self, observation: Observation, info: dict[str, Any]) -> Any:
        """The next action, for the observation and info that the last reset or step gave."""
        ...


def begin(policy: Any, env: Any, observation: Observation, info: dict[str, Any]) -> None:
    """Call a policy's ``reset`` with what it takes: ``(env)``, or ``(observation, info)``."""
    if takes_observation(policy):
        policy.reset(observation, info)
    else:
        policy.reset(env)


def takes_observation(policy: Any) -> bool:
    """Whether ``reset`` takes ``(observation, info)`` and not the environment."""
    parameters = inspect.signature(policy.reset).parameters.values()
    plain = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
    needed = [one for one in parameters if one.kind in plain and one.default is one.empty]
    return len(needed) > 1


class ScriptedPolicy(ABC):
    """Base of the policies that ship with auvgym: holds the episode's environment and counters."""

    name = "scripted"
    knows: Knows = "nothing"
    description = ""

    def __init__(self, seed: int = 0) -> None:
        self.seed = seed
        self.evaluations = 0
        self.replans = 0
        self.planning_seconds = 0.0

    def reset(self, env: Any) -> None:
        """Forget the last episode and look at the new one."""
        self.env: AUVEnv = env.unwrapped
        self.evaluations = 0
        self.replans = 0
        self.planning_seconds = 0.0
        self.goal: Vector = np.asarray(self.env.world.goal, dtype=np.float64)

    @abstractmethod
    def act(self, observation: Observation, info: dict[str, Any]) -> Action:
        """The next action, (d,) float32."""

    @property
    def position(self) -> Vector:
        """Where the vehicle is, (3,) m."""
        return np.asarray(self.env.episode.position, dtype=np.float64)

    def steer_to(self, waypoint_m: Vector) -> Action:
        """The action whose waypoint is ``waypoint_m`` (3,) m, or as near to it as one leg gets."""
        return np.asarray(self.env.action_for(waypoint_m), dtype=np.float32)

    def count(self, evaluations: int, replans: int = 0) -> None:
        """Count what a plan took, here and in the environment's ``info``."""
        self.evaluations += evaluations
        self.replans += replans
        self.env.charge(evaluations, replans)

    @contextmanager
    def planning(self) -> Iterator[None]:
        """Count the wall clock of the block as planning time."""
        begin = time.perf_counter()
        try:
            yield
        finally:
            self.planning_seconds += time.perf_counter() - begin
