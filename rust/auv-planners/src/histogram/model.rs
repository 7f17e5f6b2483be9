//! Fixed-height histograms (LFHH eq. 1-2): one for each gene, with bins that are equally likely and
//! unequally wide.

use auv_world::rng::Stream;

/// A histogram for each gene.
#[derive(Debug, Clone)]
pub struct Histograms {
    bins: usize,
    /// `bins + 1` bounds for each gene.
    bounds: Vec<f64>,
    sorted: Vec<i64>,
}

impl Histograms {
    /// Room for histograms of `genes` genes, made from `selected` values each.
    pub fn new(genes: usize, bins: usize, selected: usize) -> Self {
        Self { bins, bounds: vec![0.0; genes * (bins + 1)], sorted: Vec::with_capacity(selected) }
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
    pub fn build(
        &mut self,
        gene: usize,
        values: impl Iterator<Item = f64>,
        best: f64,
        learning: f64,
        low: f64,
        high: f64,
    ) {
        let sorted = &mut self.sorted;
        sorted.clear();
        sorted.extend(values.map(|item| ordered(item + learning * (best - item))));
        sorted.sort_unstable();
        let (bins, selected) = (self.bins, sorted.len());
        let bounds = &mut self.bounds[gene * (bins + 1)..][..bins + 1];
        bounds[0] = low;
        for (k, bound) in bounds.iter_mut().enumerate().take(bins).skip(1) {
            let m = k * selected / bins;
            *bound = (number(sorted[m - 1]) + number(sorted[m])) / 2.0;
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

    /// The value at a place in a bin.
    #[inline]
    pub fn value(&self, gene: usize, (bin, place): (usize, f64)) -> f64 {
        let bounds = self.bounds(gene);
        bounds[bin] + place * (bounds[bin + 1] - bounds[bin])
    }
}

/// An integer that is ordered as the number is: integers sort twice as fast.
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
    use auv_world::rng::Purpose;

    #[test]
    fn bounds_by_hand() {
        // Sorted 1 2 4 8 | 10 20: three bins of two values each.
        let mut model = Histograms::new(2, 3, 6);
        model.build(1, [8.0, 20.0, 1.0, 4.0, 2.0, 10.0].into_iter(), 0.0, 0.0, -5.0, 30.0);
        assert_eq!(model.bounds(1), [-5.0, 3.0, 9.0, 30.0]);
    }

    #[test]
    fn bounds_when_bins_do_not_divide_the_values() {
        // m = k * 5 / 3 = 1, 3.
        let mut model = Histograms::new(1, 3, 5);
        model.build(0, [1.0, 2.0, 3.0, 4.0, 5.0].into_iter(), 0.0, 0.0, 0.0, 6.0);
        assert_eq!(model.bounds(0), [0.0, 1.5, 3.5, 6.0]);
    }

    #[test]
    fn integers_are_ordered_as_their_numbers() {
        let numbers = [-1e9, -2.5, -1e-9, 0.0, 1e-9, 2.5, 1e9];
        assert!(numbers.windows(2).all(|pair| ordered(pair[0]) < ordered(pair[1])));
        assert!(numbers.iter().all(|value| number(ordered(*value)) == *value));
    }

    #[test]
    fn learning_moves_values_towards_the_best() {
        let mut model = Histograms::new(1, 2, 2);
        model.build(0, [0.0, 10.0].into_iter(), 10.0, 0.08, -1.0, 11.0);
        // 0 becomes 0.8, 10 stays.
        assert_eq!(model.bounds(0), [-1.0, 5.4, 11.0]);
    }

    #[test]
    fn bins_are_equally_likely_and_uniform() {
        let mut model = Histograms::new(1, 4, 4);
        model.build(0, [1.0, 2.0, 3.0, 10.0].into_iter(), 0.0, 0.0, 0.0, 20.0);
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
