//! Planner `iifds-de`: differential evolution (rand/1/bin) of the same four coefficients.

use auv_world::rng::Stream;
use serde::Deserialize;

use super::objective::Objective;
use super::tuner::{Bounds, Genes, Rest, Tuned, Tuner, bounds};
use crate::differential_evolution::three_others;
use crate::error::{PlanError, within};
use crate::fluid::settings::Flow;
use crate::parameters::Parameters;
use crate::plan::Plan;
use crate::registry::Request;

/// Parameters of `iifds-de`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Individuals.
    pub population: usize,
    /// F: the weight of the difference.
    pub factor: f64,
    /// CR: the part of the genes that comes from the mutant.
    pub crossover: f64,
    /// Generations without progress that end the search; 0: none do.
    pub stall: u64,
    /// Less than this is no progress.
    pub tolerance: f64,
    /// Greatest rho.
    pub rho_max: f64,
    /// Greatest sigma.
    pub sigma_max: f64,
    /// What is minimised.
    pub objective: Objective,
    /// How the flow is made and followed.
    pub flow: Flow,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            population: 20,
            factor: 0.6,
            crossover: 0.9,
            stall: 0,
            tolerance: 1e-3,
            rho_max: 3.0,
            sigma_max: 3.0,
            objective: Objective::default(),
            flow: Flow::default(),
        }
    }
}

impl Parameters for Settings {
    fn check(&self) -> Result<(), PlanError> {
        within("population", self.population, 4, 100_000)?;
        within("factor", self.factor, 0.0, 2.0)?;
        within("crossover", self.crossover, 0.0, 1.0)?;
        within("stall", self.stall, 0, 1 << 32)?;
        within("tolerance", self.tolerance, 0.0, 1e9)?;
        within("rho_max", self.rho_max, 1.0, 1e3)?;
        within("sigma_max", self.sigma_max, 1.0, 1e3)?;
        self.objective.check()?;
        self.flow.check()
    }
}

/// 2000 lines with the usual population.
const GENERATIONS: u64 = 99;

/// Answers a request.
///
/// # Errors
/// As [`crate::registry::plan`].
pub fn plan_iifds_de(request: &Request<'_>) -> Result<Plan, PlanError> {
    tune_differential(request).map(|tuned| tuned.plan)
}

/// The same, with the coefficients that it found.
///
/// # Errors
/// As [`crate::registry::plan`].
pub fn tune_differential(request: &Request<'_>) -> Result<Tuned, PlanError> {
    let (common, settings) = request.parse::<Settings>()?;
    let rest = Rest { stall: settings.stall, tolerance: settings.tolerance };
    let mut tuner = Tuner::new(request, &common, &settings.flow, settings.objective, rest)?;
    let generations = common.generations_or(GENERATIONS);
    // A spent budget or an interruption unwinds through `None`; what was found until then stands.
    let _ended_early = run(&settings, &mut tuner, generations, &mut request.random()).is_none();
    tuner.finish(request.planner)
}

fn run(settings: &Settings, tuner: &mut Tuner<'_>, generations: u64, stream: &mut Stream) -> Option<()> {
    let bounds = bounds(settings.rho_max, settings.sigma_max);
    let n = settings.population;
    let mut members: Vec<Genes> = (0..n).map(|_| bounds.map(|[low, high]| stream.uniform(low, high))).collect();
    let mut values = members.iter().map(|genes| tuner.evaluate(genes)).collect::<Option<Vec<f64>>>()?;
    let mut trials = members.clone();
    for _ in 0..generations {
        if tuner.end_generation() {
            return Some(());
        }
        for (number, trial) in trials.iter_mut().enumerate() {
            *trial = breed(settings, &bounds, &members, number, stream);
        }
        for (number, trial) in trials.iter().enumerate() {
            let value = tuner.evaluate(trial)?;
            if value <= values[number] {
                (members[number], values[number]) = (*trial, value);
            }
        }
    }
    tuner.end_generation();
    Some(())
}

/// A member, crossed with the mutant a + F (b - c); genes out of their bounds are drawn anew.
fn breed(settings: &Settings, bounds: &Bounds, members: &[Genes], number: usize, stream: &mut Stream) -> Genes {
    let [a, b, c] = three_others(stream, members.len(), number).map(|other| members[other]);
    let certain = stream.below(bounds.len());
    std::array::from_fn(|gene| {
        let [low, high] = bounds[gene];
        if gene != certain && stream.unit() >= settings.crossover {
            return members[number][gene];
        }
        let mutant = a[gene] + settings.factor * (b[gene] - c[gene]);
        if (low..=high).contains(&mutant) { mutant } else { stream.uniform(low, high) }
    })
}
