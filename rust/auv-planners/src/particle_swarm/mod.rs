//! PSO: particle swarm optimisation with a global topology, AFHH's rival (its section 4.1).

use auv_world::rng::Stream;
use serde::Deserialize;

use crate::error::{PlanError, within};
use crate::parameters::Parameters;
use crate::plan::Plan;
use crate::population::{self, Defaults, Method, Population, Survival};
use crate::registry::Request;
use crate::sections::SectionProblem;

/// Parameters of PSO, with the AFHH paper's values as defaults.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Particles (NP).
    pub population: usize,
    /// Inertia weight (w).
    pub inertia: f64,
    /// Acceleration towards a particle's own best (c1).
    pub cognitive: f64,
    /// Acceleration towards the best of all (c2).
    pub social: f64,
    /// Greatest velocity in a gene, as a part of its range. The paper names none, and without one the
    /// swarm does not come to rest; 0.2 is usual.
    pub v_max: Option<f64>,
}

impl Default for Settings {
    fn default() -> Self {
        Self { population: 200, inertia: 0.5, cognitive: 2.0, social: 2.0, v_max: None }
    }
}

impl Parameters for Settings {
    fn check(&self) -> Result<(), PlanError> {
        within("population", self.population, 4, 100_000)?;
        within("inertia", self.inertia, 0.0, 2.0)?;
        within("cognitive", self.cognitive, 0.0, 10.0)?;
        within("social", self.social, 0.0, 10.0)?;
        within("v_max", self.v_max.unwrap_or(1.0), 1e-9, 1e9)
    }
}

/// PSO.
///
/// # Errors
/// As [`crate::registry::plan`].
pub fn plan_pso(request: &Request<'_>) -> Result<Plan, PlanError> {
    let (common, settings) = request.parse::<Settings>()?;
    let size = settings.population;
    population::plan(request, &common, size, Defaults::afhh(), |_| Pso {
        settings,
        positions: Vec::new(),
        velocities: Vec::new(),
        best: Vec::new(),
    })
}

/// The swarm; members of the population are the particles' own bests, children their positions.
struct Pso {
    settings: Settings,
    /// One particle after the other.
    positions: Vec<f64>,
    velocities: Vec<f64>,
    /// The best position of all.
    best: Vec<f64>,
}

impl Pso {
    /// The velocity of a gene at `position` whose own best and best of all are given, for two random
    /// numbers in 0 .. 1.
    #[inline(always)]
    fn velocity(&self, velocity: f64, position: f64, own: f64, all: f64, random: [f64; 2]) -> f64 {
        let Settings { inertia, cognitive, social, .. } = self.settings;
        inertia * velocity + cognitive * random[0] * (own - position) + social * random[1] * (all - position)
    }
}

impl Method for Pso {
    const SURVIVAL: Survival = Survival::Duel;

    fn breed(&mut self, problem: &SectionProblem, population: &mut Population, _generation: u64, stream: &mut Stream) {
        let genes = population.genes();
        self.best.clear();
        self.best.extend_from_slice(population.member(population.best()));
        let most = self.settings.v_max.unwrap_or(f64::INFINITY);
        for particle in 0..population.size() {
            let ([own], child) = population.members_and_child([particle], particle);
            for gene in 0..genes {
                let (low, high) = (problem.low()[gene], problem.high()[gene]);
                let i = particle * genes + gene;
                let random = stream.half_units();
                let velocity = self.velocity(self.velocities[i], self.positions[i], own[gene], self.best[gene], random);
                let most = most * (high - low).max(f64::MIN_POSITIVE);
                self.velocities[i] = velocity.clamp(-most, most);
                self.positions[i] = (self.positions[i] + self.velocities[i]).clamp(low, high);
                child[gene] = self.positions[i];
            }
        }
    }

    fn survived(&mut self, population: &Population) {
        if self.positions.is_empty() {
            for particle in 0..population.size() {
                self.positions.extend_from_slice(population.member(particle));
            }
            self.velocities.resize(self.positions.len(), 0.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_velocity_by_hand() {
        let pso =
            Pso { settings: Settings::default(), positions: Vec::new(), velocities: Vec::new(), best: Vec::new() };
        // 0.5 * 4 + 2 * 0.25 * (10 - 6) + 2 * 0.5 * (3 - 6) = 2 + 2 - 3.
        assert_eq!(pso.velocity(4.0, 6.0, 10.0, 3.0, [0.25, 0.5]), 1.0);
    }
}
