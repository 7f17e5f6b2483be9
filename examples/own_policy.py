"""A policy of one's own, flown against shipped ones on a suite.

python examples/own_policy.py [SUITE]        # default: demo

The command line knows it, too: cd examples && auvgym evaluate --policy own_policy:ClearestBeam
"""

import sys

import numpy as np

from auvgym import evaluation, policies

LOOK_M = 2000.0


class ClearestBeam(policies.ScriptedPolicy):
    """Goes along the sonar beam that is best for both room and direction."""

    name = "clearest-beam"
    knows = "sensors"
    description = "the beam with the best sum of free range and heading for the goal"

    def reset(self, env):
        super().reset(env)
        self.sonar = self.env.observation_layout["sonar"]
        self.beams = self.env.sonar_directions  # unit vectors: forward (to the goal), left, up

    def act(self, observation, info):
        free = 1.0 - observation[self.sonar]  # 1 where nothing is within the sonar's range
        best = self.beams[np.argmax(free + self.beams[:, 0])]
        if free[0] > 0.5 or info["distance_to_goal_m"] < LOOK_M:
            return self.steer_to(self.goal)
        # Forward, left[, up] are the entries of an action; 0 already goes forward by a quarter.
        action = best[: self.env.dimensions].astype(np.float32)
        action[0] = (action[0] - 0.25) / 0.75
        return np.clip(action, -1.0, 1.0)


def main() -> None:
    suite = evaluation.load_suite(sys.argv[1] if len(sys.argv) > 1 else "demo")
    names = ["own_policy:ClearestBeam", "sonar-rule", "straight"]
    specs = [evaluation.PolicySpec(name) for name in names]
    with evaluation.Store(None) as store:
        results = evaluation.run(suite, specs, store)
    for row in evaluation.summarise(results):
        solved = f"{row.solved}/{row.episodes}"
        print(f"{row.environment}  {row.rank}. {row.policy:24} {solved:>6}  score {row.score:.3f}")


if __name__ == "__main__":
    main()
