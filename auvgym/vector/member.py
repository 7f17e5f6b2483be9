"""One environment of a batch, as policies and ``get_attr`` see it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy.typing as npt

from auvgym import _core
from auvgym._arrays import numbers
from auvgym.envs.waypoint import Action
from auvgym.world import World

if TYPE_CHECKING:
    from auvgym.vector.environment import AUVVectorEnv

#: What only the whole batch does.
TOGETHER = frozenset({"reset", "step", "close", "np_random", "np_random_seed"})


class Member:
    """Environment ``index`` of a batch: what ``env.unwrapped`` is, without ``reset`` and ``step``.

    What the class of environment defines (``dimensions``, ``observation_layout``, spaces,
    ``render_mode``) is found here too.
    """

    def __init__(self, batch: AUVVectorEnv, index: int) -> None:
        self._batch = batch
        self.index = index
        #: What a policy wants drawn: waypoints (n, 3) m, or None.
        self.plan: npt.NDArray[Any] | None = None

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name in TOGETHER:
            raise AttributeError(f"an environment of a batch has no {name!r} of its own")
        return getattr(self._batch.settings, name)

    @property
    def unwrapped(self) -> Member:
        """Itself."""
        return self

    @property
    def spec(self) -> Any:
        """How Gymnasium made the batch."""
        return self._batch.spec

    @property
    def episode(self) -> _core.Episode:
        """A copy of the engine's episode. Its trail and actions are empty unless they are recorded.

        Raises:
            ResetNeeded: before the first ``reset``.
        """
        return self._batch.episode(self.index)

    @property
    def world(self) -> World:
        """A copy of the world at the present time."""
        return World._of(self.episode.world)

    def action_for(self, waypoint: npt.ArrayLike) -> Action:
        """The action, (d,) float32, that steers towards a waypoint, (3,) m.

        Raises:
            ValueError: if the waypoint is not finite or has another shape, or in re-plan mode.
        """
        if self.action_mode == "replan":
            raise ValueError("action_for steers at waypoints: in re-plan mode the plan does")
        point = numbers("waypoint", waypoint)
        if point.shape != (3,):
            raise ValueError(f"waypoint has shape {point.shape}: must be (3,)")
        return self.episode.action_for((point[0], point[1], point[2]))

    def charge(self, evaluations: int = 0, replans: int = 0) -> None:
        """Charge planning to the episode: counted in ``info``."""
        self._batch.charge(self.index, evaluations, replans)

    def render(self) -> Any:
        """A frame, (height, width, 3) uint8, or None without a ``render_mode``."""
        return self._batch.frame(self.index)

    def get_wrapper_attr(self, name: str) -> Any:
        """The attribute of that name, as Gymnasium's wrappers call it."""
        return getattr(self, name)
