"""Policies by name: the shipped ones, one per planner, and anybody's ``module:Class``."""

from __future__ import annotations

import importlib
import inspect
import os
import sys
from collections.abc import Callable
from typing import Any

import auvgym
from auvgym import ompl
from auvgym._names import unknown
from auvgym.policies.astar_replan import AstarReplanPolicy
from auvgym.policies.base import Policy, PolicyError, ScriptedPolicy
from auvgym.policies.hold import HoldPolicy
from auvgym.policies.iifds_reactive import IifdsReactivePolicy
from auvgym.policies.lane import LanePolicy
from auvgym.policies.planner import PlannerPolicy
from auvgym.policies.random_actions import RandomPolicy
from auvgym.policies.sonar_rule import SonarRulePolicy
from auvgym.policies.straight import StraightPolicy

SCRIPTED: dict[str, type[ScriptedPolicy]] = {
    policy.name: policy
    for policy in (
        RandomPolicy,
        HoldPolicy,
        StraightPolicy,
        LanePolicy,
        SonarRulePolicy,
        AstarReplanPolicy,
        IifdsReactivePolicy,
    )
}


def list_policies() -> list[str]:
    """Every name that :func:`make` knows: the floors and references, then one per planner."""
    planners = [name for name in auvgym.list_planners() if name not in SCRIPTED]
    return [*SCRIPTED, *planners]


def make(name: str, seed: int = 0, **parameters: Any) -> Policy:
    """Make a policy.

    Args:
        name: one of :func:`list_policies`, or ``"module:Class"`` for a class of one's own.
        seed: seed of whatever the policy draws.
        **parameters: the policy's own, as its class documents them; a planner's policy takes
            ``window`` and the planner's parameters.

    Raises:
        PolicyError: no policy of that name, or a parameter that it does not have.
    """
    if name in SCRIPTED:
        _check_parameters(name, SCRIPTED[name], parameters)
        return SCRIPTED[name](seed=seed, **parameters)
    if name in auvgym.list_planners() or name in ompl.PLANNERS:
        return PlannerPolicy(planner=name, seed=seed, **parameters)
    if ":" in name:
        return _make_foreign(name, seed, parameters)
    raise PolicyError(unknown("policy", name, list_policies()))


def _make_foreign(name: str, seed: int, parameters: dict[str, Any]) -> Policy:
    module_name, _, class_name = name.partition(":")
    # A console script's path starts at its own folder; people keep their policy where they stand.
    if os.getcwd() not in sys.path:
        sys.path.insert(0, os.getcwd())
    try:
        module = importlib.import_module(module_name)
    except ModuleNotFoundError as error:
        raise PolicyError(
            f'policy "{name}": cannot import module "{module_name}" ({error}); it is looked for '
            "in the present folder and on PYTHONPATH"
        ) from error
    maker = getattr(module, class_name, None)
    if not callable(maker):
        raise PolicyError(f'policy "{name}": module "{module_name}" has no class "{class_name}"')
    _check_parameters(name, maker, parameters)
    accepted = inspect.signature(maker).parameters
    policy = maker(**({"seed": seed} if "seed" in accepted else {}), **parameters)
    for method in ("reset", "act"):
        if not callable(getattr(policy, method, None)):
            raise PolicyError(
                f'policy "{name}" has no method "{method}"; a policy has reset(env) and '
                "act(observation, info)"
            )
    return policy  # type: ignore[no-any-return]


def _check_parameters(name: str, maker: Callable[..., Any], parameters: dict[str, Any]) -> None:
    accepted = inspect.signature(maker).parameters
    if any(one.kind is inspect.Parameter.VAR_KEYWORD for one in accepted.values()):
        return
    known = [key for key in accepted if key != "seed"]
    for key in parameters:
        if key not in known:
            raise PolicyError(f'policy "{name}": {unknown("parameter", key, known)}')
