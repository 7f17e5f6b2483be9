"""Trained agents from files: ONNX with a card, and Stable-Baselines3 archives."""

from __future__ import annotations

import hashlib
import json
import warnings
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from auvgym._extras import require
from auvgym.policies.base import Action, Knows, Observation, PolicyError

CARD_SCHEMA = 1
# Where the class of an archive's policy lives -> the algorithm that made it, as SB3 files them.
_ALGORITHMS = {
    "stable_baselines3.common.policies": ("stable_baselines3", "PPO"),
    "stable_baselines3.sac.policies": ("stable_baselines3", "SAC"),
    "stable_baselines3.td3.policies": ("stable_baselines3", "TD3"),
    "stable_baselines3.dqn.policies": ("stable_baselines3", "DQN"),
    "sb3_contrib.tqc.policies": ("sb3_contrib", "TQC"),
}


class CodeWarning(UserWarning):
    """A file that runs code of its author when it is read."""


class _Agent:
    """What agents share: they see observations only.

    Attributes:
        name: the file's path, as it was given.
    """

    knows: Knows = "sensors"

    def __init__(self, path: str, seed: int, sha256: str | None) -> None:
        self.name = path
        self.seed = seed
        found = file_hash(path)
        if sha256 is not None and found != sha256:
            raise PolicyError(
                f'policy "{path}": the file has hash {found}, {sha256} is asked for; it has changed'
            )

    def reset(self, observation: Observation, info: dict[str, Any]) -> None:
        """Nothing is remembered."""


class OnnxPolicy(_Agent):
    """An agent in an ONNX file: (1, n) float32 observations in, (1, d) actions out.

    An action is float32, clipped to [-1, 1], or int64 where actions are discrete. An agent that
    remembers has further float32 inputs (1, k) and as many outputs after the action: zeros go in
    where an episode begins, then what came out.

    Beside ``agent.onnx`` lies its card ``agent.json``: an object with ``schema`` (1), ``name``,
    ``environment`` (a Gymnasium id, or a list of them) and whatever else is worth knowing. The file
    is data: reading and running it runs nobody's code.

    Args:
        path: of the ONNX file.
        seed: unused; an agent is a function of its observation.
        sha256: of the ONNX file (16 hex digits), to be held to.

    Raises:
        PolicyError: a file or card that is missing, or not what it should be.
        ImportError: without onnxruntime (extra ``agents``).
    """

    def __init__(self, path: str, seed: int = 0, sha256: str | None = None) -> None:
        super().__init__(path, seed, sha256)
        self.card = read_card(path)
        runtime = require("onnxruntime", "agents")
        options = runtime.SessionOptions()
        # One thread: many small agents fly at once, and sums keep their order.
        options.intra_op_num_threads = options.inter_op_num_threads = 1
        options.log_severity_level = 3
        try:
            self._session = runtime.InferenceSession(
                path, options, providers=["CPUExecutionProvider"]
            )
        except Exception as error:  # onnxruntime's own errors derive from nothing narrower
            raise PolicyError(f'policy "{path}": is not an ONNX model ({error})') from error
        inputs, outputs = self._session.get_inputs(), self._session.get_outputs()
        memory = inputs[1:]
        if (
            any(one.type != "tensor(float)" for one in inputs)
            or len(outputs) < 1 + len(memory)
            or not all(isinstance(one.shape[-1], int) for one in memory)
        ):
            raise PolicyError(
                f'policy "{path}": the model takes {[(one.name, one.type) for one in inputs]}; '
                "float32 observations (1, n) are needed, and what it remembers (1, k) if an output "
                "follows the action for each"
            )
        self._input, self._entries = inputs[0].name, inputs[0].shape[-1]
        self._widths = {one.name: int(one.shape[-1]) for one in memory}
        self._outputs = [one.name for one in outputs[: 1 + len(memory)]]
        self.begin()

    def reset(self, observation: Observation, info: dict[str, Any]) -> None:
        """Forget the last episode."""
        self.begin()

    def begin(self) -> None:
        """Remember nothing."""
        self._memory = {
            name: np.zeros((1, width), np.float32) for name, width in self._widths.items()
        }

    def act(self, observation: Observation, info: dict[str, Any]) -> Action | int:
        """The action: (d,) float32, or a number where actions are discrete."""
        if isinstance(self._entries, int) and len(observation) != self._entries:
            raise PolicyError(
                f'policy "{self.name}": the model takes {self._entries} entries, this environment '
                f"has {len(observation)}; its card says {self.card['environment']!r}"
            )
        given = np.asarray(observation, dtype=np.float32)[None]
        action, *remembered = self._session.run(self._outputs, {self._input: given, **self._memory})
        self._memory = dict(zip(self._widths, remembered, strict=True))
        if action.dtype.kind == "i":
            return int(action.reshape(-1)[0])
        return np.clip(np.asarray(action, dtype=np.float32).reshape(-1), -1.0, 1.0)


class Sb3Policy(_Agent):
    """An agent of Stable-Baselines3, its archive as ``model.save`` writes it.

    **Reading the archive runs code**: it holds pickled Python objects. Read only archives of people
    whose programs you would run; an ONNX file with its card has no such risk.

    Args:
        path: of the zip archive.
        seed: of the draws where ``deterministic`` is false.
        sha256: of the archive (16 hex digits), to be held to.
        algorithm: ``"PPO"``, ``"SAC"``, ...; by default what the archive's policy says.
        deterministic: take the likeliest action.

    Raises:
        PolicyError: a file that is no such archive, or of an unknown algorithm.
        ImportError: without stable-baselines3 (extra ``train``).
    """

    def __init__(
        self,
        path: str,
        seed: int = 0,
        sha256: str | None = None,
        algorithm: str | None = None,
        deterministic: bool = True,
    ) -> None:
        super().__init__(path, seed, sha256)
        module, found = _algorithm(path)
        warnings.warn(
            f"{path}: reading a Stable-Baselines3 archive runs code from it", CodeWarning, 3
        )
        maker = getattr(require(module, "train"), algorithm or found, None)
        if maker is None:
            raise PolicyError(f'policy "{path}": {module} has no algorithm "{algorithm}"')
        self._model = maker.load(path, device="cpu")
        self._deterministic = deterministic

    def reset(self, observation: Observation, info: dict[str, Any]) -> None:
        """Begin the draws of a stochastic policy anew, for this episode alone."""
        if not self._deterministic:
            self._model.set_random_seed((self.seed + int(info["episode_seed"])) % 2**31)

    def act(self, observation: Observation, info: dict[str, Any]) -> Action | int:
        """The action: (d,) float32, or a number where actions are discrete."""
        action, _ = self._model.predict(observation, deterministic=self._deterministic)
        if np.asarray(action).dtype.kind == "i":
            return int(action)
        return np.clip(np.asarray(action, dtype=np.float32).reshape(-1), -1.0, 1.0)


#: Ending of a file -> the policy that reads it.
AGENTS: dict[str, type[OnnxPolicy] | type[Sb3Policy]] = {".onnx": OnnxPolicy, ".zip": Sb3Policy}


def file_hash(path: str) -> str:
    """The first 16 hex digits of a file's SHA-256.

    Raises:
        PolicyError: it cannot be read.
    """
    try:
        return hashlib.sha256(Path(path).read_bytes()).hexdigest()[:16]
    except OSError as error:
        raise PolicyError(f'policy "{path}": cannot be read ({error})') from error


def read_card(path: str) -> dict[str, Any]:
    """The card beside an ONNX file.

    Raises:
        PolicyError: there is none, or it lacks what a card says.
    """
    card_path = Path(path).with_suffix(".json")
    try:
        card = json.loads(card_path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise PolicyError(
            f'policy "{path}": its card {card_path} cannot be read ({error}); it is a JSON object '
            'like {"schema": 1, "name": "my agent", "environment": "AUVDynamic2D-v0"}'
        ) from error
    if not isinstance(card, dict):
        raise PolicyError(f"{card_path}: is not a JSON object")
    if card.get("schema") != CARD_SCHEMA:
        raise PolicyError(f"{card_path}: schema is {card.get('schema')!r}; {CARD_SCHEMA} is read")
    for key in ("name", "environment"):
        if not card.get(key):
            raise PolicyError(f"{card_path}: {key} is missing")
    return card


def _algorithm(path: str) -> tuple[str, str]:
    """The module and class that made an archive, from its plain part; nothing is unpickled."""
    try:
        with zipfile.ZipFile(path) as archive:
            data = json.loads(archive.read("data"))
        module = str(data["policy_class"]["__module__"])
    except (OSError, KeyError, TypeError, ValueError, zipfile.BadZipFile) as error:
        raise PolicyError(
            f'policy "{path}": is not a Stable-Baselines3 archive ({error})'
        ) from error
    if module not in _ALGORITHMS:
        raise PolicyError(f'policy "{path}": policies of {module} are not known')
    return _ALGORITHMS[module]
