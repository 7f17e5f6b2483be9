"""Scripted policies: the floors and references of every board, and planners as policies.

``make(name, seed=0, **parameters)`` gives one, ``list_policies()`` the names, ``list_triggers()``
those that decide when to plan anew. A policy of one's
own is a class with ``reset(env)`` or ``reset(observation, info)``, and
``act(observation, info)``, see :class:`Policy`.
"""

from __future__ import annotations

from auvgym.policies.agents import CodeWarning
from auvgym.policies.base import Knows, Policy, PolicyError, ScriptedPolicy, begin
from auvgym.policies.planner import PlannerPolicy
from auvgym.policies.registry import frozen_parameters, list_policies, list_triggers, make
from auvgym.policies.shipped import ShippedAgent, list_agents
from auvgym.policies.triggers import Trigger

__all__ = [
    "CodeWarning",
    "Knows",
    "PlannerPolicy",
    "Policy",
    "PolicyError",
    "ScriptedPolicy",
    "ShippedAgent",
    "Trigger",
    "begin",
    "frozen_parameters",
    "list_agents",
    "list_policies",
    "list_triggers",
    "make",
]
