//! The sea floor: its depth, a clearance that never overestimates, and the range of a sonar beam.

mod gridded;
mod peaks;

pub use gridded::GridFloor;
pub use peaks::PeakFloor;

use crate::math::Vec3;

/// The sea floor of a world.
#[derive(Debug, Clone)]
pub enum Floor {
    /// None: nothing below.
    None,
    /// One depth (m).
    Flat(f64),
    /// Gaussian peaks.
    Peaks(PeakFloor),
    /// A grid of depths.
    Gridded(GridFloor),
}

impl Floor {
    /// Depth of the floor (m) at (x, y); infinite where there is none.
    pub fn depth(&self, x: f64, y: f64) -> f64 {
        match self {
            Self::None => f64::INFINITY,
            Self::Flat(depth) => *depth,
            Self::Peaks(peaks) => peaks.depth(x, y),
            Self::Gridded(grid) => grid.depth(x, y),
        }
    }

    /// The lesser of `nearest` and a lower bound of the signed distance to the floor (m). Knowing that
    /// something else is `nearest` lets far peaks be passed over.
    #[inline]
    pub fn clearance(&self, point: Vec3, nearest: f64) -> f64 {
        match self {
            Self::None => nearest,
            Self::Flat(depth) => nearest.min(depth - point[2]),
            Self::Peaks(peaks) => peaks.clearance(point, nearest),
            Self::Gridded(grid) => nearest.min(grid.clearance(point)),
        }
    }

    /// Appends what of the floor a beam of at most `longest` metres from `origin` can meet.
    pub fn near(&self, origin: Vec3, longest: f64, candidates: &mut Vec<u32>) {
        if let Self::Peaks(peaks) = self {
            peaks.near(origin, longest, candidates);
        }
    }

    /// How far a beam of unit `direction` runs before it meets the floor (m), at most `longest`;
    /// `candidates` as from [`Floor::near`].
    pub fn range(&self, origin: Vec3, direction: Vec3, longest: f64, candidates: &[u32]) -> f64 {
        match self {
            Self::None => longest,
            Self::Flat(depth) => plane_range(depth - origin[2], direction[2]).min(longest),
            Self::Peaks(peaks) => peaks.range(origin, direction, longest, candidates),
            Self::Gridded(grid) => grid.range(origin, direction, longest),
        }
    }
}

/// How far a beam runs before it meets a plane `gap` away, approached at `rate` per metre.
#[inline]
pub(crate) fn plane_range(gap: f64, rate: f64) -> f64 {
    if gap <= 0.0 {
        0.0
    } else if rate > 0.0 {
        gap / rate
    } else {
        f64::INFINITY
    }
}
