"""Evaluation: suites of frozen instances, a runner that keeps what ends, and a ranking.

``run(load_suite("demo"), [PolicySpec("straight")], Store("results.db"))`` flies and stores,
``summarise(results)`` ranks, ``replay(result)`` flies a stored episode again and compares.
"""

from __future__ import annotations

from auvgym.evaluation.flight import Flight
from auvgym.evaluation.replay import Replay, ReplayError, replay
from auvgym.evaluation.result import EpisodeResult, PolicySpec
from auvgym.evaluation.runner import fitting, run
from auvgym.evaluation.seeds import SEEDS, seeds_of
from auvgym.evaluation.store import Store, StoreError
from auvgym.evaluation.suite import Instance, Suite, SuiteError, single_suite
from auvgym.evaluation.suite_file import list_suites, load_suite
from auvgym.evaluation.summary import PolicySummary, summarise, wilson_interval
from auvgym.evaluation.verify import Verification, verify

__all__ = [
    "SEEDS",
    "EpisodeResult",
    "Flight",
    "Instance",
    "PolicySpec",
    "PolicySummary",
    "Replay",
    "ReplayError",
    "Store",
    "StoreError",
    "Suite",
    "SuiteError",
    "Verification",
    "fitting",
    "list_suites",
    "load_suite",
    "replay",
    "run",
    "seeds_of",
    "single_suite",
    "summarise",
    "verify",
    "wilson_interval",
]
