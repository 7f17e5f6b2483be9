//! LFHH (Algorithm 2): sample from fixed-height histograms of the best, every few generations smooth
//! instead, keep the best of old and new.

use auv_world::rng::Stream;

use super::sampling::Sampler;
use super::settings::Settings;
use super::smoothing::smooth;
use super::sorted::SortedGenes;
use crate::error::PlanError;
use crate::plan::Plan;
use crate::population::{self, Defaults, Method, Population, Survival};
use crate::registry::Request;
use crate::sections::SectionProblem;

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
    let size = settings.population;
    population::plan(request, &common, size, Defaults::lfhh(request), |problem| Lfhh {
        sorted: SortedGenes::new(problem.genes(), settings.selected(), size),
        sampler: Sampler::new(problem, &settings),
        settings,
    })
}

struct Lfhh {
    settings: Settings,
    sorted: SortedGenes,
    sampler: Sampler,
}

impl Method for Lfhh {
    const SURVIVAL: Survival = Survival::Best;

    fn breed(&mut self, problem: &SectionProblem, population: &mut Population, generation: u64, stream: &mut Stream) {
        if self.settings.smooth && generation.is_multiple_of(self.settings.smooth_every) {
            for number in 0..population.size() {
                let ([old], new) = population.members_and_child([number], number);
                smooth(problem, old, self.settings.smoothing, new);
            }
        } else {
            self.sampler.learn(problem, &self.settings, &self.sorted, population);
            for child in 0..population.size() {
                self.sampler.sample(problem, stream, population.child(child));
            }
        }
    }

    fn survived(&mut self, population: &Population) {
        self.sorted.update(population);
    }
}
