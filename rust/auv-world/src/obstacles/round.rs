//! Spheres and discs as structures of arrays: exact signed distances, several lanes at once.

use wide::f64x4;

use super::nearest::{Lanes, Nearest};
use crate::lanes::{Column, LANES, least};
use crate::math::{Vec2, Vec3, distance};

/// Balls at one time.
#[derive(Debug, Clone, Default)]
pub struct Spheres {
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    radius: Vec<f64>,
    /// The balls in order of y, so that a query can begin with its neighbours.
    order: Vec<u32>,
    slabs: Vec<Slab>,
    /// Where the first slab begins, and how many there are to a metre if they were even.
    first: f64,
    slabs_per_metre: f64,
}

/// Four balls that follow each other along y.
#[derive(Debug, Clone, Copy)]
struct Slab {
    x: f64x4,
    y: f64x4,
    z: f64x4,
    radius: f64x4,
    /// They and all that follow reach no lower than this y, ...
    low: f64,
    /// ... they and all before no higher than this.
    high: f64,
}

/// Vertical cylinders through all depths at one time.
#[derive(Debug, Clone, Default)]
pub struct Discs {
    x: Column,
    y: Column,
    radius: Column,
}

/// A ball or disc within reach of a sonar.
#[derive(Debug, Clone, Copy)]
pub struct Echo {
    /// Which one.
    pub index: u32,
    /// Its centre from the sonar (m).
    offset: Vec3,
    /// Squared offset less the squared radius (m^2).
    outside: f64,
}

impl Echo {
    /// Its centre from the sonar (m), a disc's on the map.
    pub fn offset(&self) -> Vec3 {
        self.offset
    }
}

/// Keeps those of four whose bits in `near` are set.
#[inline(always)]
fn keep(near: u32, index: impl Fn(usize) -> u32, offset: [f64x4; 3], outside: f64x4, echoes: &mut Vec<Echo>) {
    if near == 0 {
        return;
    }
    let (offset, outside) = (offset.map(f64x4::to_array), outside.to_array());
    for lane in (0..LANES).filter(|lane| near >> lane & 1 == 1) {
        echoes.push(Echo { index: index(lane), offset: offset.map(|axis| axis[lane]), outside: outside[lane] });
    }
}

/// More than what rounds where slabs end, as a part of the numbers that do.
const SLACK: f64 = 1e-9;

/// So many slabs on either side of a point are looked at in any case.
const AROUND: usize = 2;

/// Padding of a column of centres: far from everything.
const FAR: f64 = 1e15;

/// The lesser of `nearest` and distance - radius of four balls. Roots are taken only if one of them may
/// be nearer than the nearest so far, (distance)^2 < (nearest + radius)^2.
#[inline(always)]
fn nearer(distance2: f64x4, radius: f64x4, nearest: f64) -> f64 {
    let reach = f64x4::splat(nearest) + radius;
    if distance2.simd_lt(reach * reach).any() { least(distance2.sqrt() - radius, nearest) } else { nearest }
}

/// Puts numbers of `values` in order of these, equal ones as they were. Balls that moved a little are nearly in order
/// already: then each is passed by few others.
fn order_by(values: &[f64], order: &mut [u32]) {
    let follows = |a: u32, b: u32| values[a as usize].total_cmp(&values[b as usize]).is_gt();
    let mut passes_left = 8 * order.len();
    for i in 1..order.len() {
        let (moved, mut j) = (order[i], i);
        while j > 0 && follows(order[j - 1], moved) {
            order[j] = order[j - 1];
            j -= 1;
        }
        order[j] = moved;
        let Some(left) = passes_left.checked_sub(i - j) else {
            return order.sort_by(|a, b| values[*a as usize].total_cmp(&values[*b as usize]));
        };
        passes_left = left;
    }
}

/// Four unit directions of sonar beams.
pub type Beams = [f64x4; 3];
/// The same where they are kept.
pub type BeamColumns = [[f64; LANES]; 3];

/// The lesser of `nearest` and how far four beams run before they meet a ball: `along` is the centre's
/// offset along each beam, `outside` its squared offset less the squared radius, `square` the squared
/// length of the beams' directions in the space of the ball.
#[inline(always)]
fn chord(along: f64x4, outside: f64, square: f64x4, nearest: f64x4) -> f64x4 {
    if outside <= 0.0 {
        return f64x4::ZERO;
    }
    let discriminant = along * along - square * f64x4::splat(outside);
    let meets = along.simd_gt(f64x4::ZERO) & discriminant.simd_ge(f64x4::ZERO);
    if !meets.any() {
        return nearest;
    }
    let range = (along - discriminant.fast_max(f64x4::ZERO).sqrt()) / square;
    meets.select(range.fast_min(nearest), nearest)
}

impl Spheres {
    /// Room for `count` balls.
    pub fn with_room(count: usize) -> Self {
        let column = || Vec::with_capacity(count);
        let (order, slabs) = (Vec::with_capacity(count), Vec::with_capacity(count.div_ceil(LANES)));
        Self { x: column(), y: column(), z: column(), radius: column(), order, slabs, ..Self::default() }
    }

    /// Appends a ball; [`Spheres::arrange`] must follow before a query.
    pub fn push(&mut self, centre: Vec3, radius: f64) {
        self.order.push(self.x.len() as u32);
        self.x.push(centre[0]);
        self.y.push(centre[1]);
        self.z.push(centre[2]);
        self.radius.push(radius);
    }

    /// Moves ball `i`; [`Spheres::arrange`] must follow before a query.
    pub fn place(&mut self, i: usize, centre: Vec3) {
        (self.x[i], self.y[i], self.z[i]) = (centre[0], centre[1], centre[2]);
    }

    /// Puts the balls in order after some were placed.
    pub fn arrange(&mut self) {
        order_by(&self.y, &mut self.order);
        if let (Some(&first), Some(&last)) = (self.order.first(), self.order.last()) {
            self.first = self.y[first as usize];
            self.slabs_per_metre = (self.order.len() / LANES) as f64 / (self.y[last as usize] - self.first).max(1e-9);
        }
        self.slabs.clear();
        for four in self.order.chunks(LANES) {
            let column = |values: &[f64], filler: f64| {
                f64x4::new(std::array::from_fn(|lane| four.get(lane).map_or(filler, |i| values[*i as usize])))
            };
            let reach = |sign: f64| {
                let ends = four.iter().map(|i| sign * self.y[*i as usize] + self.radius[*i as usize]);
                sign * ends.fold(f64::NEG_INFINITY, f64::max)
            };
            self.slabs.push(Slab {
                x: column(&self.x, FAR),
                y: column(&self.y, FAR),
                z: column(&self.z, FAR),
                radius: column(&self.radius, 0.0),
                low: reach(-1.0),
                high: reach(1.0),
            });
        }
        for i in 1..self.slabs.len() {
            let j = self.slabs.len() - 1 - i;
            self.slabs[i].high = self.slabs[i].high.max(self.slabs[i - 1].high);
            self.slabs[j].low = self.slabs[j].low.min(self.slabs[j + 1].low);
        }
    }

    /// Number of balls.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// Centre (m) and radius (m) of ball `i`.
    pub fn get(&self, i: usize) -> (Vec3, f64) {
        ([self.x[i], self.y[i], self.z[i]], self.radius[i])
    }

    /// Signed distance to the nearest (m); infinite if there are none.
    #[inline]
    pub fn clearance(&self, point: Vec3) -> f64 {
        let [x, y, z] = point.map(f64x4::splat);
        let distance2 = |slab: &Slab| {
            let (dx, dy, dz) = (x - slab.x, y - slab.y, z - slab.z);
            dx * dx + dy * dy + dz * dz
        };
        // The neighbours are looked at without branches, which random points would mispredict.
        let middle = self.middle(point[1]);
        let (first, last) = (middle.saturating_sub(AROUND), (middle + AROUND).min(self.slabs.len()));
        let around = self.slabs[first..last]
            .iter()
            .fold(f64x4::splat(f64::INFINITY), |nearest, slab| nearest.fast_min(distance2(slab).sqrt() - slab.radius));
        let mut nearest = least(around, f64::INFINITY);
        for slab in &self.slabs[last..] {
            if slab.low - point[1] >= nearest {
                break;
            }
            nearest = nearer(distance2(slab), slab.radius, nearest);
        }
        for slab in self.slabs[..first].iter().rev() {
            if point[1] - slab.high >= nearest {
                break;
            }
            nearest = nearer(distance2(slab), slab.radius, nearest);
        }
        nearest
    }

    /// Signed distance (m) from a point to ball `i`.
    #[inline]
    pub fn clearance_of(&self, i: usize, point: Vec3) -> f64 {
        distance(point, [self.x[i], self.y[i], self.z[i]]) - self.radius[i]
    }

    /// The nearest.
    pub fn nearest(&self, point: Vec3) -> Nearest<usize> {
        let at = point.map(f64x4::splat);
        let mut lanes = Lanes::new();
        let see = |lanes: &mut Lanes, i: usize| {
            let slab = &self.slabs[i];
            let (dx, dy, dz) = (at[0] - slab.x, at[1] - slab.y, at[2] - slab.z);
            lanes.see(i, (dx * dx + dy * dy + dz * dz).sqrt() - slab.radius);
        };
        let middle = self.middle(point[1]);
        let (first, last) = (middle.saturating_sub(AROUND), (middle + AROUND).min(self.slabs.len()));
        (first..last).for_each(|i| see(&mut lanes, i));
        for i in last..self.slabs.len() {
            if self.slabs[i].low - point[1] >= lanes.found().rivals {
                break;
            }
            see(&mut lanes, i);
        }
        for i in (0..first).rev() {
            if point[1] - self.slabs[i].high >= lanes.found().rivals {
                break;
            }
            see(&mut lanes, i);
        }
        let found = lanes.found();
        // From farther away than the padding that would be the nearest, and is no ball.
        Nearest { index: found.index.and_then(|i| self.order.get(i)).map(|i| *i as usize), ..found }
    }

    /// The slab where y should be. Where to begin decides only how soon the rest can be passed over: a guess.
    #[inline]
    fn middle(&self, y: f64) -> usize {
        let along = (y - self.first) * self.slabs_per_metre;
        (along.max(0.0) as usize).min(self.slabs.len())
    }

    /// Appends the balls nearer than `longest`.
    pub fn near(&self, origin: Vec3, longest: f64, echoes: &mut Vec<Echo>) {
        let at = origin.map(f64x4::splat);
        let mut look = |i: usize, slab: &Slab| {
            let offset = [slab.x - at[0], slab.y - at[1], slab.z - at[2]];
            let square = offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2];
            let reach = f64x4::splat(longest) + slab.radius;
            let near = square.simd_lt(reach * reach).to_bitmask();
            keep(near, |lane| self.order[i * LANES + lane], offset, square - slab.radius * slab.radius, echoes);
        };
        let (y, middle) = (origin[1], self.middle(origin[1]));
        let beyond = longest + SLACK * (longest + y.abs());
        for (i, slab) in self.slabs.iter().enumerate().skip(middle).take_while(|(_, slab)| slab.low - y <= beyond) {
            look(i, slab);
        }
        let before = self.slabs[..middle].iter().enumerate().rev();
        for (i, slab) in before.take_while(|(_, slab)| y - slab.high <= beyond) {
            look(i, slab);
        }
    }

    /// The lesser of `nearest` and how far beams run before they meet one of `echoes` (m).
    #[inline]
    pub fn range(beams: &Beams, nearest: f64x4, echoes: &[Echo]) -> f64x4 {
        echoes.iter().fold(nearest, |nearest, echo| {
            let c = echo.offset.map(f64x4::splat);
            let along = beams[0] * c[0] + beams[1] * c[1] + beams[2] * c[2];
            chord(along, echo.outside, f64x4::ONE, nearest)
        })
    }
}

impl Discs {
    /// Appends a disc.
    pub fn push(&mut self, centre: Vec2, radius: f64) {
        self.x.push(centre[0], FAR);
        self.y.push(centre[1], FAR);
        self.radius.push(radius, 0.0);
    }

    /// Moves disc `i`.
    pub fn place(&mut self, i: usize, centre: Vec2) {
        (self.x[i], self.y[i]) = (centre[0], centre[1]);
    }

    /// Number of discs.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// Centre (m) and radius (m) of disc `i`.
    pub fn get(&self, i: usize) -> (Vec2, f64) {
        ([self.x[i], self.y[i]], self.radius[i])
    }

    /// Signed distance to the nearest (m); infinite if there are none.
    #[inline]
    pub fn clearance(&self, point: Vec3) -> f64 {
        let (x, y) = (f64x4::splat(point[0]), f64x4::splat(point[1]));
        let columns = self.x.chunks().zip(self.y.chunks()).zip(self.radius.chunks());
        let nearest = columns.fold(f64x4::splat(f64::INFINITY), |nearest, ((cx, cy), radius)| {
            let (dx, dy) = (x - cx, y - cy);
            nearest.fast_min((dx * dx + dy * dy).sqrt() - radius)
        });
        least(nearest, f64::INFINITY)
    }

    /// Signed distance (m) from a point to disc `i`.
    #[inline]
    pub fn clearance_of(&self, i: usize, point: Vec3) -> f64 {
        let (dx, dy) = (point[0] - self.x[i], point[1] - self.y[i]);
        (dx * dx + dy * dy).sqrt() - self.radius[i]
    }

    /// The nearest.
    pub fn nearest(&self, point: Vec3) -> Nearest<usize> {
        let (x, y) = (f64x4::splat(point[0]), f64x4::splat(point[1]));
        let columns = self.x.chunks().zip(self.y.chunks()).zip(self.radius.chunks());
        let mut lanes = Lanes::new();
        for (chunk, ((cx, cy), radius)) in columns.enumerate() {
            let (dx, dy) = (x - cx, y - cy);
            lanes.see(chunk, (dx * dx + dy * dy).sqrt() - radius);
        }
        lanes.found()
    }

    /// Appends the discs nearer than `longest`.
    pub fn near(&self, origin: Vec3, longest: f64, echoes: &mut Vec<Echo>) {
        let (x, y) = (f64x4::splat(origin[0]), f64x4::splat(origin[1]));
        let columns = self.x.chunks().zip(self.y.chunks()).zip(self.radius.chunks());
        for (chunk, ((cx, cy), radius)) in columns.enumerate() {
            let offset = [cx - x, cy - y, f64x4::ZERO];
            let square = offset[0] * offset[0] + offset[1] * offset[1];
            let reach = f64x4::splat(longest) + radius;
            let near = square.simd_lt(reach * reach).to_bitmask();
            keep(near, |lane| (chunk * LANES + lane) as u32, offset, square - radius * radius, echoes);
        }
    }

    /// The lesser of `nearest` and how far beams run before they meet one of `echoes` (m). Beams straight up or
    /// down meet only a disc that they start in.
    #[inline]
    pub fn range(beams: &Beams, nearest: f64x4, echoes: &[Echo]) -> f64x4 {
        let square = (beams[0] * beams[0] + beams[1] * beams[1]).fast_max(f64x4::splat(1e-300));
        echoes.iter().fold(nearest, |nearest, echo| {
            let along = beams[0] * f64x4::splat(echo.offset[0]) + beams[1] * f64x4::splat(echo.offset[1]);
            chord(along, echo.outside, square, nearest)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::add_scaled;
    use proptest::prelude::*;

    #[test]
    fn from_beyond_the_padding_none_is_the_nearest() {
        let mut spheres = Spheres::default();
        spheres.push([0.0; 3], 5.0);
        spheres.arrange();
        assert_eq!(spheres.nearest([20.0, 0.0, 0.0]).index, Some(0));
        assert_eq!(spheres.nearest([FAR; 3]).index, None);
    }

    proptest! {
        #[test]
        fn orders_as_a_stable_sort(values in prop::collection::vec(0..40_u8, 0..90), steps in 0.0..2.0_f64) {
            // From nearly in order to not at all.
            let values: Vec<f64> =
                values.iter().enumerate().map(|(i, v)| (f64::from(*v) + steps * i as f64).round()).collect();
            let mut order: Vec<u32> = (0..values.len() as u32).collect();
            let mut expected = order.clone();
            expected.sort_by(|a, b| values[*a as usize].total_cmp(&values[*b as usize]));
            order_by(&values, &mut order);
            prop_assert_eq!(order, expected);
        }

        #[test]
        fn beam_ends_on_a_surface(p in prop::array::uniform3(-9e3..9e3_f64), d in prop::array::uniform3(-1.0..1.0_f64)) {
            let mut spheres = Spheres::default();
            let mut discs = Discs::default();
            for i in 0..7 {
                let t = f64::from(i);
                spheres.push([1500.0 * t - 4000.0, 700.0 * t, 500.0 * t - 900.0], 400.0 + 100.0 * t);
                discs.push([1500.0 * t - 4000.0, 700.0 * t], 400.0 + 100.0 * t);
            }
            spheres.arrange();
            let each = (0..7).map(|i| { let (c, r) = spheres.get(i); crate::math::distance(p, c) - r });
            prop_assert_eq!(spheres.clearance(p), each.fold(f64::INFINITY, f64::min));
            let length = crate::math::norm(d);
            prop_assume!(length > 0.1);
            let d = [d[0] / length, d[1] / length, d[2] / length];
            let beams = d.map(f64x4::splat);
            let endless = f64x4::splat(f64::INFINITY);
            let (mut balls, mut circles) = (Vec::new(), Vec::new());
            spheres.near(p, 1e6, &mut balls);
            discs.near(p, 1e6, &mut circles);
            prop_assert_eq!((balls.len(), circles.len()), (7, 7));
            let range = Spheres::range(&beams, endless, &balls).to_array()[0];
            let flat = Discs::range(&beams, endless, &circles).to_array()[3];
            for (clearance, range) in [(spheres.clearance(p), range), (discs.clearance(p), flat)] {
                prop_assert!(range >= clearance.max(0.0) - 1e-6);
                if clearance <= 0.0 { prop_assert_eq!(range, 0.0); }
            }
            let mut near = Vec::new();
            spheres.near(p, 5000.0, &mut near);
            let limit = f64x4::splat(5000.0);
            prop_assert_eq!(range.min(5000.0), Spheres::range(&beams, limit, &near).to_array()[1]);
            for (found, flat) in [(&near, false), (&circles, true)] {
                let mut found: Vec<u32> = found.iter().map(|echo| echo.index).collect();
                found.sort_unstable();
                let close = |i: &u32| {
                    let (([x, y], r), z) = if flat { (discs.get(*i as usize), p[2]) } else {
                        let ([x, y, z], r) = spheres.get(*i as usize);
                        (([x, y], r), z)
                    };
                    crate::math::distance(p, [x, y, z]) < r + if flat { 1e6 } else { 5000.0 }
                };
                prop_assert_eq!(found, (0..7).filter(close).collect::<Vec<u32>>());
            }
            if range.is_finite() && range > 0.0 {
                prop_assert!(spheres.clearance(add_scaled(p, range, d)).abs() < 1e-6);
            }
        }
    }
}
