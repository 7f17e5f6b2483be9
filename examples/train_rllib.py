"""PPO of Ray RLlib learns on auvgym; needs pip install "auvgym[ray,train]"."""

import argparse

import gymnasium
from ray.rllib.algorithms.ppo import PPOConfig
from ray.rllib.core.rl_module.default_model_config import DefaultModelConfig
from ray.tune.registry import register_env

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--env", default="AUVDynamic2D-v0")
parser.add_argument("--difficulty", default="normal")
parser.add_argument("--iterations", type=int, default=60, help="of --batch legs each")
parser.add_argument("--batch", type=int, default=8192)
parser.add_argument("--envs", type=int, default=16, help="in each runner")
parser.add_argument("--runners", type=int, default=1, help="processes that fly; 0: this one")
options = parser.parse_args()

register_env(
    "auv",
    lambda settings: gymnasium.make(f"auvgym:{options.env}", **settings),
)
config = (
    PPOConfig()
    .environment("auv", env_config={"difficulty": options.difficulty})
    .env_runners(num_env_runners=options.runners, num_envs_per_env_runner=options.envs)
    .training(
        lr=5e-4,
        gamma=0.99,
        lambda_=0.95,
        train_batch_size_per_learner=options.batch,
        minibatch_size=min(1024, options.batch),
        num_epochs=5,
    )
    .rl_module(model_config=DefaultModelConfig(fcnet_hiddens=[128, 128], fcnet_activation="tanh"))
    .debugging(seed=0, log_level="ERROR")
)
algorithm = config.build_algo()
for iteration in range(options.iterations):
    runners = algorithm.train()["env_runners"]
    legs = runners["num_env_steps_sampled_lifetime"]
    # Whatever arrives sums to more than 0, whatever fails to less: see docs/environments.md.
    print(f"{iteration:4d}  {legs:9.0f} legs  return {runners.get('episode_return_mean', 0):.3f}")
algorithm.stop()
