//! What a trigger sees of the plan in flight, after what every agent sees.

use auv_world::World;
use auv_world::math::{distance, sub};

use super::Pilot;
use super::course::{Course, Way, piece_m};
use crate::episode::Episode;
use crate::frame::Frame;
use crate::observation::{Entry, Writer};

/// Where along the plan its currents are told, in parts of the sonar range.
const LOOKS: [f64; 3] = [0.25, 0.5, 1.0];

/// So much of the time limit makes an entry of 1 in `planning_delay`.
const LONGEST_DELAY: f64 = 0.1;

/// A conflict is looked for at least so often along the plan, in parts of the reach.
const STEP: f64 = 0.01;

/// Blocks of the plan in order: name, length in 2-D, length in 3-D, bounds, meaning.
pub const BLOCKS: [Entry; 10] = [
    (
        "plan_conflict",
        1,
        1,
        0.0,
        1.0,
        "1 - way along the plan to where it comes within the station radius of something solid, over the sonar range; \
         0 if it does not within that",
    ),
    ("plan_changes", 1, 1, 0.0, 1.0, "a quarter of the number of map changes since the plan was made"),
    ("plan_age", 2, 2, 0.0, 1.0, "since the plan was made: path length over d0, time over the time limit"),
    (
        "plan_left",
        2,
        2,
        0.0,
        2.0,
        "length left of the plan over d0; time that its map promises for it over the time left",
    ),
    (
        "plan_leg",
        3,
        4,
        -1.0,
        1.0,
        "unit vector to where the next leg is steered (forward, left[, up]); its distance over the reach",
    ),
    (
        "plan_current",
        6,
        6,
        -2.0,
        2.0,
        "along and to the left of the plan, over the vehicle's speed: the current that the plan's map promises at \
         0.25, 0.5 and 1 sonar range along it",
    ),
    ("plan_error", 6, 6, -2.0, 2.0, "the same: promised minus present current"),
    (
        "plan_loss",
        1,
        1,
        -1.0,
        1.0,
        "time for the plan within sonar range in the present current minus the promised one, over the time that it \
         takes in still water",
    ),
    ("plan_feasible", 1, 1, 0.0, 1.0, "1 if the planner found its plan to break no constraint"),
    (
        "planning_delay",
        3,
        3,
        0.0,
        1.0,
        "what planning in the short, the long and the full window takes over a tenth of the time limit",
    ),
];

/// Fills what `out` has left with what there is to know of the plan.
pub(crate) fn observe(episode: &Episode, pilot: &mut Pilot, out: &mut Writer<'_>) {
    let (world, state) = (episode.world(), episode.state());
    let (flight, limits) = (&world.scenario().episode, episode.limits());
    let (speed, position) = (world.scenario().vehicle.speed_mps, state.position);
    let axes = usize::from(world.scenario().dimensions);
    let range = flight.sonar_range_m;
    pilot.course.advance(position, flight.capture_radius_m);
    pilot.course.ahead(position, range, &mut pilot.way);
    let (course, way) = (&pilot.course, &pilot.way);

    let conflict = conflict(world, way);
    out.put(conflict.map_or(0.0, |far| 1.0 - far / range), 0.0, 1.0);
    let changes = world.changes().len() - course.map.changes().len();
    out.put(0.25 * changes as f64, 0.0, 1.0);
    out.put((state.path_length_m - course.made_m) / limits.distance_m, 0.0, 1.0);
    out.put((state.time_s - course.map.time_s()) / limits.time_s, 0.0, 1.0);
    let [length, time] = course.left(position);
    out.put(length / limits.distance_m, 0.0, 2.0);
    out.put(time / (limits.time_s - state.time_s).max(1e-9), 0.0, 2.0);
    let aim = course.aim(position, flight);
    let offset = Frame::towards(position, world.mission().goal_m).from_world(sub(aim, position));
    let far = distance(aim, position);
    offset[..axes].iter().for_each(|entry| out.put(entry / far.max(1e-9), -1.0, 1.0));
    out.put(far / flight.reach_m, -1.0, 1.0);
    let promised = look(&course.map, way, range);
    let present = if course.outdated(world) { look(world, way, range) } else { promised };
    promised.iter().for_each(|entry| out.put(entry / speed, -2.0, 2.0));
    promised.iter().zip(present).for_each(|(then, now)| out.put((then - now) / speed, -2.0, 2.0));
    out.put(loss(course, world, way), -1.0, 1.0);
    out.put(f64::from(u8::from(course.feasible)), 0.0, 1.0);
    for delay in pilot.delays {
        out.put(delay / (LONGEST_DELAY * limits.time_s), 0.0, 1.0);
    }
}

/// Currents (m/s) along and to the left of the way, at each of [`LOOKS`] along it.
fn look(world: &World, way: &Way, range: f64) -> [f64; 2 * LOOKS.len()] {
    let mut entries = [0.0; 2 * LOOKS.len()];
    for (pair, part) in entries.chunks_exact_mut(2).zip(LOOKS) {
        let (point, direction) = way.at(part * range);
        let level = (direction[0] * direction[0] + direction[1] * direction[1]).sqrt().max(1e-9);
        let (ex, ey) = (direction[0] / level, direction[1] / level);
        let [x, y] = world.current(point);
        (pair[0], pair[1]) = (x * ex + y * ey, y * ex - x * ey);
    }
    entries
}

/// What the present current costs against the promised one, in parts of the still-water time of the way.
fn loss(course: &Course, world: &World, way: &Way) -> f64 {
    if !course.outdated(world) {
        return 0.0;
    }
    let still = way.length() / world.scenario().vehicle.speed_mps;
    // A current that wins takes for ever: as long as makes the difference count in full.
    let seconds = |world: &World| way.seconds(world, piece_m(&world.scenario().episode)).min(4.0 * still);
    (seconds(world) - seconds(&course.map)) / still.max(1e-9)
}

/// How far along the way (m) it first comes within the station radius of something solid. Where the vehicle is
/// nearer than twice that already, half its clearance counts instead: a way that leads off is no conflict.
fn conflict(world: &World, way: &Way) -> Option<f64> {
    let flight = &world.scenario().episode;
    let near = flight.station_radius_m.min(0.5 * world.clearance(way.at(0.0).0));
    let mut far = 0.0;
    while far <= way.length() {
        let clearance = world.clearance(way.at(far).0);
        if clearance <= near {
            return Some(far);
        }
        far += (clearance - near).max(STEP * flight.reach_m);
    }
    None
}
