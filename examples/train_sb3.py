"""PPO of Stable-Baselines3 learns on the native batch and is flown in other worlds."""

import argparse

import torch
from stable_baselines3 import PPO
from stable_baselines3.common.evaluation import evaluate_policy

import auvgym

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--env", default="AUVDynamic2D-v0")
parser.add_argument("--timesteps", type=int, default=500_000)
parser.add_argument("--envs", type=int, default=128)
parser.add_argument("--tests", type=int, default=256, help="episodes flown afterwards")
options = parser.parse_args()

torch.set_num_threads(1)  # small networks are slower on more
model = PPO(
    "MlpPolicy",
    auvgym.sb3.make_vec_env(options.env, n_envs=options.envs, seed=0),
    n_steps=64,
    batch_size=1024,
    n_epochs=5,
    learning_rate=lambda left: 1e-3 * left,
    policy_kwargs={"net_arch": [128, 128], "log_std_init": -0.5},
    device="cpu",
    seed=0,
    verbose=1,
)
model.learn(options.timesteps)
model.save("ppo")

tests = auvgym.sb3.make_vec_env(options.env, n_envs=min(options.tests, 64), seed=10_000)
returns, _ = evaluate_policy(
    model, tests, n_eval_episodes=options.tests, return_episode_rewards=True
)
# Whatever arrives sums to more than 0, whatever fails to less: see docs/environments.md.
print(f"arrived: {sum(value > 0 for value in returns) / len(returns):.1%}")
