//! The best path through a lattice, for each cost.
//!
//! Cost `lfhh` is g(L) + A with g(L) = 1 - L0 / L, concave in the path's length L, and A the mean angle. A
//! concave function lies below its tangents, so with mu = g'(L*) = L0 / L*^2 the least of g(L) + A is the
//! least over mu of 1 - 2 sqrt(L0 mu) + v(mu), where v(mu) = min (A + mu L) is a sum over segments. v is
//! concave, too, so between two mu it lies above the chord, and that bounds what any path can reach there:
//! the interval with the least bound is split until no bound is below the best path found.

use super::graph::{Graph, Objective};
use super::solver::{Solution, Solver};
use crate::control::Control;
use crate::cost::Cost;

/// Intervals whose bound is no more than this below the best path are done with.
const TOLERANCE: f64 = 1e-9;
/// At most so many mu are tried: some twenty suffice where any path does.
const MOST_TRIALS: usize = 64;
/// At each mu paths count that cost up to this much more than the best: what is known to lie so far above it
/// bounds a wide interval.
const HEADROOM: f64 = 0.02;
/// What a segment that may not be taken counts where no path can do without: more than any whole path.
pub const OFFENCE: f64 = 1e9;

/// What to do with each path found; `None` to stop.
pub type Visit<'a> = dyn FnMut(&[usize]) -> Option<()> + 'a;

/// A section problem in numbers.
#[derive(Debug, Clone, Copy)]
pub struct Aim {
    pub cost: Cost,
    /// Distance from start to goal (m).
    pub direct: f64,
    /// Number of segments.
    pub segments: f64,
    /// Depths of start and goal (m).
    pub depths: [f64; 2],
    /// Depth of the box (m).
    pub depth: f64,
}

impl Aim {
    /// What is minimised where a path's length (m) counts `mu` each metre.
    pub fn objective(&self, mu: f64) -> Objective {
        let (weight, length) = match self.cost {
            Cost::Lfhh => (1.0 / self.segments, mu),
            Cost::Afhh => (1.0, 1.0),
            Cost::Time | Cost::Energy => (1.0, 0.0),
        };
        Objective { weight, length, offence: f64::INFINITY }
    }

    /// mu at a path's length (m): the slope of its share in the cost.
    pub fn slope(&self, length: f64) -> f64 {
        if length > 0.0 { self.direct / (length * length) } else { 0.0 }
    }

    /// Whether turns count.
    pub fn turns(&self) -> bool {
        self.cost != Cost::Afhh
    }
}

/// Solves for the cost and shows every path found on the way. Gives a bound that no path through the lattice
/// can be below, in units of the cost (cost `time`, `energy`: seconds); infinite if no path is feasible, `None`
/// if stopped.
pub fn optimise(
    solver: &mut Solver,
    graph: &mut Graph<'_>,
    aim: &Aim,
    control: &Control<'_>,
    visit: &mut Visit<'_>,
) -> Option<f64> {
    let all = [0, graph.lattice.rows];
    match aim.cost {
        Cost::Lfhh if aim.direct > 0.0 => sweep(solver, graph, aim, control, visit),
        Cost::Afhh => bands(solver, graph, aim, control, visit),
        _ => {
            let found = solver.solve(graph, &aim.objective(0.0), all, f64::INFINITY, aim.turns(), control)?;
            if let Some(path) = &found.path {
                visit(path)?;
            }
            Some(found.bound)
        }
    }
}

/// The path of the fewest segments that may not be taken; turns are not looked at.
pub fn least_offending(
    solver: &mut Solver,
    graph: &mut Graph<'_>,
    aim: &Aim,
    control: &Control<'_>,
) -> Option<Solution> {
    let objective = Objective { offence: OFFENCE, ..aim.objective(aim.slope(aim.direct)) };
    let all = [0, graph.lattice.rows];
    solver.solve(graph, &objective, all, f64::INFINITY, false, control)
}

/// v at one mu, or a bound of it.
#[derive(Debug, Clone, Copy)]
struct Sample {
    mu: f64,
    value: f64,
}

/// The sweep of mu for cost `lfhh`.
struct Sweep<'a, 'b, 'c> {
    solver: &'a mut Solver,
    graph: &'a mut Graph<'b>,
    aim: &'a Aim,
    control: &'a Control<'c>,
    /// The least cost of the paths found.
    best: f64,
    trials: usize,
}

impl Sweep<'_, '_, '_> {
    /// The tangent of the length's share at the length where its slope is mu, at length 0.
    fn tangent(&self, mu: f64) -> f64 {
        1.0 - 2.0 * (self.aim.direct * mu).sqrt()
    }

    /// Solves for one mu.
    fn sample(&mut self, mu: f64, visit: &mut Visit<'_>) -> Option<Sample> {
        self.trials += 1;
        // A path that costs less than the best lies below this for the mu of its own length.
        let ceiling = self.best + HEADROOM - self.tangent(mu);
        let all = [0, self.graph.lattice.rows];
        let found = self.solver.solve(self.graph, &self.aim.objective(mu), all, ceiling, true, self.control)?;
        if let Some(path) = &found.path {
            let (angles, length) = self.graph.sums(path);
            let cost = 1.0 - self.aim.direct / length + angles / self.aim.segments;
            if cost < self.best {
                self.best = cost;
                visit(path)?;
            }
        }
        Some(Sample { mu, value: found.bound })
    }

    /// The least that a path can cost whose mu lies between two, and where.
    fn between(&self, low: Sample, high: Sample) -> (f64, f64) {
        let slope = (high.value - low.value) / (high.mu - low.mu);
        let mu = self.aim.slope(slope).clamp(low.mu, high.mu);
        (self.tangent(mu) + low.value + slope * (mu - low.mu), mu)
    }
}

fn sweep(
    solver: &mut Solver,
    graph: &mut Graph<'_>,
    aim: &Aim,
    control: &Control<'_>,
    visit: &mut Visit<'_>,
) -> Option<f64> {
    let mut sweep = Sweep { solver, graph, aim, control, best: f64::INFINITY, trials: 0 };
    // No path is shorter than the straight line, and one that costs less than the best so far is no longer
    // than direct / (1 - best), since the angles count at least 0.
    let high = sweep.sample(aim.slope(aim.direct), visit)?;
    if sweep.best == f64::INFINITY {
        return Some(f64::INFINITY);
    }
    let room = (1.0 - sweep.best).max(0.0);
    let low = sweep.sample(room * room / aim.direct, visit)?;
    let mut intervals = vec![(low, high)];
    loop {
        let bounds = intervals.iter().map(|(low, high)| sweep.between(*low, *high)).enumerate();
        let least = bounds.min_by(|(_, a), (_, b)| a.0.total_cmp(&b.0));
        let Some((i, (bound, mu))) = least else { return Some(sweep.best) };
        if bound >= sweep.best - TOLERANCE || sweep.trials >= MOST_TRIALS {
            return Some(bound.min(sweep.best));
        }
        let (low, high) = intervals.swap_remove(i);
        let middle = sweep.sample(mu, visit)?;
        intervals.extend([(low, middle), (middle, high)]);
    }
}

/// The shortest path of each band of depths for cost `afhh`, narrow bands first.
fn bands(
    solver: &mut Solver,
    graph: &mut Graph<'_>,
    aim: &Aim,
    control: &Control<'_>,
    visit: &mut Visit<'_>,
) -> Option<f64> {
    let objective = aim.objective(0.0);
    let rows = graph.lattice.rows;
    let depths = graph.lattice.depths(0).to_vec();
    let share = |length: f64| if length > 0.0 { 1.0 - aim.direct / length } else { 0.0 };
    let range = |low: f64, high: f64| if aim.depth > 0.0 { (high - low) / aim.depth } else { 0.0 };
    let shallow = aim.depths[0].min(aim.depths[1]);
    let deep = aim.depths[0].max(aim.depths[1]);
    // The first row of a band, and one past the last; a band holds start and goal, and any row it can do without
    // makes it no narrower.
    let mut bands = Vec::new();
    let first_deeper = depths.iter().take_while(|depth| **depth < shallow).count();
    let last_shallower = rows - depths.iter().rev().take_while(|depth| **depth > deep).count();
    for first in 0..=first_deeper.min(rows - 1) {
        for end in last_shallower.max(first + 1)..=rows {
            bands.push((range(shallow.min(depths[first]), deep.max(depths[end - 1])), [first, end]));
        }
    }
    bands.sort_by(|a, b| a.0.total_cmp(&b.0));
    let shortest = solver.solve(graph, &objective, [0, rows], f64::INFINITY, false, control)?;
    if shortest.path.is_none() {
        return Some(f64::INFINITY);
    }
    let mut best = f64::INFINITY;
    for (range, rows) in bands {
        if range + share(shortest.bound) >= best {
            break;
        }
        let ceiling = if best - range < 1.0 { aim.direct / (1.0 - (best - range)) } else { f64::INFINITY };
        let found = solver.solve(graph, &objective, rows, ceiling, false, control)?;
        if let Some(path) = &found.path {
            best = best.min(range + share(found.bound));
            visit(path)?;
        }
    }
    Some(best)
}
