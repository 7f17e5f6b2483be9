//! The genes of the best members, sorted: what histograms are built from. From one generation to the next
//! few of the best change, so that theirs are replaced instead of all being sorted again.

use crate::population::Population;

/// The values of each gene among the best members, ascending.
#[derive(Debug, Clone)]
pub struct SortedGenes {
    selected: usize,
    /// `selected` values for each gene, as integers that are ordered alike: those sort twice as fast.
    values: Vec<i64>,
    /// Places of the members whose genes these are.
    places: Vec<u32>,
    /// Whether each place of the population is one of them.
    holds: Vec<bool>,
    leavers: Vec<u32>,
    enterers: Vec<u32>,
}

impl SortedGenes {
    /// Room for the genes of the `selected` best of a population of `size`.
    pub fn new(genes: usize, selected: usize, size: usize) -> Self {
        Self {
            selected,
            values: vec![0; genes * selected],
            places: Vec::with_capacity(selected),
            holds: vec![false; 2 * size],
            leavers: Vec::with_capacity(selected),
            enterers: Vec::with_capacity(selected),
        }
    }

    /// Number of values of each gene.
    pub fn selected(&self) -> usize {
        self.selected
    }

    /// A value of a gene, by its rank.
    #[inline(always)]
    pub fn value(&self, gene: usize, rank: usize) -> f64 {
        number(self.values[gene * self.selected + rank])
    }

    /// Takes up who is among the best now. To be called after every selection: the genes of those who left
    /// are known only until the next children are bred.
    pub fn update(&mut self, population: &Population) {
        let best = &population.places()[..self.selected];
        self.enterers.clear();
        self.enterers.extend(best.iter().filter(|place| !self.holds[**place as usize]));
        let first = self.places.is_empty();
        if !first && self.enterers.is_empty() {
            return;
        }
        self.holds.fill(false);
        for place in best {
            self.holds[*place as usize] = true;
        }
        self.leavers.clear();
        self.leavers.extend(self.places.iter().filter(|place| !self.holds[**place as usize]));
        self.places.clear();
        self.places.extend_from_slice(best);
        // Sorting a gene costs about as much as replacing a fifth of its values.
        if first || 5 * self.enterers.len() > self.selected {
            self.sort(population);
        } else {
            self.replace(population);
        }
    }

    fn sort(&mut self, population: &Population) {
        for (gene, values) in self.values.chunks_exact_mut(self.selected).enumerate() {
            for (value, place) in values.iter_mut().zip(&self.places) {
                *value = ordered(population.at(*place)[gene]);
            }
            values.sort_unstable();
        }
    }

    fn replace(&mut self, population: &Population) {
        for (leaver, enterer) in self.leavers.iter().zip(&self.enterers) {
            let (old, new) = (population.at(*leaver), population.at(*enterer));
            for ((values, old), new) in self.values.chunks_exact_mut(self.selected).zip(old).zip(new) {
                let (old, new) = (ordered(*old), ordered(*new));
                let (from, to) = (below(values, old), below(values, new));
                if to > from {
                    values.copy_within(from + 1..to, from);
                    values[to - 1] = new;
                } else {
                    values.copy_within(to..from, to + 1);
                    values[to] = new;
                }
            }
        }
    }
}

/// How many of the sorted values are less.
#[inline(always)]
fn below(values: &[i64], value: i64) -> usize {
    // A count has no branches to mispredict, and the values are few.
    values.iter().map(|other| usize::from(*other < value)).sum()
}

/// An integer that is ordered as the number is.
#[inline(always)]
fn ordered(number: f64) -> i64 {
    flip(number.to_bits() as i64)
}

/// The number of such an integer.
#[inline(always)]
fn number(ordered: i64) -> f64 {
    f64::from_bits(flip(ordered) as u64)
}

/// Turns the order of negative numbers round, whose bits say the magnitude.
#[inline(always)]
fn flip(bits: i64) -> i64 {
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}

#[cfg(test)]
mod tests {
    use super::*;
    use auv_world::rng::{Purpose, Stream};

    #[test]
    fn integers_are_ordered_as_their_numbers() {
        let numbers = [-1e9, -2.5, -1e-9, 0.0, 1e-9, 2.5, 1e9];
        assert!(numbers.windows(2).all(|pair| ordered(pair[0]) < ordered(pair[1])));
        assert!(numbers.iter().all(|value| number(ordered(*value)) == *value));
    }

    #[test]
    fn replacing_is_as_good_as_sorting() {
        let (size, selected, genes) = (40, 20, 3);
        let mut population = Population::new(size, genes);
        let mut sorted = SortedGenes::new(genes, selected, size);
        let mut stream = Stream::new(3, Purpose::Planner, 0);
        for generation in 0..60 {
            for child in 0..size {
                // Few values, so that there are equals.
                population.child(child).iter_mut().for_each(|gene| *gene = (30.0 * stream.unit()).floor() - 15.0);
                population.set_child_cost(child, stream.unit() * (1.0 - 0.002 * f64::from(generation)));
            }
            population.select();
            sorted.update(&population);
            for gene in 0..genes {
                let mut expected: Vec<f64> = (0..selected).map(|i| population.member(i)[gene]).collect();
                expected.sort_by(f64::total_cmp);
                let found: Vec<f64> = (0..selected).map(|rank| sorted.value(gene, rank)).collect();
                assert_eq!(found, expected, "generation {generation}");
            }
        }
    }
}
