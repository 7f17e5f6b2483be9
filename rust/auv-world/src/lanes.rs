//! Columns of numbers, read four at once. Only sums, products, quotients, roots and comparisons are used,
//! which give the same bytes whatever the width of the machine's registers.

use wide::f64x4;

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

/// e^x of four numbers: bit for bit [`crate::math::exp`].
#[inline(always)]
pub fn exp(x: f64x4) -> f64x4 {
    let x = x.fast_max(f64x4::splat(-708.0)).fast_min(f64x4::splat(709.0));
    let rounder = f64x4::splat(ROUNDER);
    let shifted = x * f64x4::splat(std::f64::consts::LOG2_E) + rounder;
    let n = shifted - rounder;
    let r = (x - n * f64x4::splat(LN2_HIGH)) - n * f64x4::splat(LN2_LOW);
    let c = |i: usize| f64x4::splat(EXP_TAYLOR[i]);
    let (r2, pair) = (r * r, |i: usize| c(i) + c(i + 1) * r);
    let (r4, quad) = (r2 * r2, |i: usize| pair(i) + pair(i + 2) * r2);
    let p = (quad(0) + quad(4) * r4) + (quad(8) + c(12) * r4) * (r4 * r4);
    let scale = shifted.to_array().map(|v| f64::from_bits(v.to_bits().wrapping_add(1023) << 52));
    p * f64x4::new(scale)
}

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
        }
    }

    #[test]
    fn pads_with_the_filler() {
        let mut column = Column::default();
        (0..5).for_each(|i| column.push(f64::from(i), 9.0));
        let chunks: Vec<[f64; 4]> = column.chunks().map(f64x4::to_array).collect();
        assert_eq!(chunks, [[0.0, 1.0, 2.0, 3.0], [4.0, 9.0, 9.0, 9.0]]);
        assert_eq!(least(f64x4::new([4.0, 2.0, 3.0, 9.0]), 7.0), 2.0);
    }
}
