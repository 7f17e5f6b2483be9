//! The time to the goal from every node of a grid, through the present map and currents: Dijkstra's
//! algorithm from the goal outwards, with the time that each edge takes (ground speed along it
//! V_par + sqrt(V^2 - V_perp^2)).

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use auv_world::World;
use auv_world::kinematics::{ground_speed, travel_time};
use auv_world::math::{Vec2, Vec3, add_scaled, distance, norm, sub};
use serde::{Deserialize, Serialize};

/// How finely the world is looked at, and how far from solids.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Distance between nodes (m); 0 chooses 1/80 (2-D) or 1/40 (3-D) of the longest edge of the box.
    pub spacing_m: f64,
    /// Nodes and edges keep this clear of solids (m).
    pub inflation_m: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { spacing_m: 0.0, inflation_m: 300.0 }
    }
}

impl Settings {
    /// The spacing asked for, or `part` of the default for a world (m).
    pub(super) fn spacing_or(&self, world: &World, part: f64) -> f64 {
        if self.spacing_m > 0.0 {
            return self.spacing_m;
        }
        let domain = &world.scenario().domain;
        let longest = (0..3).map(|axis| domain.max_m[axis] - domain.min_m[axis]).fold(0.0, f64::max);
        part * longest / if world.scenario().dimensions == 2 { 80.0 } else { 40.0 }
    }
}

/// Slower over ground than this part of its speed through water, a vehicle is not getting anywhere.
const STALLED: f64 = 0.02;

/// Most nodes a grid may have.
const MOST_NODES: f64 = 4e6;

/// A field of times to the goal.
#[derive(Debug, Clone)]
pub struct TimeField {
    origin: Vec3,
    spacing: Vec3,
    counts: [usize; 3],
    speed: f64,
    inflation: f64,
    goal: Vec3,
    seconds: Vec<f64>,
    /// The node that comes next on the way to the goal; the node itself if that is the goal.
    next: Vec<u32>,
    settled: u64,
}

/// A node to look at, ordered by time, then by index, so that ties are the same everywhere.
#[derive(PartialEq)]
struct Entry {
    seconds: f64,
    node: u32,
}

impl Eq for Entry {}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> Ordering {
        other.seconds.total_cmp(&self.seconds).then(other.node.cmp(&self.node))
    }
}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Steps to neighbours: on the map all coprime steps of up to 3 nodes (32) in 2-D and up to 2 (16) in 3-D,
/// there also one node up or down, and straight up and down.
fn steps(flat: bool) -> Vec<[i32; 3]> {
    let coprime = |a: i32, b: i32| {
        let (mut a, mut b) = (a.abs(), b.abs());
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a == 1
    };
    let reach = if flat { 3 } else { 2 };
    let levels: &[i32] = if flat { &[0] } else { &[0, -1, 1] };
    let mut steps = Vec::new();
    for &dz in levels {
        for dy in -reach..=reach {
            for dx in -reach..=reach {
                if coprime(dx, dy) || (dx == 0 && dy == 0 && dz != 0) {
                    steps.push([dx, dy, dz]);
                }
            }
        }
    }
    steps
}

impl TimeField {
    /// The field of a world as it is now, for its goal or another. `interrupted` is asked now and then;
    /// when it says yes, there is no field.
    pub fn new(world: &World, goal: Vec3, settings: Settings, interrupted: &mut dyn FnMut() -> bool) -> Option<Self> {
        let domain = &world.scenario().domain;
        let flat = world.scenario().dimensions == 2;
        let size: Vec3 = std::array::from_fn(|axis| domain.max_m[axis] - domain.min_m[axis]);
        let wanted = settings.spacing_or(world, 1.0);
        // A finer grid than memory allows is made coarser.
        let nodes: f64 = size.iter().map(|edge| edge / wanted + 1.0).product();
        let wanted = if nodes > MOST_NODES { wanted * (nodes / MOST_NODES).sqrt() } else { wanted };
        let counts: [usize; 3] = std::array::from_fn(|axis| (size[axis] / wanted).round() as usize + 1);
        let spacing: Vec3 = std::array::from_fn(|axis| match counts[axis] {
            1 => wanted,
            count => size[axis] / (count - 1) as f64,
        });
        let total = counts.iter().product();
        let mut field = Self {
            origin: domain.min_m,
            spacing,
            counts,
            speed: world.scenario().vehicle.speed_mps,
            inflation: settings.inflation_m,
            goal,
            seconds: vec![f64::INFINITY; total],
            next: vec![u32::MAX; total],
            settled: 0,
        };
        field.spread(world, &steps(flat), interrupted).then_some(field)
    }

    fn cell(&self, node: usize) -> [usize; 3] {
        [node % self.counts[0], node / self.counts[0] % self.counts[1], node / (self.counts[0] * self.counts[1])]
    }

    /// Where a node lies (m).
    pub fn place(&self, node: usize) -> Vec3 {
        let cell = self.cell(node);
        std::array::from_fn(|axis| self.origin[axis] + cell[axis] as f64 * self.spacing[axis])
    }

    fn spread(&mut self, world: &World, steps: &[[i32; 3]], interrupted: &mut dyn FnMut() -> bool) -> bool {
        let total = self.seconds.len();
        let mut clearance = Vec::with_capacity(total);
        let mut current: Vec<Vec2> = Vec::with_capacity(total);
        for node in 0..total {
            if node.is_multiple_of(4096) && interrupted() {
                return false;
            }
            let place = self.place(node);
            clearance.push(world.clearance(place));
            current.push(world.current(place));
        }
        let edges: Vec<(Vec3, f64, i64)> = steps
            .iter()
            .map(|step| {
                let span: Vec3 = std::array::from_fn(|axis| f64::from(step[axis]) * self.spacing[axis]);
                let length = norm(span);
                let row = self.counts[0] as i64;
                let offset =
                    i64::from(step[0]) + row * (i64::from(step[1]) + self.counts[1] as i64 * i64::from(step[2]));
                (span.map(|component| component / length), length, offset)
            })
            .collect();
        let mut heap = BinaryHeap::new();
        self.seed(world, &clearance, &mut heap);
        let mut done = vec![false; total];
        while let Some(Entry { seconds, node }) = heap.pop() {
            let here = node as usize;
            if done[here] {
                continue;
            }
            done[here] = true;
            self.settled += 1;
            if self.settled.is_multiple_of(1024) && interrupted() {
                return false;
            }
            let cell = self.cell(here);
            for (step, (direction, length, offset)) in steps.iter().zip(&edges) {
                // The edge runs from a neighbour behind to here.
                let inside = (0..3).all(|axis| {
                    let index = cell[axis] as i64 - i64::from(step[axis]);
                    index >= 0 && index < self.counts[axis] as i64
                });
                if !inside {
                    continue;
                }
                let behind = (here as i64 - offset) as usize;
                if done[behind] || clearance[behind] <= self.inflation {
                    continue;
                }
                let pace = self.pace(*direction, current[behind], current[here]);
                let arrival = seconds + length * pace;
                if arrival < self.seconds[behind]
                    && self.free(world, self.place(behind), clearance[behind], self.place(here), clearance[here])
                {
                    self.seconds[behind] = arrival;
                    self.next[behind] = node;
                    heap.push(Entry { seconds: arrival, node: behind as u32 });
                }
            }
        }
        true
    }

    /// Seconds per metre along an edge between two currents, by Simpson's rule over its ends and middle;
    /// infinite where the current wins at any of them.
    #[inline]
    fn pace(&self, direction: Vec3, behind: Vec2, here: Vec2) -> f64 {
        let middle = [0.5 * (behind[0] + here[0]), 0.5 * (behind[1] + here[1])];
        let slowness = |current: Vec2| {
            let over_ground = ground_speed(direction, current, self.speed);
            if over_ground > STALLED * self.speed { 1.0 / over_ground } else { f64::INFINITY }
        };
        (slowness(behind) + 4.0 * slowness(middle) + slowness(here)) / 6.0
    }

    /// Puts the nodes from which the goal is reached directly on the heap.
    fn seed(&mut self, world: &World, clearance: &[f64], heap: &mut BinaryHeap<Entry>) {
        let at_goal = world.clearance(self.goal);
        let near = 1.8 * self.spacing.iter().fold(0.0, |a: f64, b| a.max(*b));
        for node in self.nodes_within(self.goal, near) {
            let place = self.place(node);
            if clearance[node] <= 0.0 || !self.clear_of(world, place, clearance[node], self.goal, at_goal, 0.0) {
                continue;
            }
            let seconds = travel_time(world, place, self.goal, self.speed, 4);
            if seconds.is_finite() {
                self.seconds[node] = seconds;
                self.next[node] = node as u32;
                heap.push(Entry { seconds, node: node as u32 });
            }
        }
    }

    /// Nodes no farther than `radius` from a point, in order of their index.
    fn nodes_within(&self, point: Vec3, radius: f64) -> Vec<usize> {
        let range = |axis: usize| {
            let low = ((point[axis] - radius - self.origin[axis]) / self.spacing[axis]).ceil().max(0.0) as usize;
            let high = ((point[axis] + radius - self.origin[axis]) / self.spacing[axis]).floor();
            let high = if high < 0.0 { 0 } else { (high as usize + 1).min(self.counts[axis]) };
            low..high
        };
        let mut nodes = Vec::new();
        for iz in range(2) {
            for iy in range(1) {
                for ix in range(0) {
                    let node = ix + self.counts[0] * (iy + self.counts[1] * iz);
                    if distance(self.place(node), point) <= radius {
                        nodes.push(node);
                    }
                }
            }
        }
        nodes
    }

    fn free(&self, world: &World, a: Vec3, at_a: f64, b: Vec3, at_b: f64) -> bool {
        // Near start and goal the inflation gives way to what room there is.
        let margin = self.inflation.min(at_a).min(at_b).max(0.0);
        self.clear_of(world, a, at_a, b, at_b, margin)
    }

    /// Whether the segment ab keeps `margin` from everything solid: balls of the clearances at its ends
    /// cover it, or both of its halves are covered.
    fn clear_of(&self, world: &World, a: Vec3, at_a: f64, b: Vec3, at_b: f64, margin: f64) -> bool {
        let length = distance(a, b);
        if at_a < margin || at_b < margin {
            return false;
        }
        if at_a + at_b - 2.0 * margin >= length {
            return true;
        }
        if length < 0.02 * self.spacing[0] {
            return true;
        }
        let middle = add_scaled(a, 0.5, sub(b, a));
        let at_middle = world.clearance(middle);
        self.clear_of(world, a, at_a, middle, at_middle, margin)
            && self.clear_of(world, middle, at_middle, b, at_b, margin)
    }

    /// Where to steer from `position`: the node within `reach_m`, or the goal, that is reached freely and
    /// from which least time is left in all. Nodes nearer than a third of the reach count only if no
    /// farther one is free: along a good path all are nearly equal, and short legs waste replanning.
    /// `None` if nothing is in free reach.
    pub fn best_waypoint(&self, world: &World, position: Vec3, reach_m: f64) -> Option<Vec3> {
        let at_position = world.clearance(position);
        let mut candidates: Vec<(bool, f64, Vec3)> = self
            .nodes_within(position, reach_m)
            .into_iter()
            .filter(|&node| self.seconds[node].is_finite())
            .map(|node| {
                let place = self.place(node);
                let near = 3.0 * distance(place, position) < reach_m;
                (near, self.seconds[node] + travel_time(world, position, place, self.speed, 2), place)
            })
            .filter(|(_, seconds, place)| seconds.is_finite() && *place != position)
            .collect();
        if distance(position, self.goal) <= reach_m {
            candidates.push((false, travel_time(world, position, self.goal, self.speed, 4), self.goal));
        }
        candidates.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        candidates
            .into_iter()
            .map(|(_, _, place)| place)
            .find(|place| self.free(world, position, at_position, *place, world.clearance(*place)))
    }

    /// The time that is left from a node (s), and the node after it.
    pub(super) fn follow(&self, node: usize) -> (f64, usize) {
        (self.seconds[node], self.next[node] as usize)
    }

    /// The best node to enter the field at from `position`, looking ever farther.
    pub(super) fn entry(&self, world: &World, position: Vec3) -> Option<usize> {
        let at_position = world.clearance(position);
        let spacing = self.spacing.iter().fold(0.0, |a: f64, b| a.max(*b));
        (1..=4).find_map(|factor| {
            let mut nodes: Vec<(f64, usize)> = self
                .nodes_within(position, 1.5 * spacing * f64::from(factor))
                .into_iter()
                .filter(|&node| self.seconds[node].is_finite())
                .map(|node| (self.seconds[node] + travel_time(world, position, self.place(node), self.speed, 4), node))
                .filter(|(seconds, _)| seconds.is_finite())
                .collect();
            nodes.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let free = |place: Vec3| self.free(world, position, at_position, place, world.clearance(place));
            nodes.into_iter().map(|(_, node)| node).find(|&node| free(self.place(node)))
        })
    }

    /// Whether a straight leg is free and how long it takes (s).
    pub(super) fn leg(&self, world: &World, a: Vec3, b: Vec3) -> Option<f64> {
        let pieces = (2.0 * distance(a, b) / self.spacing[0]).ceil().clamp(1.0, 64.0) as usize;
        let seconds = travel_time(world, a, b, self.speed, pieces);
        (seconds.is_finite() && self.free(world, a, world.clearance(a), b, world.clearance(b))).then_some(seconds)
    }

    /// Nodes settled: what the field cost.
    pub fn settled(&self) -> u64 {
        self.settled
    }

    /// Time to the goal (s) of every node, x fastest, and how many nodes along x, y, z.
    pub fn seconds(&self) -> (&[f64], [usize; 3]) {
        (&self.seconds, self.counts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use auv_world::families::{Parameters, generate};

    fn still(family: &str) -> World {
        let parameters = Parameters { vortices: Some(0), obstacles: Some(0), ..Parameters::default() };
        World::new(generate(family, 3, &parameters).unwrap(), 3, 0).unwrap()
    }

    #[test]
    fn neighbours() {
        assert_eq!(steps(true).len(), 32);
        assert_eq!(steps(false).len(), 50);
    }

    #[test]
    fn still_water_times_are_distances() {
        let world = still("lfhh-2d");
        let goal = world.mission().goal_m;
        let field = TimeField::new(&world, goal, Settings::default(), &mut || false).unwrap();
        let (seconds, counts) = field.seconds();
        assert_eq!(counts, [41, 81, 1]);
        for (node, time) in seconds.iter().enumerate() {
            let straight = distance(field.place(node), goal) / 2.0;
            assert!(*time >= straight * (1.0 - 1e-12) && *time <= 1.014 * straight + 300.0, "{time} {straight}");
        }
    }

    #[test]
    fn never_steers_into_solids() {
        for family in ["lfhh-2d", "lfhh-3d"] {
            let world = World::new(generate(family, 5, &Parameters::default()).unwrap(), 5, 0).unwrap();
            let goal = world.mission().goal_m;
            let field = TimeField::new(&world, goal, Settings::default(), &mut || false).unwrap();
            let mut position = world.mission().start_m;
            for _ in 0..200 {
                let next = field.best_waypoint(&world, position, 2000.0).unwrap();
                for i in 0..=20 {
                    let point = add_scaled(position, 0.05 * f64::from(i), sub(next, position));
                    assert!(world.clearance(point) > 0.0);
                }
                position = next;
                if position == goal {
                    break;
                }
            }
            assert_eq!(position, goal);
        }
    }

    #[test]
    fn an_interrupted_field_is_none() {
        let world = still("lfhh-2d");
        assert!(TimeField::new(&world, world.mission().goal_m, Settings::default(), &mut || true).is_none());
    }
}
