"""``AUVThreat3D-v0``."""

from auvgym.envs.waypoint import AUVEnv


class AUVThreat3DEnv(AUVEnv):
    """Cross a box through a meandering jet while threats on steady courses cross the way.

    ## Description
    A vehicle of 2 m/s goes 14.1 km from corner to corner of a box of 10 x 10 x 4 km, at 3 km depth,
    through a meandering jet at rest, among six threats: spheres of 500 to 1000 m radius that move
    all the time, each on a level course at constant speed that meets a vehicle on the straight way
    or nearly so (after Yao & Zhao 2018). With ``manoeuvres`` they turn or zigzag on the way, and are seen to
    do so only as they do it. A threat that comes to a wall of the box is reflected. The
    map never changes otherwise. The water moves the vehicle always, but no threat; line-of-sight
    guidance crabs against it where it can.

    Threats are seen within the sonar range, with noise: the ``obstacles`` block of the observation
    is measured anew at each step. All other entries are exact.

    ## Action space
    ``Box(-1, 1, (3,), float32)``: the next waypoint, an offset from the vehicle in the
    goal-aligned frame (forward = horizontal direction to the goal, then left and up), scaled by the reach of
    600 m:

    | index | offset |
    |---|---|
    | 0 | forward (0.25 + 0.75 a) reach: 0 goes forward, -1 backs out by half the reach |
    | 1 | left a reach |
    | 2 | up a reach |

    The waypoint is clipped to the box (100 m inside its side walls, the surface and the bottom). One step flies
    towards it until it is within 100 m (after at least 3 s), 60 s have passed, or the episode ends:
    1 to 20 physics ticks of 3 s, so that a waypoint less than 100 m off decides for one tick alone.

    ## Observation space
    ``Box(low, high, (97,), float32)``. V is the vehicle's speed, d0 the distance at the start, the
    sonar range 3000 m; directions are in the goal-aligned frame. ``env.unwrapped.observation_layout``
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

    With ``sensor_noise_m`` > 0 a seen centre has normal noise of that standard deviation along each
    axis, and a seen velocity that of the difference of two such centres 60 s apart (at 20 m:
    0.47 m/s along each axis). The noise follows from the episode's seed and the time.

    ## Reward
    For each step ``(d_before - d_after) / d0 - 0.75 dt / time_limit``, plus 1 on arrival and -1 on
    any other end. An episode that arrives sums to at least 1.25 - 300 m / d0, one that fails to less
    than 0, whatever the world: the reward orders policies as the leaderboard does.

    ## Starting state
    The vehicle at (0, 0, 3) km, heading for the goal at (10, 10, 3) km; every threat within the box
    and 900 m clear of both.

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
    - ``scenario``: a shipped name (``iifds-threat1``, ``iifds-threats3``, ``iifds-complex``: exact
      sensors), the path of a TOML file or a Scenario; None draws new threats and a new jet of the
      family ``iifds`` for every episode. ``mission``: its start/goal pair.
    - ``difficulty``: "easy", "normal" (default) or "hard": 3, 6 or 10 threats of at most 1, 3.5 or
      4 m/s, a jet of 0.2, 0.5 or 0.7 V on its centre line, time factor 1.5, 1.75 or 2.
    - ``obstacles``: how many threats; ``obstacle_speed_mps``: of the fastest threat; ``current_ratio``: the jet's
      speed over V, 0 for still water; ``time_factor``; ``vehicle_speed_mps``;
      ``manoeuvres``: "none" (default), "turn" (each in a circle), "zigzag" or "mixed";
      ``sensor_noise_m`` (20; 0: exact).
    - ``action_mode``: "waypoint". ``render_mode``: None, "human" or "rgb_array".

    The same seed gives the same bytes. Environments can be deep-copied and pickled while running
    and go on identically.

    ## Version history
    - v0: first version.
    """

    dimensions = 3
    family = "iifds"
