"""Where the time of PPO goes: Stable-Baselines3 on the native batch and on Gymnasium's Pendulum-v1.

The same networks, the same number of steps; only the environments differ. A step of an AUV
environment is a whole leg, some 40 ticks of physics; one of Pendulum-v1 is one tick. Shares are of
the wall clock: `environments` is stepping them (with SB3's bookkeeping), `acting` the rest of the
rollout (network, buffer), `learning` the gradient steps. Needs the extra `train`. As in `auvgym
train` torch's threads wait passively, which leaves their cores to the engine's.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Callable
from typing import Any

os.environ.setdefault("OMP_WAIT_POLICY", "PASSIVE")  # before torch reads it

import torch
from rich.console import Console
from rich.table import Table
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.env_util import make_vec_env

import auvgym

CORES = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class Clock:
    """Adds up how long some functions take."""

    def __init__(self) -> None:
        self.seconds = 0.0

    def wraps(self, function: Callable[..., Any]) -> Callable[..., Any]:
        def timed(*args: Any, **kwargs: Any) -> Any:
            began = time.perf_counter()
            try:
                return function(*args, **kwargs)
            finally:
                self.seconds += time.perf_counter() - began

        return timed


class FromSecondRollout(BaseCallback):
    """Begins to count when everything has run once."""

    def __init__(self, clocks: list[Clock]) -> None:
        super().__init__()
        self.clocks, self.rollouts = clocks, 0
        self.began = (0.0, 0.0, 0)

    def _on_rollout_start(self) -> None:
        if self.rollouts == 1:
            for clock in self.clocks:
                clock.seconds = 0.0
            self.began = (time.perf_counter(), time.process_time(), self.num_timesteps)
        self.rollouts += 1

    def _on_step(self) -> bool:
        return True


def make_envs(name: str, count: int, threads: int) -> Any:
    """The native batch for the environments of auvgym, SB3's own loop for the others."""
    if name in auvgym.registration.ENVIRONMENTS:
        return auvgym.sb3.make_vec_env(name, n_envs=count, seed=0, threads=threads)
    return make_vec_env(name, n_envs=count, seed=0)


def measure(name: str, options: argparse.Namespace, torch_threads: int) -> list[str]:
    """A row of the table."""
    torch.set_num_threads(torch_threads)
    envs = make_envs(name, options.envs, options.threads)
    stepping, learning = Clock(), Clock()
    envs.step = stepping.wraps(envs.step)
    model = PPO(
        "MlpPolicy",
        envs,
        n_steps=64,
        batch_size=1024,
        n_epochs=5,
        learning_rate=1e-3,
        policy_kwargs={"net_arch": options.layers, "log_std_init": -0.5},
        device="cpu",
        seed=0,
    )
    model.train = learning.wraps(model.train)
    count = FromSecondRollout([stepping, learning])
    model.learn((options.rollouts + 1) * 64 * options.envs, callback=count)
    wall, processor = time.perf_counter() - count.began[0], time.process_time() - count.began[1]
    steps = model.num_timesteps - count.began[2]
    envs.close()
    shares = [stepping.seconds, wall - stepping.seconds - learning.seconds, learning.seconds]
    rates = [
        f"{steps / wall:,.0f}",
        f"{steps / processor:,.0f}",
        f"{steps / stepping.seconds:,.0f}",
    ]
    return [name, str(torch_threads), *rates, *(f"{share / wall:.1%}" for share in shares)]


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    names = ["AUVDynamic2D-v0", "AUVDynamic3D-v0", "AUVHarbor2D-v0", "Pendulum-v1"]
    parser.add_argument("--env", nargs="+", default=names, help="any id (%(default)s)")
    parser.add_argument("--envs", type=int, default=128, help="at once (%(default)s)")
    parser.add_argument("--rollouts", type=int, default=6, help="of 64 steps each (%(default)s)")
    parser.add_argument(
        "--layers", type=int, nargs="+", default=[128, 128], help="of the networks (%(default)s)"
    )
    parser.add_argument("--threads", type=int, default=CORES, help="of the engine (%(default)s)")
    parser.add_argument(
        "--torch-threads", type=int, nargs="+", default=[1, 2], help="of the networks (%(default)s)"
    )
    options = parser.parse_args()
    table = Table(title=f"PPO, {options.envs} environments, {options.threads} engine threads")
    for column in [
        "environments",
        "torch threads",
        "steps/s",
        "steps/processor s",
        "stepping alone",
    ]:
        table.add_column(column, justify="left" if column == "environments" else "right")
    for share in ["environments", "acting", "learning"]:
        table.add_column(share, justify="right")
    for threads in options.torch_threads:
        for name in options.env:
            table.add_row(*measure(name, options, threads))
    Console(width=120).print(table)


if __name__ == "__main__":
    main()
