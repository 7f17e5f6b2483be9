"""The trained agents that come with the package: a name, and a network for each environment."""

from __future__ import annotations

from functools import lru_cache
from importlib import resources
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from auvgym._extras import require
from auvgym._names import unknown
from auvgym.policies.agents import OnnxPolicy
from auvgym.policies.base import Action, Knows, Observation, PolicyError

REPLAN = "replan"


@lru_cache(maxsize=1)
def list_agents() -> dict[str, dict[str, Path]]:
    """Name of an agent -> what it was trained for -> its ONNX file; the card is beside it.

    What it was trained for is an environment's id, with ``/replan`` if it chooses when to plan.
    """
    found: dict[str, dict[str, Path]] = {}
    folder = Path(str(resources.files("auvgym") / "agents"))
    for path in sorted(folder.glob("*/*.onnx")):
        trained_for = path.stem.replace(f"-{REPLAN}", f"/{REPLAN}")
        found.setdefault(path.parent.name, {})[trained_for] = path
    return found


def agents_can_fly() -> bool:
    """Whether the extra ``agents`` is there."""
    return find_spec("onnxruntime") is not None


class ShippedAgent:
    """A trained agent that comes with auvgym (extra ``agents``).

    ``reset`` looks which environment this is and takes the network that was trained for it; from
    then on it sees observations only.

    Args:
        agent: its name, one of :func:`list_agents`.
        seed: unused; an agent is a function of what it sees.

    Raises:
        PolicyError: no such agent, or it has no network for the environment.
        ImportError: without onnxruntime.
    """

    knows: Knows = "sensors"

    def __init__(self, agent: str, seed: int = 0) -> None:
        agents = list_agents()
        if agent not in agents:
            raise PolicyError(unknown("agent", agent, agents))
        require("onnxruntime", "agents")  # a board says it once, before it flies
        self.name = agent
        self.description = f"trained network, for {', '.join(agents[agent])}"
        self._files = agents[agent]
        self._loaded: dict[str, OnnxPolicy] = {}

    def reset(self, env: Any) -> None:
        """Take the network for this environment."""
        trained_for = env.spec.id if env.spec is not None else type(env.unwrapped).__name__
        if hasattr(env.action_space, "n"):  # discrete: when to plan
            trained_for = f"{trained_for}/{REPLAN}"
        if trained_for not in self._files:
            raise PolicyError(f'policy "{self.name}": {unknown("task", trained_for, self._files)}')
        if trained_for not in self._loaded:
            self._loaded[trained_for] = OnnxPolicy(str(self._files[trained_for]))
        self._agent = self._loaded[trained_for]
        self._agent.begin()

    def act(self, observation: Observation, info: dict[str, Any]) -> Action | int:
        """The network's action."""
        return self._agent.act(observation, info)
