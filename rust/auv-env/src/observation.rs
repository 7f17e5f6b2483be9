//! What an agent sees: a flat vector of 32-bit floats in named blocks, each within its stated bounds.

use auv_world::math::{Vec3, add_scaled, norm};
use auv_world::rng::{Purpose, Stream};

use crate::episode::Episode;
use crate::frame::Frame;
use crate::replan;

/// Obstacles described one by one.
pub const NEAREST: usize = 3;

/// A block of the observation.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// Its name.
    pub name: &'static str,
    /// Where it starts.
    pub start: usize,
    /// Its length.
    pub len: usize,
    /// Least value.
    pub low: f32,
    /// Greatest value.
    pub high: f32,
    /// What it says, in which unit.
    pub meaning: &'static str,
}

/// What there is of a block: name, length in 2-D, length in 3-D, bounds, meaning.
pub type Entry = (&'static str, usize, usize, f32, f32, &'static str);

/// What is decided: where to go next, or whether to plan anew.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// The next waypoint.
    Waypoint,
    /// Whether to plan anew; then the plan is seen, too.
    Replan,
}

impl Mode {
    /// Entries of an action in 2 or 3 dimensions.
    pub fn action_len(self, dimensions: u8) -> usize {
        match self {
            Self::Waypoint => usize::from(dimensions),
            Self::Replan => 1,
        }
    }
}

/// Blocks of the vehicle and what is round it, in order.
const BLOCKS: [Entry; 16] = [
    ("goal_distance", 1, 1, -1.0, 1.0, "2 d / d0 - 1: distance to the goal on the map over the one at the start"),
    ("goal_near", 1, 1, 0.0, 1.0, "distance to the goal on the map over the sonar range"),
    ("position", 2, 2, -1.0, 1.0, "x and y in the box, -1 at its lower and 1 at its upper walls"),
    ("time_left", 1, 1, 0.0, 1.0, "time left over the time limit"),
    ("energy_left", 1, 1, 0.0, 1.0, "energy left over the energy budget"),
    ("change_distance", 1, 1, 0.0, 1.0, "path length since the last map change over that between changes"),
    ("change_time", 1, 1, 0.0, 1.0, "time since the last map change over that of the change distance at full speed"),
    ("heading", 2, 2, -1.0, 1.0, "forward and left of the motion through water (unit vector)"),
    ("frame", 2, 2, -1.0, 1.0, "x and y of the unit vector towards the goal"),
    ("depth", 0, 1, -1.0, 1.0, "depth in the box, -1 at its top and 1 at its bottom"),
    ("altitude", 0, 1, 0.0, 2.0, "height above the sea floor over the sonar range"),
    ("goal_depth", 0, 1, -1.0, 1.0, "height of the goal above the vehicle over the sonar range"),
    ("climb", 0, 1, -1.0, 1.0, "upward part of the heading (unit vector)"),
    (
        "current",
        8,
        8,
        -2.0,
        2.0,
        "forward and left of the current over the vehicle's speed: here, and at (1, 0), (0.6, 0.8), (0.6, -0.8) reach",
    ),
    ("sonar", 24, 52, 0.0, 1.0, "1 - range / sonar range of each beam"),
    (
        "obstacles",
        15,
        21,
        -1.0,
        1.0,
        "three nearest within sonar range, each: centre from the vehicle over the sonar range (forward, left[, up]), \
         extent over the sonar range, velocity over the vehicle's speed (forward, left[, up]); zeros if there is none",
    ),
];

/// All blocks of a mode.
fn blocks(mode: Mode) -> impl Iterator<Item = &'static Entry> {
    let plan: &[Entry] = match mode {
        Mode::Waypoint => &[],
        Mode::Replan => &replan::BLOCKS,
    };
    BLOCKS.iter().chain(plan)
}

/// The blocks of an observation in 2 or 3 dimensions.
pub fn layout(dimensions: u8, mode: Mode) -> Vec<Block> {
    let mut start = 0;
    blocks(mode)
        .filter_map(|&(name, flat, deep, low, high, meaning)| {
            let len = if dimensions == 2 { flat } else { deep };
            let block = Block { name, start, len, low, high, meaning };
            start += len;
            (len > 0).then_some(block)
        })
        .collect()
}

/// Length of an observation.
pub fn length(dimensions: u8, mode: Mode) -> usize {
    blocks(mode).map(|block| if dimensions == 2 { block.1 } else { block.2 }).sum()
}

/// Writes values one after another, each clipped to the bounds of its block.
pub(crate) struct Writer<'a> {
    values: &'a mut [f32],
    next: usize,
}

impl<'a> Writer<'a> {
    pub(crate) fn new(values: &'a mut [f32]) -> Self {
        Self { values, next: 0 }
    }

    #[inline]
    pub(crate) fn put(&mut self, value: f64, low: f64, high: f64) {
        self.values[self.next] = value.clamp(low, high) as f32;
        self.next += 1;
    }

    /// Puts what `value` makes of each of `from`.
    #[inline]
    fn put_all(&mut self, from: &[f64], value: impl Fn(f64) -> f64, low: f64, high: f64) {
        let first = self.next;
        self.next += from.len();
        let to = self.values[first..self.next].iter_mut().zip(from);
        to.for_each(|(to, from)| *to = value(*from).clamp(low, high) as f32);
    }
}

/// Seconds between the two looks from which a velocity is told.
const BETWEEN_LOOKS_S: f64 = 60.0;

/// What sees obstacles. Its noise follows from the episode's seed and the tick, so that looking twice at one
/// time shows the same.
struct Sensor {
    noise_m: f64,
    stream: Stream,
}

impl Sensor {
    fn new(episode: &Episode) -> Self {
        let stream = Stream::new(episode.world().seed(), Purpose::Sensor, episode.state().ticks as u32);
        Self { noise_m: episode.world().scenario().episode.sensor_noise_m, stream }
    }

    /// A true position (m) as it is seen.
    fn position(&mut self, truth: Vec3, axes: usize) -> Vec3 {
        self.disturbed(truth, axes, self.noise_m)
    }

    /// A true velocity (m/s) as it is seen: the difference of two positions over the time between.
    fn velocity(&mut self, truth: Vec3, axes: usize) -> Vec3 {
        self.disturbed(truth, axes, std::f64::consts::SQRT_2 * self.noise_m / BETWEEN_LOOKS_S)
    }

    fn disturbed(&mut self, mut truth: Vec3, axes: usize, deviation: f64) -> Vec3 {
        if deviation > 0.0 {
            truth[..axes].iter_mut().for_each(|entry| *entry = self.stream.normal(*entry, deviation));
        }
        truth
    }
}

/// An obstacle within sonar range.
#[derive(Debug, Clone, Copy)]
struct Contact {
    gap: f64,
    offset: Vec3,
    index: usize,
}

/// Writes what the vehicle sees now.
pub(crate) fn observe(episode: &Episode, ranges: &[f64], out: &mut Writer<'_>) {
    let (world, state) = (episode.world(), episode.state());
    let (domain, flight) = (&world.scenario().domain, &world.scenario().episode);
    let (position, goal) = (state.position, world.mission().goal_m);
    let deep = world.scenario().dimensions == 3;
    let frame = Frame::towards(position, goal);
    let (speed, sonar_range) = (world.scenario().vehicle.speed_mps, flight.sonar_range_m);
    let distance = norm([goal[0] - position[0], goal[1] - position[1], 0.0]);
    let inside =
        |axis: usize| 2.0 * (position[axis] - domain.min_m[axis]) / (domain.max_m[axis] - domain.min_m[axis]) - 1.0;

    out.put(2.0 * distance / episode.limits().distance_m - 1.0, -1.0, 1.0);
    out.put(distance / sonar_range, 0.0, 1.0);
    out.put(inside(0), -1.0, 1.0);
    out.put(inside(1), -1.0, 1.0);
    out.put(1.0 - state.time_s / episode.limits().time_s, 0.0, 1.0);
    out.put(1.0 - state.energy_j / episode.limits().energy_j, 0.0, 1.0);
    let every = world.scenario().change.as_ref().map_or(f64::INFINITY, auv_world::scenario::Change::every_m);
    out.put(state.since_change_m / every, 0.0, 1.0);
    let last = world.changes().last().map_or(0.0, |change| change.time_s);
    out.put((state.time_s - last) * speed / every, 0.0, 1.0);
    let heading = frame.from_world(state.heading);
    out.put(heading[0], -1.0, 1.0);
    out.put(heading[1], -1.0, 1.0);
    out.put(frame.forward[0], -1.0, 1.0);
    out.put(frame.forward[1], -1.0, 1.0);
    if deep {
        out.put(inside(2), -1.0, 1.0);
        out.put((world.floor_depth(position[0], position[1]) - position[2]) / sonar_range, 0.0, 2.0);
        out.put((position[2] - goal[2]) / sonar_range, -1.0, 1.0);
        out.put(heading[2], -1.0, 1.0);
    }
    let looks = [[0.0, 0.0], [1.0, 0.0], [0.6, 0.8], [0.6, -0.8]]
        .map(|ahead| add_scaled(position, flight.reach_m, frame.to_world([ahead[0], ahead[1], 0.0])));
    for current in world.currents(looks) {
        let [forward, left] = frame.flat(current);
        out.put(forward / speed, -2.0, 2.0);
        out.put(left / speed, -2.0, 2.0);
    }
    out.put_all(ranges, |range| 1.0 - range / sonar_range, 0.0, 1.0);
    let axes = if deep { 3 } else { 2 };
    let mut sensor = Sensor::new(episode);
    for contact in nearest(episode, sonar_range, axes) {
        let Some(contact) = contact else {
            for _ in 0..2 * axes + 1 {
                out.put(0.0, 0.0, 0.0);
            }
            continue;
        };
        let offset = frame.from_world(sensor.position(contact.offset, axes));
        let velocity = frame.from_world(sensor.velocity(world.obstacle_velocity(contact.index), axes));
        offset[..axes].iter().for_each(|v| out.put(v / sonar_range, -1.0, 1.0));
        out.put(world.extents()[contact.index] / sonar_range, 0.0, 1.0);
        velocity[..axes].iter().for_each(|v| out.put(v / speed, -1.0, 1.0));
    }
}

/// The nearest obstacles whose extent reaches into sonar range, nearest first, of equals the first.
fn nearest(episode: &Episode, sonar_range: f64, axes: usize) -> [Option<Contact>; NEAREST] {
    let world = episode.world();
    let mut found: [Option<Contact>; NEAREST] = [None; NEAREST];
    let rank = |c: &Option<Contact>| c.map_or((f64::INFINITY, usize::MAX), |c| (c.gap, c.index));
    for (index, mut offset) in episode.within_sonar() {
        let extent = world.extents()[index];
        if axes == 2 {
            offset[2] = 0.0;
        }
        let square = offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2];
        let reach = extent + sonar_range;
        if square >= reach * reach {
            continue;
        }
        let mut contact = Some(Contact { gap: square.sqrt() - extent, offset, index });
        for slot in &mut found {
            if rank(&contact) < rank(slot) {
                std::mem::swap(slot, &mut contact);
            }
        }
    }
    found
}
