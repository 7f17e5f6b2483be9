"""From a configuration to a model of Stable-Baselines3: which hyperparameter goes where."""

from __future__ import annotations

import inspect
from pathlib import Path
from typing import Any

import auvgym.sb3  # first: it says what to install
from auvgym._extras import require
from auvgym._names import unknown
from auvgym.evaluation.seeds import training_seed
from auvgym.training.config import STRIDE, TrainingConfig, TrainingError
from auvgym.training.mixture import MixedVecEnv
from auvgym.training.stride import LONGEST, SHORTEST, StrideVecEnv

#: Algorithm -> where its class is.
CLASSES = {
    "ppo": ("stable_baselines3", "PPO"),
    "recurrent-ppo": ("sb3_contrib", "RecurrentPPO"),
    "sac": ("stable_baselines3", "SAC"),
    "tqc": ("sb3_contrib", "TQC"),
    "dqn": ("stable_baselines3", "DQN"),
}
#: Hyperparameters that are this package's own.
OWN = ("policy", "n_envs", "mixture", "normalize", "action_bias", *STRIDE)
NORMALIZE = {
    None: None,
    "observations": {"norm_obs": True, "norm_reward": False},
    "rewards": {"norm_obs": False, "norm_reward": True},
    "both": {"norm_obs": True, "norm_reward": True},
}
ACTIVATIONS = {"tanh": "Tanh", "relu": "ReLU", "elu": "ELU", "silu": "SiLU"}
_LINEAR = "lin_"
# Arguments of the classes that are set here, or are no numbers that a recipe could hold.
_NOT_RECIPES = {
    *("self", "policy", "env", "seed", "device", "verbose", "policy_kwargs", "tensorboard_log"),
    *("observation_space", "action_space", "lr_schedule", "action_noise", "stats_window_size"),
    *("replay_buffer_class", "replay_buffer_kwargs", "rollout_buffer_class"),
    *("rollout_buffer_kwargs", "features_extractor_class", "features_extractor_kwargs"),
    *("optimizer_class", "normalize_images", "_init_setup_model"),
}


def algorithm_class(algorithm: str) -> Any:
    """The class of Stable-Baselines3 (contrib).

    Raises:
        ImportError: without the extra ``train``.
    """
    module, name = CLASSES[algorithm]
    return getattr(require(module, "train"), name)


def make_envs(config: TrainingConfig, statistics: Path | None, flown: int = 0) -> Any:
    """The environments to train in, normalised if the configuration says so.

    Args:
        config: the training.
        statistics: file of the normalisation to go on with.
        flown: legs that the training has flown.
    """
    envs = plain_envs(config, flown)
    chosen = config.hyperparameters.get("normalize")
    if chosen not in NORMALIZE:
        names = [str(name) for name in NORMALIZE]
        raise TrainingError(unknown("normalize", chosen, names))
    kinds = NORMALIZE[chosen]
    if kinds is None:
        return envs
    normalize = require("stable_baselines3.common.vec_env", "train").VecNormalize
    if statistics is not None:
        return normalize.load(str(statistics), envs)
    gamma = config.hyperparameters.get("gamma", 0.99)
    return normalize(envs, gamma=gamma, **kinds)


def plain_envs(config: TrainingConfig, flown: int = 0) -> Any:
    """The environments themselves, shared out among the entries of ``mixture`` if there is one."""
    mixture = config.hyperparameters.get("mixture") or [{}]
    listed = isinstance(mixture, list) and all(isinstance(one, dict) for one in mixture)
    if not listed or len(mixture) > config.n_envs:
        raise TrainingError(
            f"mixture = {mixture!r}: must be a list of settings, no more than n_envs, as "
            '[{"difficulty": "normal"}, {"difficulty": "hard"}]'
        )
    try:
        parts = [
            auvgym.sb3.make_vec_env(
                config.environment,
                n_envs=config.n_envs // len(mixture) + (index < config.n_envs % len(mixture)),
                info_keywords=("is_success",),
                env_kwargs={**config.settings, **settings},
            )
            for index, settings in enumerate(mixture)
        ]
    except TypeError as error:  # a setting that the environment does not have
        raise TrainingError(f"{config.environment}: {error}") from error
    envs = parts[0] if len(parts) == 1 else MixedVecEnv(parts)
    least, share = config.least_waypoint, config.least_waypoint_from
    if least is None:
        return envs
    if hasattr(envs.action_space, "n"):
        raise TrainingError(f"least_waypoint = {least}: there are no waypoints to choose here")
    if not SHORTEST < least <= LONGEST:
        raise TrainingError(
            f"least_waypoint = {least}: must be reaches, more than 0 and at most {LONGEST}"
        )
    return StrideVecEnv(envs, least, round(share * config.timesteps) - flown)


def make_model(config: TrainingConfig, envs: Any) -> Any:
    """A fresh model.

    Raises:
        TrainingError: an unknown hyperparameter, or one that the algorithm refuses.
    """
    algorithm = algorithm_class(config.algorithm)
    _check_actions(algorithm, config, envs.action_space)
    ours, theirs, policys = sorted_hyperparameters(config, algorithm)
    try:
        model = algorithm(
            ours["policy"], envs, seed=config.seed, device="cpu", policy_kwargs=policys, **theirs
        )
    except (AssertionError, TypeError, ValueError) as error:
        raise TrainingError(f"{config.algorithm} refuses its hyperparameters: {error}") from error
    if ours.get("action_bias"):
        _bias(model, ours["action_bias"])
    return model


def seed_envs(envs: Any, config: TrainingConfig, part: int) -> None:
    """Seed the environments out of the range for training.

    After the model is made: that seeds them, too, with the model's own seed.
    """
    envs.seed(training_seed(config.seed, part))


def sorted_hyperparameters(
    config: TrainingConfig, algorithm: Any
) -> tuple[dict[str, Any], dict[str, Any], dict[str, Any]]:
    """Hyperparameters apart: this package's, the algorithm's, its policy's.

    Raises:
        TrainingError: one that nobody has, or a value that is none.
    """
    given = dict(config.hyperparameters)
    policy_name = given.get("policy", "MlpPolicy")
    if policy_name not in algorithm.policy_aliases:
        raise TrainingError(unknown("policy", policy_name, algorithm.policy_aliases))
    policy = algorithm.policy_aliases[policy_name]
    for_algorithm = _arguments(algorithm)
    for_policy = _arguments(policy)
    ours: dict[str, Any] = {"policy": policy_name}
    theirs: dict[str, Any] = {}
    policys: dict[str, Any] = {}
    for name, value in given.items():
        if name in OWN:
            ours[name] = value
        elif name in for_algorithm:
            theirs[name] = _schedule(name, value)
        elif name in for_policy:
            policys[name] = _activation(value) if name == "activation_fn" else value
        else:
            known = [*OWN, *for_algorithm, *for_policy]
            raise TrainingError(unknown(f"hyperparameter of {config.algorithm}", name, known))
    return ours, theirs, policys


def _arguments(maker: Any) -> list[str]:
    names = inspect.signature(maker.__init__).parameters
    return [name for name in names if name not in _NOT_RECIPES]


def _schedule(name: str, value: Any) -> Any:
    """``lin_0.001``: from there to 0, linearly over the training."""
    if not (isinstance(value, str) and value.startswith(_LINEAR)):
        return value
    try:
        start = float(value.removeprefix(_LINEAR))
    except ValueError:
        raise TrainingError(f'{name} = "{value}": a schedule is written lin_0.001') from None
    return require("stable_baselines3.common.utils", "train").LinearSchedule(start, 0.0, 1.0)


def _activation(value: Any) -> Any:
    if value not in ACTIVATIONS:
        raise TrainingError(unknown("activation_fn", value, ACTIVATIONS))
    return getattr(require("torch", "train").nn, ACTIVATIONS[value])


def _check_actions(algorithm: Any, config: TrainingConfig, space: Any) -> None:
    """Say it in our words before Stable-Baselines3 asserts it in its own."""
    discrete = type(space).__name__ == "Discrete"
    if config.algorithm == "dqn" and not discrete:
        raise TrainingError(
            'dqn needs discrete actions: train it with action_mode="replan" '
            "(--env-set action_mode=replan), or take ppo, sac or tqc"
        )
    if config.algorithm in ("sac", "tqc") and discrete:
        raise TrainingError(f"{config.algorithm} needs continuous actions: take ppo or dqn")


def _bias(model: Any, bias: Any) -> None:
    """Start the output of the policy's last layer at ``bias``, for its first entries."""
    layer = getattr(model.policy, "action_net", None)
    values = bias if isinstance(bias, list) else [bias]
    if layer is None or len(values) > len(layer.bias):
        raise TrainingError(
            f"action_bias = {bias!r}: needs a policy with an action_net of at least so many outputs"
        )
    torch = require("torch", "train")
    with torch.no_grad():
        layer.bias[: len(values)] = torch.tensor(values, dtype=layer.bias.dtype)
