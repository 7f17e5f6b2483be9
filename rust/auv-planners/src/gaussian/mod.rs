//! EDA-G: estimation of distribution with a Gaussian for each gene, LFHH's rival (LFHH section V): mean and
//! standard deviation of the best paths, new paths clamped to the bounds, the best of old and new.

use auv_world::rng::Stream;
use serde::Deserialize;

use crate::error::{PlanError, within};
use crate::parameters::Parameters;
use crate::plan::Plan;
use crate::population::{self, Defaults, Method, Population, Survival};
use crate::registry::Request;
use crate::sections::SectionProblem;

/// Parameters of EDA-G, with the LFHH paper's values as defaults.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Paths in the population (NP).
    pub population: usize,
    /// Best paths that the Gaussians are fitted to (S); by default half the population.
    pub selected: Option<usize>,
}

impl Default for Settings {
    fn default() -> Self {
        Self { population: 200, selected: None }
    }
}

impl Settings {
    fn selected(&self) -> usize {
        self.selected.unwrap_or(self.population / 2)
    }
}

impl Parameters for Settings {
    fn check(&self) -> Result<(), PlanError> {
        within("population", self.population, 4, 100_000)?;
        within("selected", self.selected(), 2, self.population)
    }
}

/// EDA-G.
///
/// # Errors
/// As [`crate::registry::plan`].
pub fn plan_eda_g(request: &Request<'_>) -> Result<Plan, PlanError> {
    let (common, settings) = request.parse::<Settings>()?;
    let size = settings.population;
    population::plan(request, &common, size, Defaults::lfhh(request), |problem| EdaG {
        selected: settings.selected(),
        mean: vec![0.0; problem.genes()],
        deviation: vec![0.0; problem.genes()],
    })
}

struct EdaG {
    selected: usize,
    mean: Vec<f64>,
    deviation: Vec<f64>,
}

impl EdaG {
    fn fit(&mut self, population: &Population) {
        let best = &population.places()[..self.selected];
        self.mean.fill(0.0);
        self.deviation.fill(0.0);
        for place in best {
            for (mean, gene) in self.mean.iter_mut().zip(population.at(*place)) {
                *mean += gene / best.len() as f64;
            }
        }
        for place in best {
            let genes = population.at(*place).iter().zip(&self.mean);
            for (square, (gene, mean)) in self.deviation.iter_mut().zip(genes) {
                *square += (gene - mean) * (gene - mean) / best.len() as f64;
            }
        }
        self.deviation.iter_mut().for_each(|square| *square = square.sqrt());
    }
}

impl Method for EdaG {
    const SURVIVAL: Survival = Survival::Best;

    fn breed(&mut self, problem: &SectionProblem, population: &mut Population, _generation: u64, stream: &mut Stream) {
        self.fit(population);
        for child in 0..population.size() {
            let genes = population.child(child);
            for pair in (0..genes.len()).step_by(2) {
                let normals = stream.normals();
                for (gene, normal) in (pair..genes.len()).zip(normals) {
                    let value = self.mean[gene] + self.deviation[gene] * normal;
                    genes[gene] = value.clamp(problem.low()[gene], problem.high()[gene]);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fits_the_best_only() {
        let mut population = Population::new(4, 2);
        for (child, genes) in [[1.0, 5.0], [3.0, 5.0], [90.0, -9.0], [70.0, 8.0]].into_iter().enumerate() {
            population.child(child).copy_from_slice(&genes);
            population.set_child_cost(child, child as f64);
        }
        population.select();
        let mut model = EdaG { selected: 2, mean: vec![0.0; 2], deviation: vec![0.0; 2] };
        model.fit(&population);
        assert_eq!((model.mean, model.deviation), (vec![2.0, 5.0], vec![1.0, 0.0]));
    }
}
