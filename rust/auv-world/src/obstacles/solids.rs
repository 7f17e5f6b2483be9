//! The shapes that are neither spheres nor discs, with boxes round them that spare most of their measuring.

use wide::f64x4;

use super::Solid;
use super::nearest::Nearest;
use super::polygon::Prism;
use crate::lanes::{LANES, least};
use crate::math::{Vec2, Vec3};

/// A box that nothing is near to: padding.
const FAR: f64 = 1e15;
/// More than what rounds in the distance to a box, as a part of its square.
const SLACK: f64 = 1e-12;

/// Shapes at one time, in the scenario's order.
#[derive(Debug, Clone, Default)]
pub struct Solids {
    shapes: Vec<Solid>,
    boxes: Vec<Boxes>,
}

/// The boxes on the map round four shapes that follow each other.
#[derive(Debug, Clone, Copy)]
struct Boxes {
    low: [[f64; LANES]; 2],
    high: [[f64; LANES]; 2],
}

impl Boxes {
    const NONE: Self = Self { low: [[FAR; LANES]; 2], high: [[FAR; LANES]; 2] };

    fn set(&mut self, lane: usize, (low, high): (Vec2, Vec2)) {
        for axis in 0..2 {
            (self.low[axis][lane], self.high[axis][lane]) = (low[axis], high[axis]);
        }
    }

    /// Squared distances on the map.
    #[inline(always)]
    fn squares(&self, point: Vec3) -> f64x4 {
        let [dx, dy] = [0, 1].map(|axis| {
            let at = f64x4::splat(point[axis]);
            let (below, beyond) = (f64x4::new(self.low[axis]) - at, at - f64x4::new(self.high[axis]));
            below.fast_max(beyond).fast_max(f64x4::ZERO)
        });
        dx * dx + dy * dy
    }
}

impl Solids {
    /// Appends a shape.
    pub fn push(&mut self, shape: Solid) {
        let i = self.shapes.len();
        self.boxes.resize(i / LANES + 1, Boxes::NONE);
        self.boxes[i / LANES].set(i % LANES, shape.bounds());
        self.shapes.push(shape);
    }

    /// Moves shape `i`.
    pub fn place(&mut self, i: usize, position: Vec3) {
        self.shapes[i].place(position);
        self.boxes[i / LANES].set(i % LANES, self.shapes[i].bounds());
    }

    /// The shapes.
    pub fn shapes(&self) -> &[Solid] {
        &self.shapes
    }

    /// Squared distances on the map to the boxes, four at once.
    #[inline(always)]
    fn squares(&self, point: Vec3) -> impl Iterator<Item = f64x4> + '_ {
        self.boxes.iter().map(move |boxes| boxes.squares(point))
    }

    /// The lesser of `nearest` and the signed distance (m) to the nearest shape, never more than the true one.
    #[inline]
    pub fn clearance(&self, point: Vec3, mut nearest: f64) -> f64 {
        if self.shapes.is_empty() {
            return nearest;
        }
        if nearest == f64::INFINITY {
            // The nearest box first: it shows that most others need not be looked into.
            nearest = self.shapes[self.nearest_box(point)].clearance(point);
        }
        for (chunk, square) in self.squares(point).enumerate() {
            let reach = nearest.max(0.0);
            let mut near = square.simd_le(f64x4::splat(reach * reach * (1.0 + SLACK))).to_bitmask();
            while near != 0 {
                let i = chunk * LANES + near.trailing_zeros() as usize;
                near &= near - 1;
                if let Some(shape) = self.shapes.get(i) {
                    nearest = nearest.min(shape.clearance(point));
                }
            }
        }
        nearest
    }

    /// The nearest; farther away than `within` (m) perhaps none.
    pub fn nearest(&self, point: Vec3, within: f64) -> Nearest<usize> {
        let mut found = Nearest::none(f64::INFINITY);
        let mut passed_over = f64x4::splat(f64::INFINITY);
        for (chunk, square) in self.squares(point).enumerate() {
            let reach = found.clearance.min(within).max(0.0);
            let near = square.simd_le(f64x4::splat(reach * reach * (1.0 + SLACK)));
            passed_over = passed_over.fast_min(near.select(passed_over, square));
            let mut near = near.to_bitmask();
            while near != 0 {
                let i = chunk * LANES + near.trailing_zeros() as usize;
                near &= near - 1;
                if let Some(shape) = self.shapes.get(i) {
                    found = found.with(i, shape.clearance(point));
                }
            }
        }
        let passed_over = least(passed_over, f64::INFINITY).sqrt();
        Nearest { rivals: found.rivals.min(passed_over), ..found }
    }

    fn nearest_box(&self, point: Vec3) -> usize {
        let (mut best, mut at) = (f64x4::splat(f64::INFINITY), f64x4::ZERO);
        for (chunk, square) in self.squares(point).enumerate() {
            let closer = square.simd_lt(best);
            best = closer.select(square, best);
            at = closer.select(f64x4::splat(chunk as f64), at);
        }
        let (best, at) = (best.to_array(), at.to_array());
        let lane = (1..LANES).fold(0, |least, lane| if best[lane] < best[least] { lane } else { least });
        (at[lane] as usize * LANES + lane).min(self.shapes.len() - 1)
    }

    /// Shortens `ranges` (m), at most `longest`, to how far beams of unit `directions` run before they meet a shape.
    pub fn range(&self, origin: Vec3, directions: &[Vec3], longest: f64, ranges: &mut [f64]) {
        let level = directions.iter().all(|direction| direction[2] == 0.0);
        let reach = f64x4::splat(longest * longest * (1.0 + SLACK));
        for (chunk, square) in self.squares(origin).enumerate() {
            let near = square.simd_le(reach).to_bitmask();
            let four = self.shapes.iter().skip(chunk * LANES).take(LANES).enumerate();
            for (_, shape) in four.filter(|(lane, _)| near >> lane & 1 == 1) {
                match shape {
                    Solid::Polygon(prism) if level && prism.reaches_through(origin[2]) => {
                        level_range(prism, origin, directions, ranges);
                    }
                    shape => {
                        for (direction, range) in directions.iter().zip(&mut *ranges) {
                            *range = shape.range(origin, *direction, *range);
                        }
                    }
                }
            }
        }
    }
}

/// [`Solid::range`] of a polygon that beams can only meet from the side: those that may are taken four at once.
fn level_range(prism: &Prism, origin: Vec3, directions: &[Vec3], ranges: &mut [f64]) {
    if prism.covers(origin) {
        ranges.fill(0.0);
        return;
    }
    let (mut beams, mut count) = ([0; LANES], 0);
    for first in (0..directions.len()).step_by(LANES) {
        let four = std::array::from_fn(|lane| (first + lane).min(directions.len() - 1));
        let mut stop = prism.may_stop(origin, &level(directions, four), lanes(ranges, four));
        while stop != 0 {
            let beam = first + stop.trailing_zeros() as usize;
            stop &= stop - 1;
            if beam < directions.len() {
                beams[count] = beam;
                count += 1;
            }
            if count == LANES {
                march(prism, origin, directions, &beams, ranges);
                count = 0;
            }
        }
    }
    if count > 0 {
        march(prism, origin, directions, &beams[..count], ranges);
    }
}

/// Shortens the ranges of one to four `beams`.
fn march(prism: &Prism, origin: Vec3, directions: &[Vec3], beams: &[usize], ranges: &mut [f64]) {
    let four = std::array::from_fn(|lane| beams[lane.min(beams.len() - 1)]);
    let found = prism.march(origin, &level(directions, four), lanes(ranges, four)).to_array();
    for (beam, range) in beams.iter().zip(found) {
        ranges[*beam] = range;
    }
}

fn lanes(values: &[f64], four: [usize; LANES]) -> f64x4 {
    f64x4::new(four.map(|i| values[i]))
}

fn level(directions: &[Vec3], four: [usize; LANES]) -> [f64x4; 2] {
    [0, 1].map(|axis| f64x4::new(four.map(|i| directions[i][axis])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::obstacles::march as walk;
    use crate::scenario::{Cylinder, Polygon, Superquadric};
    use proptest::prelude::*;

    /// A star of three to nine corners, a cylinder or a superquadric.
    fn shape(kind: usize, [x, y]: Vec2, size: f64, turns: &[f64]) -> Solid {
        match kind {
            0 => Solid::Cylinder(Cylinder {
                position_m: [x, y],
                radius_m: size,
                top_m: -1.0,
                bottom_m: 20.0,
                velocity_mps: [0.0; 2],
            }),
            1 => Solid::Superquadric(Superquadric {
                position_m: [x, y, 5.0],
                semi_axes_m: [size, 0.7 * size, 0.5 * size],
                exponents: [2.0, 4.0, 8.0],
                velocity_mps: [0.0; 3],
            }),
            _ => {
                let corner = |(i, part): (usize, &f64)| {
                    let angle = std::f64::consts::TAU * i as f64 / turns.len() as f64;
                    [x + size * part * libm::cos(angle), y + size * part * libm::sin(angle)]
                };
                let vertices_m = turns.iter().enumerate().map(corner).collect();
                Solid::Polygon(Prism::new(&Polygon { vertices_m, top_m: -1.0, bottom_m: 9.0, velocity_mps: [0.0; 2] }))
            }
        }
    }

    fn shapes() -> impl Strategy<Value = Vec<Solid>> {
        let place = (0..14_usize, prop::array::uniform2(0.0..200.0_f64), 3.0..30.0_f64);
        let one = (place, prop::collection::vec(0.3..1.0_f64, 3..9));
        prop::collection::vec(one.prop_map(|((kind, at, size), turns)| shape(kind, at, size, &turns)), 0..17)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]
        /// What the boxes leave out would have changed nothing: bit for bit the least of all, and the ranges that
        /// each beam finds alone, shape after shape.
        #[test]
        fn leaving_out_changes_nothing(
            shapes in shapes(),
            p in prop::array::uniform2(-20.0..220.0_f64),
            level in any::<bool>(),
            cap in prop_oneof![Just(f64::INFINITY), -10.0..30.0_f64],
            moved in prop::array::uniform2(-30.0..30.0_f64),
            first in 0.0..7.0_f64,
        ) {
            let mut solids = Solids::default();
            shapes.iter().for_each(|shape| solids.push(shape.clone()));
            let mut shapes = shapes;
            if let Some(shape) = shapes.first_mut() {
                let place = [100.0 + moved[0], 100.0 + moved[1], 3.0];
                shape.place(place);
                solids.place(0, place);
            }
            let point = [p[0], p[1], if level { 0.0 } else { 4.0 }];
            let all = shapes.iter().fold(cap, |nearest, shape| nearest.min(shape.clearance(point)));
            prop_assert_eq!(solids.clearance(point, cap).to_bits(), all.to_bits());

            let directions: Vec<Vec3> = (0..26)
                .map(|i| {
                    let (angle, z) = (first + f64::from(i), if level { 0.0 } else { 0.6_f64 });
                    let flat = (1.0 - z * z).sqrt();
                    [flat * libm::cos(angle), flat * libm::sin(angle), z]
                })
                .collect();
            let mut ranges: Vec<f64> = (0..26).map(|i| 50.0 / f64::from(1 + i % 3)).collect();
            let mut alone = ranges.clone();
            solids.range(point, &directions, 50.0, &mut ranges);
            for (direction, range) in directions.iter().zip(&mut alone) {
                for shape in &shapes {
                    *range = walk(point, *direction, *range, |point| shape.clearance(point));
                }
            }
            prop_assert_eq!(ranges, alone);
        }
    }
}
