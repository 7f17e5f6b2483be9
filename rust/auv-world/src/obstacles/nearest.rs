//! The nearest of many solids, and by how much it is nearer than all others: as long as nothing has moved that far,
//! it is the nearest still, and need not be looked for.

use wide::f64x4;

use crate::lanes::{LANES, least};

/// The nearest solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest<I> {
    /// Its clearance (m); infinite if there is none.
    pub clearance: f64,
    /// Which one.
    pub index: Option<I>,
    /// No other's clearance is less than this (m).
    pub rivals: f64,
}

impl<I> Nearest<I> {
    /// Of nothing, but for solids of which is only known that they are no nearer than `rivals`.
    pub fn none(rivals: f64) -> Self {
        Self { clearance: f64::INFINITY, index: None, rivals }
    }

    /// With another solid.
    #[inline]
    pub fn with(self, index: I, clearance: f64) -> Self {
        self.and(Self { clearance, index: Some(index), rivals: f64::INFINITY })
    }

    /// With other solids, of which the nearest is known.
    #[inline]
    pub fn and(self, other: Self) -> Self {
        let (first, second) = if other.clearance < self.clearance { (other, self) } else { (self, other) };
        Self { rivals: first.rivals.min(second.clearance).min(second.rivals), ..first }
    }

    /// The same by another name.
    pub fn named<J>(self, name: impl Fn(I) -> J) -> Nearest<J> {
        Nearest { clearance: self.clearance, index: self.index.map(name), rivals: self.rivals }
    }
}

/// The nearest and the second of each lane so far.
pub(super) struct Lanes {
    nearest: f64x4,
    second: f64x4,
    /// The chunk of the nearest.
    chunk: f64x4,
}

impl Lanes {
    pub fn new() -> Self {
        let far = f64x4::splat(f64::INFINITY);
        Self { nearest: far, second: far, chunk: f64x4::ZERO }
    }

    /// Takes in the clearances of a chunk.
    #[inline(always)]
    pub fn see(&mut self, chunk: usize, clearance: f64x4) {
        let nearer = clearance.simd_lt(self.nearest);
        self.second = self.second.fast_min(nearer.select(self.nearest, clearance));
        self.nearest = nearer.select(clearance, self.nearest);
        self.chunk = nearer.select(f64x4::splat(chunk as f64), self.chunk);
    }

    /// What is nearest so far; numbers count through all chunks.
    #[inline(always)]
    pub fn found(&self) -> Nearest<usize> {
        let (nearest, chunk) = (self.nearest.to_array(), self.chunk.to_array());
        let rivals = least(self.second, f64::INFINITY);
        (0..LANES).fold(Nearest::none(rivals), |found, lane| {
            if nearest[lane] == f64::INFINITY {
                return found;
            }
            found.with(chunk[lane] as usize * LANES + lane, nearest[lane])
        })
    }
}
