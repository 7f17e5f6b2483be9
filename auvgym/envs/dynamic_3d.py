"""``AUVDynamic3D-v0``."""

from auvgym.envs.waypoint import AUVEnv


class AUVDynamic3DEnv(AUVEnv):
    """Cross a box of spheres, peaks and drifting vortices whose map keeps changing.

    ## Description
    A vehicle of 2 m/s crosses 39 km of a box 20 km wide and 20 km deep, among 70 spheres, over 12
    Gaussian peaks and through six Lamb-Oseen vortices (the 3-D world of the LFHH paper, Liu et al.
    2019).

    Between map changes everything is still unless ``obstacle_speed_mps`` or ``vortex_drift_mps``
    say otherwise. When the vehicle has travelled ``change_every_m`` the map changes: every obstacle
    takes a normal step of 500 m standard deviation along each axis, every vortex is drawn anew.
    An obstacle whose new place would come within 900 m of vehicle, start or goal stays where it
    was, so a change never harms by itself. The water moves the vehicle always; line-of-sight
    guidance crabs against it where it can.

    ## Action space
    ``Box(-1, 1, (3,), float32)``: the next waypoint, an offset from the vehicle in the
    goal-aligned frame (forward = horizontal direction to the goal, then left and up), scaled by the reach of
    2000 m:

    | index | offset |
    |---|---|
    | 0 | forward (0.25 + 0.75 a) reach: 0 goes forward, -1 backs out by half the reach |
    | 1 | left a reach |
    | 2 | up a reach |

    The waypoint is clipped to the box (300 m inside its side walls, the surface and the bottom). One step flies
    towards it until it is within 200 m (after at least 60 s), 1500 s have passed, the map changes,
    or the episode ends: about 40 physics ticks of 15 s.

    ## Observation space
    ``Box(low, high, (97,), float32)``. V is the vehicle's speed, d0 the distance at the start, the
    sonar range 5000 m; directions are in the goal-aligned frame. ``env.unwrapped.observation_layout``
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
    any other end. An episode that arrives sums to at least 1.25 - 300 m / d0, one that fails to less
    than 0, whatever the world: the reward orders policies as the leaderboard does.

    ## Starting state
    x uniform in 3 .. 17 km, depth uniform in 2 .. 16 km and 900 m clear of the sea floor, on the near
    side (y = 0), goal likewise at y = 39 km; the vehicle heads for the goal.

    ## Episode end
    The episode terminates (time and energy left are observed, so nothing is truncated):

    - ``goal``: within 300 m of the goal;
    - ``collision``: clearance to anything solid no longer positive;
    - ``out_of_bounds``: more than 500 m outside the box;
    - ``energy``: budget spent (2 times the still-water straight run);
    - ``timeout``: ``time_factor`` times the still-water straight-line time d0 / V.

    ## Info
    ``time_s, energy_j, path_length_m, min_clearance_m, distance_to_goal_m, evaluations, replans,
    map_changes, map_changed, is_success, outcome``; ``reset`` adds ``episode_seed``.

    ## Arguments
    - ``scenario``: a shipped name, the path of a TOML file or a Scenario; None draws a new world of
      the family ``lfhh-3d`` for every episode. ``mission``: its start/goal pair.
    - ``difficulty``: "easy", "normal" (default) or "hard": current ratio and time factor as
      calibrated (see ``docs/calibration.md``).
    - ``variant``: "debiased" (default: obstacles and vortices even over the width, vortices
      turning either way) or "paper" (the papers' distributions).
    - ``current_ratio``: fastest summed current of every map over V, or ``ring_ratio``: ring speed
      of a single vortex over V; ``time_factor``; ``obstacles``; ``vortices``, ``peaks``;
      ``vehicle_speed_mps``; ``change_every_m`` (0: never); ``obstacle_speed_mps``;
      ``vortex_drift_mps``; ``sensor_noise_m`` (0: the ``obstacles`` block is exact).
    - ``action_mode``: "waypoint", as above, or "replan": a planner's path is flown leg by leg, the action is
      ``Discrete(4)`` (0 go on, 1 plan a short window anew, 2 a long one, 3 plan anew to the goal), planning
      takes its time, and the observation goes on with the plan: ``docs/environments.md``. For it alone:
      ``planner`` (default: "astar" on a grid of 1000 m), ``planner_parameters``, ``windows`` (how far a short
      and a long one reach, in parts of d0: 0.2 and 0.5), ``planning_s`` (what planning to the goal takes, s:
      600, windows in proportion; or three numbers) or instead ``seconds_per_evaluation``.
    - ``render_mode``: None, "human" or "rgb_array".

    The same seed gives the same bytes. Environments can be deep-copied and pickled while running
    and go on identically.

    ## Version history
    - v0: first version.
    """

    dimensions = 3
    family = "lfhh-3d"
