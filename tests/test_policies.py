"""Policies: every one flies, none remembers, and the floors do what their names say."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest

import auvgym
from auvgym import policies
from auvgym.evaluation import Instance, PolicySpec, Store, Suite, run
from auvgym.policies.planner import next_waypoint

FLOORS = ["random", "hold", "straight", "lane", "sonar-rule", "astar-replan"]
ENVIRONMENTS = ["AUVDynamic2D-v0", "AUVDynamic3D-v0", "AUVStatic3D-v0"]

# Still water and one disc across the straight line: what a policy knows decides how it ends.
ONE_DISC = {
    "schema": 1,
    "name": "one-disc",
    "dimensions": 2,
    "domain": {"min_m": [0, 0, 0], "max_m": [20_000, 20_000, 0], "margin_m": 500},
    "missions": [{"start_m": [10_000, 0, 0], "goal_m": [10_000, 19_000, 0]}],
    "limits": {"time_factor": 3.0, "energy_factor": 4.0},
    "sections": {"count": 20, "spacing_m": 1000.0, "frame": "domain"},
    "obstacles": [{"kind": "disc", "position_m": [10_000, 9_000], "radius_m": 1_200}],
}


def fly(env: gymnasium.Env[Any, Any], policy: Any, seed: int) -> dict[str, Any]:
    """One episode; the last info, with the actions flown under "actions"."""
    observation, info = env.reset(seed=seed)
    policy.reset(env)
    actions, ended = [], False
    while not ended:
        action = policy.act(observation, info)
        assert env.action_space.contains(action), f"{policy.name}: {action!r}"
        actions.append(action)
        observation, _, terminated, truncated, info = env.step(action)
        ended = terminated or truncated
    return {**info, "actions": np.array(actions)}


def test_the_floors_and_every_planner_are_listed() -> None:
    names = auvgym.list_policies()
    assert names[: len(FLOORS)] == FLOORS
    assert set(auvgym.list_planners()) <= set(names)
    for name in names:
        policy = policies.make(name)
        assert isinstance(policy, policies.Policy)
        assert policy.name == name
        assert policy.knows in ("nothing", "sensors", "map")


@pytest.mark.parametrize("environment", ENVIRONMENTS)
@pytest.mark.parametrize("name", [*FLOORS, "lfhh"])
def test_a_policy_flies_the_same_whatever_it_flew_before(name: str, environment: str) -> None:
    env = gymnasium.make(f"auvgym:{environment}")
    fresh = fly(env, policies.make(name), seed=3)
    used = policies.make(name)
    fly(env, used, seed=4)
    again = fly(env, used, seed=3)
    assert np.array_equal(fresh.pop("actions"), again.pop("actions"))
    assert fresh == again
    assert fresh["outcome"] in ("goal", "collision", "out_of_bounds", "energy", "timeout")


@pytest.mark.parametrize("environment", ENVIRONMENTS)
def test_planners_count_what_they_spend(environment: str) -> None:
    env = gymnasium.make(f"auvgym:{environment}")
    for name in ("astar-replan", "lfhh"):
        policy: Any = policies.make(name)
        info = fly(env, policy, seed=3)
        assert policy.evaluations > 0
        assert policy.planning_seconds > 0.0
        # A change that ends the episode too leaves nobody to plan again.
        assert info["map_changes"] - 1 <= policy.replans <= info["map_changes"]


def test_random_depends_on_both_seeds() -> None:
    env = gymnasium.make("auvgym:AUVDynamic2D-v0")
    first = [
        fly(env, policies.make("random", seed=policy), seed=episode)["actions"][0].tolist()
        for policy, episode in ((0, 0), (0, 1), (1, 0))
    ]
    assert len({tuple(action) for action in first}) == 3


def test_hold_stays_until_the_time_is_up() -> None:
    env = gymnasium.make("auvgym:AUVDynamic2D-v0", scenario=auvgym.Scenario.from_dict(ONE_DISC))
    info = fly(env, policies.make("hold"), seed=0)
    assert info["outcome"] == "timeout"
    assert info["distance_to_goal_m"] == pytest.approx(19_000, abs=300)


@pytest.mark.parametrize(
    ("name", "outcome"),
    [
        ("straight", "collision"),
        ("sonar-rule", "goal"),
        ("lane", "goal"),
        ("astar-replan", "goal"),
        ("lfhh", "goal"),
    ],
)
def test_who_gets_past_one_disc(name: str, outcome: str) -> None:
    env = gymnasium.make("auvgym:AUVDynamic2D-v0", scenario=auvgym.Scenario.from_dict(ONE_DISC))
    info = fly(env, policies.make(name), seed=0)
    assert info["outcome"] == outcome
    if outcome == "goal":
        assert info["min_clearance_m"] > 0.0


def test_lane_keeps_to_the_eastern_margin() -> None:
    env = gymnasium.make("auvgym:AUVDynamic2D-v0")
    east = 0.0
    for seed in range(6):
        fly(env, policies.make("lane"), seed)
        core: Any = env.unwrapped
        trail = np.asarray(core.episode.trail)
        east = max(east, float(trail[:, 0].max()))
    assert east > 0.85 * 20_000


def test_a_planner_draws_its_plan() -> None:
    env = gymnasium.make("auvgym:AUVDynamic3D-v0")
    env.reset(seed=0)
    policies.make("lfhh").reset(env)
    core: Any = env.unwrapped
    assert core.plan.shape[1] == 3
    assert np.allclose(core.plan[0], core.world.start)
    assert np.allclose(core.plan[-1], core.world.goal)


def test_waypoints_are_skipped_when_reached_or_passed() -> None:
    path = np.array([[0, 0, 0], [0, 1000, 0], [1000, 1000, 0], [1000, 2000, 0]], dtype=np.float64)
    assert next_waypoint(path, 0, np.array([0, 0, 0.0]), 200) == 1
    assert next_waypoint(path, 1, np.array([0, 850, 0.0]), 200) == 2  # reached
    assert next_waypoint(path, 1, np.array([-900, 1001, 0.0]), 200) == 2  # carried beside it
    assert next_waypoint(path, 2, np.array([500, 1200, 0.0]), 200) == 2
    assert next_waypoint(path, 3, np.array([1000, 2500, 0.0]), 200) == 3  # the last is kept


def test_unknown_names_and_parameters_say_what_there_is() -> None:
    with pytest.raises(
        policies.PolicyError, match=r"did you mean 'straight'.*there are: .*astar-replan"
    ):
        policies.make("strait")
    with pytest.raises(policies.PolicyError, match=r"unknown parameter 'tube'.*tube_radius_m"):
        policies.make("sonar-rule", tube=1.0)
    with pytest.raises(auvgym.PlanningError, match="unknown field `generatons`"):
        policies.make("lfhh", generatons=3)
    with pytest.raises(policies.PolicyError, match='cannot import module "no_such_module"'):
        policies.make("no_such_module:Policy")
    with pytest.raises(policies.PolicyError, match='has no class "Nothing"'):
        policies.make("json:Nothing")
    with pytest.raises(policies.PolicyError, match='has no method "reset"'):
        policies.make("json:JSONDecoder")


def test_a_class_of_ones_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "drifter.py").write_text(
        "import numpy as np\n"
        "class Drifter:\n"
        "    name, knows = 'drifter', 'nothing'\n"
        "    def __init__(self, push=0.5): self.push = push\n"
        "    def reset(self, env): self.shape = env.action_space.shape\n"
        "    def act(self, observation, info):\n"
        "        return np.full(self.shape, self.push, np.float32)\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    suite = Suite("own", (Instance("AUVDynamic2D-v0", 0),))
    with Store(None) as store:
        (result,) = run(suite, [PolicySpec("drifter:Drifter", 0, {"push": 0.25})], store)
    assert result.knows == "nothing"
    assert np.all(result.action_log() == 0.25)
