//! ADE: the adaptive differential evolution (Zhang et al. 2014) that both papers compare with. They give its
//! numbers but not its formula; the adaptation of F is this project's reading.

use auv_world::rng::Stream;
use serde::Deserialize;

use super::{Rates, breed};
use crate::error::{PlanError, within};
use crate::parameters::Parameters;
use crate::plan::Plan;
use crate::population::{self, Defaults, Method, Population, Survival};
use crate::registry::Request;
use crate::sections::SectionProblem;

/// Parameters of ADE, with the LFHH paper's values (alpha, beta and F0 of its Table 1) as defaults.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Paths in the population (NP).
    pub population: usize,
    /// Least crossover rate (alpha).
    pub crossover_low: f64,
    /// Greatest crossover rate (beta).
    pub crossover_high: f64,
    /// F0: F falls from twice this to this.
    pub factor: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { population: 200, crossover_low: 0.0, crossover_high: 0.4, factor: 0.6 }
    }
}

impl Parameters for Settings {
    fn check(&self) -> Result<(), PlanError> {
        within("population", self.population, 4, 100_000)?;
        within("crossover_low", self.crossover_low, 0.0, 1.0)?;
        within("crossover_high", self.crossover_high, self.crossover_low, 1.0)?;
        within("factor", self.factor, 0.0, 2.0)
    }
}

/// ADE.
///
/// # Errors
/// As [`crate::registry::plan`].
pub fn plan_ade(request: &Request<'_>) -> Result<Plan, PlanError> {
    let (common, settings) = request.parse::<Settings>()?;
    let (size, defaults) = (settings.population, Defaults::lfhh(request));
    let horizon = defaults.horizon(&common, size);
    population::plan(request, &common, size, defaults, |_| Ade { settings, horizon, fates: Vec::new() })
}

/// F in a generation of `horizon`: F0 2^exp(1 - G / (G + 1 - g)).
fn factor(base: f64, generation: u64, horizon: u64) -> f64 {
    let left = (horizon + 1).saturating_sub(generation).max(1);
    base * libm::exp2(libm::exp(1.0 - horizon as f64 / left as f64))
}

struct Ade {
    settings: Settings,
    horizon: u64,
    fates: Vec<f64>,
}

impl Method for Ade {
    const SURVIVAL: Survival = Survival::Duel;

    fn breed(&mut self, problem: &SectionProblem, population: &mut Population, generation: u64, stream: &mut Stream) {
        let factor = factor(self.settings.factor, generation, self.horizon);
        for child in 0..population.size() {
            let crossover = stream.uniform(self.settings.crossover_low, self.settings.crossover_high);
            breed(problem, population, child, Rates { factor, crossover, walk: 0.0 }, stream, &mut self.fates);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_factor_falls_from_twice_to_once() {
        assert!((factor(0.6, 1, 300) - 1.2).abs() < 1e-12);
        assert!((factor(0.6, 300, 300) - 0.6).abs() < 1e-12);
        assert!((factor(0.6, 151, 300) - 0.6 * libm::exp2(libm::exp(-1.0))).abs() < 1e-12);
        assert!(factor(0.6, 400, 300).is_finite());
    }
}
