//! Fixed-height histograms (LFHH eq. 1-2): one for each gene, with bins that are equally likely and
//! unequally wide.

use auv_world::rng::Stream;

use super::sorted::SortedGenes;

/// A histogram for each gene.
#[derive(Debug, Clone)]
pub struct Histograms {
    bins: usize,
    /// `bins + 1` bounds for each gene.
    bounds: Vec<f64>,
}

impl Histograms {
    /// Room for histograms of `genes` genes.
    pub fn new(genes: usize, bins: usize) -> Self {
        Self { bins, bounds: vec![0.0; genes * (bins + 1)] }
    }

    /// Number of bins.
    pub fn bins(&self) -> usize {
        self.bins
    }

    /// The bounds of a gene's bins, ascending.
    #[inline]
    pub fn bounds(&self, gene: usize) -> &[f64] {
        &self.bounds[gene * (self.bins + 1)..][..self.bins + 1]
    }

    /// Builds the histogram of a gene: every value first moves towards `best` by the part `learning`
    /// (LTS, eq. 14); then inner bounds lie midway between neighbours of the sorted values, so that
    /// each bin holds equally many, and the outer ones at `low` and `high`.
    pub fn build(&mut self, gene: usize, sorted: &SortedGenes, best: f64, learning: f64, low: f64, high: f64) {
        let (bins, selected) = (self.bins, sorted.selected());
        let bounds = &mut self.bounds[gene * (bins + 1)..][..bins + 1];
        // Learning keeps the order, so that only the values at the bounds need to learn.
        let learned = |rank: usize| {
            let item = sorted.value(gene, rank);
            item + learning * (best - item)
        };
        bounds[0] = low;
        for (k, bound) in bounds.iter_mut().enumerate().take(bins).skip(1) {
            let m = k * selected / bins;
            *bound = (learned(m - 1) + learned(m)) / 2.0;
        }
        bounds[bins] = high;
    }

    /// A random bin and a uniform place in it, from one draw: the whole part of `unit * bins` and the
    /// rest.
    #[inline]
    pub fn draw(&self, stream: &mut Stream) -> (usize, f64) {
        let place = stream.unit() * self.bins as f64;
        let bin = (place as usize).min(self.bins - 1);
        (bin, place - bin as f64)
    }

    /// Draws every gene of a candidate: two from each random number, whose halves say bin and place in it
    /// to a part in four thousand million.
    #[inline]
    pub fn sample(&self, stream: &mut Stream, genes: &mut [f64]) {
        let bins = self.bins as u64;
        for (pair, bounds) in genes.chunks_mut(2).zip(self.bounds.chunks(2 * (self.bins + 1))) {
            let random = stream.next_u64();
            let halves = [random & 0xFFFF_FFFF, random >> 32];
            for ((gene, bounds), half) in pair.iter_mut().zip(bounds.chunks_exact(self.bins + 1)).zip(halves) {
                // Whole part and rest of half / 2^32 * bins.
                let place = half * bins;
                let bin = &bounds[(place >> 32) as usize..][..2];
                *gene = bin[0] + f64::from(place as u32) * (1.0 / 4_294_967_296.0) * (bin[1] - bin[0]);
            }
        }
    }

    /// The value at a place in a bin.
    #[inline]
    pub fn value(&self, gene: usize, (bin, place): (usize, f64)) -> f64 {
        let bounds = self.bounds(gene);
        bounds[bin] + place * (bounds[bin + 1] - bounds[bin])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::population::Population;
    use auv_world::rng::Purpose;

    /// One gene of a population that consists of these values.
    fn sorted(values: &[f64]) -> SortedGenes {
        let mut population = Population::new(values.len(), 1);
        for (child, value) in values.iter().enumerate() {
            population.child(child).fill(*value);
            population.set_child_cost(child, child as f64);
        }
        population.select();
        let mut sorted = SortedGenes::new(1, values.len(), values.len());
        sorted.update(&population);
        sorted
    }

    #[test]
    fn bounds_by_hand() {
        // Sorted 1 2 4 8 | 10 20: three bins of two values each.
        let mut model = Histograms::new(1, 3);
        model.build(0, &sorted(&[8.0, 20.0, 1.0, 4.0, 2.0, 10.0]), 0.0, 0.0, -5.0, 30.0);
        assert_eq!(model.bounds(0), [-5.0, 3.0, 9.0, 30.0]);
    }

    #[test]
    fn bounds_when_bins_do_not_divide_the_values() {
        // m = k * 5 / 3 = 1, 3.
        let mut model = Histograms::new(1, 3);
        model.build(0, &sorted(&[1.0, 2.0, 3.0, 4.0, 5.0]), 0.0, 0.0, 0.0, 6.0);
        assert_eq!(model.bounds(0), [0.0, 1.5, 3.5, 6.0]);
    }

    #[test]
    fn learning_moves_values_towards_the_best() {
        let mut model = Histograms::new(1, 2);
        model.build(0, &sorted(&[0.0, 10.0]), 10.0, 0.08, -1.0, 11.0);
        // 0 becomes 0.8, 10 stays.
        assert_eq!(model.bounds(0), [-1.0, 5.4, 11.0]);
    }

    #[test]
    fn bins_are_equally_likely_and_uniform() {
        let mut model = Histograms::new(1, 4);
        model.build(0, &sorted(&[1.0, 2.0, 3.0, 10.0]), 0.0, 0.0, 0.0, 20.0);
        let mut stream = Stream::new(1, Purpose::Planner, 0);
        let (mut counts, mut places) = ([0; 4], 0.0);
        for _ in 0..40_000 {
            let draw = model.draw(&mut stream);
            counts[draw.0] += 1;
            places += draw.1;
            let value = model.value(0, draw);
            let bounds = model.bounds(0);
            assert!(value >= bounds[draw.0] && value <= bounds[draw.0 + 1]);
        }
        assert!(counts.iter().all(|count| (9_600..10_400).contains(count)), "{counts:?}");
        assert!((places / 40_000.0 - 0.5).abs() < 0.01);
    }
}
