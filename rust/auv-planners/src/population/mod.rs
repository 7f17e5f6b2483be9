//! What all population planners share: members and children as a structure of arrays, the loop over
//! generations, and when it ends. A planner is a [`Method`]: how it breeds, and who survives.

mod members;

use auv_world::rng::Stream;

pub use members::Population;

use crate::error::PlanError;
use crate::parameters::{Common, StopRule};
use crate::plan::Plan;
use crate::registry::Request;
use crate::search::Search;
use crate::sections::SectionProblem;

/// Who lives on after a generation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Survival {
    /// The best of members and children; members are then in order of cost.
    Best,
    /// Of each member and its child the better one; members keep their numbers.
    Duel,
}

/// What makes one population planner differ from another.
pub trait Method {
    /// Who survives.
    const SURVIVAL: Survival;

    /// Writes every child of a generation; the first is number 1.
    fn breed(&mut self, problem: &SectionProblem, population: &mut Population, generation: u64, stream: &mut Stream);

    /// Sees who survived; also of the first population, before anything is bred.
    fn survived(&mut self, _population: &Population) {}
}

/// What a planner does if it is not told otherwise.
#[derive(Debug, Clone, Copy)]
pub struct Defaults {
    /// Generations after the first population.
    pub generations: u64,
    /// When to stop.
    pub stop: StopRule,
}

impl Defaults {
    /// LFHH's experiment: 100 generations in 2-D and 300 in 3-D, or until a path is feasible.
    pub fn lfhh(request: &Request<'_>) -> Self {
        let generations = if request.world.scenario().dimensions == 2 { 100 } else { 300 };
        Self { generations, stop: StopRule::FirstFeasible }
    }

    /// A tenth of AFHH's experiment (its 5 000 000 evaluations are 25 000 generations), all of it spent.
    pub fn afhh() -> Self {
        Self { generations: 2_500, stop: StopRule::Exhaust }
    }

    /// How many generations a method may count on that changes its ways with them (G).
    pub fn horizon(self, common: &Common, size: usize) -> u64 {
        let affordable = common.max_evaluations.map(|budget| budget / size as u64);
        common.generations.or(affordable).unwrap_or(self.generations).max(1)
    }
}

/// Answers a request with a method for a population of `size`.
///
/// # Errors
/// [`PlanError`] if start or goal is no place in the world.
pub fn plan<M: Method>(
    request: &Request<'_>,
    common: &Common,
    size: usize,
    defaults: Defaults,
    make: impl FnOnce(&SectionProblem) -> M,
) -> Result<Plan, PlanError> {
    let mut problem = request.problem(common)?;
    let mut method = make(&problem);
    let mut search = Search::new(&mut problem, common, defaults.stop, request.control);
    let generations = common.generations_or(defaults.generations);
    // A spent budget or an interruption unwinds through `None`; what was found until then stands.
    let _ended_early = run(&mut search, &mut method, size, generations, &mut request.random()).is_none();
    Ok(search.finish(request.planner))
}

/// Searches until the stop rule holds or `generations` are done; `None` if the search stopped it.
fn run<M: Method>(
    search: &mut Search<'_>,
    method: &mut M,
    size: usize,
    generations: u64,
    stream: &mut Stream,
) -> Option<()> {
    let genes = search.problem().genes();
    let mut population = Population::new(size, genes);
    for child in 0..size {
        let problem = search.problem();
        for ((value, low), high) in population.child(child).iter_mut().zip(problem.low()).zip(problem.high()) {
            *value = stream.uniform(*low, *high);
        }
    }
    survive(search, method, &mut population)?;
    for generation in 1..=generations {
        // Without genes there is but one path.
        if search.is_done() || genes == 0 {
            break;
        }
        method.breed(search.problem(), &mut population, generation, stream);
        survive(search, method, &mut population)?;
    }
    Some(())
}

/// Evaluates all children, and lets the better live.
fn survive<M: Method>(search: &mut Search<'_>, method: &mut M, population: &mut Population) -> Option<()> {
    for child in 0..population.size() {
        let cost = search.evaluate(population.child(child))?;
        population.set_child_cost(child, cost);
    }
    match M::SURVIVAL {
        Survival::Best => population.select(),
        Survival::Duel => population.duel(),
    }
    method.survived(population);
    search.end_generation();
    Some(())
}
