"""``AUVVectorEnv``: Gymnasium's vector interface to the engine's batch."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, TypeAlias

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium.error import ResetNeeded
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space

from auvgym import _core
from auvgym._core import ActionError
from auvgym._names import unknown
from auvgym.envs.waypoint import AUVEnv
from auvgym.scenario import check_seed
from auvgym.vector.member import Member
from auvgym.vector.seeds import EpisodeSeeds

Observations: TypeAlias = npt.NDArray[np.float32]
Flags: TypeAlias = npt.NDArray[np.bool_]
Steps: TypeAlias = tuple[Observations, npt.NDArray[np.float64], Flags, Flags, dict[str, Any]]


class AUVVectorEnv(gymnasium.vector.VectorEnv[Observations, npt.ArrayLike, npt.NDArray[Any]]):
    """Many environments of one class, stepped together on all cores.

    Environment i does what a single one does that was given the same seeds and actions, bit for
    bit, whatever the number of threads. Arrays that were returned are the caller's: nothing
    writes to them later.

    Args:
        env_class: the environment's class.
        num_envs: how many.
        autoreset_mode: what follows when an episode ends: ``"NextStep"`` (the next step begins
            another and ignores the action), ``"SameStep"`` (the same step does, and the last
            observation and info are ``infos["final_obs"]`` and ``infos["final_info"]``) or
            ``"Disabled"`` (``reset(options={"reset_mask": mask})`` does).
        threads: how many to use; None: as many as there are cores for this process.
        record: whether episodes keep trails and actions; None: if they are rendered.
        render_mode: None or ``"rgb_array"``.
        **settings: those of the environment.

    Raises:
        TypeError: for an unknown setting, or a class that steps in a way of its own.
        ValueError: for a value that is not allowed.
    """

    def __init__(
        self,
        env_class: type[AUVEnv],
        num_envs: int = 1,
        *,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        threads: int | None = None,
        record: bool | None = None,
        render_mode: str | None = None,
        **settings: Any,
    ) -> None:
        for method in ("reset", "step", "_make_source"):
            if getattr(env_class, method) is not getattr(AUVEnv, method):
                raise TypeError(
                    f"{env_class.__name__} has a {method}() of its own, which a batch does not "
                    'call: use vectorization_mode="sync"'
                )
        if render_mode not in (None, "rgb_array"):
            raise ValueError(f"render_mode = {render_mode!r}: a batch needs None or 'rgb_array'")
        self.num_envs = _count("num_envs", num_envs)
        if threads is None:
            threads = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else 0
            threads = threads or os.cpu_count() or 1
        self._threads = _count("threads", threads)
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self.render_mode = render_mode
        self._record = render_mode is not None if record is None else bool(record)
        #: One environment with the same settings, which is never flown.
        self.settings = env_class(render_mode=render_mode, **settings)
        self.metadata = {**env_class.metadata, "autoreset_mode": self.autoreset_mode}
        self.single_observation_space = self.settings.observation_space
        self.single_action_space = self.settings.action_space
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self._seeds = EpisodeSeeds(self.num_envs)
        self._ended: Flags = np.zeros(self.num_envs, np.bool_)
        self._running = False
        self._viewers: dict[int, Any] = {}
        self._batch = self._make_batch()
        #: The environments one by one: what ``env.unwrapped`` is elsewhere.
        self.members = [Member(self, index) for index in range(self.num_envs)]

    def _make_batch(self) -> _core.Batch:
        return _core.Batch(
            self.settings._source,
            self.num_envs,
            self._threads,
            self.autoreset_mode.value,
            self._record,
        )

    @property
    def threads(self) -> int:
        """How many threads step the environments."""
        return self._batch.threads

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Observations, dict[str, Any]]:
        """Begin an episode in every environment.

        Args:
            seed: environment i is seeded with seed + i, or with the i-th of a sequence.
            options: ``{"episode_seed": n}`` begins exactly the episode n in all, or the i-th of a
                sequence in environment i; ``{"reset_mask": mask}``, (n,) bool, begins only there,
                the other episodes go on.

        Returns:
            Observations, (n, k) float32, and infos.
        """
        count = self.num_envs
        seeds = _for_each(seed, count, "seed", step=1)
        options = dict(options or {})
        mask = _mask(options.pop("reset_mask", None), count)
        given = _for_each(options.pop("episode_seed", None), count, "episode_seed", step=0)
        if options:
            known = ["episode_seed", "reset_mask"]
            raise ValueError(unknown("option", next(iter(options)), known))
        if not (self._running or mask.all()):
            raise ResetNeeded("call reset() without a reset_mask first")
        which = np.flatnonzero(mask)
        self._seeds.seed(seeds, which)
        begun = self._seeds.next.copy()
        drawn = np.array([n is None for n in given], np.bool_)
        for index in which[~drawn[which]].tolist():
            begun[index] = check_seed(given[index], "episode_seed")
        self._running = False
        observations = self._batch.reset(begun, mask)
        self._seeds.used(which[drawn[which]])
        self._ended = self._ended & ~mask
        self._running = True
        return observations, self._infos(mask.copy(), begun, everywhere=mask)

    def step(self, actions: npt.ArrayLike) -> Steps:
        """Fly one leg in every environment.

        Args:
            actions: (n, d) numbers in [-1, 1]; in re-plan mode (n,) numbers 0, 1, 2 or 3.

        Returns:
            Observations (n, k) float32, rewards (n,) float64, terminations and truncations (n,)
            bool, infos: for each key an array (n,), and under ``_key`` whose entries count.

        Raises:
            ActionError: for actions of wrong shape or type, or one not finite or out of range,
                naming its environment; nothing has moved then.
            ResetNeeded: before ``reset``, after a step that was interrupted, and, without
                autoreset, after the end of an episode.
        """
        observations, rewards, ended, begun, seeds = self.advance(actions)
        infos = self._infos(begun, seeds)
        if self.autoreset_mode is AutoresetMode.SAME_STEP and ended.any():
            last = np.full(self.num_envs, None, dtype=object)
            over = ended.nonzero()[0]
            for index, row in zip(over.tolist(), self.last_observations(over), strict=True):
                last[index] = row
            infos["final_obs"], infos["_final_obs"] = last, ended.copy()
            infos["final_info"] = self._batch.info(True, ended, True)
            infos["_final_info"] = ended.copy()
        return observations, rewards, ended, self._none(), infos

    def advance(
        self, actions: npt.ArrayLike
    ) -> tuple[Observations, npt.NDArray[np.float64], Flags, Flags, npt.NDArray[np.uint64]]:
        """A step without infos, for other interfaces to the batch.

        Returns:
            Observations, rewards, which episodes ended, which environments began another, and
            the seeds of those.

        Raises:
            As :meth:`step`.
        """
        if not self._running:
            raise ResetNeeded(
                "call reset() first: there are no episodes, or a step was interrupted"
            )
        if self.autoreset_mode is AutoresetMode.DISABLED and self._ended.any():
            over = np.flatnonzero(self._ended)[:5].tolist()
            raise ResetNeeded(f"the episodes of environments {over} have ended: call reset() first")
        seeds = self._seeds.next.copy()
        # Whatever interrupts from here on leaves some environments a step ahead.
        self._running = False
        try:
            observations, rewards, ended = self._batch.step(self._as_float32(actions), seeds)
        except ActionError:
            self._running = True
            raise
        match self.autoreset_mode:
            case AutoresetMode.NEXT_STEP:
                began = self._ended
            case AutoresetMode.SAME_STEP:
                began = ended.copy()
            case AutoresetMode.DISABLED:
                began = self._none()
        self._seeds.used(began.nonzero()[0])
        self._ended = ended.copy()
        self._running = True
        return observations, rewards, ended, began, seeds

    def _none(self) -> Flags:
        return np.zeros(self.num_envs, np.bool_)

    def _as_float32(self, actions: Any) -> Observations:
        """Actions as the engine takes them."""
        discrete = self.settings.action_mode == "replan"
        shape = (self.num_envs,) if discrete else (self.num_envs, self.settings.dimensions)
        try:
            array = np.asarray(actions)
        except (TypeError, ValueError) as error:
            raise ActionError(f"actions must be numbers of shape {shape} ({error})") from error
        if array.dtype.kind not in "fiu":
            raise ActionError(f"actions must be numbers of shape {shape}, not {array.dtype}")
        if array.shape != shape:
            raise ActionError(f"actions have shape {array.shape}: must be {shape}")
        if discrete:
            array = array[:, None]
        if array.dtype == np.float32:
            return np.ascontiguousarray(array)
        # A number too large for float32 becomes infinite, which the engine refuses by name.
        with np.errstate(over="ignore"):
            return np.ascontiguousarray(array, dtype=np.float32)

    def columns(self, last: bool = False) -> dict[str, Any]:
        """What is measured, by name an array (n,): now, or when the ``last`` episodes ended."""
        return self._batch.info(last)

    def rows(self, indices: npt.NDArray[np.intp], last: bool = False) -> list[dict[str, Any]]:
        """The infos of some environments, as alone: now, or when the ``last`` episodes ended."""
        return self._batch.infos(indices.astype(np.int64, copy=False), last)

    def _infos(
        self, begun: Flags, seeds: npt.NDArray[np.uint64], everywhere: Flags | None = None
    ) -> dict[str, Any]:
        # Zero, False or None where there is nothing to tell, and masks, as Gymnasium has them.
        columns = self._batch.info(False, everywhere, True)
        if begun.any():
            columns["episode_seed"] = np.where(begun, seeds, np.uint64(0))
            columns["_episode_seed"] = begun
        return columns

    def episode(self, index: int) -> _core.Episode:
        """A copy of the episode of environment ``index``.

        Raises:
            ResetNeeded: before the first ``reset``.
        """
        if not self._running:
            raise ResetNeeded("call reset() first: there is no episode yet")
        return self._batch.episode(index)

    def last_observations(self, indices: npt.NDArray[np.intp]) -> Observations:
        """What the m environments ``indices`` saw last in their last episodes, (m, k) float32.

        Raises:
            IndexError: if one has not ended an episode in the same step yet.
        """
        return self._batch.last_observations(indices.astype(np.int64, copy=False))

    def charge(self, index: int, evaluations: int = 0, replans: int = 0) -> None:
        """Charge planning to the episode of environment ``index``: counted in its info."""
        self._batch.charge(index, evaluations, replans)

    def frame(self, index: int) -> npt.NDArray[np.uint8] | None:
        """A picture of environment ``index``, (height, width, 3) uint8."""
        if self.render_mode is None:
            gymnasium.logger.warn("render() does nothing without a render_mode, see make_vec")
            return None
        if index not in self._viewers:
            from auvgym.rendering import Viewer

            self._viewers[index] = Viewer(self.render_mode)
        member = self.members[index]
        episode = member.episode
        plan = episode.plan if member.plan is None else member.plan
        frame: npt.NDArray[np.uint8] = self._viewers[index].frame(member.world, episode, plan)
        return frame

    def render(self) -> tuple[Any, ...] | None:
        """A picture of each environment, or None without a ``render_mode``."""
        frames = tuple(
            self.frame(index) for index in range(self.num_envs if self.render_mode else 1)
        )
        return frames if self.render_mode else None

    def call(self, name: str, *args: Any, **kwargs: Any) -> tuple[Any, ...]:
        """The attribute ``name`` of every environment, called if it is a method."""
        found = [getattr(member, name) for member in self.members]
        return tuple(each(*args, **kwargs) if callable(each) else each for each in found)

    def get_attr(self, name: str) -> tuple[Any, ...]:
        """The attribute ``name`` of every environment."""
        return tuple(getattr(member, name) for member in self.members)

    def set_attr(self, name: str, values: Any) -> None:
        """Set the attribute ``name`` of every environment: one value, or a list of one each."""
        if not isinstance(values, (list, tuple)):
            values = [values] * self.num_envs
        if len(values) != self.num_envs:
            raise ValueError(f"values has {len(values)} entries: must have {self.num_envs}")
        for member, value in zip(self.members, values, strict=True):
            setattr(member, name, value)

    def close_extras(self, **kwargs: Any) -> None:
        """Close the pictures."""
        for viewer in self._viewers.values():
            viewer.close()
        self._viewers = {}

    def __getstate__(self) -> dict[str, Any]:
        # Threads and windows belong to their process; episodes go along.
        episodes = [self._batch.episode(i) for i in range(self.num_envs)] if self._running else []
        return {**self.__dict__, "_batch": episodes, "_viewers": {}}

    def __setstate__(self, state: dict[str, Any]) -> None:
        episodes = state["_batch"]
        self.__dict__.update(state)
        self._batch = self._make_batch()
        for index, episode in enumerate(episodes):
            self._batch.replace(index, episode)


def _count(name: str, value: int) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or value < 1:
        raise ValueError(f"{name} = {value!r}: must be an integer, 1 or more")
    return value


def _for_each(value: Any, count: int, name: str, step: int) -> list[int | None]:
    """One integer or None for each environment: a number counted up by ``step``, or a sequence."""
    if value is None:
        return [None] * count
    if isinstance(value, (int, np.integer)):
        return [int(value) + step * i for i in range(count)]
    values = list(value)
    if len(values) != count:
        raise ValueError(f"{name} has {len(values)} entries: must have num_envs = {count}")
    return [None if entry is None else check_seed(entry, name) for entry in values]


def _mask(mask: Any, count: int) -> Flags:
    """Whose episodes begin."""
    if mask is None:
        return np.ones(count, np.bool_)
    if not (isinstance(mask, np.ndarray) and mask.dtype == np.bool_ and mask.shape == (count,)):
        raise ValueError(f"reset_mask = {mask!r}: must be a bool array of shape ({count},)")
    if not mask.any():
        raise ValueError("reset_mask: must be true somewhere")
    return np.ascontiguousarray(mask)
