"""``AUVHarbor2D-v0``."""

from auvgym.envs.waypoint import AUVEnv


class AUVHarbor2DEnv(AUVEnv):
    """Cross a harbour basin between polygons in a steady current, past vessels if asked for.

    ## Description
    A vehicle of 1.5 m/s crosses a basin of 200 x 200 m among polygons that need not be convex, may
    overlap and reach beyond the walls, in a uniform current of random direction (after Huang & Jin
    2021). A way that is 4 m clear of polygons always exists. The map never changes.

    With ``vessels`` discs of 4 to 8 m radius are under way, each on a straight course at constant
    speed: over polygons as if they were not there, and back at the walls. They begin 25 m clear of
    start and goal. The map that a policy is given shows where they are, not where they will be, so
    that a plan grows old: the planners' policies take ``replan_every_s`` for that.

    A danger zone is a margin that planners keep: the hull of a polygon, 1.875 m wider unless told
    (``auvgym.maklink``). Nothing happens to a vehicle that enters one. What counts as a collision
    is clearance to the polygons and discs themselves. The water moves the vehicle always, but
    nothing else; line-of-sight guidance crabs against it where it can.

    ## Action space
    ``Box(-1, 1, (2,), float32)``: the next waypoint, an offset from the vehicle in the
    goal-aligned frame (forward = horizontal direction to the goal, then left), scaled by the reach of
    20 m:

    | index | offset |
    |---|---|
    | 0 | forward (0.25 + 0.75 a) reach: 0 goes forward, -1 backs out by half the reach |
    | 1 | left a reach |

    The waypoint is clipped to the box (1 m inside its side walls). One step flies
    towards it until it is within 2 m (after at least 0.8 s), 20 s have passed, or the episode ends: about 40
    physics ticks of 0.2 s.

    ## Observation space
    ``Box(low, high, (59,), float32)``. V is the vehicle's speed, d0 the distance at the start, the
    sonar range 50 m; directions are in the goal-aligned frame. ``env.unwrapped.observation_layout``
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
    | 12-19 | current | -2 .. 2 | forward and left of the current over the vehicle's speed: here, and at (1, 0), (0.6, 0.8), (0.6, -0.8) reach |
    | 20-43 | sonar | 0 .. 1 | 1 - range / sonar range of each beam |
    | 44-58 | obstacles | -1 .. 1 | three nearest within sonar range, each: centre from the vehicle over the sonar range (forward, left[, up]), extent over the sonar range, velocity over the vehicle's speed (forward, left[, up]); zeros if there is none |

    The sonar's beams: 24, every 15 degrees from forward to the left. ``env.unwrapped.sonar_directions`` has them as unit vectors. Walls,
    surface and sea floor return echoes, too.

    ## Reward
    For each step ``(d_before - d_after) / d0 - 0.75 dt / time_limit``, plus 1 on arrival and -1 on
    any other end. An episode that arrives sums to at least 1.25 - 3 m / d0, one that fails to less
    than 0, whatever the world: the reward orders policies as the leaderboard does.

    ## Starting state
    Start and goal anywhere in the basin, 10 m inside its walls, at least 100 m apart and 12 m clear
    of polygons; the vehicle heads for the goal.

    ## Episode end
    The episode terminates (time and energy left are observed, so nothing is truncated):

    - ``goal``: within 3 m of the goal;
    - ``collision``: clearance to anything solid no longer positive;
    - ``out_of_bounds``: more than 5 m outside the box;
    - ``energy``: budget spent (``time_factor`` times the still-water straight run);
    - ``timeout``: ``time_factor`` times the still-water straight-line time d0 / V.

    ## Info
    ``time_s, energy_j, path_length_m, min_clearance_m, distance_to_goal_m, evaluations, replans,
    map_changes, map_changed, is_success, outcome``; ``reset`` adds ``episode_seed``.

    ## Arguments
    - ``scenario``: a shipped name (``harbor-p``, ``harbor-a``, ``harbor-b``, ``harbor-book``, and
      ``harbor-raster`` of 35 x 35 m), the path of a TOML file or a Scenario, with any currents; None
      draws a new basin of the family ``harbor`` for every episode. ``mission``: its start/goal pair.
    - ``difficulty``: "easy", "normal" (default) or "hard": polygons, current ratio and time factor
      as calibrated (see ``docs/calibration.md``).
    - ``obstacles``: polygons; ``vessels`` (0); ``obstacle_speed_mps``: of the fastest vessel (0.6 V;
      the slowest has half of it); ``current_ratio``: the current's speed over V, 0 for still water;
      ``time_factor``; ``vehicle_speed_mps``; ``sensor_noise_m`` (0: the ``obstacles`` block is exact).
    - ``action_mode``: "waypoint", as above, or "replan": a planner's path is flown leg by leg, the action is
      ``Discrete(4)`` (0 go on, 1 plan a short window anew, 2 a long one, 3 plan anew to the goal), planning
      takes its time, and the observation goes on with the plan: ``docs/environments.md``. For it alone:
      ``planner`` (default: "astar" on a grid of 2.5 m), ``planner_parameters``, ``windows`` (how far a short
      and a long one reach, in parts of d0: 0.2 and 0.5), ``planning_s`` (what planning to the goal takes, s:
      5, windows in proportion; or three numbers) or instead ``seconds_per_evaluation``.
    - ``render_mode``: None, "human" or "rgb_array".

    The same seed gives the same bytes. Environments can be deep-copied and pickled while running
    and go on identically.

    ## Version history
    - v0: first version.
    """

    dimensions = 2
    family = "harbor"
    usual_planning_s = 5.0
