import gymnasium

import auvgym

env = gymnasium.make("AUVDynamic3D-v0")
policy = auvgym.policies.make("sonar-rule")
observation, info = env.reset(seed=1)
policy.reset(env)
while info["outcome"] == "running":
    action = policy.act(observation, info)
    observation, reward, terminated, truncated, info = env.step(action)
print(f"{info['outcome']} after {info['time_s'] / 3600:.2f} h")
