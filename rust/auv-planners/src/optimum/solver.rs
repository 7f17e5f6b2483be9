//! The best path through a lattice for a sum over its segments, by dynamic programming in two passes.
//!
//! Backwards from the goal, over places: what is at least still to come, turns disregarded. Forwards from
//! the start, over steps (the turn limit ties each step to the one before): only those that can be part of
//! a path below a ceiling. The ceiling starts just above the first pass's optimum and is raised until a path
//! comes through, so that few steps are looked at; the result is exact nevertheless.

use super::graph::{Graph, Objective, before, for_steps};
use crate::control::Control;

/// First height of the ceiling above the bound, in parts of it ...
const FIRST_CEILING: f64 = 1e-3;
/// ... and by how much it grows.
const GROWTH: f64 = 4.0;
/// The control is asked once in so many places or steps.
const ASK_EVERY: usize = 64;
/// No such place.
const NONE: usize = usize::MAX;

/// What is known of a problem after its solution.
#[derive(Debug, Clone)]
pub struct Solution {
    /// No path counts less. Infinite if there is none.
    pub bound: f64,
    /// The best path, node by node, unless none counts less than the ceiling.
    pub path: Option<Vec<usize>>,
}

/// Memory of the two passes, kept from one solution to the next.
#[derive(Debug, Default)]
pub struct Solver {
    /// The least that is still to come, by layer and node.
    rest: Vec<f64>,
    /// The least so far over each step of the present layer and of the next.
    so_far: [Vec<f64>; 2],
    /// The steps among them that were reached, as pairs of node and step.
    reached: [Vec<(u32, u32)>; 2],
    /// The step before each step.
    parents: Vec<u32>,
}

impl Solver {
    /// The best path within rows `rows[0] .. rows[1]` that counts no more than `ceiling`; with `turns`, of
    /// those that keep the turn limit. `None` if interrupted.
    pub fn solve(
        &mut self,
        graph: &mut Graph<'_>,
        objective: &Objective,
        rows: [usize; 2],
        ceiling: f64,
        turns: bool,
        control: &Control<'_>,
    ) -> Option<Solution> {
        self.look_back(graph, objective, rows, control)?;
        let (bound, first) = self.least_first(graph, objective);
        if bound >= ceiling || first == NONE {
            return Some(Solution { bound, path: None });
        }
        let straight = self.descend(graph, objective, rows, first);
        if !turns || keeps_turns(graph, &straight) {
            return Some(Solution { bound, path: Some(straight) });
        }
        let mut height = FIRST_CEILING * bound.abs();
        loop {
            // Beyond twice the bound whatever there is will do.
            let present = if height < bound.abs() { ceiling.min(bound + height) } else { ceiling };
            let found = self.look_forward(graph, objective, rows, present, control)?;
            if let Some((value, path)) = found {
                return Some(Solution { bound: value, path: Some(path) });
            }
            if present >= ceiling {
                return Some(Solution { bound: ceiling, path: None });
            }
            height *= GROWTH;
        }
    }

    /// The first pass.
    fn look_back(
        &mut self,
        graph: &mut Graph<'_>,
        objective: &Objective,
        rows: [usize; 2],
        control: &Control<'_>,
    ) -> Option<()> {
        let lattice = graph.lattice;
        let (layers, nodes, columns) = (lattice.layers(), lattice.nodes(), lattice.columns);
        self.rest.clear();
        self.rest.resize(layers * nodes, f64::INFINITY);
        for layer in (0..layers).rev() {
            let [first, end] = lattice.span(layer);
            let within = (rows[0]..rows[1]).flat_map(|row| (first..end).map(move |column| row * columns + column));
            let (present, next) = self.rest[layer * nodes..].split_at_mut(nodes);
            for (i, node) in within.enumerate() {
                if i % ASK_EVERY == 0 && control.interrupted() {
                    return None;
                }
                present[node] = if layer + 1 == layers {
                    graph.last(objective, node)
                } else {
                    least_step(graph, objective, layer, node, rows, next).0
                };
            }
        }
        Some(())
    }

    /// The bound and the node of the first layer where it is met.
    fn least_first(&self, graph: &Graph<'_>, objective: &Objective) -> (f64, usize) {
        let values = (0..graph.lattice.nodes()).map(|node| (graph.first(objective, node) + self.rest[node], node));
        values.fold((f64::INFINITY, NONE), |best, value| if value.0 < best.0 { value } else { best })
    }

    /// The path of the first pass from a node of the first layer.
    fn descend(&self, graph: &mut Graph<'_>, objective: &Objective, rows: [usize; 2], first: usize) -> Vec<usize> {
        let (layers, nodes) = (graph.lattice.layers(), graph.lattice.nodes());
        let mut path = vec![first];
        for layer in 0..layers - 1 {
            let next = &self.rest[(layer + 1) * nodes..];
            path.push(least_step(graph, objective, layer, path[layer], rows, next).1);
        }
        path
    }

    /// The second pass: the best path that keeps the turn limit and counts no more than `ceiling`.
    fn look_forward(
        &mut self,
        graph: &mut Graph<'_>,
        objective: &Objective,
        rows: [usize; 2],
        ceiling: f64,
        control: &Control<'_>,
    ) -> Option<Option<(f64, Vec<usize>)>> {
        let lattice = graph.lattice;
        let (layers, nodes, steps) = (lattice.layers(), lattice.nodes(), lattice.steps());
        let Self { rest, so_far, reached, parents } = self;
        // Rounding must not hide the path that the ceiling came from.
        let ceiling = ceiling + 1e-12 * ceiling.abs();
        for values in so_far.iter_mut() {
            values.clear();
            values.resize(nodes * steps, f64::INFINITY);
        }
        parents.resize((layers - 1) * nodes * steps, 0);
        reached.iter_mut().for_each(Vec::clear);
        let mut best = (f64::INFINITY, NONE, 0);
        // Takes every step that may follow one that led to `node` on `layer`.
        let [mut here, mut there] = [0, 1];
        for node in 0..nodes {
            let value = graph.first(objective, node);
            if value + rest[node] > ceiling {
                continue;
            }
            if node % ASK_EVERY == 0 && control.interrupted() {
                return None;
            }
            let arrived = graph.first_step(node);
            if layers == 1 {
                let total = value + rest[node];
                if total < best.0 && graph.may_turn(arrived, graph.last_step(node)) {
                    best = (total, node, 0);
                }
                continue;
            }
            let mut take = Expansion { rest, so_far: &mut so_far[here], reached: &mut reached[here], parents, ceiling };
            take.expand(graph, objective, rows, 0, node, value, 0, arrived);
        }
        for layer in 1..layers {
            for i in 0..reached[here].len() {
                if i % ASK_EVERY == 0 && control.interrupted() {
                    return None;
                }
                let (from, step) = reached[here][i];
                let (from, step) = (from as usize, step as usize);
                let slot = from * steps + step;
                let node = after(graph, step, from);
                let value = std::mem::replace(&mut so_far[here][slot], f64::INFINITY);
                let arrived = graph.between(layer - 1, from, node);
                if layer + 1 == layers {
                    let total = value + rest[layer * nodes + node];
                    if total < best.0 && total <= ceiling && graph.may_turn(arrived, graph.last_step(node)) {
                        best = (total, node, step);
                    }
                    continue;
                }
                let mut take =
                    Expansion { rest, so_far: &mut so_far[there], reached: &mut reached[there], parents, ceiling };
                take.expand(graph, objective, rows, layer, node, value, step as u32, arrived);
            }
            reached[here].clear();
            std::mem::swap(&mut here, &mut there);
        }
        if best.1 == NONE {
            return Some(None);
        }
        let mut path = vec![best.1];
        let (mut node, mut step) = (best.1, best.2);
        for layer in (0..layers - 1).rev() {
            node = before(lattice, step, node);
            path.push(node);
            step = parents[graph.base(layer, node) + step] as usize;
        }
        path.reverse();
        Some(Some((best.0, path)))
    }
}

/// Where the steps out of a node are noted.
struct Expansion<'a> {
    rest: &'a [f64],
    so_far: &'a mut [f64],
    reached: &'a mut Vec<(u32, u32)>,
    parents: &'a mut [u32],
    ceiling: f64,
}

impl Expansion<'_> {
    /// Takes every step from a node that may follow the step `parent` by which it was reached.
    #[allow(clippy::too_many_arguments)]
    #[inline]
    fn expand(
        &mut self,
        graph: &mut Graph<'_>,
        objective: &Objective,
        rows: [usize; 2],
        layer: usize,
        node: usize,
        value: f64,
        parent: u32,
        arrived: [f64; 3],
    ) {
        let (nodes, base) = (graph.lattice.nodes(), graph.base(layer, node));
        let next = &self.rest[(layer + 1) * nodes..];
        for_steps(graph.lattice, layer, node, rows, |step, to| {
            let so_far = value + graph.step(objective, base + step);
            let slot = node * graph.lattice.steps() + step;
            if so_far + next[to] <= self.ceiling
                && so_far < self.so_far[slot]
                && graph.may_turn(arrived, graph.between(layer, node, to))
                && graph.is_free(base + step, layer, node, to)
            {
                if self.so_far[slot] == f64::INFINITY {
                    self.reached.push((node as u32, step as u32));
                }
                self.so_far[slot] = so_far;
                self.parents[base + step] = parent;
            }
        });
    }
}

/// The least that can follow a node, and the next node on that way.
fn least_step(
    graph: &mut Graph<'_>,
    objective: &Objective,
    layer: usize,
    node: usize,
    rows: [usize; 2],
    next: &[f64],
) -> (f64, usize) {
    let base = graph.base(layer, node);
    loop {
        let mut best = (f64::INFINITY, NONE, NONE);
        for_steps(graph.lattice, layer, node, rows, |step, to| {
            let value = graph.step(objective, base + step) + next[to];
            if value < best.0 {
                best = (value, to, base + step);
            }
        });
        // A step that proves blocked weighs more now: look again.
        if best.1 == NONE || graph.is_known(best.2) || graph.is_free(best.2, layer, node, best.1) {
            return (best.0, best.1);
        }
    }
}

/// The node to which a step leads.
#[inline(always)]
fn after(graph: &Graph<'_>, step: usize, from: usize) -> usize {
    let [across, down] = graph.lattice.reach;
    let (columns, width) = (graph.lattice.columns, 2 * across + 1);
    from + (step / width) * columns + step % width - down * columns - across
}

/// Whether no turn of a path is too sharp.
fn keeps_turns(graph: &Graph<'_>, path: &[usize]) -> bool {
    let mut arrived = graph.first_step(path[0]);
    for (layer, pair) in path.windows(2).enumerate() {
        let leaving = graph.between(layer, pair[0], pair[1]);
        if !graph.may_turn(arrived, leaving) {
            return false;
        }
        arrived = leaving;
    }
    graph.may_turn(arrived, graph.last_step(path[path.len() - 1]))
}
