"""Stable-Baselines3 on the batch: what its own vectorised environments do, and faster."""

from __future__ import annotations

import copy
import pickle
import warnings
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # whatever its own dependencies have to say on import
    pytest.importorskip("stable_baselines3")
    import torch
    from stable_baselines3 import PPO, SAC
    from stable_baselines3.common.evaluation import evaluate_policy
    from stable_baselines3.common.monitor import Monitor, load_results
    from stable_baselines3.common.vec_env import DummyVecEnv, VecFrameStack, VecNormalize

    import auvgym.sb3

IDS = ["AUVDynamic2D-v0", "AUVThreat3D-v0"]
COUNT = 4
NET = {"net_arch": [8]}
HURRY = {"time_factor": 1.0}


def make(env_id: str = "AUVDynamic2D-v0", count: int = COUNT, **settings: Any) -> Any:
    return auvgym.sb3.make_vec_env(env_id, n_envs=count, **settings)


def theirs(env_id: str) -> DummyVecEnv:
    return DummyVecEnv([lambda: Monitor(gymnasium.make(env_id, **HURRY))] * COUNT)


def actions(envs: Any, step: int) -> Any:
    shape = (COUNT, *envs.action_space.shape)
    drawn = np.random.default_rng(step).uniform(-1, 1, shape)
    drawn[:, 0] = abs(drawn[:, 0])  # ahead, so that episodes end soon
    return drawn.astype(np.float32)


def told(info: dict[str, Any]) -> dict[str, Any]:
    """An info without the clock; observations as bytes."""
    episode = {key: value for key, value in info["episode"].items() if key != "t"}
    seen = info["terminal_observation"].tobytes()
    return {**info, "episode": episode, "terminal_observation": seen}


@pytest.fixture(autouse=True)
def one_thread() -> None:
    torch.set_num_threads(1)


@pytest.mark.parametrize("env_id", IDS)
def test_it_is_sb3s_own_vecenv_step_by_step(env_id: str) -> None:
    ours, expected = make(env_id, **HURRY), theirs(env_id)
    ours.seed(3), expected.seed(3)
    assert np.array_equal(ours.reset(), expected.reset())
    assert ours.reset_infos == expected.reset_infos
    ends = 0
    for step in range(60):
        one, other = ours.step(actions(ours, step)), expected.step(actions(ours, step))
        for left, right in zip(one[:3], other[:3], strict=True):
            assert left.dtype == right.dtype
            assert np.array_equal(left, right)
        for index in np.flatnonzero(one[2]):
            ends += 1
            assert told(one[3][index]) == told(other[3][index])
        assert ours.reset_infos == expected.reset_infos
    assert ends > 0


def test_running_environments_have_empty_infos() -> None:
    envs = make()
    envs.reset()
    assert envs.step(actions(envs, 0))[3] == [{}] * COUNT


def test_options_are_used_once() -> None:
    envs = make(seed=1)
    envs.set_options([{"episode_seed": 9}, {}, {}, {"episode_seed": 2}])
    envs.reset()
    first = [info["episode_seed"] for info in envs.reset_infos]
    assert (first[0], first[3]) == (9, 2)
    envs.reset()
    assert 9 not in [info["episode_seed"] for info in envs.reset_infos]
    envs.set_options({"nonsense": 1})
    with pytest.raises(ValueError, match="nonsense"):
        envs.reset()


def test_seeds() -> None:
    one, other, third = make(seed=5), make(seed=5), make(seed=6)
    first = one.reset()
    assert np.array_equal(first, other.reset())
    assert np.array_equal(first[1], third.reset()[0])
    assert not np.array_equal(first, one.reset())


def test_attributes_and_methods() -> None:
    envs = make(env_kwargs={"difficulty": "hard"}, threads=1)
    envs.reset()
    assert envs.get_attr("dimensions", indices=[0, 2]) == [2, 2]
    assert envs.get_attr("episode", indices=1)[0].outcome == "running"
    envs.set_attr("note", 3, indices=[1])
    assert envs.get_attr("note", indices=1) == [3]
    assert not envs.has_attr("note")
    assert envs.has_attr("world")
    waypoint = envs.env_method("action_for", [5e3, 9e3, 0.0], indices=range(2))
    assert [action.shape for action in waypoint] == [(2,), (2,)]
    assert envs.env_is_wrapped(Monitor) == [True] * COUNT
    assert envs.env_is_wrapped(gymnasium.wrappers.TimeLimit, indices=0) == [False]


def test_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    pytest.importorskip("pygame")
    envs = make(render_mode="rgb_array")
    envs.reset()
    one = envs.get_images()[0]
    assert envs.render().shape[:2] == (2 * one.shape[0], 2 * one.shape[1])
    envs.close()


@pytest.mark.parametrize("clone", [copy.deepcopy, lambda envs: pickle.loads(pickle.dumps(envs))])
def test_copies_go_on_identically(clone: Any) -> None:
    envs = make(**HURRY)
    envs.reset()
    for step in range(7):
        envs.step(actions(envs, step))
    other = clone(envs)
    for step in range(30):
        one, two = envs.step(actions(envs, step)), other.step(actions(envs, step))
        assert all(
            np.array_equal(left, right) for left, right in zip(one[:3], two[:3], strict=True)
        )
        for index in np.flatnonzero(one[2]):
            assert told(one[3][index]) == told(two[3][index])


def test_normalised_trained_saved_and_loaded(tmp_path: Path) -> None:
    envs = VecNormalize(make(seed=0, monitor_dir=tmp_path, info_keywords=["is_success"], **HURRY))
    settings = {"n_steps": 64, "batch_size": 128, "n_epochs": 1, "device": "cpu", "seed": 0}
    model = PPO("MlpPolicy", envs, policy_kwargs=NET, **settings).learn(1024)
    assert len(model.ep_info_buffer) > 4
    assert {"r", "l", "t", "is_success"} <= set(model.ep_info_buffer[0])
    model.save(tmp_path / "model.zip")
    envs.save(str(tmp_path / "statistics.pkl"))
    lines = load_results(str(tmp_path))
    assert len(lines) >= len(model.ep_info_buffer)
    assert set(lines["is_success"]) <= {True, False}

    fresh = VecNormalize.load(str(tmp_path / "statistics.pkl"), make(seed=9, **HURRY))
    assert np.array_equal(fresh.obs_rms.mean, envs.obs_rms.mean)
    fresh.training = False
    again = PPO.load(tmp_path / "model.zip", env=fresh, device="cpu")
    observation = fresh.reset()
    assert np.array_equal(
        again.predict(observation, deterministic=True)[0],
        model.predict(observation, deterministic=True)[0],
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        returns, lengths = evaluate_policy(again, fresh, 4, return_episode_rewards=True)
    assert len(returns) == len(lengths) == 4
    envs.close()


def test_off_policy_and_frames() -> None:
    envs = VecFrameStack(make(seed=0, **HURRY), 2)
    settings = {"learning_starts": 32, "batch_size": 32, "device": "cpu", "seed": 0}
    model = SAC("MlpPolicy", envs, policy_kwargs=NET, **settings).learn(128)
    assert model.replay_buffer.size() > 0


def test_what_is_wrong_is_said() -> None:
    envs = make()
    envs.reset()
    with pytest.raises(auvgym.ActionError, match="environment 1"):
        envs.step(np.array([[0, 0], [np.nan, 0], [0, 0], [0, 0]], np.float32))
    with pytest.raises(ValueError, match="SAME_STEP"):
        auvgym.sb3.AUVVecEnv(gymnasium.make_vec("AUVDynamic2D-v0", num_envs=2).unwrapped)
    with pytest.raises(TypeError, match="nonsense"):
        make(nonsense=1)
