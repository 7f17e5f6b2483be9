//! The sea floor: its depth, a clearance that never overestimates, and the range of a sonar beam.

mod gridded;
mod peaks;

pub use gridded::GridFloor;
pub use peaks::PeakFloor;

use crate::lanes::LANES;
use crate::math::Vec3;
use crate::obstacles::BeamColumns;

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

    /// Shortens `ranges` to how far beams run before they meet the floor (m); `candidates` as from [`Floor::near`].
    pub fn range(&self, origin: Vec3, beams: &[BeamColumns], candidates: &[u32], ranges: &mut [[f64; LANES]]) {
        let each = |ranges: &mut [[f64; LANES]], range: &dyn Fn(Vec3, f64) -> f64| {
            for (beams, ranges) in beams.iter().zip(ranges) {
                *ranges = std::array::from_fn(|lane| range(beams.map(|axis| axis[lane]), ranges[lane]));
            }
        };
        match self {
            Self::None => {}
            Self::Flat(depth) => {
                let above = (depth - origin[2]).max(0.0);
                each(ranges, &|beam, range| if beam[2] > 0.0 { range.min(above / beam[2]) } else { range });
            }
            Self::Peaks(peaks) => peaks.range(origin, beams, candidates, ranges),
            Self::Gridded(grid) => each(ranges, &|beam, range| grid.range(origin, beam, range)),
        }
    }
}
