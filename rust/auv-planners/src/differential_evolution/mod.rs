//! Differential evolution (rand/1/bin), under the two rivals that the papers compare with.

mod ade;
mod rwde;

use auv_world::rng::Stream;

pub use ade::{Settings as AdeSettings, plan_ade};
pub use rwde::{Settings as RwdeSettings, plan_rwde};

use crate::population::Population;
use crate::sections::SectionProblem;

/// The rates of one trial.
#[derive(Debug, Clone, Copy)]
struct Rates {
    /// F: the weight of the difference.
    factor: f64,
    /// CR: the part of the genes that comes from the mutant.
    crossover: f64,
    /// The part of the genes that comes from anywhere.
    walk: f64,
}

/// Three members, different from each other and from member `not`.
pub(crate) fn three_others(stream: &mut Stream, size: usize, not: usize) -> [usize; 3] {
    let mut others = [not; 3];
    for k in 0..3 {
        while others[..k].contains(&others[k]) || others[k] == not {
            others[k] = stream.below(size);
        }
    }
    others
}

/// Writes child `number`: its member, crossed with the mutant a + F (b - c). Genes out of their bounds are
/// drawn anew. `fates` is room for a number per gene.
fn breed(
    problem: &SectionProblem,
    population: &mut Population,
    number: usize,
    rates: Rates,
    stream: &mut Stream,
    fates: &mut Vec<f64>,
) {
    let genes = population.genes();
    let [a, b, c] = three_others(stream, population.size(), number);
    // One number decides what becomes of a gene: it walks, it crosses, or it stays.
    fates.resize(genes, 0.0);
    stream.fill_half_units(fates);
    fates[stream.below(genes)] = rates.walk;
    let crosses = rates.walk + (1.0 - rates.walk) * rates.crossover;
    let (low, high) = (problem.low(), problem.high());
    let ([parent, a, b, c], child) = population.members_and_child([number, a, b, c], number);
    let members = parent.iter().zip(a).zip(b.iter().zip(c));
    let bounds = low.iter().zip(high);
    for (((((parent, a), (b, c)), fate), (low, high)), child) in members.zip(&*fates).zip(bounds).zip(&mut *child) {
        let mutant = a + rates.factor * (b - c);
        let crosses = (*fate < crosses) | (*fate == rates.walk);
        let redrawn = (*fate < rates.walk) | (crosses & ((mutant < *low) | (mutant > *high)));
        *child = select(redrawn, f64::NAN, select(crosses, mutant, *parent));
    }
    for ((child, low), high) in child.iter_mut().zip(low).zip(high) {
        if child.is_nan() {
            *child = stream.uniform(*low, *high);
        }
    }
}

/// One of two numbers without a branch, which could not be predicted.
#[inline(always)]
fn select(first: bool, a: f64, b: f64) -> f64 {
    let mask = 0_u64.wrapping_sub(u64::from(first));
    f64::from_bits((a.to_bits() & mask) | (b.to_bits() & !mask))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use crate::{Cost, CostOptions};
    use auv_world::rng::Purpose;

    #[test]
    fn others_are_others() {
        let mut stream = Stream::new(1, Purpose::Planner, 0);
        for i in 0..1000 {
            let [a, b, c] = three_others(&mut stream, 4, i % 4);
            let mut all = [i % 4, a, b, c];
            all.sort_unstable();
            assert_eq!(all, [0, 1, 2, 3]);
        }
    }

    fn child(rates: Rates, values: [f64; 4]) -> Vec<f64> {
        let world = testing::paper_world("lfhh-2d-1", 0);
        let mission = world.mission();
        let (start, goal) = (mission.start_m, mission.goal_m);
        let problem = SectionProblem::new(&world, start, goal, Cost::Lfhh, &CostOptions::default()).unwrap();
        let mut population = Population::new(4, problem.genes());
        for (number, value) in values.into_iter().enumerate() {
            population.child(number).fill(value);
            population.set_child_cost(number, 1.0);
        }
        population.duel();
        breed(&problem, &mut population, 0, rates, &mut Stream::new(1, Purpose::Planner, 0), &mut Vec::new());
        population.child(0).to_vec()
    }

    #[test]
    fn a_trial_by_hand() {
        // All others are equal: the mutant is their value. Without crossover one gene is the mutant's.
        let none = child(Rates { factor: 0.5, crossover: 0.0, walk: 0.0 }, [1e3, 5e3, 5e3, 5e3]);
        assert_eq!(none.iter().filter(|gene| **gene == 5e3).count(), 1);
        assert_eq!(none.iter().filter(|gene| **gene == 1e3).count(), none.len() - 1);
        let all = child(Rates { factor: 0.5, crossover: 1.0, walk: 0.0 }, [1e3, 5e3, 5e3, 5e3]);
        assert!(all.iter().all(|gene| *gene == 5e3));
    }

    #[test]
    fn genes_stay_in_their_bounds() {
        for walk in [0.0, 0.5] {
            let genes = child(Rates { factor: 1.2, crossover: 1.0, walk }, [1e3, 100.0, 19.9e3, 200.0]);
            assert!(genes.iter().all(|gene| (0.0..=20e3).contains(gene)), "{genes:?}");
        }
    }
}
