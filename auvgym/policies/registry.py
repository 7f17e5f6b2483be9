"""Policies by name: the shipped ones, one per planner, and anybody's ``module:Class``."""

from __future__ import annotations

import importlib
import inspect
import os
import sys
from collections.abc import Callable, Mapping
from typing import Any

import auvgym
from auvgym import ompl
from auvgym._names import unknown
from auvgym.policies.agents import AGENTS, file_hash
from auvgym.policies.astar_replan import AstarReplanPolicy
from auvgym.policies.base import Policy, PolicyError, ScriptedPolicy
from auvgym.policies.hold import HoldPolicy
from auvgym.policies.iifds_reactive import IifdsReactivePolicy
from auvgym.policies.lane import LanePolicy
from auvgym.policies.planner import PlannerPolicy
from auvgym.policies.random_actions import RandomPolicy
from auvgym.policies.shipped import ShippedAgent, agents_can_fly, list_agents
from auvgym.policies.sonar_rule import SonarRulePolicy
from auvgym.policies.straight import StraightPolicy
from auvgym.policies.triggers import TRIGGERS

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
    """Every name that can fly here: floors and references, trained agents, one per planner.

    Trained agents need the extra ``agents``.
    """
    planners = [name for name in auvgym.list_planners() if name not in SCRIPTED]
    return [*SCRIPTED, *(list_agents() if agents_can_fly() else []), *planners]


def list_triggers() -> list[str]:
    """Every name that :func:`make` knows of policies for ``action_mode="replan"``."""
    return list(TRIGGERS)


def make(name: str, seed: int = 0, **parameters: Any) -> Policy:
    """Make a policy.

    Args:
        name: one of :func:`list_policies` or :func:`list_triggers`, ``"module:Class"`` for a
            class of one's own, or the path of a trained agent: ``"agent.onnx"`` with its card, or
            a Stable-Baselines3 ``"agent.zip"`` (reading one runs code from it).
        seed: seed of whatever the policy draws.
        **parameters: the policy's own, as its class documents them; a planner's policy takes
            ``window`` and the planner's parameters.

    Raises:
        PolicyError: no policy of that name, or a parameter that it does not have.
    """
    if name in SCRIPTED:
        _check_parameters(name, SCRIPTED[name], parameters, ("seed",))
        return SCRIPTED[name](seed=seed, **parameters)
    if name in TRIGGERS:
        _check_parameters(name, TRIGGERS[name], parameters, ("seed",))
        return TRIGGERS[name](seed=seed, **parameters)
    if name in auvgym.list_planners() or name in ompl.PLANNERS:
        return PlannerPolicy(planner=name, seed=seed, **parameters)
    if name in list_agents():
        _check_parameters(name, ShippedAgent, parameters, ("seed", "agent"))
        return ShippedAgent(name, seed=seed, **parameters)
    for ending, agent in AGENTS.items():
        if name.endswith(ending):
            _check_parameters(name, agent, parameters, ("seed", "path"))
            made: Any = agent(name, seed=seed, **parameters)
            return made  # type: ignore[no-any-return]
    if ":" in name:
        return _make_foreign(name, seed, parameters)
    raise PolicyError(unknown("policy", name, [*list_policies(), *list_triggers()]))


def is_shipped(name: str) -> bool:
    """Whether a policy is auvgym's own code, which needs no guard."""
    ours = (SCRIPTED, TRIGGERS, list_agents(), auvgym.list_planners(), ompl.PLANNERS)
    return any(name in names for names in ours)


def frozen_parameters(name: str, parameters: Mapping[str, Any]) -> dict[str, Any]:
    """The parameters as results keep them: an agent's with the hash of its file.

    Two files of one name are two policies, and :func:`make` refuses a file of another hash. The
    agents that come with auvgym are bound to its version, as all of its policies.

    Raises:
        PolicyError: the agent's file cannot be read.
    """
    if not name.endswith(tuple(AGENTS)):
        return dict(parameters)
    return {"sha256": file_hash(name), **parameters}


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
    _check_parameters(name, maker, parameters, ("seed",))
    accepted = inspect.signature(maker).parameters
    policy = maker(**({"seed": seed} if "seed" in accepted else {}), **parameters)
    for method in ("reset", "act"):
        if not callable(getattr(policy, method, None)):
            raise PolicyError(
                f'policy "{name}" has no method "{method}"; a policy has reset(env) or '
                "reset(observation, info), and act(observation, info)"
            )
    return policy  # type: ignore[no-any-return]


def _check_parameters(
    name: str, maker: Callable[..., Any], parameters: dict[str, Any], own: tuple[str, ...]
) -> None:
    accepted = inspect.signature(maker).parameters
    if any(one.kind is inspect.Parameter.VAR_KEYWORD for one in accepted.values()):
        return
    known = [key for key in accepted if key not in own]
    for key in parameters:
        if key not in known:
            raise PolicyError(f'policy "{name}": {unknown("parameter", key, known)}')
