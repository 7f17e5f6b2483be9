"""Entry points of ``gymnasium.make_vec``: ``auvgym.vector.entry:AUVDynamic3DEnv`` makes a batch.

Gymnasium wants a name for each environment; whatever class ``auvgym.envs`` has is one here.
"""

from __future__ import annotations

from functools import partial

from auvgym import envs
from auvgym.vector.environment import AUVVectorEnv


def __getattr__(name: str) -> partial[AUVVectorEnv]:
    found = getattr(envs, name, None)
    if not (isinstance(found, type) and issubclass(found, envs.AUVEnv)):
        raise AttributeError(f"module 'auvgym.envs' has no environment {name!r}")
    return partial(AUVVectorEnv, found)
