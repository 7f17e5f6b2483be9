//! What the steps of a lattice weigh, and which of them are free: collisions are tested when a search first
//! wants to take a step, and remembered.

use auv_world::math::Vec3;

use super::lattice::Lattice;
use crate::control::Control;
use crate::cost::Segments;
use crate::sections::SectionProblem;

/// The control is asked once in this many places, whose steps take some microseconds each.
const ASK_EVERY: usize = 64;

/// What a search minimises: the sum of `weight` x weight + `length` x length (m) over the segments.
#[derive(Debug, Clone, Copy)]
pub struct Objective {
    /// Factor of the weights.
    pub weight: f64,
    /// Factor of the lengths.
    pub length: f64,
    /// What a segment counts that may not be taken; infinite to forbid it.
    pub offence: f64,
}

impl Objective {
    #[inline(always)]
    fn of(&self, weight: f64, length: f64) -> f64 {
        (self.weight * weight + self.length * length).min(self.offence)
    }
}

/// A vector along, lateral and in depth (m).
pub type Step = [f64; 3];

/// A lattice with its steps weighed.
pub struct Graph<'a> {
    pub lattice: &'a Lattice,
    segments: &'a mut Segments,
    points: Vec<Vec3>,
    /// Weights of the steps from each place, infinite if it may not be taken. The sign bit is set where
    /// collisions are yet to be tested.
    weights: Vec<f32>,
    lengths: Vec<f32>,
    /// Length and weight from start to each place of the first layer, and from each of the last to the goal.
    ends: [Vec<(f64, f64)>; 2],
    /// Start and goal: lateral place and depth, and distance along to the next layer (m).
    outer: [Step; 2],
    /// Distance between layers (m).
    spacing: f64,
    /// Least cosine that a change of direction may have.
    turn_limit: f64,
}

/// Directions this near to the turn limit, in cosine, count as too sharp, whatever rounding says of them.
const TIE: f64 = 1e-9;

impl<'a> Graph<'a> {
    /// Weighs all steps; `None` if interrupted.
    pub fn new(
        problem: &SectionProblem,
        lattice: &'a Lattice,
        segments: &'a mut Segments,
        control: &Control<'_>,
    ) -> Option<Self> {
        let (layers, nodes, steps) = (lattice.layers(), lattice.nodes(), lattice.steps());
        let points: Vec<Vec3> = (0..layers).flat_map(|layer| lattice.points(problem, layer)).collect();
        let frame = problem.frame();
        let sections = problem.sections();
        let outer = [(0, sections[0]), (1, sections[layers - 1])].map(|(end, section)| {
            let [x, y, z] = problem.ends()[end];
            [(section as f64 - frame.section(x, y)).abs() * frame.spacing_m(), frame.lateral(x, y), z]
        });
        let mut weights = Vec::with_capacity((layers - 1) * nodes * steps);
        let mut lengths = Vec::with_capacity(weights.capacity());
        let mut slots = Vec::with_capacity(steps);
        let mut to = Vec::with_capacity(steps);
        for layer in 0..layers - 1 {
            for array in [&mut weights, &mut lengths] {
                array.resize((layer + 1) * nodes * steps, f32::INFINITY);
            }
            let [first, end] = lattice.span(layer);
            for node in (0..nodes).filter(|node| (first..end).contains(&(node % lattice.columns))) {
                if node % ASK_EVERY == 0 && control.interrupted() {
                    return None;
                }
                slots.clear();
                to.clear();
                let base = (layer * nodes + node) * steps;
                for_steps(lattice, layer, node, [0, lattice.rows], |step, next| {
                    slots.push(base + step);
                    to.push(points[(layer + 1) * nodes + next]);
                });
                for (slot, (length, weight)) in slots.iter().zip(segments.weigh(points[layer * nodes + node], &to)) {
                    lengths[*slot] = length as f32;
                    weights[*slot] = if weight.is_finite() { -(weight as f32) } else { f32::INFINITY };
                }
            }
        }
        let [start, goal] = problem.ends();
        let excluded = |blocked: bool, weight: f64| if blocked { f64::INFINITY } else { weight };
        let near = &points[..nodes];
        let weighed: Vec<_> = segments.weigh(start, near).collect();
        let from_start = weighed.into_iter().zip(near);
        let from_start = from_start
            .map(|((length, weight), to)| (length, excluded(segments.blocks_first(start, *to), weight)))
            .collect();
        let mut to_goal = Vec::with_capacity(nodes);
        for point in &points[(layers - 1) * nodes..] {
            let weighed = segments.weigh(*point, &[goal]).next();
            let (length, weight) = weighed.unwrap_or((0.0, f64::INFINITY));
            to_goal.push((length, excluded(segments.blocks_last(*point, goal), weight)));
        }
        let turn_limit = segments.turn_limit() + TIE;
        let spacing = frame.spacing_m();
        Some(Self {
            lattice,
            segments,
            points,
            weights,
            lengths,
            ends: [from_start, to_goal],
            outer,
            spacing,
            turn_limit,
        })
    }

    /// What the first segment to a node counts.
    pub fn first(&self, objective: &Objective, node: usize) -> f64 {
        let (length, weight) = self.ends[0][node];
        objective.of(weight, length)
    }

    /// What the last segment from a node counts.
    pub fn last(&self, objective: &Objective, node: usize) -> f64 {
        let (length, weight) = self.ends[1][node];
        objective.of(weight, length)
    }

    /// Number of a node's step 0.
    #[inline(always)]
    pub fn base(&self, layer: usize, node: usize) -> usize {
        (layer * self.lattice.nodes() + node) * self.lattice.steps()
    }

    /// What a step counts, if it proves free.
    #[inline(always)]
    pub fn step(&self, objective: &Objective, edge: usize) -> f64 {
        objective.of(f64::from(self.weights[edge].abs()), f64::from(self.lengths[edge]))
    }

    /// Whether a step was tested before, or could never be taken.
    #[inline(always)]
    pub fn is_known(&self, edge: usize) -> bool {
        self.weights[edge].is_sign_positive()
    }

    /// Whether a step is free; tests it if nobody did.
    #[inline]
    pub fn is_free(&mut self, edge: usize, layer: usize, from: usize, to: usize) -> bool {
        if !self.is_known(edge) {
            let nodes = self.lattice.nodes();
            let blocked =
                self.segments.blocks(self.points[layer * nodes + from], self.points[(layer + 1) * nodes + to]);
            self.weights[edge] = if blocked { f32::INFINITY } else { -self.weights[edge] };
        }
        self.weights[edge].is_finite()
    }

    /// The step from a node to one on the next layer.
    #[inline(always)]
    pub fn between(&self, layer: usize, from: usize, to: usize) -> Step {
        let (a, b) = (self.lattice.place(layer, from), self.lattice.place(layer + 1, to));
        [self.spacing, b[0] - a[0], b[1] - a[1]]
    }

    /// The step from start to a node.
    pub fn first_step(&self, node: usize) -> Step {
        let [along, lateral, depth] = self.outer[0];
        let place = self.lattice.place(0, node);
        [along, place[0] - lateral, place[1] - depth]
    }

    /// The step from a node to the goal.
    pub fn last_step(&self, node: usize) -> Step {
        let [along, lateral, depth] = self.outer[1];
        let place = self.lattice.place(self.lattice.layers() - 1, node);
        [along, lateral - place[0], depth - place[1]]
    }

    /// Whether a vehicle may turn from one step to the other.
    #[inline(always)]
    pub fn may_turn(&self, a: Step, b: Step) -> bool {
        let dot = |a: Step, b: Step| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        dot(a, b) >= self.turn_limit * (dot(a, a) * dot(b, b)).sqrt()
    }

    /// Sums of weights and lengths (m) along a path of nodes.
    pub fn sums(&self, path: &[usize]) -> (f64, f64) {
        let ends = [self.ends[0][path[0]], self.ends[1][path[path.len() - 1]]];
        let ((mut length, mut weight), last) = (ends[0], ends[1]);
        for (layer, pair) in path.windows(2).enumerate() {
            let edge = self.base(layer, pair[0]) + step_between(self.lattice, pair[0], pair[1]);
            length += f64::from(self.lengths[edge]);
            weight += f64::from(self.weights[edge].abs());
        }
        (weight + last.1, length + last.0)
    }
}

/// Calls `visit` with number and end of each step from a node that stays within the lattice and the rows.
#[inline(always)]
pub fn for_steps(lattice: &Lattice, layer: usize, node: usize, rows: [usize; 2], mut visit: impl FnMut(usize, usize)) {
    let [across, down] = lattice.reach;
    let (row, column) = (node / lattice.columns, node % lattice.columns);
    let [first, end] = lattice.span(layer + 1);
    let left = first.max(column.saturating_sub(across));
    let right = end.min(column + across + 1);
    for next_row in rows[0].max(row.saturating_sub(down))..rows[1].min(row + down + 1) {
        // Both differences are at least 0 by the bounds above.
        let step = (next_row + down - row) * (2 * across + 1);
        for next in left..right {
            visit(step + next + across - column, next_row * lattice.columns + next);
        }
    }
}

/// Number of the step from a node to one on the next layer.
pub fn step_between(lattice: &Lattice, from: usize, to: usize) -> usize {
    let [across, down] = lattice.reach;
    let place = |node: usize| (node / lattice.columns, node % lattice.columns);
    let ((row, column), (next_row, next)) = (place(from), place(to));
    (next_row + down - row) * (2 * across + 1) + next + across - column
}

/// The node from which a step leads to `to`.
#[inline(always)]
pub fn before(lattice: &Lattice, step: usize, to: usize) -> usize {
    let [across, down] = lattice.reach;
    let width = 2 * across + 1;
    to + down * lattice.columns + across - (step / width) * lattice.columns - step % width
}
