//! From the best path of a lattice to the best near it: the same search in a tube around the path, ever
//! narrower and finer.

use auv_world::math::distance;

use super::graph::{Graph, Objective};
use super::lattice::Lattice;
use super::offer;
use super::solver::Solver;
use super::sweep::{Aim, OFFENCE};
use crate::control::Control;
use crate::cost::{Cost, Segments};
use crate::search::Search;

/// Columns and rows on each side of the path in 2-D ...
const HALVES_2D: [usize; 2] = [8, 0];
/// ... and in 3-D.
const HALVES_3D: [usize; 2] = [3, 2];
/// Tubes of the same grain, at most.
const ROUNDS: usize = 6;
/// The finest grain, in parts of the first.
const FINEST: f64 = 1.0 / 256.0;
/// A gain of less than this, in units of the cost, asks for a finer tube.
const GAIN: f64 = 1e-6;

/// Improves the search's best path; `None` if stopped.
pub fn polish(
    search: &mut Search<'_>,
    segments: &mut Segments,
    solver: &mut Solver,
    aim: &Aim,
    grain: [f64; 2],
    control: &Control<'_>,
) -> Option<()> {
    let mut part = 0.5;
    while part >= FINEST {
        let step = grain.map(|step| part * step);
        for _ in 0..ROUNDS {
            let before = search.best_total();
            for band in bands(search, aim, step[1]) {
                refine(search, segments, solver, aim, step, band, control)?;
            }
            if search.best_total() > before - GAIN {
                break;
            }
        }
        part *= 0.5;
    }
    Some(())
}

/// The best path of one tube.
fn refine(
    search: &mut Search<'_>,
    segments: &mut Segments,
    solver: &mut Solver,
    aim: &Aim,
    step: [f64; 2],
    band: [f64; 2],
    control: &Control<'_>,
) -> Option<()> {
    let (genes, feasible) = search.best();
    let problem = search.problem();
    let halves = if problem.has_depth() { HALVES_3D } else { HALVES_2D };
    let lattice = Lattice::tube(problem, genes, step, halves, band);
    let length = problem.path(genes).windows(2).map(|leg| distance(leg[0], leg[1])).sum();
    let objective = aim.objective(aim.slope(length));
    let mut graph = Graph::new(problem, &lattice, segments, control)?;
    let all = [0, lattice.rows];
    let mut found = solver.solve(&mut graph, &objective, all, f64::INFINITY, aim.turns(), control)?;
    if found.path.is_none() && !feasible {
        let lenient = Objective { offence: OFFENCE, ..objective };
        found = solver.solve(&mut graph, &lenient, all, f64::INFINITY, false, control)?;
    }
    if let Some(path) = found.path {
        let genes = lattice.genes(problem, &path);
        if genes != search.best().0 {
            offer(search, &genes)?;
        }
    }
    Some(())
}

/// The bands of depths (m) to look into: all, or where the range of depth counts what the path takes and a
/// little more or less at either side.
fn bands(search: &Search<'_>, aim: &Aim, step: f64) -> Vec<[f64; 2]> {
    let problem = search.problem();
    let [top, bottom] = problem.frame().depth_bounds();
    if aim.cost != Cost::Afhh || !problem.has_depth() {
        return vec![[top, bottom]];
    }
    let ends = [aim.depths[0].min(aim.depths[1]), aim.depths[0].max(aim.depths[1])];
    let depths = &search.best().0[problem.inner()..];
    let low = depths.iter().fold(ends[0], |a, b| a.min(*b));
    let high = depths.iter().fold(ends[1], |a, b| a.max(*b));
    let mut bands = Vec::new();
    for up in [1.0, 0.0, -1.0] {
        for down in [1.0, 0.0, -1.0] {
            let band = [(low + up * step).min(ends[0]).max(top), (high - down * step).max(ends[1]).min(bottom)];
            // Start and goal may lie outside the box, waypoints may not.
            let band = [band[0].min(bottom), band[1].max(top)];
            if !bands.contains(&band) {
                bands.push(band);
            }
        }
    }
    bands
}
