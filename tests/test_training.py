"""Training: recipes, runs that stop and go on, networks as ONNX, agents by name."""

from __future__ import annotations

import json
import subprocess
import sys
import warnings
from itertools import combinations, product
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from typer.testing import CliRunner

from auvgym import evaluation, policies, training
from auvgym.cli import app
from auvgym.registration import ENVIRONMENTS
from auvgym.training import TrainingConfig, TrainingError, configure

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # whatever its own dependencies have to say on import
    pytest.importorskip("sb3_contrib")
    pytest.importorskip("tensorboard")
    pytest.importorskip("onnx")
    import onnxruntime
    import torch.utils.tensorboard
    from stable_baselines3.common.vec_env import VecNormalize

    from auvgym.training import models
    from auvgym.training.export import export_onnx, largest_difference
    from auvgym.training.flights import Examination
    from auvgym.training.stride import OFFSET, SCALE, stride

TINY = {"n_envs": 4, "n_steps": 8, "batch_size": 32, "n_epochs": 1, "net_arch": [8]}
# Enough to see it go: short episodes, few of them.
HURRY = {"difficulty": "easy", "time_factor": 1.0}


def tiny(algorithm: str = "ppo", timesteps: int = 96, **others: Any) -> TrainingConfig:
    without = {"least_waypoint": None, "least_waypoint_from": 0}
    hyperparameters = {**TINY, **without, **others.pop("hyperparameters", {})}
    settings = {"validate_every": 40, "validation_episodes": 3, "settings": HURRY, **others}
    return configure(
        algorithm, "AUVDynamic2D-v0", timesteps, hyperparameters=hyperparameters, **settings
    )


def small(algorithm: str, environment: str = "AUVDynamic3D-v0", **more: Any) -> Any:
    """A fresh model with a small network."""
    sizes = {"n_envs": 2, "mixture": None, "batch_size": 32, "net_arch": [8, 8], **more}
    if algorithm == "recurrent-ppo":
        sizes |= {"lstm_hidden_size": 5}
    if algorithm in ("sac", "tqc", "dqn"):
        sizes |= {"buffer_size": 100}
    config = configure(algorithm, environment, hyperparameters=sizes)
    envs = models.make_envs(config, None)
    return models.make_model(config, envs), envs


def test_every_algorithm_has_a_recipe_for_every_environment() -> None:
    assert training.list_algorithms() == ["dqn", "ppo", "recurrent-ppo", "sac", "tqc"]
    for algorithm, environment in product(training.list_algorithms(), ENVIRONMENTS):
        config = configure(algorithm, environment)
        assert config.timesteps > 0
        assert config.n_envs > 0
        if algorithm != "dqn":
            ours, theirs, policys = models.sorted_hyperparameters(
                config, models.algorithm_class(algorithm)
            )
            assert theirs["gamma"] < 1.0
            assert policys["net_arch"]
            assert ours["policy"]


def test_ranges_of_seeds_do_not_meet() -> None:
    for one, other in combinations(evaluation.SEEDS.values(), 2):
        assert not range(max(one.start, other.start), min(one.stop, other.stop))
    assert evaluation.seeds_of("test", 1000) == range(100_000, 101_000)
    with pytest.raises(ValueError, match="did you mean 'test'"):
        evaluation.seeds_of("tests", 10)
    with pytest.raises(ValueError, match="count = 0"):
        evaluation.seeds_of("test", 0)
    frozen = [one for name in evaluation.list_suites() for one in load(name)]
    assert {one.seed for one in frozen} <= set(evaluation.SEEDS["boards"])


def load(name: str) -> Any:
    return evaluation.load_suite(name).instances


@pytest.fixture(scope="module")
def trained(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A training that was stopped in its second part and went on."""
    folder = tmp_path_factory.mktemp("training") / "run"
    told: list[int] = []

    def stop(done: int, total: int) -> None:
        assert total == 96
        told.append(done)
        if done == 60:
            raise KeyboardInterrupt

    config = tiny(hyperparameters={"normalize": "both"})
    with pytest.raises(KeyboardInterrupt):
        training.train(config, folder, on_progress=stop, command="first")
    assert told == list(range(4, 61, 4))
    state = json.loads((folder / "state.json").read_text())
    assert (state["timesteps"], state["parts"]) == (60, 1)
    assert (folder / "agent.onnx").is_file()
    rows = []
    result = training.train(config, folder, resume=True, on_row=rows.append, command="second")
    assert result.timesteps == 60 + 64  # whole roll-outs of n_envs n_steps
    assert [row.timesteps for row in rows] == [80, 120, 124]
    return folder


def test_a_training_leaves_all_that_is_needed_to_repeat_it(trained: Path) -> None:
    card = json.loads((trained / "agent.json").read_text())
    assert card["commands"] == ["first", "second"]
    assert card["seeds"]["training"] == [1_000_000, 4]
    assert card["seeds"]["validation"] == [200_000, 3]
    assert {"torch", "stable_baselines3", "auvgym", "python"} <= set(card["versions"])
    assert card["hyperparameters"]["net_arch"] == [8]
    assert [row["timesteps"] for row in card["curve"]] == [40, 80, 120, 124]
    assert card["largest_difference_to_torch"] < 1e-4
    assert card["sha256"] == policies.frozen_parameters(str(trained / "agent.onnx"), {})["sha256"]
    curve = (trained / "curve.csv").read_text().splitlines()
    assert curve[0].startswith("timesteps,seconds,train_success,train_return,success,")
    assert len(curve) == 1 + 4
    assert list((trained / "tensorboard").iterdir())
    assert (trained / "vecnormalize.pkl").is_file()
    again = TrainingConfig.load(trained / "config.json")
    assert again == tiny(hyperparameters={"normalize": "both"})


def test_the_file_does_what_the_model_does(trained: Path) -> None:
    """On observations of an episode, by another way than the export checks itself."""
    agent = policies.make(str(trained / "agent.onnx"))
    model = models.algorithm_class("ppo").load(trained / "model.zip", device="cpu")
    config = TrainingConfig.load(trained / "config.json")
    normalizer = VecNormalize.load(str(trained / "vecnormalize.pkl"), models.plain_envs(config))
    env = gymnasium.make("AUVDynamic2D-v0", **HURRY)
    observation, info = env.reset(seed=5)
    policies.begin(agent, env, observation, info)
    while info["outcome"] == "running":
        action = agent.act(observation, info)
        seen = normalizer.normalize_obs(observation[None])
        expected = np.clip(model.predict(seen, deterministic=True)[0][0], -1, 1)
        assert action == pytest.approx(expected, abs=1e-5)
        observation, _, _, _, info = env.step(action)


def test_returns_over_several_legs_outlive_a_stop(tmp_path: Path) -> None:
    def stop(done: int, total: int) -> None:
        if done == 60:
            raise KeyboardInterrupt

    sizes = {"n_envs": 4, "n_steps": 10, "buffer_size": 400, "learning_starts": 20, "net_arch": [8]}
    config = configure(
        "sac", "AUVDynamic2D-v0", 96, hyperparameters=sizes,
        validate_every=40, validation_episodes=3, settings=HURRY,
    )  # fmt: skip
    with pytest.raises(KeyboardInterrupt):
        training.train(config, tmp_path, on_progress=stop)
    assert (tmp_path / "last-replay-buffer.pkl").is_file()
    assert training.train(config, tmp_path, resume=True).timesteps == 96
    saved = models.algorithm_class("sac").load(tmp_path / "last.zip", device="cpu")
    assert (saved.replay_buffer.n_steps, saved.replay_buffer.gamma) == (10, 0.99)


@pytest.mark.parametrize("algorithm", ["ppo", "recurrent-ppo", "sac", "tqc"])
def test_networks_as_onnx(algorithm: str, tmp_path: Path) -> None:
    model, _ = small(algorithm, normalize=None)
    path = tmp_path / "agent.onnx"
    assert export_onnx(model, path) < 1e-5
    # The check is one: another network does not pass it.
    other, _ = small(algorithm, "AUVThreat3D-v0")
    other.policy.load_state_dict(model.policy.state_dict())
    assert largest_difference(other, path) < 1e-5
    with torch.no_grad():
        for parameter in other.policy.parameters():
            parameter += 0.1
    assert largest_difference(other, path) > 1e-3


def test_discrete_networks_as_onnx(tmp_path: Path) -> None:
    from stable_baselines3 import DQN, PPO

    for maker in (PPO, DQN):
        env = gymnasium.make("CartPole-v1")
        model = maker("MlpPolicy", env, policy_kwargs={"net_arch": [8]}, device="cpu", seed=1)
        path = tmp_path / "agent.onnx"
        model.observation_space.low[:], model.observation_space.high[:] = -2, 2
        export_onnx(model, path)
        path.with_suffix(".json").write_text('{"schema": 1, "name": "x", "environment": "y"}')
        agent = policies.make(str(path))
        for observation in np.random.default_rng(0).uniform(-2, 2, (20, 4)).astype(np.float32):
            action = agent.act(observation, {})
            assert isinstance(action, int)
            assert action == int(model.predict(observation, deterministic=True)[0])


def test_an_agent_remembers_within_its_episode_only(tmp_path: Path) -> None:
    model, _ = small("recurrent-ppo", "AUVDynamic2D-v0")
    path = tmp_path / "agent.onnx"
    export_onnx(model, path)
    path.with_suffix(".json").write_text('{"schema": 1, "name": "x", "environment": "y"}')
    agent = policies.make(str(path))
    seen = np.full(59, 0.3, np.float32)
    flights = []
    for _ in range(2):
        agent.reset(seen, {})
        flights.append([agent.act(seen, {}) for _ in range(3)])
    assert np.array_equal(*flights)
    assert not np.array_equal(flights[0][0], flights[0][1])


def test_an_examination_is_what_single_flights_are() -> None:
    def act(observations: Any, begins: Any) -> Any:
        return np.stack([ahead(observation) for observation in observations])

    def ahead(observation: Any) -> Any:
        return np.array([1.0, observation[12]], np.float32).clip(-1, 1)

    settings = {"difficulty": "easy"}
    flown = Examination("AUVDynamic2D-v0", range(8), settings).fly(act)
    env = gymnasium.make("AUVDynamic2D-v0", **settings)
    for seed in range(8):
        observation, info = env.reset(seed=seed)
        total, steps = 0.0, 0
        while info["outcome"] == "running":
            observation, reward, _, _, info = env.step(ahead(observation))
            total, steps = total + float(reward), steps + 1
        limit_s = env.unwrapped.episode.time_limit_s
        share = info["time_s"] / limit_s if info["is_success"] else 1.0
        assert flown.success[seed] == info["is_success"]
        assert (flown.steps[seed], flown.time_share[seed]) == (steps, share)
        assert flown.returns[seed] == pytest.approx(total)
    summary = flown.summary()
    assert summary["success"] == flown.success.mean()
    assert summary["success_low"] <= summary["success"] <= summary["success_high"]


def test_environments_begin_in_the_range_for_training() -> None:
    config = tiny(hyperparameters={"n_envs": 2, "batch_size": 16}, seed=3)
    envs = models.make_envs(config, None)
    models.make_model(config, envs)  # which seeds them with 3
    models.seed_envs(envs, config, part=1)
    envs.reset()
    drawn = [info["episode_seed"] for info in envs.reset_infos]
    expected = []
    for index in range(2):
        env = gymnasium.make("AUVDynamic2D-v0", **HURRY)
        expected.append(env.reset(seed=4_010_000 + index)[1]["episode_seed"])
    assert drawn == expected


def test_waypoints_are_never_where_the_vehicle_is() -> None:
    config = tiny(hyperparameters={"least_waypoint": 0.2})
    envs, plain = models.make_envs(config, None), models.plain_envs(tiny())
    for one in (envs, plain):
        models.seed_envs(one, config, part=0)
        one.reset()
    stays = np.full((4, 2), [-1 / 3, 0.01], np.float32)  # forward 0, left 0.01 reach
    seen, expected = envs.step(stays)[0], plain.step(stride(stays, 0.2))[0]
    np.testing.assert_array_equal(seen, expected)
    assert (seen != plain.step(stays)[0]).any(axis=1).all()
    late = {"hyperparameters": {"least_waypoint": 0.2, "least_waypoint_from": 0.75}}
    envs, plain = models.make_envs(tiny(**late), None, 64), models.plain_envs(tiny())
    for one in (envs, plain):  # 72 of 96 legs are free, 64 of them flown
        models.seed_envs(one, config, part=0)
        one.reset()
    for asked in (stays, stays, stride(stays, 0.2)):
        np.testing.assert_array_equal(envs.step(stays)[0], plain.step(asked)[0])
    rng = np.random.default_rng(0)
    for wide in (2, 3):
        actions = rng.uniform(-1.2, 1.2, (500, wide)).astype(np.float32)
        strides, clipped = stride(actions, 0.2), np.clip(actions, -1, 1)
        scale, offset = np.array(SCALE[:wide]), np.array(OFFSET[:wide])
        before, after = clipped * scale + offset, strides * scale + offset
        length = np.linalg.norm(before, axis=1)
        near = length < 0.2
        assert near.any()
        np.testing.assert_array_equal(strides[~near], clipped[~near])
        shortest = before[near] / length[near, None] * 0.2
        np.testing.assert_allclose(after[near], shortest, atol=1e-5)


@pytest.mark.parametrize("environment", ["AUVDynamic2D-v0", "AUVDynamic3D-v0"])
def test_files_ask_for_no_nearer_waypoints_either(environment: str, tmp_path: Path) -> None:
    model, envs = small("ppo", environment, action_bias=[-0.3])
    path = tmp_path / "agent.onnx"
    assert export_onnx(model, path, least=0.5) < 1e-5
    assert largest_difference(model, path) > 0.01  # the model itself asks for its own place
    envs.close()


def test_a_mixture_of_difficulties_is_for_trainings_that_name_none() -> None:
    mixture = configure("ppo", "AUVDynamic2D-v0").hyperparameters["mixture"]
    assert {"difficulty": "normal"} in mixture
    assert {"difficulty": "hard"} in mixture
    for settings in ({"difficulty": "easy"}, {"scenario": "lfhh-2d-1"}):
        named = configure("ppo", "AUVDynamic2D-v0", settings=settings)
        assert "mixture" not in named.hyperparameters
        assert named.settings == settings
    replan = configure("ppo", "AUVDynamic2D-v0", settings={"action_mode": "replan"})
    assert "mixture" not in replan.hyperparameters
    for more, left in [({"difficulty": "hard"}, True), ({"planner": "rrt-star"}, False)]:
        settings = {"action_mode": "replan", **more}
        coarse = configure("ppo", "AUVDynamic3D-v0", settings=settings).hyperparameters
        assert ("mixture" in coarse) == left


def test_a_mixture_is_shared_out() -> None:
    mixture = [{"time_factor": 1.1}, {"time_factor": 1.5}]
    config = tiny(hyperparameters={"n_envs": 5, "mixture": mixture})
    envs = models.make_envs(config, None)
    models.seed_envs(envs, config, part=0)
    observations = envs.reset()
    assert observations.shape == (5, 59)
    factors = [
        round(episode.time_limit_s * 2.0 / np.linalg.norm(world.goal - world.start), 3)
        for episode, world in zip(envs.get_attr("episode"), envs.get_attr("world"), strict=True)
    ]
    assert factors == [1.1, 1.1, 1.1, 1.5, 1.5]
    _, rewards, ended, infos = envs.step(np.zeros((5, 2), np.float32))
    assert (rewards.shape, ended.shape, len(infos)) == ((5,), (5,), 5)
    for index, world in enumerate(envs.env_method("get_wrapper_attr", "world", indices=[4, 0])):
        single = gymnasium.make("AUVDynamic2D-v0", **{**HURRY, **mixture[1 - index]})
        single.reset(seed=1_000_000 + (4 if index == 0 else 0))
        assert world.scenario.hash == single.unwrapped.world.scenario.hash
    envs.set_attr("note", 1, indices=3)
    assert envs.get_attr("note", 3) == [1]
    envs.close()


def test_the_first_actions_go_where_the_bias_says() -> None:
    model, _ = small("ppo", action_bias=[0.5, -0.25])
    assert model.policy.action_net.bias.tolist() == [0.5, -0.25, 0.0]
    schedule = model.learning_rate
    assert [schedule(left) for left in (1.0, 0.5, 0.0)] == pytest.approx([1e-3, 5e-4, 0.0])


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"hyperparameters": {"n_step": 3}}, "unknown hyperparameter of ppo 'n_step'; did you"),
        ({"hyperparameters": {"n_envs": 0}}, "n_envs = 0: must be a whole number, 1 .. 10000"),
        ({"hyperparameters": {"learning_rate": "lin_x"}}, "a schedule is written lin_0.001"),
        ({"hyperparameters": {"activation_fn": "tan"}}, "did you mean 'tanh'"),
        ({"hyperparameters": {"policy": "CnnPolic"}}, "unknown policy 'CnnPolic'"),
        ({"hyperparameters": {"normalize": "all"}}, "unknown normalize 'all'"),
        ({"hyperparameters": {"least_waypoint": 0.7}}, "must be reaches, more than 0"),
        ({"hyperparameters": {"least_waypoint": "far"}}, "least_waypoint = 'far': must be a num"),
        ({"hyperparameters": {"least_waypoint_from": 2}}, "_from = 2: must be a share, 0 .. 1"),
        ({"hyperparameters": {"mixture": []}}, None),
        ({"hyperparameters": {"mixture": "hard"}}, "mixture = 'hard': must be a list"),
        ({"hyperparameters": {"action_bias": [0, 0, 0]}}, "action_bias = "),
        ({"hyperparameters": {"batch_size": 1}}, "ppo refuses its hyperparameters"),
        ({"hyperparameters": {"mixture": [{"difficult": "hard"}]}}, "did you mean 'difficulty'"),
        ({"timesteps": 0.5}, "timesteps = 0.5: must be a whole number"),
        ({"timesteps": 0}, "timesteps = 0"),
        ({"seed": -1}, "seed = -1"),
        ({"validation_episodes": 0}, "validation_episodes = 0"),
        ({"torch_threads": 0}, "torch_threads = 0"),
        ({"settings": {"difficulty": "insane"}}, "insane"),
        ({"settings": {"action_mod": 1}}, "did you mean 'action_mode'"),
    ],
)
def test_what_is_wrong_is_said(change: dict[str, Any], said: str | None, tmp_path: Path) -> None:
    def run() -> None:
        training.train(tiny(**change), tmp_path / "run", on_progress=stop)

    def stop(done: int, total: int) -> None:
        raise InterruptedError

    if said is None:
        with pytest.raises(InterruptedError):
            run()
    else:
        with pytest.raises(ValueError, match=said):
            run()
        assert not (tmp_path / "run" / "last.zip").exists()


def test_algorithms_and_actions_that_do_not_go_together() -> None:
    with pytest.raises(TrainingError, match="dqn needs discrete actions"):
        small("dqn")
    with pytest.raises(TrainingError, match="unknown environment 'AUVDynamic4D-v0'; did you"):
        configure("ppo", "AUVDynamic4D-v0")
    with pytest.raises(ValueError, match="unknown algorithm 'pp0'; did you mean 'ppo'"):
        configure("pp0", "AUVDynamic2D-v0")


def test_the_command_line(trained: Path, tmp_path: Path) -> None:
    def call(*arguments: str) -> Any:
        return CliRunner().invoke(app, ["train", *arguments])

    sizes = [word for name, value in TINY.items() for word in ("--set", f"{name}={value}")]
    short = ["--timesteps", "32", "--validation-episodes", "2", "--difficulty", "easy"]
    out = tmp_path / "run"
    command = ["ppo", *sizes, *short, "--env-set", "time_factor=1", "--out", str(out)]
    done = call(*command)
    assert done.exit_code == 0, done.output
    assert "best on the validation seeds after 32" in done.output
    assert str(out / "agent.onnx") in done.output.replace("\n", "")
    again = call(*command)
    assert again.exit_code == 2
    assert "has a training already" in again.output
    assert "give more with --timesteps" in call(*command, "--resume").output
    assert "describes another training" in call(*command, "--seed", "1", "--resume").output
    striding = [*command, "--set", "least_waypoint=0.2", "--timesteps", "64", "--resume"]
    assert call(*striding).exit_code == 0
    card = json.loads((out / "agent.json").read_text())
    assert card["hyperparameters"]["least_waypoint"] == 0.2
    assert len(card["commands"]) == 2
    assert call(*command, "--fresh").exit_code == 0
    nothing = call("ppo", "--out", str(tmp_path / "none"), "--resume")
    assert "has no training to go on with" in nothing.output
    flown = CliRunner().invoke(
        app,
        ["evaluate", "--policy", str(out / "agent.onnx"), "--seeds", "test", "--episodes", "2"],
    )
    assert flown.exit_code == 0, flown.output
    wrong = ["evaluate", "--policy", "straight", "--seeds", "test", "--first-seed", "3"]
    assert "without --first-seed" in CliRunner().invoke(app, wrong).output


def test_shipped_agents_fly_by_name() -> None:
    agents = policies.list_agents()
    assert set(ENVIRONMENTS) <= set(agents["ppo"])
    assert "ppo" in policies.list_policies()
    for environment, path in agents["ppo"].items():
        card = json.loads(path.with_suffix(".json").read_text())
        assert path.stat().st_size < 300_000
        assert card["environment"] == environment.partition("/")[0]
        assert card["sha256"] == policies.frozen_parameters(str(path), {})["sha256"]
        assert card["commands"][0].startswith("auvgym train ")
        entries = onnxruntime.InferenceSession(str(path)).get_inputs()[0].shape[-1]
        env = gymnasium.make(card["environment"], **card["settings"])
        observation, info = env.reset(seed=1)
        assert entries == len(observation)
        agent = policies.make("ppo")
        policies.begin(agent, env, observation, info)
        assert env.action_space.contains(agent.act(observation, info))
    assert policies.frozen_parameters("ppo", {}) == {}
    odd = gymnasium.make("CartPole-v1")
    with pytest.raises(policies.PolicyError, match="unknown task 'CartPole-v1"):
        policies.make("ppo").reset(odd)


@pytest.mark.parametrize("environment", ["AUVDynamic2D-v0", "AUVStatic3D-v0"])
def test_shipped_agents_are_better_than_the_rule(environment: str) -> None:
    suite = evaluation.single_suite(environment, 30, "hard")
    specs = [evaluation.PolicySpec(name) for name in ("ppo", "sonar-rule")]
    results = evaluation.run(suite, specs, evaluation.Store(None), workers=1)
    solved = dict.fromkeys(("ppo", "sonar-rule"), 0)
    for result in results:
        solved[result.policy] += result.success
    assert solved["ppo"] > solved["sonar-rule"] + 5


def test_a_shipped_agent_without_its_runtime_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "onnxruntime", None)
    with pytest.raises(ImportError, match=r"auvgym\[agents\]"):
        policies.make("ppo")


def test_the_judgement_of_the_shipped_agents(tmp_path: Path) -> None:
    pytest.importorskip("onnxruntime")
    script = Path(__file__).parents[1] / "baselines" / "agents" / "judge_agents.py"
    done = subprocess.run(
        [sys.executable, script, "--episodes", "3", "--workers", "1", "--env", "AUVHarbor2D-v0"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    lines = [line.split(" | ") for line in done.stdout.splitlines()]
    assert [line[2] for line in lines] == ["ppo", "sonar-rule", "astar"] * 2
    for agent, *others in (lines[:3], lines[3:]):
        for other in others:
            solved, time_share = float(other[3].split()[0]), float(other[4])
            gained, faster = (float(cell.split()[0]) for cell in other[6:8])
            assert gained == pytest.approx(float(agent[3].split()[0]) - solved, abs=0.11)
            assert faster == pytest.approx(float(agent[4]) - time_share, abs=2e-3)
