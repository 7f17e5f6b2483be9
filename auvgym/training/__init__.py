"""Training agents on the engine's batch (extra ``train``): recipes, runs, networks as ONNX.

::

    config = auvgym.training.configure("ppo", "AUVDynamic2D-v0", timesteps=500_000)
    auvgym.training.train(config, "results/ppo")
"""

from auvgym.training.config import TrainingConfig, TrainingError, configure
from auvgym.training.recipes import list_algorithms, load_recipe
from auvgym.training.run import TrainingResult, train

__all__ = [
    "TrainingConfig",
    "TrainingError",
    "TrainingResult",
    "configure",
    "list_algorithms",
    "load_recipe",
    "train",
]
