"""Many environments at once, stepped in one call: what ``gymnasium.make_vec`` gives.

::

    envs = gymnasium.make_vec("AUVDynamic3D-v0", num_envs=256)
    observations, infos = envs.reset(seed=0)
    observations, rewards, terminations, truncations, infos = envs.step(envs.action_space.sample())
"""

from auvgym.vector.environment import AUVVectorEnv
from auvgym.vector.member import Member

__all__ = ["AUVVectorEnv", "Member"]
