"""``AUVStatic3D-v0``."""

from auvgym.envs.waypoint import AUVEnv


class AUVStatic3DEnv(AUVEnv):
    """Cross a tank of spheres and peaks in still water where nothing ever changes.

    ## Description
    A vehicle of 0.5 m/s crosses 39 m of a tank 20 m wide and 20 m deep, among 120 spheres and over
    five Gaussian peaks (the world of the AFHH paper, Liu, Zhan et al. 2018: the same box as LFHH's,
    a thousandth of its size). Vortices, map changes and obstacles that move are there if asked for.

    ## Action space
    ``Box(-1, 1, (3,), float32)``: the next waypoint, an offset from the vehicle in the
    goal-aligned frame (forward = horizontal direction to the goal, then left and up), scaled by the reach of
    2 m:

    | index | offset |
    |---|---|
    | 0 | forward (0.25 + 0.75 a) reach: 0 goes forward, -1 backs out by half the reach |
    | 1 | left a reach |
    | 2 | up a reach |

    The waypoint is clipped to the box (0.3 m inside its side walls, the surface and the bottom). One step flies
    towards it until it is within 0.2 m (after at least 0.24 s), 6 s have passed, or the episode ends:
    about 40 physics ticks of 0.06 s.

    ## Observation space
    ``Box(low, high, (97,), float32)``. V is the vehicle's speed, d0 the distance at the start, the
    sonar range 5 m; directions are in the goal-aligned frame. ``env.unwrapped.observation_layout``
    gives each block's slice. Everything is clipped to its bounds.

    | index | block | bounds | content |
    |---|---|---|---|
    | 0 | goal_distance | -1 .. 1 | 2 d / d0 - 1: distance to the goal on the map over the one at the start |
    | 1 | goal_near | 0 .. 1 | distance to the goal on the map over the sonar range |
    | 2-3 | position | -1 .. 1 | x and y in the box, -1 at its lower and 1 at its upper walls |
    | 4 | time_left | 0 .. 1 | time left over the time limit |
    | 5 | energy_left | 0 .. 1 | energy left over the energy budget |
    | 6 | change_distance | 0 .. 1 | path length since the last map change over that between changes |
    | 7 | change_time | 0 .. 1 | time since the last map change over that of the change distance at full speed |
    | 8-9 | heading | -1 .. 1 | forward and left of the motion through water (unit vector) |
    | 10-11 | frame | -1 .. 1 | x and y of the unit vector towards the goal |
    | 12 | depth | -1 .. 1 | depth in the box, -1 at its top and 1 at its bottom |
    | 13 | altitude | 0 .. 2 | height above the sea floor over the sonar range |
    | 14 | goal_depth | -1 .. 1 | height of the goal above the vehicle over the sonar range |
    | 15 | climb | -1 .. 1 | upward part of the heading (unit vector) |
    | 16-23 | current | -2 .. 2 | forward and left of the current over the vehicle's speed: here, and at (1, 0), (0.6, 0.8), (0.6, -0.8) reach |
    | 24-75 | sonar | 0 .. 1 | 1 - range / sonar range of each beam |
    | 76-96 | obstacles | -1 .. 1 | three nearest within sonar range, each: centre from the vehicle over the sonar range (forward, left[, up]), extent over the sonar range, velocity over the vehicle's speed (forward, left[, up]); zeros if there is none |

    The sonar's beams: elevations 0, 25, -25, 55 and -55 degrees, each with
    azimuths 0, 20, -20, 45, -45, 75, -75, 120, -120 and 180, then straight up and straight down. ``env.unwrapped.sonar_directions`` has them as unit vectors. Walls,
    surface and sea floor return echoes, too.

    ## Reward
    For each step ``(d_before - d_after) / d0 - 0.75 dt / time_limit``, plus 1 on arrival and -1 on
    any other end. An episode that arrives sums to at least 1.25 - 0.3 m / d0, one that fails to less
    than 0, whatever the world: the reward orders policies as the leaderboard does.

    ## Starting state
    x uniform in 3 .. 17 m, depth uniform in 2 .. 16 m and 0.9 m clear of the sea floor, on the near
    side (y = 0), goal likewise at y = 39 m; the vehicle heads for the goal.

    ## Episode end
    The episode terminates (time and energy left are observed, so nothing is truncated):

    - ``goal``: within 0.3 m of the goal;
    - ``collision``: clearance to anything solid no longer positive;
    - ``out_of_bounds``: more than 0.5 m outside the box;
    - ``energy``: budget spent (2 times the still-water straight run);
    - ``timeout``: ``time_factor`` times the still-water straight-line time d0 / V.

    ## Info
    ``time_s, energy_j, path_length_m, min_clearance_m, distance_to_goal_m, evaluations, replans,
    map_changes, map_changed, is_success, outcome``; ``reset`` adds ``episode_seed``.

    ## Arguments
    - ``scenario``: a shipped name (``afhh-1`` .. ``afhh-4`` are the paper's twelve start/goal
      pairs), the path of a TOML file or a Scenario; None draws a new tank of the family ``afhh``
      for every episode. ``mission``: its start/goal pair.
    - ``difficulty``: "easy", "normal" (default) or "hard": 60, 120 or 200 spheres (about 13, 18
      or 24 % of the cells blocked), time factor 1.5, 1.15 or 1.1, and the current ratio of
      vortices that are asked for.
    - ``obstacles``; ``peaks``; ``vortices`` (0) with ``variant`` and ``current_ratio`` or
      ``ring_ratio``; ``time_factor``; ``vehicle_speed_mps``; ``change_every_m`` (0: never);
      ``obstacle_speed_mps``; ``vortex_drift_mps``; ``sensor_noise_m`` (0).
    - ``action_mode``: "waypoint", as above, or "replan": a planner's path is flown leg by leg, the action is
      ``Discrete(4)`` (0 go on, 1 plan a short window anew, 2 a long one, 3 plan anew to the goal), planning
      takes its time, and the observation goes on with the plan: ``docs/environments.md``. For it alone:
      ``planner`` (default: "astar" on a grid of 1 m), ``planner_parameters``, ``windows`` (how far a short
      and a long one reach, in parts of d0: 0.2 and 0.5), ``planning_s`` (what planning to the goal takes, s:
      2.4, windows in proportion; or three numbers) or instead ``seconds_per_evaluation``.
    - ``render_mode``: None, "human" or "rgb_array".

    The same seed gives the same bytes. Environments can be deep-copied and pickled while running
    and go on identically.

    ## Version history
    - v0: first version.
    """

    dimensions = 3
    family = "afhh"
    usual_planning_s = 2.4
