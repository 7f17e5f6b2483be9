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
        rows = self.envs.rows(np.arange(self.num_envs))
        begun = zip(rows, infos["episode_seed"].tolist(), strict=True)
        self.reset_infos = [{**row, "episode_seed": seed} for row, seed in begun]
        return observations

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
            self._end(over, seeds, infos)
        return observations, rewards.astype(np.float32), ended, infos

    def _end(
        self,
        over: npt.NDArray[np.intp],
        seeds: npt.NDArray[np.uint64],
        infos: list[dict[str, Any]],
    ) -> None:
        """Fill in the infos of the episodes that have just ended; their sums begin anew."""
        elapsed = round(time.time() - self._start, 6)
        sums = zip(self._returns[over].tolist(), self._lengths[over].tolist(), strict=True)
        self._returns[over], self._lengths[over] = 0.0, 0
        looks, seeds_used = self.envs.last_observations(over), seeds[over].tolist()
        ends, begins = self.envs.rows(over, last=True), self.envs.rows(over)
        for at, (index, (reward, length)) in enumerate(zip(over.tolist(), sums, strict=True)):
            chosen = {key: ends[at][key] for key in self._info_keywords}
            episode = {"r": round(reward, 6), "l": length, "t": elapsed, **chosen}
            if self._writer is not None:
                self._writer.write_row(episode)
            infos[index] = {
                **ends[at],
                "episode": episode,
                "terminal_observation": looks[at],
                "TimeLimit.truncated": False,
            }
            self.reset_infos[index] = {**begins[at], "episode_seed": seeds_used[at]}

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
