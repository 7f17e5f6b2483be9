"""The folder of a training: what is in it, and under which names."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from auvgym.training.config import TrainingError


@dataclass(frozen=True)
class TrainingFolder:
    """Where a training keeps what comes of it."""

    path: Path

    @property
    def config(self) -> Path:
        """What was trained: a :class:`TrainingConfig`."""
        return self.path / "config.json"

    @property
    def state(self) -> Path:
        """How far it is, and on what: legs, seconds, parts, command lines, versions."""
        return self.path / "state.json"

    @property
    def curve(self) -> Path:
        """The learning curve."""
        return self.path / "curve.csv"

    @property
    def tensorboard(self) -> Path:
        """TensorBoard's event files."""
        return self.path / "tensorboard"

    @property
    def onnx(self) -> Path:
        """The best network as ONNX; its card is beside it."""
        return self.path / "agent.onnx"

    def model(self, which: str) -> Path:
        """A model's archive: the ``"best"`` on the validation seeds, or the ``"last"``."""
        return self.path / {"best": "model.zip", "last": "last.zip"}[which]

    def statistics(self, which: str) -> Path:
        """The ``VecNormalize`` that goes with a model; there is none if nothing is normalised."""
        return self.path / {"best": "vecnormalize.pkl", "last": "last-vecnormalize.pkl"}[which]

    @property
    def replay_buffer(self) -> Path:
        """What an off-policy training that was stopped goes on with."""
        return self.path / "last-replay-buffer.pkl"

    @property
    def exists(self) -> bool:
        """Whether a training has been here."""
        return self.config.is_file()

    def clear(self) -> None:
        """Remove a training that has been here, and nothing else."""
        which = ("best", "last")
        files = [self.config, self.state, self.curve, self.onnx, self.replay_buffer]
        files += [self.onnx.with_suffix(".json")]
        files += [path for one in which for path in (self.model(one), self.statistics(one))]
        for file in files:
            file.unlink(missing_ok=True)
        shutil.rmtree(self.tensorboard, ignore_errors=True)

    def begin(self) -> None:
        """Make the folder.

        Raises:
            TrainingError: a training has been here.
        """
        if self.exists:
            raise TrainingError(
                f"{self.path} has a training already: go on with --resume, forget it with --fresh, "
                "or give another folder with --out"
            )
        self.path.mkdir(parents=True, exist_ok=True)

    def save_model(self, which: str, model: Any) -> None:
        """Write a model and its normalisation, each whole or not at all."""
        # Stable-Baselines3 chooses the class of the replay buffer anew, and takes the one that it
        # has chosen before for one's own, with a warning.
        _replace(self.model(which), lambda path: model.save(path, exclude=["replay_buffer_class"]))
        normalizer = model.get_vec_normalize_env()
        if normalizer is not None:
            _replace(self.statistics(which), lambda path: normalizer.save(str(path)))

    def statistics_of(self, which: str) -> Path | None:
        """The file of the normalisation, if there is one."""
        path = self.statistics(which)
        return path if path.is_file() else None

    def write_state(self, state: dict[str, Any]) -> None:
        """Write how far it is."""
        text = json.dumps(state, indent=2) + "\n"
        _replace(self.state, lambda path: path.write_text(text, encoding="utf-8"))

    def read_state(self) -> dict[str, Any]:
        """Read how far it is.

        Raises:
            TrainingError: there is nothing to go on with.
        """
        if not (self.exists and self.state.is_file() and self.model("last").is_file()):
            raise TrainingError(
                f"{self.path} has no training to go on with: {self.model('last').name} is missing"
            )
        state: dict[str, Any] = json.loads(self.state.read_text(encoding="utf-8"))
        return state


def _replace(path: Path, write: Callable[[Path], Any]) -> None:
    """Write beside the target and rename, so that an interrupt leaves the old file whole."""
    beside = path.with_name(f"new-{path.name}")
    write(beside)
    os.replace(beside, path)
