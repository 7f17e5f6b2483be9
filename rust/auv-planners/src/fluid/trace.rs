//! A line of the flow from start to goal (eq. 14-15), kept out of obstacles by a guard.

use auv_world::World;
use auv_world::math::{Vec3, add_scaled, distance, norm, sub};
use auv_world::seabed::Floor;

use super::field::Field;
use crate::control::Control;

/// How far a step goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Advance {
    /// As far as the vehicle goes in the time.
    Unit,
    /// As far as the flow goes in the time, as eq. 14 is printed.
    Raw,
}

/// How a line is followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    /// A step (m): speed times time.
    pub step_m: f64,
    /// The guard makes no shorter steps (m).
    pub substep_m: f64,
    /// Speed of the vehicle through water (m/s).
    pub speed_mps: f64,
    /// V0, the speed of the undisturbed flow (m/s).
    pub virtual_speed_mps: f64,
    /// lambda: the share of the flow to the goal, the rest being the current's (eq. 15).
    pub lambda: f64,
    /// How far a step goes.
    pub advance: Advance,
    /// Whether the guard is on.
    pub guard: bool,
    /// The guard lets nothing come nearer than this Gamma.
    pub guard_gamma: f64,
    /// The goal is reached this near (m), and within a step in any case.
    pub capture_m: f64,
    /// A line that is this many times as long as the straight one is lost.
    pub length_factor: f64,
}

/// How a line ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// At the goal.
    Reached,
    /// Too long, or where nothing flows.
    Lost,
    /// The caller interrupted.
    Interrupted,
}

/// The guard puts points out this much farther, in Gamma, than it lets them come.
const BEYOND: f64 = 0.002;
/// The guard's steps are at most this part of the clearance.
const CAREFUL: f64 = 0.3;
/// On an obstacle the guard's steps are no longer than this part of its shortest semi-axis.
const BESIDE: f64 = 0.03;
/// So often a point may be put out of one obstacle into another.
const PUSHES: usize = 16;
/// A flow slower than this part of the undisturbed one stands still.
const STILL: f64 = 1e-9;
/// No line has more steps.
const MOST_STEPS: usize = 20_000;
/// The control is asked once in this many steps.
const ASK_EVERY: usize = 256;
/// Lines keep this part of the box's depth above a level floor.
const ABOVE_FLOOR: f64 = 1e-4;

/// The box that lines stay in.
#[derive(Debug, Clone, Copy)]
pub struct Walls {
    low: Vec3,
    high: Vec3,
}

impl Walls {
    /// The box of the world, above a level floor, widened to hold the ends of the line.
    pub fn new(world: &World, ends: [Vec3; 2]) -> Self {
        let domain = &world.scenario().domain;
        let (mut low, mut high) = (domain.min_m, domain.max_m);
        if let Floor::Flat(depth) = world.floor()
            && world.scenario().dimensions == 3
        {
            high[2] = high[2].min(depth - ABOVE_FLOOR * (high[2] - low[2])).max(low[2]);
        }
        for end in ends {
            for axis in 0..3 {
                (low[axis], high[axis]) = (low[axis].min(end[axis]), high[axis].max(end[axis]));
            }
        }
        Self { low, high }
    }

    /// The nearest point in the box.
    pub fn clamp(&self, point: Vec3) -> Vec3 {
        std::array::from_fn(|axis| point[axis].clamp(self.low[axis], self.high[axis]))
    }

    /// A velocity that does not leave the box.
    pub fn slide(&self, point: Vec3, velocity: Vec3) -> Vec3 {
        std::array::from_fn(|axis| {
            let leaves = (point[axis] <= self.low[axis] && velocity[axis] < 0.0)
                || (point[axis] >= self.high[axis] && velocity[axis] > 0.0);
            if leaves { 0.0 } else { velocity[axis] }
        })
    }
}

/// The undisturbed flow: to the goal, and with the current (eq. 2 and 15).
#[inline]
pub fn undisturbed(world: &World, steps: &Steps, point: Vec3, goal: Vec3) -> Vec3 {
    let to_goal = sub(goal, point);
    let length = norm(to_goal);
    let scale = if length > 0.0 { steps.lambda * steps.virtual_speed_mps / length } else { 0.0 };
    let mut flow = to_goal.map(|step| scale * step);
    if steps.lambda < 1.0 {
        let [u, v] = world.current(point);
        flow[0] += (1.0 - steps.lambda) * u;
        flow[1] += (1.0 - steps.lambda) * v;
    }
    flow
}

/// Follows the flow from `start` and writes every point to `path`, which ends at the goal in any case.
pub fn trace(
    field: &mut Field,
    world: &World,
    steps: &Steps,
    [start, goal]: [Vec3; 2],
    control: &Control<'_>,
    path: &mut Vec<Vec3>,
) -> Ending {
    let walls = Walls::new(world, [start, goal]);
    let longest = steps.length_factor * distance(start, goal);
    let shortest = field.bodies().iter().map(|body| BESIDE * body.shape.smallest()).fold(steps.substep_m, f64::min);
    path.clear();
    path.push(start);
    let (mut here, mut travelled) = (start, 0.0);
    let ending = loop {
        let left = distance(here, goal);
        let free = if steps.guard { field.clearance(here, steps.step_m / CAREFUL) } else { f64::INFINITY };
        let step = steps.step_m.min(shortest.max(CAREFUL * free));
        if left <= step.max(steps.capture_m) {
            break Ending::Reached;
        }
        if travelled > longest || path.len() > MOST_STEPS {
            break Ending::Lost;
        }
        if path.len().is_multiple_of(ASK_EVERY) && control.interrupted() {
            break Ending::Interrupted;
        }
        let flow = undisturbed(world, steps, here, goal);
        let velocity = walls.slide(here, field.velocity(here, goal, flow));
        let speed = norm(velocity);
        if speed <= STILL * steps.virtual_speed_mps {
            break Ending::Lost;
        }
        let far = match steps.advance {
            Advance::Unit => step,
            Advance::Raw => (steps.step_m / steps.speed_mps * speed).min(step),
        };
        let mut next = walls.clamp(add_scaled(here, far / speed, velocity));
        if steps.guard {
            next = put_out(field, &walls, next, steps.guard_gamma, steps.step_m);
        }
        travelled += distance(here, next);
        // Points that do not move count, too, so that the loop ends.
        travelled += 1e-3 * far;
        here = next;
        path.push(here);
    };
    if path.len() > 1 && path[path.len() - 1] == goal {
        path.pop();
    }
    path.push(goal);
    ending
}

/// The point, out of whatever it lies in or touches; a way out longer than `most` is left to the flow.
pub(super) fn put_out(field: &Field, walls: &Walls, point: Vec3, gamma: f64, most: f64) -> Vec3 {
    let mut place = point;
    for _ in 0..PUSHES {
        let Some(body) = field.deepest(place, gamma) else { return place };
        place = walls.clamp(body.shape.outside(place, gamma + BEYOND));
    }
    if distance(point, place) <= most { place } else { point }
}
