//! Planners `iifds-ga` and `iifds-iga`: a genetic algorithm, plain and with the mutation of grey wolves.

use auv_world::rng::Stream;
use serde::Deserialize;

use super::objective::Objective;
use super::tuner::{Bounds, Genes, Rest, Tuned, Tuner, bounds};
use crate::error::{PlanError, within};
use crate::fluid::settings::Flow;
use crate::parameters::Parameters;
use crate::plan::Plan;
use crate::registry::Request;

/// How much each of the three leaders counts (eq. 29).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Leaders {
    /// The better, the more.
    #[default]
    Inverse,
    /// As printed: the worse, the more.
    Printed,
}

/// Parameters of the genetic algorithms, with the paper's values as defaults.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Individuals (n).
    pub population: usize,
    /// Chance of a pair to be crossed (Pc).
    pub crossover: f64,
    /// Chance of an individual to mutate (Pm): 0.01, with grey wolves 0.5.
    pub mutation: Option<f64>,
    /// Part of the individuals that is kept as it is in selection.
    pub elite: f64,
    /// Part of the individuals that is neither crossed nor mutated.
    pub protect: f64,
    /// How much the leaders count; grey wolves only.
    pub leaders: Leaders,
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
            population: 100,
            crossover: 0.5,
            mutation: None,
            elite: 0.10,
            protect: 0.04,
            leaders: Leaders::Inverse,
            stall: 3,
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
        within("crossover", self.crossover, 0.0, 1.0)?;
        within("mutation", self.mutation.unwrap_or(0.0), 0.0, 1.0)?;
        within("elite", self.elite, 0.0, 1.0)?;
        within("protect", self.protect, 0.0, 1.0)?;
        within("stall", self.stall, 0, 1 << 32)?;
        within("tolerance", self.tolerance, 0.0, 1e9)?;
        within("rho_max", self.rho_max, 1.0, 1e3)?;
        within("sigma_max", self.sigma_max, 1.0, 1e3)?;
        self.objective.check()?;
        self.flow.check()
    }
}

/// How individuals mutate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mutation {
    /// One gene is drawn anew.
    Uniform,
    /// All genes move towards the three best (eq. 28-30).
    GreyWolf,
}

/// Generations of the paper.
const GENERATIONS: u64 = 30;
/// Values count as at least this, so that they have an inverse.
const LEAST: f64 = 1e-12;

/// The plain algorithm.
///
/// # Errors
/// As [`crate::registry::plan`].
pub fn plan_iifds_ga(request: &Request<'_>) -> Result<Plan, PlanError> {
    tune_genetic(request, Mutation::Uniform).map(|tuned| tuned.plan)
}

/// The one with grey wolves.
///
/// # Errors
/// As [`crate::registry::plan`].
pub fn plan_iifds_iga(request: &Request<'_>) -> Result<Plan, PlanError> {
    tune_genetic(request, Mutation::GreyWolf).map(|tuned| tuned.plan)
}

/// Either, with the coefficients that it found.
///
/// # Errors
/// As [`crate::registry::plan`].
pub fn tune_genetic(request: &Request<'_>, mutation: Mutation) -> Result<Tuned, PlanError> {
    let (common, settings) = request.parse::<Settings>()?;
    let rest = Rest { stall: settings.stall, tolerance: settings.tolerance };
    let mut tuner = Tuner::new(request, &common, &settings.flow, settings.objective, rest)?;
    let affordable = common.max_evaluations.map(|budget| budget / settings.population as u64);
    let herd = Herd {
        mutation,
        chance: settings.mutation.unwrap_or(if mutation == Mutation::GreyWolf { 0.5 } else { 0.01 }),
        bounds: bounds(settings.rho_max, settings.sigma_max),
        horizon: common.generations.or(affordable).unwrap_or(GENERATIONS).max(1),
        settings,
    };
    let generations = common.generations_or(GENERATIONS);
    // A spent budget or an interruption unwinds through `None`; what was found until then stands.
    let _ended_early = herd.run(&mut tuner, generations, &mut request.random()).is_none();
    tuner.finish(request.planner)
}

/// A chromosome and its value.
#[derive(Debug, Clone, Copy)]
struct Individual {
    genes: Genes,
    value: f64,
    /// Whether the value is that of the genes.
    known: bool,
}

/// One search.
struct Herd {
    settings: Settings,
    mutation: Mutation,
    chance: f64,
    bounds: Bounds,
    horizon: u64,
}

impl Herd {
    fn run(&self, tuner: &mut Tuner<'_>, generations: u64, stream: &mut Stream) -> Option<()> {
        let n = self.settings.population;
        let draw = |stream: &mut Stream| self.bounds.map(|[low, high]| stream.uniform(low, high));
        let mut herd: Vec<Individual> =
            (0..n).map(|_| Individual { genes: draw(stream), value: f64::INFINITY, known: false }).collect();
        let mut next = Vec::with_capacity(n);
        evaluate(&mut herd, tuner)?;
        for generation in 1..=generations {
            if tuner.end_generation() {
                return Some(());
            }
            let leaders = [herd[0], herd[1], herd[2]];
            self.select(&herd, &mut next, stream);
            std::mem::swap(&mut herd, &mut next);
            let protected = share(self.settings.protect, n);
            self.cross(&mut herd[protected..], stream);
            for individual in &mut herd[protected..] {
                if stream.unit() < self.chance {
                    self.mutate(individual, &leaders, generation, stream);
                }
            }
            evaluate(&mut herd, tuner)?;
        }
        tuner.end_generation();
        Some(())
    }

    /// The elite, and the rest by roulette (eq. 26) from all, who are in order.
    fn select(&self, herd: &[Individual], next: &mut Vec<Individual>, stream: &mut Stream) {
        let n = herd.len();
        next.clear();
        next.extend_from_slice(&herd[..share(self.settings.elite, n)]);
        let total: f64 = herd.iter().map(|individual| fitness(individual.value)).sum();
        while next.len() < n {
            let mut left = stream.unit() * total;
            let chosen = herd.iter().position(|individual| {
                left -= fitness(individual.value);
                left < 0.0
            });
            // Where nothing has a fitness all are alike.
            next.push(herd[chosen.unwrap_or_else(|| stream.below(n))]);
        }
    }

    /// Pairs at random; what follows a random gene is exchanged.
    fn cross(&self, herd: &mut [Individual], stream: &mut Stream) {
        for i in (1..herd.len()).rev() {
            herd.swap(i, stream.below(i + 1));
        }
        for pair in herd.chunks_exact_mut(2) {
            if stream.unit() >= self.settings.crossover {
                continue;
            }
            let (first, second) = pair.split_at_mut(1);
            let cut = 1 + stream.below(first[0].genes.len() - 1);
            if first[0].genes[cut..] != second[0].genes[cut..] {
                first[0].genes[cut..].swap_with_slice(&mut second[0].genes[cut..]);
                (first[0].known, second[0].known) = (false, false);
            }
        }
    }

    fn mutate(&self, individual: &mut Individual, leaders: &[Individual; 3], generation: u64, stream: &mut Stream) {
        let before = individual.genes;
        match self.mutation {
            Mutation::Uniform => {
                let gene = stream.below(before.len());
                let [low, high] = self.bounds[gene];
                individual.genes[gene] = stream.uniform(low, high);
            }
            Mutation::GreyWolf => {
                let a = 2.0 * (1.0 - generation as f64 / self.horizon as f64).max(0.0);
                let weights = self.weights(leaders.map(|leader| leader.value));
                for gene in 0..before.len() {
                    let pulled = |leader: &Individual, random: f64| {
                        leader.genes[gene] - a * (random - 0.5) * (before[gene] - leader.genes[gene]).abs()
                    };
                    let moved: f64 = (0..3).map(|j| weights[j] * pulled(&leaders[j], stream.unit())).sum();
                    let [low, high] = self.bounds[gene];
                    individual.genes[gene] = moved.clamp(low, high);
                }
            }
        }
        individual.known &= individual.genes == before;
    }

    /// gamma of eq. 29; equal if the leaders are worth nothing.
    fn weights(&self, values: [f64; 3]) -> [f64; 3] {
        let shares = match self.settings.leaders {
            Leaders::Inverse => values.map(fitness),
            Leaders::Printed => values,
        };
        let sum: f64 = shares.iter().sum();
        if sum > 0.0 && sum.is_finite() { shares.map(|share| share / sum) } else { [1.0 / 3.0; 3] }
    }
}

fn fitness(value: f64) -> f64 {
    1.0 / value.max(LEAST)
}

/// A part of `n`, to the nearest whole number.
fn share(part: f64, n: usize) -> usize {
    ((part * n as f64).round() as usize).min(n)
}

/// Evaluates those who changed, and puts all in order; elders stay before their equals.
fn evaluate(herd: &mut [Individual], tuner: &mut Tuner<'_>) -> Option<()> {
    for individual in herd.iter_mut().filter(|individual| !individual.known) {
        individual.value = tuner.evaluate(&individual.genes)?;
        individual.known = true;
    }
    herd.sort_by(|a, b| a.value.total_cmp(&b.value));
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use auv_world::rng::Purpose;

    fn herd(settings: Settings, mutation: Mutation) -> Herd {
        Herd { settings, mutation, chance: 0.5, bounds: bounds(3.0, 3.0), horizon: 10 }
    }

    fn individual(value: f64) -> Individual {
        Individual { genes: [1.0 + value / 10.0; 4], value, known: true }
    }

    #[test]
    fn roulette_prefers_the_better_and_never_the_worthless() {
        let herd = herd(Settings { elite: 0.0, ..Settings::default() }, Mutation::Uniform);
        let all = [individual(1.0), individual(3.0), individual(f64::INFINITY)];
        let (mut next, mut stream) = (Vec::new(), Stream::new(1, Purpose::Planner, 0));
        let mut counts = [0; 2];
        for _ in 0..4000 {
            herd.select(&all, &mut next, &mut stream);
            for chosen in &next {
                counts[usize::from(chosen.value > 1.0)] += 1;
                assert!(chosen.value.is_finite());
            }
        }
        let share = f64::from(counts[0]) / 12_000.0;
        assert!((share - 0.75).abs() < 0.02, "{share}");
        herd.select(&[individual(f64::INFINITY); 3], &mut next, &mut stream);
        assert_eq!(next.len(), 3);
    }

    #[test]
    fn crossing_exchanges_genes() {
        let herd = herd(Settings { crossover: 1.0, ..Settings::default() }, Mutation::Uniform);
        let mut pair = [individual(1.0), individual(2.0)];
        herd.cross(&mut pair, &mut Stream::new(1, Purpose::Planner, 0));
        assert!(!pair[0].known && pair[0].genes[0] != pair[0].genes[3]);
        for gene in 0..4 {
            assert!((pair[0].genes[gene] + pair[1].genes[gene] - 2.3).abs() < 1e-12);
        }
    }

    #[test]
    fn wolves_follow_their_leaders() {
        let mut herd = herd(Settings::default(), Mutation::GreyWolf);
        let leaders = [individual(1.0), individual(2.0), individual(4.0)];
        assert_eq!(herd.weights([1.0, 2.0, 4.0]), [4.0 / 7.0, 2.0 / 7.0, 1.0 / 7.0]);
        assert_eq!(herd.weights([f64::INFINITY; 3]), [1.0 / 3.0; 3]);
        let mut follower = individual(9.0);
        // In the last generation a is 0: the place is the leaders' weighted mean.
        herd.mutate(&mut follower, &leaders, 10, &mut Stream::new(1, Purpose::Planner, 0));
        let mean = (4.0 * 1.1 + 2.0 * 1.2 + 1.4) / 7.0;
        assert!((follower.genes[0] - mean).abs() < 1e-12 && !follower.known);
        assert_eq!(follower.genes[3], 1.0);
        herd.settings.leaders = Leaders::Printed;
        assert_eq!(herd.weights([1.0, 2.0, 5.0]), [0.125, 0.25, 0.625]);
    }
}
