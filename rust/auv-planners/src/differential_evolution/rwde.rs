//! RWDE: differential evolution with a random walk (Zhan and Zhang 2012), AFHH's rival. Its paper is not
//! quoted in AFHH's; that a gene walks anywhere in its bounds, and how often, is this project's reading.

use auv_world::rng::Stream;
use serde::Deserialize;

use super::{Rates, breed};
use crate::error::{PlanError, within};
use crate::parameters::Parameters;
use crate::plan::Plan;
use crate::population::{self, Defaults, Method, Population, Survival};
use crate::registry::Request;
use crate::sections::SectionProblem;

/// Parameters of RWDE. AFHH's experiment has two settings: the default, and factor 0.1 with crossover 0.5.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Paths in the population (NP).
    pub population: usize,
    /// F.
    pub factor: f64,
    /// CR.
    pub crossover: f64,
    /// The part of the genes that walks at first ...
    pub walk_first: f64,
    /// ... and at last; linear in between.
    pub walk_last: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { population: 200, factor: 0.5, crossover: 0.1, walk_first: 0.1, walk_last: 0.001 }
    }
}

impl Parameters for Settings {
    fn check(&self) -> Result<(), PlanError> {
        within("population", self.population, 4, 100_000)?;
        within("factor", self.factor, 0.0, 2.0)?;
        within("crossover", self.crossover, 0.0, 1.0)?;
        within("walk_first", self.walk_first, 0.0, 1.0)?;
        within("walk_last", self.walk_last, 0.0, 1.0)
    }
}

/// RWDE.
///
/// # Errors
/// As [`crate::registry::plan`].
pub fn plan_rwde(request: &Request<'_>) -> Result<Plan, PlanError> {
    let (common, settings) = request.parse::<Settings>()?;
    let size = settings.population;
    let horizon = Defaults::afhh().horizon(&common, size);
    population::plan(request, &common, size, Defaults::afhh(), |_| Rwde { settings, horizon, fates: Vec::new() })
}

struct Rwde {
    settings: Settings,
    horizon: u64,
    fates: Vec<f64>,
}

impl Rwde {
    fn rates(&self, generation: u64) -> Rates {
        let Settings { factor, crossover, walk_first, walk_last, .. } = self.settings;
        let progress = (generation as f64 / self.horizon as f64).min(1.0);
        Rates { factor, crossover, walk: walk_first + progress * (walk_last - walk_first) }
    }
}

impl Method for Rwde {
    const SURVIVAL: Survival = Survival::Duel;

    fn breed(&mut self, problem: &SectionProblem, population: &mut Population, generation: u64, stream: &mut Stream) {
        let rates = self.rates(generation);
        for child in 0..population.size() {
            breed(problem, population, child, rates, stream, &mut self.fates);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn walks_less_and_less() {
        let rwde = Rwde { settings: Settings::default(), horizon: 100, fates: Vec::new() };
        let walk = |generation| rwde.rates(generation).walk;
        assert!((walk(0) - 0.1).abs() < 1e-12 && (walk(100) - 0.001).abs() < 1e-12);
        assert!((walk(50) - 0.0505).abs() < 1e-12 && (walk(300) - 0.001).abs() < 1e-12);
    }
}
