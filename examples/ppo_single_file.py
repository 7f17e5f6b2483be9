"""PPO in one file, in the manner of CleanRL: torch and the batch, nothing between them."""

import argparse
import math
import time

import gymnasium
import numpy as np
import torch
from gymnasium.vector import AutoresetMode
from torch import nn
from torch.distributions import Normal

import auvgym  # noqa: F401  # registers the environments

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--env", default="AUVDynamic2D-v0")
parser.add_argument("--difficulty", default="normal")
parser.add_argument("--timesteps", type=int, default=500_000)
parser.add_argument("--envs", type=int, default=128)
parser.add_argument("--steps", type=int, default=64, help="legs of each environment in a roll-out")
parser.add_argument("--epochs", type=int, default=5)
parser.add_argument("--batch", type=int, default=1024)
parser.add_argument("--learning-rate", type=float, default=1e-3)
parser.add_argument("--gamma", type=float, default=0.99)
parser.add_argument("--gae-lambda", type=float, default=0.95)
parser.add_argument("--clip", type=float, default=0.2)
parser.add_argument("--seed", type=int, default=0)
parser.add_argument("--tests", type=int, default=256, help="episodes flown afterwards")
args = parser.parse_args()

torch.set_num_threads(1)  # small networks are slower on more
torch.manual_seed(args.seed)
random = np.random.default_rng(args.seed)


def make(count: int) -> gymnasium.vector.VectorEnv:
    return gymnasium.make_vec(
        args.env, num_envs=count, difficulty=args.difficulty, autoreset_mode=AutoresetMode.SAME_STEP
    )


def layer(inputs: int, outputs: int, gain: float) -> nn.Linear:
    made = nn.Linear(inputs, outputs)
    nn.init.orthogonal_(made.weight, gain)
    nn.init.zeros_(made.bias)
    return made


def network(inputs: int, outputs: int, gain: float) -> nn.Sequential:
    first, second = layer(inputs, 128, math.sqrt(2)), layer(128, 128, math.sqrt(2))
    return nn.Sequential(first, nn.Tanh(), second, nn.Tanh(), layer(128, outputs, gain))


envs = make(args.envs)
entries = envs.single_observation_space.shape[0]
width = envs.single_action_space.shape[0]
actor, critic = network(entries, width, 0.01), network(entries, 1, 1.0)
log_std = nn.Parameter(torch.full((width,), -0.5))
with torch.no_grad():
    actor[-1].bias[0] = 0.5  # ahead
parameters = [*actor.parameters(), *critic.parameters(), log_std]
optimizer = torch.optim.Adam(parameters, lr=args.learning_rate, eps=1e-5)

shape = (args.steps, args.envs)
observations = torch.zeros(*shape, entries)
actions = torch.zeros(*shape, width)
log_probs, rewards, ends, values, advantages = (torch.zeros(shape) for _ in range(5))

observation = torch.from_numpy(envs.reset(seed=1_000_000 + args.seed)[0])
rollouts = max(1, args.timesteps // (args.steps * args.envs))
begin = time.monotonic()
for rollout in range(rollouts):
    optimizer.param_groups[0]["lr"] = args.learning_rate * (1 - rollout / rollouts)
    landed, arrived = 0, 0
    with torch.no_grad():
        for step in range(args.steps):
            policy = Normal(actor(observation), log_std.exp())
            action = policy.sample()
            observations[step], actions[step] = observation, action
            log_probs[step] = policy.log_prob(action).sum(-1)
            values[step] = critic(observation).squeeze(-1)
            seen, reward, ended, _, infos = envs.step(action.clamp(-1, 1).numpy())
            observation = torch.from_numpy(seen)
            rewards[step], ends[step] = torch.from_numpy(reward), torch.from_numpy(ended)
            if ended.any():
                landed += int(ended.sum())
                arrived += int(infos["final_info"]["is_success"][ended].sum())
        # Time left is observed, so every end is one: nothing is bootstrapped across it.
        following, advantage = critic(observation).squeeze(-1), torch.zeros(args.envs)
        for step in reversed(range(args.steps)):
            goes_on = 1 - ends[step]
            error = rewards[step] + args.gamma * following * goes_on - values[step]
            advantage = error + args.gamma * args.gae_lambda * goes_on * advantage
            advantages[step], following = advantage, values[step]
    returns = advantages + values

    flat = [part.flatten(0, 1) for part in (observations, actions, log_probs, advantages, returns)]
    for _ in range(args.epochs):
        for rows in torch.from_numpy(random.permutation(len(flat[0]))).split(args.batch):
            some, taken, old, gains, target = (part[rows] for part in flat)
            ratio = (Normal(actor(some), log_std.exp()).log_prob(taken).sum(-1) - old).exp()
            gains = (gains - gains.mean()) / (gains.std() + 1e-8)
            clipped = ratio.clamp(1 - args.clip, 1 + args.clip)
            policy_loss = -torch.min(gains * ratio, gains * clipped).mean()
            value_loss = (critic(some).squeeze(-1) - target).square().mean()
            optimizer.zero_grad()
            (policy_loss + 0.5 * value_loss).backward()
            nn.utils.clip_grad_norm_(parameters, 0.5)
            optimizer.step()
    legs = (rollout + 1) * args.steps * args.envs
    print(f"{legs:9d} legs  {time.monotonic() - begin:5.0f} s  arrived {arrived}/{landed}")

# The seeds of docs/training.md for validation, each flown once.
tests = make(args.tests)
seen, _ = tests.reset(seed=200_000)
flying, arrived = np.ones(args.tests, bool), 0
while flying.any():
    with torch.no_grad():
        action = actor(torch.from_numpy(seen)).clamp(-1, 1).numpy()
    seen, _, ended, _, infos = tests.step(action)
    now = flying & ended
    arrived += int(infos["final_info"]["is_success"][now].sum()) if now.any() else 0
    flying &= ~ended
print(f"arrived: {arrived / args.tests:.1%}")
