"""Running a training: from a configuration to a folder with an agent in it."""

from __future__ import annotations

import platform
import shlex
import sys
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from auvgym._extras import require
from auvgym.evaluation.seeds import seeds_of
from auvgym.training.config import STRIDE, TrainingConfig, TrainingError
from auvgym.training.curve import Curve, Row
from auvgym.training.folder import TrainingFolder

if TYPE_CHECKING:
    from auvgym.training.callbacks import OnProgress, OnRow

_LIBRARIES = (
    *("auvgym", "stable_baselines3", "sb3_contrib", "torch", "onnx", "onnxruntime"),
    *("gymnasium", "numpy"),
)


@dataclass(frozen=True)
class TrainingResult:
    """What came of a training.

    Attributes:
        folder: where everything is.
        best: the row of the learning curve whose network is kept.
        timesteps: legs flown.
        seconds: wall clock, validation included.
    """

    folder: Path
    best: Row
    timesteps: int
    seconds: float


def train(
    config: TrainingConfig,
    folder: str | Path,
    *,
    resume: bool = False,
    fresh: bool = False,
    on_progress: OnProgress = lambda done, total: None,
    on_row: OnRow = lambda row: None,
    command: str | None = None,
) -> TrainingResult:
    """Train an agent, look at the validation seeds meanwhile, keep the best, write it as ONNX.

    ``KeyboardInterrupt`` saves what there is and is raised again; ``resume`` goes on from there.
    What goes on flies other episodes than an uninterrupted training would.

    Args:
        config: what is trained. With ``resume`` all but ``timesteps``, ``validation_episodes`` and
            the hyperparameters ``least_waypoint`` and ``least_waypoint_from`` must be what it was.
        folder: where it goes (docs/training.md lists the files).
        resume: go on with the training in ``folder``.
        fresh: remove the training in ``folder`` first.
        on_progress: called with legs done and legs in all, often.
        on_row: called with each new row of the learning curve.
        command: the command line for the card; by default this program's.

    Raises:
        TrainingError: a value that is not allowed, a folder in use, nothing to go on with.
        ImportError: without the extra ``train``.
    """
    require("stable_baselines3", "train")
    place = TrainingFolder(Path(folder))
    if resume:
        state = _resumed(config, place)
    else:
        state = {"timesteps": 0, "seconds": 0.0, "parts": 0, "commands": []}
        if fresh:
            place.clear()
        place.begin()
    torch = require("torch", "train")
    threads = torch.get_num_threads()
    torch.set_num_threads(config.torch_threads)
    try:
        return _Run(config, place, state, command).run(on_progress, on_row)
    finally:
        torch.set_num_threads(threads)


def _resumed(config: TrainingConfig, place: TrainingFolder) -> dict[str, Any]:
    state = place.read_state()
    before = TrainingConfig.load(place.config)
    kept = {key: value for key, value in before.hyperparameters.items() if key not in STRIDE}
    given = {key: value for key, value in config.hyperparameters.items() if key in STRIDE}
    same = replace(
        before,
        timesteps=config.timesteps,
        validation_episodes=config.validation_episodes,
        hyperparameters=kept | given,
    )
    if config != same:
        raise TrainingError(
            f"{place.config} describes another training; --resume goes on with the same, and only "
            f"--timesteps, --validation-episodes, {' and '.join(STRIDE)} may change"
        )
    if state["timesteps"] >= config.timesteps:
        raise TrainingError(
            f"{place.path} has flown its {state['timesteps']} timesteps: give more with --timesteps"
        )
    return state


class _Run:
    """One part of a training, from its begin or from where it was stopped to its end or a stop."""

    def __init__(
        self,
        config: TrainingConfig,
        place: TrainingFolder,
        state: dict[str, Any],
        command: str | None,
    ) -> None:
        self.config, self.place = config, place
        self.state = {
            **state,
            "parts": state["parts"] + 1,
            "commands": [*state["commands"], _command() if command is None else command],
            "versions": versions(),
        }
        self.part = int(state["parts"])
        self._begin, self._before = time.monotonic(), float(state["seconds"])

    def seconds(self) -> float:
        """Wall clock of all parts so far."""
        return self._before + time.monotonic() - self._begin

    def run(self, on_progress: OnProgress, on_row: OnRow) -> TrainingResult:
        # All that is needed at the end, too: what is missing is missing now, not in an hour.
        from auvgym.training.callbacks import Progress, Validation
        from auvgym.training.card import write_agent
        from auvgym.training.flights import Examination

        config, place = self.config, self.place
        curve = Curve(place.curve, self.state["timesteps"] if self.part else None)
        # Made first: a setting that the environment refuses ends it before anything is written.
        examination = Examination(
            config.environment, seeds_of("validation", config.validation_episodes), config.settings
        )
        model = self._model()
        config.save(place.config)
        validation = Validation(
            examination,
            config.validate_every,
            curve,
            self.seconds,
            lambda best: self._keep(model, best),
            on_row,
            config.least_waypoint,
        )
        left = config.timesteps - model.num_timesteps
        try:
            model.learn(
                left,
                callback=[Progress(on_progress, config.timesteps), validation],
                reset_num_timesteps=self.part == 0,
                log_interval=1 if hasattr(model, "rollout_buffer") else 100,
            )
        finally:
            self._keep(model, best=False)
            self._keep_replay_buffer(model)
            if curve.best is not None:
                write_agent(place, config, self.state, curve)
        assert curve.best is not None  # the end of learning looks, too
        return TrainingResult(place.path, curve.best, model.num_timesteps, self.seconds())

    def _model(self) -> Any:
        from auvgym.training import models

        config, place = self.config, self.place
        statistics = place.statistics_of("last") if self.part else None
        envs = models.make_envs(config, statistics, self.state["timesteps"])
        if self.part:
            maker = models.algorithm_class(config.algorithm)
            model = maker.load(place.model("last"), env=envs, device="cpu")
            if place.replay_buffer.is_file():
                model.load_replay_buffer(place.replay_buffer)
            model.set_random_seed(config.seed + self.part)
        else:
            model = models.make_model(config, envs)
        models.seed_envs(envs, config, self.part)
        logger = require("stable_baselines3.common.logger", "train")
        require("tensorboard", "train")
        model.set_logger(logger.configure(str(place.tensorboard), ["tensorboard"]))
        return model

    def _keep(self, model: Any, best: bool) -> None:
        if best:
            self.place.save_model("best", model)
        self.place.save_model("last", model)
        self.state |= {"timesteps": int(model.num_timesteps), "seconds": round(self.seconds(), 1)}
        self.place.write_state(self.state)

    def _keep_replay_buffer(self, model: Any) -> None:
        """Only of a training that was stopped: it is large."""
        self.place.replay_buffer.unlink(missing_ok=True)
        stopped = model.num_timesteps < self.config.timesteps
        if stopped and hasattr(model, "save_replay_buffer"):
            model.save_replay_buffer(self.place.replay_buffer)


def _command() -> str:
    """The program's command line, without where it is installed."""
    return shlex.join([Path(sys.argv[0]).name, *sys.argv[1:]])


def versions() -> dict[str, str]:
    """Versions of what a training rests on."""
    found = {name: str(require(name, "train").__version__) for name in _LIBRARIES}
    return {**found, "python": platform.python_version()}
