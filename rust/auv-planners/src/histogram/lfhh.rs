//! LFHH (Algorithm 2): sample from fixed-height histograms of the best, every few generations smooth
//! instead, keep the best of old and new.

use auv_world::rng::Stream;

use super::population::Population;
use super::sampling::Sampler;
use super::settings::{Settings, StopRule};
use super::smoothing::smooth;
use crate::error::PlanError;
use crate::plan::Plan;
use crate::registry::Request;
use crate::search::Search;

/// LFHH: learning, smoothing, and in 3-D safe bins.
///
/// # Errors
/// As [`crate::registry::plan`].
pub fn plan_lfhh(request: &Request<'_>) -> Result<Plan, PlanError> {
    plan(request, |settings| settings)
}

/// FHH: neither learning nor smoothing, nor safe bins unless asked for.
///
/// # Errors
/// As [`crate::registry::plan`].
pub fn plan_fhh(request: &Request<'_>) -> Result<Plan, PlanError> {
    plan(request, |settings| Settings { learning: false, ..plain(settings) })
}

/// FHH with learning only.
///
/// # Errors
/// As [`crate::registry::plan`].
pub fn plan_fhh_lts(request: &Request<'_>) -> Result<Plan, PlanError> {
    plan(request, plain)
}

fn plain(settings: Settings) -> Settings {
    Settings { smooth: false, safe_bins: settings.safe_bins.or(Some(false)), ..settings }
}

fn plan(request: &Request<'_>, variant: fn(Settings) -> Settings) -> Result<Plan, PlanError> {
    let (common, settings) = request.parse::<Settings>()?;
    let settings = variant(settings);
    let mut problem = request.problem(&common)?;
    let generations = common.generations_or(Settings::default_generations(request.world.scenario().dimensions));
    let mut search = Search::new(&mut problem, &common, request.control);
    // A spent budget or an interruption unwinds through `None`; what was found until then stands.
    let _ended_early = run(&mut search, &settings, generations, &mut request.random()).is_none();
    Ok(search.finish(request.planner))
}

/// Searches until the stop rule holds or `generations` are done; `None` if the search stopped it.
fn run(search: &mut Search<'_>, settings: &Settings, generations: u64, stream: &mut Stream) -> Option<()> {
    let genes = search.problem().genes();
    let mut population = Population::new(settings.population, genes);
    let mut sampler = Sampler::new(search.problem(), settings);
    for child in 0..settings.population {
        let problem = search.problem();
        for ((value, low), high) in population.child(child).iter_mut().zip(problem.low()).zip(problem.high()) {
            *value = stream.uniform(*low, *high);
        }
    }
    evaluate(search, &mut population)?;
    for generation in 1..=generations {
        let found = settings.stop == StopRule::FirstFeasible && search.is_feasible();
        // Without genes there is but one path.
        if found || genes == 0 {
            break;
        }
        if settings.smooth && generation.is_multiple_of(settings.smooth_every) {
            for rank in 0..settings.population {
                let (old, new) = population.ranked_and_child(rank, rank);
                smooth(search.problem(), old, settings.smoothing, new);
            }
        } else {
            sampler.learn(search.problem(), settings, &population);
            for child in 0..settings.population {
                sampler.sample(search.problem(), stream, population.child(child));
            }
        }
        evaluate(search, &mut population)?;
    }
    Some(())
}

/// Evaluates all children, and lets the best live.
fn evaluate(search: &mut Search<'_>, population: &mut Population) -> Option<()> {
    for child in 0..population.size() {
        let cost = search.evaluate(population.child(child))?;
        population.set_child_cost(child, cost);
    }
    population.select();
    search.end_generation();
    Some(())
}
