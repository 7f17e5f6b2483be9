//! Columns of numbers, read four at once. Only sums, products, quotients, roots and comparisons are used,
//! which give the same bytes whatever the width of the machine's registers.

use wide::{f64x2, f64x4};

use crate::math::{EXP_TAYLOR, LN2_HIGH, LN2_LOW, ROUNDER};

/// How many numbers are read at once.
pub const LANES: usize = 4;

/// A column of numbers, padded to whole chunks.
#[derive(Debug, Clone, Default)]
pub struct Column {
    values: Vec<f64>,
    len: usize,
}

impl Column {
    /// A column of these values; the padding behind them is `filler`.
    pub fn of(values: impl Iterator<Item = f64>, filler: f64) -> Self {
        let mut values = Vec::from_iter(values);
        let len = values.len();
        values.resize(len.next_multiple_of(LANES), filler);
        Self { values, len }
    }

    /// Appends a value; the padding behind it is `filler`.
    pub fn push(&mut self, value: f64, filler: f64) {
        if self.len == self.values.len() {
            self.values.resize(self.len + LANES, filler);
        }
        self.values[self.len] = value;
        self.len += 1;
    }

    /// Number of values.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The chunks, padding included.
    #[inline(always)]
    pub fn chunks(&self) -> impl Iterator<Item = f64x4> + '_ {
        self.values.as_chunks::<LANES>().0.iter().map(|chunk| f64x4::new(*chunk))
    }

    /// The chunks in halves.
    #[inline(always)]
    pub fn halves(&self) -> impl Iterator<Item = [f64x2; 2]> + '_ {
        self.values.as_chunks::<LANES>().0.iter().map(|[a, b, c, d]| [f64x2::new([*a, *b]), f64x2::new([*c, *d])])
    }
}

impl std::ops::Index<usize> for Column {
    type Output = f64;
    #[inline(always)]
    fn index(&self, i: usize) -> &f64 {
        &self.values[i]
    }
}

impl std::ops::IndexMut<usize> for Column {
    #[inline(always)]
    fn index_mut(&mut self, i: usize) -> &mut f64 {
        &mut self.values[i]
    }
}

/// The least of four numbers and one more.
#[inline(always)]
pub fn least(values: f64x4, other: f64) -> f64 {
    let [a, b, c, d] = values.to_array();
    a.min(b).min(c.min(d)).min(other)
}

macro_rules! exponential {
    ($name:ident, $lanes:ty) => {
        /// e^x of each number: bit for bit [`crate::math::exp`].
        #[inline(always)]
        pub fn $name(x: $lanes) -> $lanes {
            let all = <$lanes>::splat;
            let x = x.fast_max(all(-708.0)).fast_min(all(709.0));
            let shifted = x * all(std::f64::consts::LOG2_E) + all(ROUNDER);
            let n = shifted - all(ROUNDER);
            let r = (x - n * all(LN2_HIGH)) - n * all(LN2_LOW);
            let c = |i: usize| all(EXP_TAYLOR[i]);
            let (r2, pair) = (r * r, |i: usize| c(i) + c(i + 1) * r);
            let (r4, quad) = (r2 * r2, |i: usize| pair(i) + pair(i + 2) * r2);
            let p = (quad(0) + quad(4) * r4) + (quad(8) + c(12) * r4) * (r4 * r4);
            let scale = shifted.to_array().map(|v| f64::from_bits(v.to_bits().wrapping_add(1023) << 52));
            p * <$lanes>::new(scale)
        }
    };
}

exponential!(exp, f64x4);
exponential!(exp_pair, f64x2);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exp_equals_the_scalar_one() {
        for i in 0..4000 {
            let x: [f64; 4] = std::array::from_fn(|lane| -720.0 + 0.09 * f64::from(4 * i + lane as i32));
            let together = exp(f64x4::new(x)).to_array();
            for lane in 0..4 {
                assert_eq!(together[lane].to_bits(), crate::math::exp(x[lane]).to_bits());
            }
            let pair = exp_pair(f64x2::new([x[0], x[1]])).to_array();
            for lane in 0..2 {
                assert_eq!(pair[lane].to_bits(), together[lane].to_bits());
            }
        }
    }

    #[test]
    fn pads_with_the_filler() {
        let mut column = Column::default();
        (0..5).for_each(|i| column.push(f64::from(i), 9.0));
        assert_eq!(Column::of((0..5).map(f64::from), 9.0).values, column.values);
        let chunks: Vec<[f64; 4]> = column.chunks().map(f64x4::to_array).collect();
        assert_eq!(chunks, [[0.0, 1.0, 2.0, 3.0], [4.0, 9.0, 9.0, 9.0]]);
        let halves: Vec<[f64; 2]> = column.halves().flatten().map(f64x2::to_array).collect();
        assert_eq!(halves, [[0.0, 1.0], [2.0, 3.0], [4.0, 9.0], [9.0, 9.0]]);
        assert_eq!(least(f64x4::new([4.0, 2.0, 3.0, 9.0]), 7.0), 2.0);
    }
}
