"""What one episode leaves behind: the row that is stored, ranked and replayed."""

from __future__ import annotations

import hashlib
import json
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from auvgym.evaluation.suite import Instance, Stratum

# How a policy, not the vehicle, can lose an episode.
POLICY_FAILURES = ("error", "invalid_action", "overtime", "exit")
# More than any episode takes: legs last a minute at least. A stranger's log is unpacked no further.
MOST_STEPS = 1_000_000
MOST_ENTRIES = 3


@dataclass(frozen=True)
class PolicySpec:
    """How to make a policy anew, in any process: name, seed and parameters (plain values)."""

    name: str
    seed: int = 0
    parameters: Mapping[str, Any] = field(default_factory=dict)

    @property
    def parameters_json(self) -> str:
        """The parameters as stored: JSON with sorted keys, so that equal ones are equal text."""
        return json.dumps(dict(self.parameters), sort_keys=True)


@dataclass(frozen=True)
class EpisodeResult:
    """One row of the results. SI units; ``None`` where a figure does not exist.

    Attributes:
        suite, suite_hash: the suite it belongs to.
        policy, policy_seed, parameters, knows: who flew; parameters as JSON.
        environment, difficulty, scenario, settings, seed: the instance.
        scenario_hash: content hash of the world that was met.
        engine_version: version of the package that flew it.
        outcome: goal, collision, out_of_bounds, energy, timeout; or how the policy failed: error
            (it raised), invalid_action (not finite, of wrong shape or range), overtime (a step
            took longer than its limit), exit (it ended its process).
        error: the failure's text, else empty.
        success: 1 or 0.
        score: success * T_ref / clip(T, T_ref, 8 T_ref), T_ref = ``still_water_time_s``.
        time_s, energy_j, path_length_m, min_clearance_m, distance_to_goal_m: at the end.
        cost: the LFHH paper's cost of the flown path, see :func:`auvgym.evaluation.flight.cost`.
        time_limit_s, still_water_time_s: the limit, and the straight line in still water.
        steps: environment steps flown.
        reward: the sum of rewards.
        evaluations, replans: what the policy counted.
        gap: what a planner's first plan costs above the section optimum of the same problem, in the
            planner's own cost; None for other policies, and where the plan breaks a constraint.
        planning_seconds: wall clock spent planning; the one column that is not reproducible.
        actions: zlib-compressed float32 bytes of the (steps, d) actions, C order.
    """

    suite: str
    suite_hash: str
    policy: str
    policy_seed: int
    parameters: str
    knows: str
    environment: str
    difficulty: str
    scenario: str
    settings: str
    seed: int
    scenario_hash: str
    engine_version: str
    outcome: str
    error: str
    success: int
    score: float
    time_s: float
    energy_j: float
    path_length_m: float
    min_clearance_m: float | None
    distance_to_goal_m: float
    cost: float | None
    time_limit_s: float
    still_water_time_s: float
    steps: int
    reward: float
    evaluations: int
    replans: int
    gap: float | None
    planning_seconds: float
    actions: bytes

    @property
    def instance(self) -> Instance:
        """What was flown."""
        return Instance(self.environment, self.seed, self.difficulty, self.scenario, self.settings)

    @property
    def stratum(self) -> Stratum:
        """What it is ranked together with: environment, difficulty, scenario, settings."""
        return self.environment, self.difficulty, self.scenario, self.settings

    @property
    def policy_failed(self) -> bool:
        """Whether the policy itself, not the vehicle, lost the episode."""
        return self.outcome in POLICY_FAILURES

    @property
    def values(self) -> tuple[Any, ...]:
        """The row's figures in the order of its fields."""
        return tuple(getattr(self, one.name) for one in fields(self))

    @property
    def checksum(self) -> str:
        """16 hex digits over every figure of the row, as it is kept beside it."""
        parts = [one.hex() if isinstance(one, (bytes, float)) else one for one in self.values]
        return hashlib.sha256(json.dumps(parts).encode()).hexdigest()[:16]

    def action_log(self) -> NDArray[np.float32]:
        """The actions flown, (steps, d) float32."""
        return unpack_actions(self.actions, self.steps)


def pack_actions(actions: list[NDArray[np.float32]]) -> bytes:
    """Compress a list of (d,) actions."""
    joined = np.concatenate(actions) if actions else np.zeros(0, np.float32)
    return zlib.compress(joined.astype("<f4").tobytes(), level=6)


def unpack_actions(packed: bytes, steps: int) -> NDArray[np.float32]:
    """The reverse of :func:`pack_actions`: (steps, d) float32.

    Raises:
        ValueError, zlib.error: it is no log of that many steps; no more than such a log is
            unpacked, whatever the bytes stand for.
    """
    if not 0 <= steps <= MOST_STEPS:
        raise ValueError(f"{steps} steps; at most {MOST_STEPS} are possible")
    unpacker = zlib.decompressobj()
    most = 4 * MOST_ENTRIES * steps
    unpacked = unpacker.decompress(packed, most + 1)
    if len(unpacked) > most or not unpacker.eof or unpacker.unused_data:
        raise ValueError(f"it does not hold {steps} steps")
    flat = np.frombuffer(unpacked, dtype="<f4").astype(np.float32)
    return flat.reshape(steps, -1) if steps else flat.reshape(0, 0)
