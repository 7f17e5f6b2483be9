//! The outline of a simple polygon: exact signed distance, of one point to four edges at once or of four points
//! to one edge.

use std::sync::Arc;

use wide::f64x4;

use super::{STEPS, TOUCH};
use crate::lanes::{LANES, least};
use crate::math::Vec2;

/// What rounds where a point is said to lie, as a part of the polygon's size.
const SLACK: f64 = 1e-9;
/// Padding: an edge far from everything.
const FAR: f64 = 1e15;

/// A polygon's outline; copies share it.
#[derive(Debug, Clone)]
pub(super) struct Outline {
    /// Edge i leads from corner i to the next.
    edges: Arc<[Edges]>,
    count: usize,
    /// A box that holds it with room for rounding.
    low: Vec2,
    high: Vec2,
    /// Half the diagonal of the box.
    extent: f64,
}

/// Four edges.
#[derive(Debug, Clone, Copy)]
struct Edges {
    from: [f64x4; 2],
    along: [f64x4; 2],
    /// Squared length.
    square: f64x4,
}

/// Squared distance of points at `offset` from where edges begin.
#[inline(always)]
fn square_gap(offset: [f64x4; 2], along: [f64x4; 2], square: f64x4) -> f64x4 {
    let part = (offset[0] * along[0] + offset[1] * along[1]) / square;
    let part = part.fast_max(f64x4::ZERO).fast_min(f64x4::ONE);
    let gap = [offset[0] - part * along[0], offset[1] - part * along[1]];
    gap[0] * gap[0] + gap[1] * gap[1]
}

impl Outline {
    /// The outline with these corners (m), at least three, seen from `centre`.
    pub fn new(corners: &[Vec2], centre: Vec2) -> Self {
        let seen = |i: usize| [corners[i][0] - centre[0], corners[i][1] - centre[1]];
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let four = |first: usize| {
            let (mut from, mut along, mut square) = ([[FAR; LANES]; 2], [[0.0; LANES]; 2], [1.0; LANES]);
            for (lane, i) in (first..corners.len()).take(LANES).enumerate() {
                let (corner, next) = (seen(i), seen(if i + 1 < corners.len() { i + 1 } else { 0 }));
                let edge = [next[0] - corner[0], next[1] - corner[1]];
                for axis in 0..2 {
                    (from[axis][lane], along[axis][lane]) = (corner[axis], edge[axis]);
                    (low[axis], high[axis]) = (low[axis].min(corner[axis]), high[axis].max(corner[axis]));
                }
                square[lane] = edge[0] * edge[0] + edge[1] * edge[1];
            }
            Edges { from: from.map(f64x4::new), along: along.map(f64x4::new), square: f64x4::new(square) }
        };
        let edges = (0..corners.len()).step_by(LANES).map(four).collect();
        let slack = SLACK * (high[0] - low[0]).max(high[1] - low[1]);
        let (low, high) = (low.map(|v| v - slack), high.map(|v| v + slack));
        let (width, height) = (high[0] - low[0], high[1] - low[1]);
        Self { edges, count: corners.len(), low, high, extent: 0.5 * (width * width + height * height).sqrt() }
    }

    #[inline(always)]
    fn corner(&self, i: usize) -> Vec2 {
        self.edges[i / LANES].from.each_ref().map(|axis| axis.as_array()[i % LANES])
    }

    /// Its corners (m).
    pub fn corners(&self) -> impl Iterator<Item = Vec2> + '_ {
        (0..self.count).map(|i| self.corner(i))
    }

    /// The corners of a box that holds it with a little room (m).
    pub fn bounds(&self) -> (Vec2, Vec2) {
        (self.low, self.high)
    }

    /// Signed distance (m), negative inside.
    pub fn distance(&self, p: Vec2) -> f64 {
        let at = p.map(f64x4::splat);
        let nearest2 = self.edges.iter().fold(f64x4::splat(f64::INFINITY), |nearest2, edges| {
            let offset = [at[0] - edges.from[0], at[1] - edges.from[1]];
            nearest2.fast_min(square_gap(offset, edges.along, edges.square))
        });
        let distance = least(nearest2, f64::INFINITY).sqrt();
        if self.holds(p) { -distance } else { distance }
    }

    /// Whether a point lies in its box.
    #[inline]
    pub fn may_hold(&self, p: Vec2) -> bool {
        (0..2).all(|axis| self.low[axis] <= p[axis] && p[axis] <= self.high[axis])
    }

    /// Whether a point lies inside, by the crossing rule: a ray to +x crosses an odd number of edges.
    fn holds(&self, p: Vec2) -> bool {
        if !self.may_hold(p) {
            return false;
        }
        let mut from = self.corner(self.count - 1);
        (0..self.count).fold(false, |inside, i| {
            let to = self.corner(i);
            let crosses = (from[1] > p[1]) != (to[1] > p[1])
                && p[0] < from[0] + (to[0] - from[0]) * (p[1] - from[1]) / (to[1] - from[1]);
            from = to;
            inside ^ crosses
        })
    }

    /// Distance (m) of each of four points, whichever side they are on.
    #[inline(always)]
    fn distances(&self, p: [f64x4; 2]) -> f64x4 {
        let mut nearest2 = f64x4::splat(f64::INFINITY);
        for (i, edges) in self.edges.iter().enumerate() {
            let (from, along) = (edges.from.map(f64x4::to_array), edges.along.map(f64x4::to_array));
            let square = edges.square.to_array();
            for lane in 0..LANES.min(self.count - i * LANES) {
                let offset = [0, 1].map(|axis| p[axis] - f64x4::splat(from[axis][lane]));
                let along = along.map(|axis| f64x4::splat(axis[lane]));
                nearest2 = nearest2.fast_min(square_gap(offset, along, f64x4::splat(square[lane])));
            }
        }
        nearest2.sqrt()
    }

    /// Which of four level beams of unit `directions` from `origin`, `longest` metres long, can end before that: a
    /// bit for each. The others keep so far away that [`super::march`] takes them to their ends.
    #[inline]
    pub fn may_stop(&self, origin: Vec2, directions: &[f64x4; 2], longest: f64x4) -> u32 {
        // Steps of more than a 256th of the way come to its end in time. Half a millimetre is more than rounding.
        let near = longest * f64x4::splat(1.02 / STEPS as f64) + f64x4::splat(5e-4);
        let turned = |corner: Vec2| {
            let offset = [f64x4::splat(corner[0] - origin[0]), f64x4::splat(corner[1] - origin[1])];
            let along = offset[0] * directions[0] + offset[1] * directions[1];
            (along, offset[0] * directions[1] - offset[1] * directions[0])
        };
        // Most beams pass by a circle round it, too.
        let (along, across) = turned([0, 1].map(|axis| 0.5 * (self.low[axis] + self.high[axis])));
        let apart = across.abs().fast_max(-along).fast_max(along - longest);
        if (apart - near).simd_gt(f64x4::splat(self.extent)).all() {
            return 0;
        }
        // In the frame of a beam the polygon lies between these.
        let (mut low, mut high) = ([f64x4::splat(f64::INFINITY); 2], [f64x4::splat(f64::NEG_INFINITY); 2]);
        for corner in self.corners() {
            let (along, across) = turned(corner);
            (low[0], high[0]) = (low[0].fast_min(along), high[0].fast_max(along));
            (low[1], high[1]) = (low[1].fast_min(across), high[1].fast_max(across));
        }
        let apart = low[1].fast_max(-high[1]).fast_max(low[0] - longest).fast_max(-high[0]);
        apart.simd_le(near).to_bitmask()
    }

    /// Walks along four level beams from `origin`, a place outside, until each touches or has run its `longest`
    /// (m): each as [`super::march`] would alone. Everything is relative to the centre of the polygon, `centre`.
    pub fn march(&self, centre: Vec2, origin: Vec2, directions: &[f64x4; 2], longest: f64x4) -> f64x4 {
        let touch = f64x4::splat(TOUCH) * longest;
        let (at, centre) = (origin.map(f64x4::splat), centre.map(f64x4::splat));
        let mut range = f64x4::ZERO;
        let mut going = f64x4::ZERO.simd_eq(f64x4::ZERO);
        for _ in 0..STEPS {
            let p: [f64x4; 2] = std::array::from_fn(|axis| (at[axis] + range * directions[axis]) - centre[axis]);
            let free = self.distances(p);
            going &= free.simd_ge(touch);
            range = going.select((range + free).fast_min(longest), range);
            going &= range.simd_lt(longest);
            if !going.any() {
                break;
            }
        }
        range
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Signed distance edge by edge.
    fn plain(corners: &[Vec2], p: Vec2) -> f64 {
        let (mut nearest2, mut inside) = (f64::INFINITY, false);
        let mut from = corners[corners.len() - 1];
        for &to in corners {
            let (edge, offset) = ([to[0] - from[0], to[1] - from[1]], [p[0] - from[0], p[1] - from[1]]);
            let part = (offset[0] * edge[0] + offset[1] * edge[1]) / (edge[0] * edge[0] + edge[1] * edge[1]);
            let part = part.clamp(0.0, 1.0);
            let gap = [offset[0] - part * edge[0], offset[1] - part * edge[1]];
            nearest2 = nearest2.min(gap[0] * gap[0] + gap[1] * gap[1]);
            let crossed = (from[1] > p[1]) != (to[1] > p[1]);
            inside ^= crossed && p[0] < from[0] + edge[0] * (p[1] - from[1]) / edge[1];
            from = to;
        }
        if inside { -nearest2.sqrt() } else { nearest2.sqrt() }
    }

    proptest! {
        #[test]
        fn four_at_once_are_what_each_is_alone(
            reaches in prop::collection::vec(0.2..1.0_f64, 3..12),
            points in prop::array::uniform4(prop::array::uniform2(-2.0..2.0_f64)),
            corner in 0..3_usize,
        ) {
            let n = reaches.len() as f64;
            let at = |(i, r): (usize, &f64)| {
                let angle = std::f64::consts::TAU * i as f64 / n;
                [r * libm::cos(angle), r * libm::sin(angle)]
            };
            let corners: Vec<Vec2> = reaches.iter().enumerate().map(at).collect();
            let outline = Outline::new(&corners, [0.0; 2]);
            // On a corner and level with one, too: there the crossing rule is put to the test.
            let points = [points[0], points[1], corners[corner], [points[3][0], corners[corner][1]]];
            let together = outline.distances([0, 1].map(|axis| f64x4::new(points.map(|p| p[axis])))).to_array();
            for (point, unsigned) in points.into_iter().zip(together) {
                let expected = plain(&corners, point);
                prop_assert_eq!(outline.distance(point).to_bits(), expected.to_bits());
                prop_assert_eq!(unsigned.to_bits(), expected.abs().to_bits());
            }
        }
    }
}
