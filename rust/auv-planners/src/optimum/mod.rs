//! Planner `section-optimum`: the exact reference of a section problem on a lattice, by dynamic programming.
//! With it every section plan has a gap: what it costs above the optimum of the same problem.

mod graph;
mod lattice;
mod polish;
mod settings;
mod solver;
mod sweep;
#[cfg(test)]
mod tests;

pub use settings::Settings;

use auv_world::World;
use auv_world::math::{Vec3, distance};

use crate::control::Control;
use crate::cost::{Cost, CostOptions};
use crate::error::PlanError;
use crate::parameters::{Common, StopRule};
use crate::plan::Plan;
use crate::registry::Request;
use crate::search::Search;
use crate::sections::SectionProblem;
use graph::Graph;
use lattice::Lattice;
use solver::Solver;
use sweep::Aim;

/// The planner's name.
const NAME: &str = "section-optimum";

/// Answers a request with the best path. Evaluations count whole paths, as everywhere: those that the lattice
/// search found on its way and those of the polish.
///
/// # Errors
/// [`PlanError`] naming the parameter, start or goal that is not allowed.
pub fn plan_section_optimum(request: &Request<'_>) -> Result<Plan, PlanError> {
    let (common, settings) = request.parse::<Settings>()?;
    let mut problem = request.problem(&common)?;
    Ok(optimum(&mut problem, &common, &settings, request.control, request.planner).plan)
}

/// The reference of a problem: the planner's answer with default parameters.
///
/// # Errors
/// [`PlanError`] if start or goal is no place in the world, or a cost option is not allowed.
pub fn reference(
    world: &World,
    start: Vec3,
    goal: Vec3,
    cost: Cost,
    options: &CostOptions,
    control: &Control<'_>,
) -> Result<Plan, PlanError> {
    let common = Common { cost, cost_options: *options, ..Common::default() };
    let mut problem = SectionProblem::new(world, start, goal, cost, options)?;
    Ok(optimum(&mut problem, &common, &Settings::default(), *control, NAME).plan)
}

/// What a plan costs above the reference of the same problem. Below 0 where the plan lies better between the
/// lattice's places than the polish came.
///
/// # Errors
/// As [`reference`].
pub fn gap(
    world: &World,
    plan: &Plan,
    cost: Cost,
    options: &CostOptions,
    control: &Control<'_>,
) -> Result<f64, PlanError> {
    let (start, goal) = (plan.waypoints[0], plan.waypoints[plan.waypoints.len() - 1]);
    Ok(plan.cost.total - reference(world, start, goal, cost, options, control)?.cost.total)
}

/// A plan, and what is known of the lattice.
struct Optimum {
    plan: Plan,
    /// No path through the lattice costs less: cost `lfhh` and `afhh` in their own units, `time` and `energy`
    /// in seconds. Infinite if none is feasible, `None` if the search did not come to its end.
    #[cfg_attr(not(test), expect(dead_code, reason = "certifies the search in its tests"))]
    bound: Option<f64>,
}

fn optimum(
    problem: &mut SectionProblem,
    common: &Common,
    settings: &Settings,
    control: Control<'_>,
    planner: &str,
) -> Optimum {
    let mut search = Search::new(problem, common, StopRule::Exhaust, control);
    let mut bound = None;
    let stopped = search.problem().inner() > 0 && run(&mut search, common, settings, &control, &mut bound).is_none();
    let spent = search.evaluations() >= common.max_evaluations.unwrap_or(u64::MAX);
    if stopped && !spent && !search.is_done() {
        search.interrupt();
    }
    if search.evaluations() == 0 {
        let straight = straight(search.problem());
        search.evaluate(&straight);
    }
    Optimum { plan: search.finish(planner), bound }
}

/// Searches the whole lattice and then around its best path; `None` if the search was stopped.
fn run(
    search: &mut Search<'_>,
    common: &Common,
    settings: &Settings,
    control: &Control<'_>,
    bound: &mut Option<f64>,
) -> Option<()> {
    let problem = search.problem().clone();
    let [start, goal] = problem.ends();
    let [top, bottom] = problem.frame().depth_bounds();
    let aim = Aim {
        cost: common.cost,
        direct: distance(start, goal),
        segments: (problem.inner() + 1) as f64,
        depths: [start[2], goal[2]],
        depth: bottom - top,
    };
    let grain = settings.grain(&problem);
    let mut segments = problem.segments();
    let mut solver = Solver::default();
    let lattice = Lattice::whole(&problem, grain, segments.longest());
    let mut graph = Graph::new(&problem, &lattice, &mut segments, control)?;
    let mut visit = |path: &[usize]| offer(search, &lattice.genes(&problem, path));
    let least = sweep::optimise(&mut solver, &mut graph, &aim, control, &mut visit)?;
    *bound = Some(least);
    if least == f64::INFINITY {
        let found = sweep::least_offending(&mut solver, &mut graph, &aim, control)?;
        match found.path {
            Some(path) => visit(&path)?,
            // Steps that reach too short a way for any path.
            None => offer(search, &straight(&problem))?,
        }
    }
    if settings.polish {
        polish::polish(search, &mut segments, &mut solver, &aim, lattice.grain, control)?;
    }
    Some(())
}

/// Evaluates a candidate; `None` to stop, since the budget is spent, the caller interrupted, or the best suffices.
fn offer(search: &mut Search<'_>, genes: &[f64]) -> Option<()> {
    search.evaluate(genes)?;
    search.end_generation();
    (!search.is_done()).then_some(())
}

/// The candidate whose waypoints lie on the line from start to goal, as far as the bounds allow.
fn straight(problem: &SectionProblem) -> Vec<f64> {
    let frame = problem.frame();
    let [start, goal] = problem.ends();
    let section = |point: Vec3| frame.section(point[0], point[1]);
    let (from, to) = (section(start), section(goal));
    let parts = problem.sections().iter().map(|section| (*section as f64 - from) / (to - from));
    let between = |a: f64, b: f64, part: f64| a + part * (b - a);
    let lateral = [start, goal].map(|point| frame.lateral(point[0], point[1]));
    let mut genes: Vec<f64> = parts.clone().map(|part| between(lateral[0], lateral[1], part)).collect();
    if problem.has_depth() {
        genes.extend(parts.map(|part| between(start[2], goal[2], part)));
    }
    for (gene, (low, high)) in genes.iter_mut().zip(problem.low().iter().zip(problem.high())) {
        *gene = gene.clamp(*low, *high);
    }
    genes
}
