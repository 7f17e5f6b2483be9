"""Gymnasium environments; each class's docstring is its specification."""

from auvgym.envs.dynamic_2d import AUVDynamic2DEnv
from auvgym.envs.dynamic_3d import AUVDynamic3DEnv
from auvgym.envs.harbor_2d import AUVHarbor2DEnv
from auvgym.envs.static_3d import AUVStatic3DEnv
from auvgym.envs.threat_3d import AUVThreat3DEnv
from auvgym.envs.waypoint import AUVEnv

__all__ = [
    "AUVDynamic2DEnv",
    "AUVDynamic3DEnv",
    "AUVEnv",
    "AUVHarbor2DEnv",
    "AUVStatic3DEnv",
    "AUVThreat3DEnv",
]
