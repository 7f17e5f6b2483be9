"""auvgym: path planning for autonomous underwater vehicles in dynamic oceans.

Importing this package registers its Gymnasium environments::

    import auvgym, gymnasium
    env = gymnasium.make("AUVDynamic3D-v0")

and gives worlds and planners without Gymnasium::

    world = auvgym.World("lfhh-3d-1", seed=0)
    plan = auvgym.plan(world, "lfhh", seed=0)

Units are SI throughout: metres, seconds, radians, m/s, joules; positions are (x, y, z) with z the
depth, positive down. ``auvgym.ocean``, ``auvgym.policies``, ``auvgym.evaluation``,
``auvgym.rendering``, ``auvgym.vector`` and ``auvgym.sb3`` are imported when they are first used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from auvgym._core import ActionError, PlanningError, ScenarioError, __version__
from auvgym.harbors import Maklink, maklink
from auvgym.planning import (
    HarborReport,
    Plan,
    gap,
    list_planners,
    path_cost,
    plan,
    replan,
    run_phases,
)
from auvgym.registration import register_environments
from auvgym.scenario import Scenario, list_families, list_scenarios
from auvgym.section_problem import SectionProblem
from auvgym.world import World

if TYPE_CHECKING:
    from auvgym import evaluation, ocean, policies, rendering, report, vector
    from auvgym.policies import list_policies

__all__ = [
    "ActionError",
    "HarborReport",
    "Maklink",
    "Plan",
    "PlanningError",
    "Scenario",
    "ScenarioError",
    "SectionProblem",
    "World",
    "__version__",
    "evaluation",
    "gap",
    "list_families",
    "list_planners",
    "list_policies",
    "list_scenarios",
    "maklink",
    "ocean",
    "path_cost",
    "plan",
    "policies",
    "rendering",
    "replan",
    "report",
    "run_phases",
    "vector",
]

register_environments()

_LATE = ("evaluation", "ocean", "policies", "rendering", "report", "sb3", "vector")


def __getattr__(name: str) -> Any:
    if name in _LATE:
        return importlib.import_module(f"auvgym.{name}")
    if name == "list_policies":
        return importlib.import_module("auvgym.policies").list_policies
    raise AttributeError(f"module 'auvgym' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
