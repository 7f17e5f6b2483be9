"""Stable-Baselines3 on the engine's batch (extra ``train``).

::

    from stable_baselines3 import PPO

    envs = auvgym.sb3.make_vec_env("AUVDynamic3D-v0", n_envs=128, seed=0)
    PPO("MlpPolicy", envs).learn(1_000_000)
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium.vector import AutoresetMode

from auvgym._extras import require
from auvgym.vector import AUVVectorEnv, Member

require("stable_baselines3", "train")

from stable_baselines3.common.monitor import Monitor, ResultsWriter  # noqa: E402
from stable_baselines3.common.vec_env import VecEnv, VecMonitor  # noqa: E402

Indices = int | Iterable[int] | None


def make_vec_env(
    env_id: str,
    n_envs: int = 1,
    seed: int | None = None,
    *,
    threads: int | None = None,
    monitor_dir: str | Path | None = None,
    info_keywords: Sequence[str] = (),
    env_kwargs: dict[str, Any] | None = None,
    **settings: Any,
) -> AUVVecEnv:
    """Many environments as a Stable-Baselines3 ``VecEnv``, stepped together on all cores.

    It keeps the books of SB3's ``Monitor`` itself; ``VecNormalize`` and the other wrappers go on
    top as usual.

    Args:
        env_id: a registered id, as ``"AUVDynamic3D-v0"``.
        n_envs: how many.
        seed: environment i is seeded with seed + i; None: anyhow.
        threads: how many to use; None: as many as there are cores for this process.
        monitor_dir: where to write ``monitor.csv``, a line for each episode; None: nowhere.
        info_keywords: keys of ``info`` that go into an episode's line, as ``("is_success",)``.
        env_kwargs: settings of the environment, as SB3's own ``make_vec_env`` takes them.
        **settings: the same.

    Raises:
        ImportError: if Stable-Baselines3 is not installed.
        TypeError, ValueError: as ``gymnasium.make_vec``.
    """
    envs = gymnasium.make_vec(
        env_id,
        num_envs=n_envs,
        autoreset_mode=AutoresetMode.SAME_STEP,
        threads=threads,
        **{**(env_kwargs or {}), **settings},
    )
    if not isinstance(envs.unwrapped, AUVVectorEnv):
        raise TypeError(f"{env_id} is no environment of auvgym: use SB3's own make_vec_env")
    vec_env = AUVVecEnv(envs.unwrapped, monitor_dir, info_keywords)
    vec_env.seed(seed)
    return vec_env


class AUVVecEnv(VecEnv):  # type: ignore[misc]  # SB3 is not looked into
    """A batch in Stable-Baselines3's manner.

    ``infos[i]`` is empty but for the step that ends an episode; then it has everything that is
    measured, ``episode`` (return ``r``, length ``l``, seconds ``t`` since the start and the
    ``info_keywords``), ``terminal_observation`` and ``TimeLimit.truncated`` (False: time left is
    observed, so running out of it is an end). ``get_attr("episode")`` looks at the others.

    Args:
        envs: a batch that begins anew in the same step.
        monitor_dir: where to write ``monitor.csv``; None: nowhere.
        info_keywords: keys of ``info`` that go into an episode's line.
    """

    def __init__(
        self,
        envs: AUVVectorEnv,
        monitor_dir: str | Path | None = None,
        info_keywords: Sequence[str] = (),
    ) -> None:
        if envs.autoreset_mode is not AutoresetMode.SAME_STEP:
            raise ValueError(f"autoreset_mode = {envs.autoreset_mode}: must be SAME_STEP")
        #: The batch, as Gymnasium has it.
        self.envs = envs
        super().__init__(envs.num_envs, envs.single_observation_space, envs.single_action_space)
        self.metadata = dict(envs.metadata)
        self._info_keywords = tuple(info_keywords)
        self._returns = np.zeros(envs.num_envs)
        self._lengths = np.zeros(envs.num_envs, np.int64)
        self._start = time.time()
        self._actions: npt.NDArray[Any] | None = None
        self._writer: Any = None
        if monitor_dir is not None:
            path = Path(monitor_dir)
            path.mkdir(parents=True, exist_ok=True)
            spec = envs.spec.id if envs.spec else None
            header = {"t_start": self._start, "env_id": spec}
            self._writer = ResultsWriter(
                str(path / "monitor.csv"), header=header, extra_keys=self._info_keywords
            )

    def reset(self) -> npt.NDArray[np.float32]:
        """Begin an episode in every environment; their infos are ``reset_infos``."""
        wanted = [options.pop("episode_seed", None) for options in self._options]
        for options in self._options:
            if options:
                raise ValueError(f"options = {options}: only episode_seed is known")
        some = [seed is not None for seed in wanted]
        options = {"episode_seed": wanted} if any(some) else None
        observations, infos = self.envs.reset(seed=self._seeds, options=options)
        self._reset_seeds()
        self._reset_options()
        self._returns[:], self._lengths[:] = 0.0, 0
        self.reset_infos = self._rows(infos, np.arange(self.num_envs))
        return observations

    @staticmethod
    def _rows(
        columns: dict[str, npt.NDArray[Any]], indices: npt.NDArray[np.intp]
    ) -> list[dict[str, Any]]:
        """The infos of some environments out of everybody's."""
        named = {name: column for name, column in columns.items() if not name.startswith("_")}
        values = zip(*(column[indices].tolist() for column in named.values()), strict=True)
        return [dict(zip(named, row, strict=True)) for row in values]

    def step_async(self, actions: npt.NDArray[Any]) -> None:
        """Take the actions, (n, d)."""
        self._actions = actions

    def step_wait(
        self,
    ) -> tuple[
        npt.NDArray[np.float32],
        npt.NDArray[np.float32],
        npt.NDArray[np.bool_],
        list[dict[str, Any]],
    ]:
        """Fly one leg in every environment.

        Raises:
            ActionError: as :meth:`AUVVectorEnv.step`.
        """
        actions, self._actions = self._actions, None
        if actions is None:
            raise RuntimeError("call step_async() first")
        observations, rewards, ended, _, seeds = self.envs.advance(actions)
        self._returns += rewards
        self._lengths += 1
        infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        over = ended.nonzero()[0]
        if over.size:
            ends = self._rows(self.envs.columns(last=True), over)
            begins = self._rows(self.envs.columns(), over)
            looks = self.envs.last_observations(over)
            for index, end, look, begin in zip(over.tolist(), ends, looks, begins, strict=True):
                infos[index] = self._ended(end, index, look)
                self.reset_infos[index] = {**begin, "episode_seed": int(seeds[index])}
        return observations, rewards.astype(np.float32), ended, infos

    def _ended(
        self, info: dict[str, Any], index: int, look: npt.NDArray[np.float32]
    ) -> dict[str, Any]:
        """The info of an episode that has just ended; its sums begin anew."""
        episode = {
            "r": round(float(self._returns[index]), 6),
            "l": int(self._lengths[index]),
            "t": round(time.time() - self._start, 6),
            **{key: info[key] for key in self._info_keywords},
        }
        self._returns[index], self._lengths[index] = 0.0, 0
        if self._writer is not None:
            self._writer.write_row(episode)
        return {
            **info,
            "episode": episode,
            "terminal_observation": look,
            "TimeLimit.truncated": False,
        }

    def close(self) -> None:
        """Close file and pictures."""
        if self._writer is not None:
            self._writer.close()
            self._writer = None
        self.envs.close()

    def _chosen(self, indices: Indices) -> list[Member]:
        return [self.envs.members[index] for index in self._get_indices(indices)]

    def get_attr(self, attr_name: str, indices: Indices = None) -> list[Any]:
        """The attribute of each environment (see :class:`auvgym.vector.Member`)."""
        return [getattr(member, attr_name) for member in self._chosen(indices)]

    def has_attr(self, attr_name: str) -> bool:
        """Whether the environments have the attribute."""
        return all(hasattr(member, attr_name) for member in self.envs.members)

    def set_attr(self, attr_name: str, value: Any, indices: Indices = None) -> None:
        """Set the attribute of each environment."""
        for member in self._chosen(indices):
            setattr(member, attr_name, value)

    def env_method(
        self, method_name: str, *method_args: Any, indices: Indices = None, **method_kwargs: Any
    ) -> list[Any]:
        """Call the method of each environment."""
        chosen = self._chosen(indices)
        return [getattr(member, method_name)(*method_args, **method_kwargs) for member in chosen]

    def env_is_wrapped(self, wrapper_class: type, indices: Indices = None) -> list[bool]:
        """Whether the environments are wrapped: this does what ``Monitor`` does."""
        monitored = issubclass(wrapper_class, (Monitor, VecMonitor))
        return [monitored for _ in self._chosen(indices)]

    def get_images(self) -> Sequence[npt.NDArray[np.uint8] | None]:
        """A picture of each environment."""
        if self.render_mode != "rgb_array":
            warnings.warn(f"render_mode = {self.render_mode!r}: no pictures", stacklevel=2)
            return [None] * self.num_envs
        return [self.envs.frame(index) for index in range(self.num_envs)]

    def __getstate__(self) -> dict[str, Any]:
        # The file stays with the original.
        return {**self.__dict__, "_writer": None}
