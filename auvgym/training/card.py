"""The card of a trained agent: what it is, and all that is needed to train it again."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Any

from auvgym.evaluation.seeds import SEEDS, seeds_of, training_seed
from auvgym.policies.agents import CARD_SCHEMA, file_hash
from auvgym.training.config import TrainingConfig
from auvgym.training.curve import Curve, Row
from auvgym.training.export import export_onnx
from auvgym.training.folder import TrainingFolder
from auvgym.training.models import algorithm_class


def write_agent(
    place: TrainingFolder, config: TrainingConfig, state: dict[str, Any], curve: Curve
) -> None:
    """Write the best network of a training as ``agent.onnx``, and its card ``agent.json``."""
    model = algorithm_class(config.algorithm).load(place.model("best"), device="cpu")
    statistics = place.statistics_of("best")
    normalizer = None if statistics is None else _read_statistics(statistics)
    difference = export_onnx(model, place.onnx, normalizer, config.least_waypoint)
    card = _card(config, state, curve) | {
        "sha256": file_hash(str(place.onnx)),
        "largest_difference_to_torch": difference,
    }
    text = json.dumps(card, indent=2) + "\n"
    place.onnx.with_suffix(".json").write_text(text, encoding="utf-8")


def _read_statistics(path: Any) -> Any:
    """A ``VecNormalize`` without environments, as it is needed to normalise."""
    import pickle

    with open(path, "rb") as file:
        return pickle.load(file)


def _card(config: TrainingConfig, state: dict[str, Any], curve: Curve) -> dict[str, Any]:
    best = curve.best
    difficulty = config.settings.get("difficulty", "")
    validation = seeds_of("validation", config.validation_episodes)
    return {
        "schema": CARD_SCHEMA,
        "name": config.name,
        "environment": config.environment,
        "difficulty": difficulty,
        "settings": config.settings,
        "algorithm": config.algorithm,
        "hyperparameters": config.hyperparameters,
        "seed": config.seed,
        "commands": state["commands"],
        "timesteps": state["timesteps"],
        "seconds": state["seconds"],
        "torch_threads": config.torch_threads,
        "versions": state["versions"],
        "seeds": {
            "training": [training_seed(config.seed), config.n_envs],
            "validation": [validation.start, len(validation)],
            "test": [SEEDS["test"].start, len(SEEDS["test"])],
        },
        "best": None if best is None else _point(best),
        "curve": [_point(row) for row in curve.rows],
    }


def _point(row: Row) -> dict[str, float]:
    return {
        name.rstrip("_"): round(value, 4) for name, value in asdict(row).items() if value == value
    }
