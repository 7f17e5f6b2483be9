//! AFHH (Liu, Zhan et al. 2018): fixed-height histograms whose search space shrinks to where the population
//! is, once a feasible path is known, and which every few generations starts anew within it.

use auv_world::rng::Stream;
use serde::Deserialize;

use super::model::Histograms;
use super::sorted::SortedGenes;
use crate::error::{PlanError, within};
use crate::parameters::Parameters;
use crate::plan::Plan;
use crate::population::{self, Defaults, Method, Population, Survival};
use crate::registry::Request;
use crate::sections::SectionProblem;

/// Where a bound goes when the search space shrinks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shrink {
    /// Midway to the outermost value, as the paper's text has it.
    #[default]
    Mean,
    /// To the outermost value, as its pseudo-code has it.
    Interval,
}

/// Parameters of AFHH, with the paper's values (section 4.1) as defaults.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Paths in the population (NP).
    pub population: usize,
    /// Best paths that the histograms are built from (S); by default half the population.
    pub selected: Option<usize>,
    /// Bins of each histogram (K); by default half as many as are selected.
    pub bins: Option<usize>,
    /// How the search space shrinks.
    pub shrink: Shrink,
    /// Every how many generations new paths are drawn from the whole search space (T, which the paper leaves
    /// open).
    pub regenerate_every: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { population: 200, selected: None, bins: None, shrink: Shrink::Mean, regenerate_every: 50 }
    }
}

impl Settings {
    fn selected(&self) -> usize {
        self.selected.unwrap_or(self.population / 2)
    }

    fn bins(&self) -> usize {
        self.bins.unwrap_or((self.selected() / 2).max(2))
    }
}

impl Parameters for Settings {
    fn check(&self) -> Result<(), PlanError> {
        within("population", self.population, 4, 100_000)?;
        within("selected", self.selected(), 2, self.population)?;
        within("bins", self.bins(), 2, self.selected())?;
        within("regenerate_every", self.regenerate_every, 1, u64::from(u32::MAX))
    }
}

/// A feasible path costs less (eq. 1-5).
const FEASIBLE: f64 = 2.0;

/// AFHH.
///
/// # Errors
/// As [`crate::registry::plan`].
pub fn plan_afhh(request: &Request<'_>) -> Result<Plan, PlanError> {
    let (common, settings) = request.parse::<Settings>()?;
    let size = settings.population;
    let horizon = Defaults::afhh().horizon(&common, size);
    population::plan(request, &common, size, Defaults::afhh(), |problem| Afhh {
        sorted: SortedGenes::new(problem.genes(), settings.selected(), size),
        histograms: Histograms::new(problem.genes(), settings.bins()),
        low: problem.low().to_vec(),
        high: problem.high().to_vec(),
        horizon,
        settings,
    })
}

/// The probability that a gene's search space shrinks in a generation of `horizon` (eq. 9).
fn shrink_probability(generation: u64, horizon: u64) -> f64 {
    let progress = 10.0 * generation as f64 / horizon as f64;
    0.01 + 0.99 * libm::expm1(progress) / libm::expm1(10.0)
}

struct Afhh {
    settings: Settings,
    horizon: u64,
    sorted: SortedGenes,
    histograms: Histograms,
    /// The search space of each gene (m).
    low: Vec<f64>,
    high: Vec<f64>,
}

impl Afhh {
    fn shrink(&mut self, population: &Population, gene: usize) {
        let genes = population.places().iter().map(|place| population.at(*place)[gene]);
        let (least, most) =
            genes.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| (least.min(value), most.max(value)));
        (self.low[gene], self.high[gene]) = match self.settings.shrink {
            Shrink::Mean => (0.5 * (self.low[gene] + least), 0.5 * (self.high[gene] + most)),
            Shrink::Interval => (least, most),
        };
    }
}

impl Method for Afhh {
    const SURVIVAL: Survival = Survival::Best;

    fn breed(&mut self, _problem: &SectionProblem, population: &mut Population, generation: u64, stream: &mut Stream) {
        let probability = shrink_probability(generation, self.horizon);
        let feasible = population.cost(0) < FEASIBLE;
        for gene in 0..self.low.len() {
            if feasible && stream.unit() < probability {
                self.shrink(population, gene);
            }
            self.histograms.build(gene, &self.sorted, 0.0, 0.0, self.low[gene], self.high[gene]);
        }
        let regenerate = generation.is_multiple_of(self.settings.regenerate_every);
        for child in 0..population.size() {
            let genes = population.child(child);
            if regenerate {
                for ((gene, low), high) in genes.iter_mut().zip(&self.low).zip(&self.high) {
                    *gene = stream.uniform(*low, *high);
                }
            } else {
                self.histograms.sample(stream, genes);
            }
        }
    }

    fn survived(&mut self, population: &Population) {
        self.sorted.update(population);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shrinking_becomes_certain_towards_the_end() {
        assert_eq!(shrink_probability(0, 100), 0.01);
        assert_eq!(shrink_probability(100, 100), 1.0);
        let middle = 0.01 + 0.99 * (libm::exp(5.0) - 1.0) / (libm::exp(10.0) - 1.0);
        assert!((shrink_probability(50, 100) - middle).abs() < 1e-15);
    }

    #[test]
    fn bounds_move_to_the_outermost_values() {
        let mut population = Population::new(4, 1);
        for (child, value) in [3.0, 7.0, 5.0, 4.0].into_iter().enumerate() {
            population.child(child).fill(value);
            population.set_child_cost(child, 0.1 * value);
        }
        population.select();
        let shrunk = |shrink| {
            let settings = Settings { population: 4, shrink, ..Settings::default() };
            let mut afhh = Afhh {
                sorted: SortedGenes::new(1, 2, 4),
                histograms: Histograms::new(1, 2),
                low: vec![0.0],
                high: vec![20.0],
                horizon: 1,
                settings,
            };
            afhh.shrink(&population, 0);
            [afhh.low[0], afhh.high[0]]
        };
        assert_eq!(shrunk(Shrink::Interval), [3.0, 7.0]);
        assert_eq!(shrunk(Shrink::Mean), [1.5, 13.5]);
    }
}
