//! The graph over a grid: which nodes are open, which edges are free, and how long they take in the present
//! currents (length over the ground speed V_par + sqrt(V^2 - V_perp^2)).

use std::cell::Cell;

use auv_world::World;
use auv_world::kinematics::{ground_speed, travel_time};
use auv_world::math::{Vec2, Vec3, distance, norm};

use super::nodes::Grid;

/// Slower over ground than this part of its speed through water, a vehicle is not getting anywhere.
const STALLED: f64 = 0.02;

/// Paces of edges are remembered if there are not more of them than this for each node.
const PACES_PER_NODE: usize = 4;

/// Which way edges are followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// As the vehicle goes.
    Forwards,
    /// To where the vehicle comes from.
    Backwards,
}

/// All edges that take the same step from node to node.
pub struct Edge {
    index: usize,
    step: [i64; 3],
    /// The same in node indices.
    offset: i64,
    direction: Vec3,
    length: f64,
}

/// A grid through the present map and currents, with a goal.
pub struct Graph<'a> {
    world: &'a World,
    grid: &'a Grid,
    clearance: Vec<f64>,
    current: Vec<Vec2>,
    edges: Vec<Edge>,
    /// How far edges step along each axis, at most.
    reach: [usize; 3],
    /// Seconds per metre of each edge from each node of one level, NaN where not known yet: the same on all levels if
    /// currents are. Empty where they are not, or there are too few levels for that to be worth its memory.
    paces: Vec<Cell<f64>>,
    /// Nodes from which the goal is reached directly, in order of their index, and how long that takes (s).
    exits: Vec<(usize, f64)>,
    /// No leg or edge is faster (m/s).
    fastest: f64,
}

impl<'a> Graph<'a> {
    /// The graph of a world as it is now; `None` if interrupted.
    pub fn new(world: &'a World, grid: &'a Grid, goal: Vec3, interrupted: &mut dyn FnMut() -> bool) -> Option<Self> {
        let (total, layer, level) = (grid.len(), grid.layer(), world.has_level_currents());
        let mut clearance = Vec::with_capacity(total);
        let mut current: Vec<Vec2> = Vec::with_capacity(total);
        let mut swiftest = 0.0_f64;
        for node in 0..total {
            if node.is_multiple_of(4096) && interrupted() {
                return None;
            }
            let place = grid.place(node);
            clearance.push(world.clearance(place));
            let flow = if level && node >= layer { current[node - layer] } else { world.current(place) };
            swiftest = swiftest.max(flow[0] * flow[0] + flow[1] * flow[1]);
            current.push(flow);
        }
        let edges = edges(grid, world.scenario().dimensions == 2);
        let steps = |axis: usize| edges.iter().map(|edge| edge.step[axis].unsigned_abs() as usize).max().unwrap_or(0);
        let paces = if level && layer * edges.len() <= PACES_PER_NODE * total { layer * edges.len() } else { 0 };
        let mut graph = Self {
            world,
            grid,
            clearance,
            current,
            reach: std::array::from_fn(steps),
            paces: vec![Cell::new(f64::NAN); paces],
            edges,
            exits: Vec::new(),
            fastest: grid.speed() + swiftest.sqrt(),
        };
        graph.find_exits(goal);
        Some(graph)
    }

    fn find_exits(&mut self, goal: Vec3) {
        let at_goal = self.world.clearance(goal);
        for node in self.grid.nodes_within(goal, 1.8 * self.grid.widest()) {
            let (place, room) = (self.grid.place(node), self.clearance[node]);
            if room <= 0.0 || !self.grid.clear_of(self.world, place, room, goal, at_goal, 0.0) {
                continue;
            }
            let seconds = travel_time(self.world, place, goal, self.grid.speed(), 4);
            if seconds.is_finite() {
                self.exits.push((node, seconds));
                // Between nodes the current may be stronger than at any of them.
                self.fastest = self.fastest.max(if seconds > 0.0 { distance(place, goal) / seconds } else { 0.0 });
            }
        }
    }

    /// Nodes from which the goal is reached directly, and the time that takes (s).
    pub fn exits(&self) -> &[(usize, f64)] {
        &self.exits
    }

    /// The time from a node straight to the goal (s), if it is an exit.
    pub fn exit(&self, node: usize) -> Option<f64> {
        self.exits.binary_search_by_key(&node, |exit| exit.0).ok().map(|place| self.exits[place].1)
    }

    /// No way is faster than this over ground (m/s): the vehicle's speed and the strongest current there is.
    pub fn fastest(&self) -> f64 {
        self.fastest
    }

    /// Whether a way may lead through a node: only the last before the goal may be nearer to solids than the
    /// inflation.
    pub fn may_lead(&self, node: usize) -> bool {
        self.is_open(node) || self.exit(node).is_some()
    }

    /// Whether a way from `position`, `room` metres clear of solids, may begin with this node.
    pub fn may_begin(&self, position: Vec3, room: f64, node: usize) -> bool {
        let free = || self.grid.free(self.world, position, room, self.grid.place(node), self.clearance[node]);
        self.may_lead(node) && free()
    }

    fn is_open(&self, node: usize) -> bool {
        self.clearance[node] > self.grid.inflation()
    }

    /// The nodes to which (or from which) edges lead, and the edges.
    #[inline]
    pub fn neighbours(&self, node: usize, direction: Direction) -> impl Iterator<Item = (usize, &Edge)> {
        let (cell, counts) = (self.grid.cell(node), self.grid.counts());
        let central = (0..3).all(|axis| cell[axis] >= self.reach[axis] && cell[axis] + self.reach[axis] < counts[axis]);
        let (cell, counts) = (cell.map(|index| index as i64), counts.map(|count| count as i64));
        let sign = if direction == Direction::Forwards { 1 } else { -1 };
        // Only open nodes lead on.
        let edges = if direction == Direction::Backwards || self.is_open(node) { &self.edges[..] } else { &[] };
        edges.iter().filter_map(move |edge| {
            let inside =
                central || (0..3).all(|axis| (0..counts[axis]).contains(&(cell[axis] + sign * edge.step[axis])));
            if !inside {
                return None;
            }
            let other = (node as i64 + sign * edge.offset) as usize;
            let useful = if direction == Direction::Forwards { self.may_lead(other) } else { self.is_open(other) };
            useful.then_some((other, edge))
        })
    }

    /// The time that an edge between two nodes takes (s).
    #[inline]
    pub fn seconds(&self, edge: &Edge, behind: usize, ahead: usize) -> f64 {
        let pace = || self.pace(edge.direction, self.current[behind], self.current[ahead]);
        if self.paces.is_empty() {
            return edge.length * pace();
        }
        let known = &self.paces[behind % self.grid.layer() * self.edges.len() + edge.index];
        if known.get().is_nan() {
            known.set(pace());
        }
        edge.length * known.get()
    }

    /// Whether the edge between two nodes is free.
    pub fn is_free(&self, behind: usize, ahead: usize) -> bool {
        let grid = self.grid;
        grid.free(self.world, grid.place(behind), self.clearance[behind], grid.place(ahead), self.clearance[ahead])
    }

    /// Seconds per metre along an edge between two currents, by Simpson's rule over its ends and middle;
    /// infinite where the current wins at any of them.
    #[inline]
    fn pace(&self, direction: Vec3, behind: Vec2, ahead: Vec2) -> f64 {
        let speed = self.grid.speed();
        let middle = [0.5 * (behind[0] + ahead[0]), 0.5 * (behind[1] + ahead[1])];
        let slowness = |current: Vec2| {
            let over_ground = ground_speed(direction, current, speed);
            if over_ground > STALLED * speed { 1.0 / over_ground } else { f64::INFINITY }
        };
        (slowness(behind) + 4.0 * slowness(middle) + slowness(ahead)) / 6.0
    }
}

fn edges(grid: &Grid, flat: bool) -> Vec<Edge> {
    let (spacing, counts) = (grid.spacing(), grid.counts().map(|count| count as i64));
    let edge = |(index, step): (usize, [i64; 3])| {
        let span: Vec3 = std::array::from_fn(|axis| step[axis] as f64 * spacing[axis]);
        let length = norm(span);
        let offset = step[0] + counts[0] * (step[1] + counts[1] * step[2]);
        Edge { index, step, offset, direction: span.map(|component| component / length), length }
    };
    steps(flat).into_iter().enumerate().map(edge).collect()
}

/// Steps to neighbours: on the map all coprime steps of up to 3 nodes (32) in 2-D and up to 2 (16) in 3-D,
/// there also one node up or down, and straight up and down.
fn steps(flat: bool) -> Vec<[i64; 3]> {
    let coprime = |a: i64, b: i64| {
        let (mut a, mut b) = (a.abs(), b.abs());
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a == 1
    };
    let reach = if flat { 3 } else { 2 };
    let levels: &[i64] = if flat { &[0] } else { &[0, -1, 1] };
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

#[cfg(test)]
mod tests {
    use auv_world::families::{Parameters, generate};

    use super::*;
    use crate::grid::Settings;

    #[test]
    fn neighbours() {
        assert_eq!(steps(true).len(), 32);
        assert_eq!(steps(false).len(), 50);
    }

    #[test]
    fn what_is_remembered_of_one_depth_holds_at_all() {
        let world = World::new(generate("lfhh-3d", 5, &Parameters::default()).unwrap(), 5, 0).unwrap();
        let grid = Grid::new(&world, Settings::default());
        let graph = Graph::new(&world, &grid, world.mission().goal_m, &mut || false).unwrap();
        assert!(!graph.paces.is_empty() && grid.len() >= 4 * grid.layer());
        let mut looked = 0;
        // From the deepest level up, then down: those that remember and those that are remembered.
        for node in (0..grid.len()).rev().step_by(7).chain((0..grid.len()).step_by(5)) {
            assert_eq!(graph.current[node], world.current(grid.place(node)));
            for (other, edge) in graph.neighbours(node, Direction::Forwards) {
                let afresh = edge.length * graph.pace(edge.direction, graph.current[node], graph.current[other]);
                assert_eq!(graph.seconds(edge, node, other).to_bits(), afresh.to_bits());
                looked += 1;
            }
        }
        assert!(looked > 10_000);
    }
}
