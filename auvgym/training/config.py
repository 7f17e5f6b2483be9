"""What a training is: everything that decides it, as plain data."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from auvgym._names import unknown
from auvgym.evaluation.suite import DEFAULT_DIFFICULTY
from auvgym.registration import ENVIRONMENTS
from auvgym.training.recipes import load_recipe

SCHEMA = 1
#: Up to these the seeds of trainings stay apart (:mod:`auvgym.evaluation.seeds`).
MAX_ENVS, MAX_SEED = 10_000, 2_000
#: Hyperparameters of waypoints that are moved away (:mod:`auvgym.training.stride`).
STRIDE = ("least_waypoint", "least_waypoint_from")
#: Settings that settle others: those are named by them, too.
_DECIDES = {"scenario": "difficulty", "planner": "planner_parameters"}


class TrainingError(ValueError):
    """A training that cannot be: names the value, and what was allowed."""


@dataclass(frozen=True)
class TrainingConfig:
    """Everything that decides a training; the file ``config.json`` of its folder.

    Attributes:
        algorithm: a name of :func:`auvgym.training.list_algorithms`.
        environment: a registered id.
        timesteps: legs to fly in all.
        settings: arguments of the environment, ``difficulty`` among them.
        hyperparameters: of the algorithm, its policy and the training (docs/training.md).
        seed: of networks, draws and episodes.
        validate_every: legs between two looks at the validation seeds.
        validation_episodes: how many of them.
        torch_threads: for the networks' arithmetic.
    """

    algorithm: str
    environment: str
    timesteps: int
    settings: dict[str, Any] = field(default_factory=dict)
    hyperparameters: dict[str, Any] = field(default_factory=dict)
    seed: int = 0
    validate_every: int = 100_000
    validation_episodes: int = 256
    torch_threads: int = 1

    def __post_init__(self) -> None:
        if self.environment not in ENVIRONMENTS:
            raise TrainingError(unknown("environment", self.environment, ENVIRONMENTS))
        _whole("timesteps", self.timesteps, 1, 10**12)
        _whole("seed", self.seed, 0, MAX_SEED)
        _whole("validate_every", self.validate_every, 1, 10**12)
        _whole("validation_episodes", self.validation_episodes, 1, 10_000)
        _whole("torch_threads", self.torch_threads, 1, 1024)
        _whole("n_envs", self.hyperparameters.get("n_envs"), 1, MAX_ENVS)

    @property
    def n_envs(self) -> int:
        """Environments that are flown at the same time."""
        return int(self.hyperparameters["n_envs"])

    @property
    def least_waypoint(self) -> float | None:
        """Shortest distance of a waypoint that an agent asks for, in reaches."""
        given = self.hyperparameters.get("least_waypoint")
        if given is not None and (isinstance(given, bool) or not isinstance(given, int | float)):
            raise TrainingError(f"least_waypoint = {given!r}: must be a number of reaches, as 0.2")
        return given

    @property
    def least_waypoint_from(self) -> float:
        """Share of the training's legs before ``least_waypoint`` holds where it explores."""
        given = self.hyperparameters.get("least_waypoint_from", 0)
        if isinstance(given, bool) or not isinstance(given, int | float) or not 0 <= given <= 1:
            raise TrainingError(f"least_waypoint_from = {given!r}: must be a share, 0 .. 1")
        return given

    @property
    def name(self) -> str:
        """``ppo-AUVDynamic2D-v0-normal``: what the folder is called unless told otherwise."""
        mode = self.settings.get("action_mode", "waypoint")
        parts = [self.algorithm, self.environment, self.settings.get("difficulty")]
        return "-".join(part for part in [*parts, mode if mode != "waypoint" else ""] if part)

    def save(self, path: Path) -> None:
        """Write it as JSON."""
        path.write_text(json.dumps({"schema": SCHEMA, **asdict(self)}, indent=2) + "\n")

    @classmethod
    def load(cls, path: Path) -> TrainingConfig:
        """Read what :meth:`save` wrote.

        Raises:
            TrainingError: the file is not such a one.
            OSError: it cannot be read.
        """
        try:
            data = json.loads(path.read_text(encoding="utf-8"))
            schema = data.pop("schema")
            if schema != SCHEMA:
                raise ValueError(f"schema is {schema!r}; {SCHEMA} is read")
            return cls(**data)
        except (ValueError, TypeError, KeyError, AttributeError) as error:
            raise TrainingError(
                f"{path}: is not the configuration of a training ({error})"
            ) from error


def configure(
    algorithm: str,
    environment: str,
    timesteps: float | None = None,
    *,
    settings: Mapping[str, Any] | None = None,
    hyperparameters: Mapping[str, Any] | None = None,
    **others: Any,
) -> TrainingConfig:
    """A training by the shipped recipe.

    A recipe's mixture is for trainings that name nothing of what it varies.

    Args:
        algorithm: a name of :func:`auvgym.training.list_algorithms`.
        environment: a registered id.
        timesteps: legs to fly; by default the recipe's.
        settings: arguments of the environment (``difficulty="normal"`` unless a scenario is given).
        hyperparameters: laid over the recipe's.
        **others: the other attributes of :class:`TrainingConfig`.

    Raises:
        TrainingError, ValueError: an unknown name or a value that is not allowed.
        ImportError: without the extra ``train``.
    """
    if environment not in ENVIRONMENTS:
        raise TrainingError(unknown("environment", environment, ENVIRONMENTS))
    chosen = dict(settings or {})
    mode = str(chosen.get("action_mode", "waypoint"))
    recipe = load_recipe(algorithm, environment, mode)
    varied = {key for one in recipe.get("mixture") or [] for key in one}
    if varied.intersection(_DECIDES.get(key, key) for key in chosen):
        del recipe["mixture"]
    if "scenario" not in chosen:
        chosen.setdefault("difficulty", DEFAULT_DIFFICULTY)
    recipe |= hyperparameters or {}
    recipe_timesteps = recipe.pop("timesteps")
    return TrainingConfig(
        algorithm,
        environment,
        whole_number("timesteps", recipe_timesteps if timesteps is None else timesteps),
        chosen,
        recipe,
        **others,
    )


def whole_number(name: str, value: float) -> int:
    """``2e6`` as 2000000.

    Raises:
        TrainingError: it is no whole number.
    """
    if isinstance(value, bool) or not isinstance(value, int | float) or value != value // 1:
        raise TrainingError(f"{name} = {value!r}: must be a whole number, as 500000 or 2e6")
    return int(value)


def _whole(name: str, value: Any, least: int, most: int) -> None:
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
        raise TrainingError(f"{name} = {value!r}: must be a whole number, {least} .. {most}")
