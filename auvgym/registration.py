"""The environments that Gymnasium knows after ``import auvgym``."""

from __future__ import annotations

import gymnasium

#: id -> class, both part of the public interface.
ENVIRONMENTS = {
    "AUVDynamic2D-v0": "auvgym.envs:AUVDynamic2DEnv",
    "AUVDynamic3D-v0": "auvgym.envs:AUVDynamic3DEnv",
    "AUVHarbor2D-v0": "auvgym.envs:AUVHarbor2DEnv",
    "AUVStatic3D-v0": "auvgym.envs:AUVStatic3DEnv",
    "AUVThreat3D-v0": "auvgym.envs:AUVThreat3DEnv",
}


def register_environments() -> None:
    """Register every environment that is not registered yet."""
    for name, entry_point in ENVIRONMENTS.items():
        if name not in gymnasium.registry:
            vector_entry_point = entry_point.replace("auvgym.envs:", "auvgym.vector.entry:")
            gymnasium.register(
                id=name, entry_point=entry_point, vector_entry_point=vector_entry_point
            )
