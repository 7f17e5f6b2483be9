//! Gaussian peaks on a flat floor (LFHH eq. 11); the sea floor is the highest of them.
//!
//! With u = sqrt(a^2 dy^2 + b^2 dx^2) / sigma a peak is h exp(-u^2 / 2), and u changes by at most
//! k = max(a, b) / sigma for each metre. So within t metres on the map the slope is at most the
//! greatest of |h u' exp(-u'^2 / 2)| k for u' in [u - k t, u], and a point `gap` above the peak is at
//! least gap / sqrt(1 + slope^2) away from it.

use wide::f64x4;

use crate::lanes::{Column, LANES, exp as exp4, least};
use crate::math::{Vec3, exp};
use crate::obstacles::{BeamColumns, Beams, STEPS, TOUCH};
use crate::scenario::{Peak, Peaks};

/// At most exp(u^2 / 2), without an exponential: the start of its series, and 1 for u < 0.
#[inline(always)]
fn falls_by(u: f64x4) -> f64x4 {
    let u = u.fast_max(f64x4::ZERO);
    series(f64x4::HALF * u * u)
}

/// At most exp(s) for s not negative.
#[inline(always)]
fn series(s: f64x4) -> f64x4 {
    f64x4::ONE + s * (f64x4::ONE + s * (f64x4::HALF + s * f64x4::splat(1.0 / 6.0)))
}

/// A lower bound of the distance to each of four peaks, or anything not less than `nearest` where they are
/// farther than that, from points `above` the flat floor at `u`; minus the gap inside.
#[inline(always)]
fn distance_bound(height: f64x4, steepness: f64x4, u: f64x4, above: f64x4, nearest: f64) -> f64x4 {
    let here = height * exp4(f64x4::splat(-0.5) * u * u);
    let gap = above - here;
    let low = (u - steepness * gap.fast_min(f64x4::splat(nearest.max(0.0)))).fast_max(f64x4::ZERO);
    // |d/du| of a peak is greatest at u = 1: there if it lies in [low, u], else at the nearer end.
    let steepest = low.fast_max(f64x4::ONE.fast_min(u));
    let slope = steepness * height * steepest * exp4(f64x4::splat(-0.5) * steepest * steepest);
    let distance = gap / (f64x4::ONE + slope * slope).sqrt();
    gap.simd_le(f64x4::ZERO).select(gap, distance)
}

/// Peaks as a structure of arrays.
#[derive(Debug, Clone)]
pub struct PeakFloor {
    floor_depth: f64,
    x: Column,
    y: Column,
    height: Column,
    /// (b / sigma)^2 and (a / sigma)^2.
    along_x: Column,
    along_y: Column,
    /// k = max(a, b) / sigma.
    steepness: Column,
    /// Height of the highest summit.
    highest: f64,
}

impl PeakFloor {
    /// Prepares checked peaks.
    pub fn new(peaks: &Peaks) -> Self {
        // Neighbours share a chunk, so that a point is near few chunks.
        let mut order: Vec<&Peak> = peaks.peaks.iter().collect();
        order.sort_by(|a, b| a.y_m.total_cmp(&b.y_m));
        let column = |value: fn(&Peak) -> f64| Column::of(order.iter().map(|peak| value(peak)), 0.0);
        Self {
            floor_depth: peaks.floor_depth_m,
            x: column(|p| p.x_m),
            y: column(|p| p.y_m),
            height: column(|p| p.height_m),
            along_x: column(|p| (p.b / p.sigma_m) * (p.b / p.sigma_m)),
            along_y: column(|p| (p.a / p.sigma_m) * (p.a / p.sigma_m)),
            steepness: column(|p| p.a.max(p.b) / p.sigma_m),
            highest: peaks.peaks.iter().fold(0.0, |highest, peak| peak.height_m.max(highest)),
        }
    }

    /// u^2 of peak `i`.
    #[inline(always)]
    fn u2(&self, i: usize, x: f64, y: f64) -> f64 {
        let (dx, dy) = (x - self.x[i], y - self.y[i]);
        self.along_x[i] * dx * dx + self.along_y[i] * dy * dy
    }

    /// Depth of the floor (m).
    pub fn depth(&self, x: f64, y: f64) -> f64 {
        let mut highest = 0.0;
        for i in 0..self.x.len() {
            let height = self.height[i] * exp(-0.5 * self.u2(i, x, y));
            highest = if height > highest { height } else { highest };
        }
        self.floor_depth - highest
    }

    /// The lesser of `nearest` and a lower bound of the signed distance to the floor (m).
    #[inline]
    pub fn clearance(&self, point: Vec3, nearest: f64) -> f64 {
        let above = self.floor_depth - point[2];
        let mut best = nearest.min(above);
        if above - best >= self.highest {
            return best;
        }
        let (x, y) = (f64x4::splat(point[0]), f64x4::splat(point[1]));
        let shapes = self.along_x.chunks().zip(self.along_y.chunks()).zip(self.steepness.chunks());
        let peaks = self.x.chunks().zip(self.y.chunks()).zip(self.height.chunks()).zip(shapes);
        for (((px, py), height), ((ax, ay), steepness)) in peaks {
            // Most peaks cannot rise to within `best` of the point: sort them out four at once. Padding
            // has no height, so it never does.
            let (dx, dy) = (x - px, y - py);
            let u = (ax * dx * dx + ay * dy * dy).sqrt();
            let room = f64x4::splat((above - best).max(0.0));
            let rises = (room * falls_by(u - steepness * f64x4::splat(best.max(0.0)))).simd_lt(height);
            if rises.any() {
                best = least(distance_bound(height, steepness, u, f64x4::splat(above), best), best);
            }
        }
        best
    }

    /// Appends the peaks that a beam of at most `longest` metres from `origin` can meet.
    pub fn near(&self, origin: Vec3, longest: f64, candidates: &mut Vec<u32>) {
        let lowest = f64x4::splat(self.floor_depth - origin[2] - longest);
        let (x, y) = (f64x4::splat(origin[0]), f64x4::splat(origin[1]));
        let shapes = self.along_x.chunks().zip(self.along_y.chunks()).zip(self.steepness.chunks());
        let peaks = self.x.chunks().zip(self.y.chunks()).zip(self.height.chunks()).zip(shapes);
        for (chunk, (((px, py), height), ((ax, ay), steepness))) in peaks.enumerate() {
            let (dx, dy) = (x - px, y - py);
            let u = (ax * dx * dx + ay * dy * dy).sqrt();
            let closest = (u - steepness * f64x4::splat(longest)).fast_max(f64x4::ZERO);
            // Most are too far away for an exponential; by more than its rounding.
            let least = lowest * series(f64x4::HALF * closest * closest);
            if least.simd_ge(height * f64x4::splat(1.0 + 1e-9)).all() {
                continue;
            }
            let near = (height * exp4(f64x4::splat(-0.5) * closest * closest)).simd_gt(lowest).to_bitmask();
            let first = chunk * LANES;
            let lanes = (first..self.x.len()).take(LANES).filter(|i| near >> (i - first) & 1 == 1);
            candidates.extend(lanes.map(|i| i as u32));
        }
    }

    /// Shortens `ranges` to how far beams run before they meet the flat floor or one of the peaks `candidates` (m).
    pub fn range(&self, origin: Vec3, beams: &[BeamColumns], candidates: &[u32], ranges: &mut [[f64; LANES]]) {
        let above = f64x4::splat(self.floor_depth - origin[2]);
        for (beams, range) in beams.iter().zip(&mut *ranges) {
            let (down, nearest) = (f64x4::new(beams[2]), f64x4::new(*range));
            let dives = down.simd_gt(f64x4::ZERO);
            let plane = above.fast_max(f64x4::ZERO) / dives.select(down, f64x4::ONE);
            *range = dives.select(plane.fast_min(nearest), nearest).to_array();
        }
        for &i in candidates {
            let i = i as usize;
            // Beams that meet a peak stand apart: they wait until there are four to walk along.
            let (mut waiting, mut count) = ([0; LANES], 0);
            for chunk in 0..beams.len() {
                let mut rises = self.rises(i, origin, &beams[chunk].map(f64x4::new), f64x4::new(ranges[chunk]));
                while rises != 0 {
                    waiting[count] = chunk * LANES + rises.trailing_zeros() as usize;
                    rises &= rises - 1;
                    count += 1;
                    if count == LANES {
                        self.walk(i, origin, beams, &waiting, ranges);
                        count = 0;
                    }
                }
            }
            if count > 0 {
                self.walk(i, origin, beams, &waiting[..count], ranges);
            }
        }
    }

    /// Which of four beams peak `i` might rise to within their `range`: a bit for each.
    #[inline]
    fn rises(&self, i: usize, origin: Vec3, beams: &Beams, range: f64x4) -> u32 {
        // u^2 along a beam is a parabola, q0 + 2 q1 t + q2 t^2: where it is least the peak is highest.
        let above = f64x4::splat(self.floor_depth - origin[2]);
        let (dx, dy) = (origin[0] - self.x[i], origin[1] - self.y[i]);
        let (ax, ay) = (self.along_x[i], self.along_y[i]);
        let q0 = f64x4::splat(ax * dx * dx + ay * dy * dy);
        let q1 = beams[0] * f64x4::splat(ax * dx) + beams[1] * f64x4::splat(ay * dy);
        let q2 = beams[0] * beams[0] * f64x4::splat(ax) + beams[1] * beams[1] * f64x4::splat(ay);
        let closest = (-q1 / q2.fast_max(f64x4::splat(1e-30))).fast_max(f64x4::ZERO).fast_min(range);
        let least = (q0 + closest * (q1 + q1 + q2 * closest)).fast_max(f64x4::ZERO);
        let lowest = above.fast_min(above - range * beams[2]);
        // Most beams pass far too high for an exponential; by more than its rounding.
        let passes = (lowest * series(f64x4::HALF * least)).simd_ge(f64x4::splat(self.height[i] * (1.0 + 1e-9)));
        if passes.all() {
            return 0;
        }
        (f64x4::splat(self.height[i]) * exp4(f64x4::splat(-0.5) * least)).simd_gt(lowest).to_bitmask()
    }

    /// Walks along one to four beams, by their numbers, towards peak `i`.
    fn walk(&self, i: usize, origin: Vec3, beams: &[BeamColumns], numbers: &[usize], ranges: &mut [[f64; LANES]]) {
        let (mut four, mut longest) = (BeamColumns::default(), [0.0; LANES]);
        for lane in 0..LANES {
            let number = numbers[lane.min(numbers.len() - 1)];
            let (chunk, at) = (number / LANES, number % LANES);
            (0..3).for_each(|axis| four[axis][lane] = beams[chunk][axis][at]);
            longest[lane] = ranges[chunk][at];
        }
        let found = self.march(i, origin, &four.map(f64x4::new), f64x4::new(longest)).to_array();
        for (&number, range) in numbers.iter().zip(found) {
            ranges[number / LANES][number % LANES] = range;
        }
    }

    /// Walks along four beams until each touches peak `i` or has run its `longest`, all at once: each as
    /// [`crate::obstacles::march`] would alone.
    fn march(&self, i: usize, origin: Vec3, beams: &Beams, longest: f64x4) -> f64x4 {
        let touch = f64x4::splat(TOUCH) * longest;
        let [x, y, height, steepness] = [self.x[i], self.y[i], self.height[i], self.steepness[i]].map(f64x4::splat);
        let (ax, ay) = (f64x4::splat(self.along_x[i]), f64x4::splat(self.along_y[i]));
        let (floor, at) = (f64x4::splat(self.floor_depth), origin.map(f64x4::splat));
        let mut range = f64x4::ZERO;
        let mut going = range.simd_eq(f64x4::ZERO);
        for _ in 0..STEPS {
            let [px, py, pz]: Beams = std::array::from_fn(|axis| at[axis] + range * beams[axis]);
            let (dx, dy) = (px - x, py - y);
            let u = (ax * dx * dx + ay * dy * dy).sqrt();
            let free = distance_bound(height, steepness, u, floor - pz, f64::INFINITY);
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
    use crate::math::add_scaled;
    use proptest::prelude::*;

    fn floor() -> PeakFloor {
        let peak = |x_m, y_m, height_m, a, b, sigma_m| Peak { x_m, y_m, height_m, a, b, sigma_m };
        PeakFloor::new(&Peaks {
            floor_depth_m: 20_000.0,
            peaks: vec![
                peak(5000.0, 9000.0, 14_000.0, 0.7, 1.2, 1800.0),
                peak(8000.0, 4000.0, 7000.0, 1.0, 0.6, 2500.0),
                peak(2000.0, 2000.0, 12_000.0, 1.1, 1.1, 1500.0),
            ],
        })
    }

    fn gap_along(floor: &PeakFloor, origin: Vec3, direction: Vec3, t: f64) -> f64 {
        let point = add_scaled(origin, t, direction);
        floor.depth(point[0], point[1]) - point[2]
    }

    #[test]
    fn the_series_lies_below() {
        for i in -10..1000 {
            let u = 0.01 * f64::from(i);
            assert!(falls_by(f64x4::splat(u)).to_array()[0] <= libm::exp(0.5 * u.max(0.0) * u.max(0.0)));
        }
    }

    /// The bound that spares an exponential never overrules it.
    #[test]
    fn what_passes_does_not_rise() {
        for i in 0..20_000 {
            let s = f64x4::splat(0.0005 * f64::from(i));
            for lowest in [1.0 - 1e-15, 1.0, 1.0 + 1e-15, 1.0 + 2e-9].map(|off| exp4(-s) * f64x4::splat(off)) {
                let passes = (lowest * series(s)).simd_ge(f64x4::splat(1.0 + 1e-9));
                assert!(!(passes & exp4(-s).simd_gt(lowest)).any());
            }
        }
    }

    #[test]
    fn summit_and_flat() {
        let floor = floor();
        assert!((floor.depth(5000.0, 9000.0) - 6000.0).abs() < 1.0);
        assert!((floor.clearance([90_000.0, 0.0, 15_000.0], f64::INFINITY) - 5000.0).abs() < 1e-9);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]
        /// The distance to any point of the floor is an upper bound of the true distance.
        #[test]
        fn never_overestimates(
            p in (0.0..10e3_f64, 0.0..12e3_f64, 0.0..20e3_f64),
            q in (-3e3..3e3_f64, -3e3..3e3_f64),
        ) {
            let floor = floor();
            let point = [p.0, p.1, p.2];
            let (x, y) = (p.0 + q.0, p.1 + q.1);
            let surface = [x, y, floor.depth(x, y)];
            let clearance = floor.clearance(point, f64::INFINITY);
            prop_assert_eq!(clearance <= 0.0, floor.depth(p.0, p.1) <= p.2);
            if clearance > 0.0 {
                prop_assert!(clearance <= crate::math::distance(point, surface) + 1e-6);
                let bounded = floor.clearance(point, 700.0);
                prop_assert!(bounded <= 700.0 && bounded <= crate::math::distance(point, surface) + 1e-6);
            }
        }

        /// Four beams that march together end where each would alone.
        #[test]
        fn beams_march_alike(
            p in (0.0..10e3_f64, 0.0..12e3_f64, 0.0..20e3_f64),
            d in prop::array::uniform4(prop::array::uniform3(-1.0..1.0_f64)),
            longest in prop::array::uniform4(1.0..6e3_f64),
        ) {
            let (floor, origin) = (floor(), [p.0, p.1, p.2]);
            let directions = d.map(|d| d.map(|v| v / crate::math::norm(d).max(1e-9)));
            let beams: Beams = std::array::from_fn(|axis| f64x4::new(directions.map(|d| d[axis])));
            for i in 0..3 {
                let together = floor.march(i, origin, &beams, f64x4::new(longest)).to_array();
                for lane in 0..4 {
                    let alone = crate::obstacles::march(origin, directions[lane], longest[lane], |point| {
                        let u = floor.u2(i, point[0], point[1]).sqrt();
                        let [height, steepness, u] = [floor.height[i], floor.steepness[i], u].map(f64x4::splat);
                        let above = f64x4::splat(floor.floor_depth - point[2]);
                        distance_bound(height, steepness, u, above, f64::INFINITY).to_array()[0]
                    });
                    prop_assert_eq!(together[lane].to_bits(), alone.to_bits());
                }
            }
        }

        /// A beam runs free up to its range and, if it stopped, it stopped at the floor.
        #[test]
        fn beams(p in (0.0..10e3_f64, 0.0..12e3_f64, 0.0..20e3_f64), d in prop::array::uniform3(-1.0..1.0_f64)) {
            let floor = floor();
            let origin = [p.0, p.1, p.2];
            let length = crate::math::norm(d);
            prop_assume!(length > 0.1 && floor.clearance(origin, f64::INFINITY) > 10.0);
            let direction = [d[0] / length, d[1] / length, d[2] / length];
            let mut near = Vec::new();
            floor.near(origin, 5000.0, &mut near);
            // Two chunks of beams, so that those that wait come from both.
            let other = [direction[1], -direction[0], direction[2]];
            let beams = [direction, other].map(|d| d.map(|v| [v; LANES]));
            let [mut ranges, mut all] = [[[5000.0; LANES]; 2]; 2];
            floor.range(origin, &beams, &near, &mut ranges);
            floor.range(origin, &beams, &[0, 1, 2], &mut all);
            prop_assert_eq!(ranges, all);
            for (chunk, direction) in [direction, other].into_iter().enumerate() {
                let mut alone = [[5000.0; LANES]];
                floor.range(origin, &[direction.map(|v| [v; LANES])], &near, &mut alone);
                prop_assert_eq!(ranges[chunk], alone[0]);
            }
            let range = ranges[0][0];
            for i in 0..50 {
                prop_assert!(gap_along(&floor, origin, direction, range * f64::from(i) / 50.0) > -1e-6);
            }
            if range < 5000.0 {
                let end = add_scaled(origin, range, direction);
                prop_assert!(floor.clearance(end, f64::INFINITY) < 6.0);
            }
        }
    }
}
