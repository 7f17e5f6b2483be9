//! The angle between segments and the current (LFHH eq. 10), eight segments at once in single precision:
//! a mean of angles needs no more, and this is where planners spend most of their time.

use std::f32::consts::{LN_2, LOG2_E};

use auv_world::World;
use wide::{f32x8, f64x8};

use super::track::{LANES, Lanes};

/// From here on, in s = r^2 / zeta^2, exp(-s) is lost beside 1 in single precision (it is less than 2^-25), so
/// that leaving it out changes nothing and no segment's angle depends on its neighbours'.
const CORE_END: f32 = 17.5;
/// Below this s the series of (1 - exp(-s)) / s keeps more digits than the exponential.
const CENTRE: f32 = 0.0625;
/// Adding and taking away 1.5 * 2^23 rounds to the nearest integer and leaves it in the low bits.
const ROUNDER: f32 = 12_582_912.0;
/// atan(sqrt t) / (pi sqrt t) for t in 0 ..= 1, coefficients of 1, t, t^2 ...: a Chebyshev fit to 2e-8.
const ARCTANGENT: [f32; 8] =
    [0.318_309_84, -0.106_098_46, 0.063_556_81, -0.044_573_86, 0.031413574, -0.018726092, 0.007569574, -0.001451427];

/// A Lamb-Oseen vortex, its centre measured from the origin.
#[derive(Debug, Clone, Copy)]
struct Vortex {
    x: f32x8,
    y: f32x8,
    /// eta / (2 pi zeta^2).
    strength: f32x8,
    /// 1 / zeta^2.
    inverse_core2: f32x8,
}

/// The vortices of a world that has no other current.
#[derive(Debug, Clone)]
pub struct Vortices {
    /// The middle of the box: offsets from it lose fewest digits (m).
    origin: [f64x8; 2],
    vortices: Vec<Vortex>,
}

impl Vortices {
    /// The vortices as they are now.
    pub fn new(world: &World) -> Self {
        let (field, domain) = (world.vortices(), &world.scenario().domain);
        let origin = [0, 1].map(|axis| 0.5 * (domain.min_m[axis] + domain.max_m[axis]));
        let vortex = |i| {
            let ([x, y], zeta) = (field.centre(i), field.core_radius(i));
            let inverse_core2 = 1.0 / (zeta * zeta);
            let strength = field.circulation(i) / std::f64::consts::TAU * inverse_core2;
            let [x, y, strength, inverse_core2] =
                [x - origin[0], y - origin[1], strength, inverse_core2].map(|value| f32x8::splat(value as f32));
            Vortex { x, y, strength, inverse_core2 }
        };
        Self { origin: origin.map(f64x8::splat), vortices: (0..field.len()).map(vortex).collect() }
    }

    /// Velocity at eight points (LFHH eq. 3-4; m/s), to about 2e-6 of the strongest vortex's part.
    #[inline(always)]
    pub fn velocity(&self, x: &Lanes, y: &Lanes) -> [f32x8; 2] {
        let [x, y] = [(x, 0), (y, 1)].map(|(place, axis)| single((f64x8::new(*place) - self.origin[axis]).to_array()));
        let (mut u, mut v) = (f32x8::ZERO, f32x8::ZERO);
        for vortex in &self.vortices {
            let (dx, dy) = (x - vortex.x, y - vortex.y);
            let s = (dx * dx + dy * dy) * vortex.inverse_core2;
            let spin = vortex.strength * falloff(s);
            u -= spin * dy;
            v += spin * dx;
        }
        [u, v]
    }
}

/// Numbers in single precision.
#[inline(always)]
pub fn single(values: [f64; LANES]) -> f32x8 {
    f32x8::new(values.map(|value| value as f32))
}

/// (1 - exp(-s)) / s.
#[inline(always)]
fn falloff(s: f32x8) -> f32x8 {
    let c = f32x8::splat;
    // Most vortices are far from most segments.
    if s.simd_ge(c(CORE_END)).all() {
        return c(1.0) / s;
    }
    let near = c(1.0) - s * (c(0.5) - s * (c(1.0 / 6.0) - s * c(1.0 / 24.0)));
    let far = (c(1.0) - decay(s)) / s;
    s.simd_lt(c(CENTRE)).select(near, far)
}

/// exp(-s) for s >= 0, to 2e-7 of itself; at least exp(-CORE_END).
#[inline(always)]
fn decay(s: f32x8) -> f32x8 {
    let c = f32x8::splat;
    let s = s.fast_min(c(CORE_END));
    let shifted = c(ROUNDER) - s * c(LOG2_E);
    let r = -s - (shifted - c(ROUNDER)) * c(LN_2);
    let r2 = r * r;
    // Taylor to degree 6, in pairs.
    let low = (c(1.0) + r) + r2 * (c(0.5) + r * c(1.0 / 6.0));
    let high = (c(1.0 / 24.0) + r * c(1.0 / 120.0)) + r2 * c(1.0 / 720.0);
    let power = low + r2 * r2 * high;
    power * f32x8::new(shifted.to_array().map(|v| f32::from_bits(v.to_bits().wrapping_add(127) << 23)))
}

/// The angles (in units of pi, 0 ..= 1, to 1.2e-7) between vectors of the given scalar and cross products;
/// 1/2 where both are 0.
#[inline(always)]
pub fn between(dot: f32x8, cross: f32x8) -> f32x8 {
    let c = f32x8::splat;
    let (along, across) = (dot.abs(), cross.abs());
    let ratio = along.fast_min(across) / along.fast_max(across).fast_max(c(f32::MIN_POSITIVE));
    let angle = ratio * series(ratio * ratio);
    let angle = across.simd_ge(along).select(c(0.5) - angle, angle);
    dot.simd_lt(f32x8::ZERO).select(c(1.0) - angle, angle)
}

/// The series by Estrin's scheme: short chains instead of a long one.
#[inline(always)]
fn series(t: f32x8) -> f32x8 {
    let t2 = t * t;
    let pair = |k: usize| f32x8::splat(ARCTANGENT[k]) + f32x8::splat(ARCTANGENT[k + 1]) * t;
    (pair(0) + pair(2) * t2) + (pair(4) + pair(6) * t2) * (t2 * t2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    fn angle(dot: f64, cross: f64) -> f32 {
        between(f32x8::splat(dot as f32), f32x8::splat(cross as f32)).to_array()[0]
    }

    #[test]
    fn agrees_with_libm_all_around() {
        for i in 0..=200_000 {
            let turned = std::f64::consts::TAU * f64::from(i) / 200_000.0;
            let (dot, cross) = (3.0 * libm::cos(turned), 3.0 * libm::sin(turned));
            let expected = libm::atan2(cross.abs(), dot) / std::f64::consts::PI;
            assert!((f64::from(angle(dot, cross)) - expected).abs() < 1.2e-7, "{turned}");
        }
    }

    #[test]
    fn without_a_direction_it_is_a_right_angle() {
        assert_eq!(angle(0.0, 0.0), 0.5);
        assert_eq!(angle(0.0, 1.0), 0.5);
        assert_eq!(angle(1.0, 0.0), 0.0);
        assert_eq!(angle(-1.0, 0.0), 1.0);
    }

    #[test]
    fn falloff_agrees_with_libm() {
        for i in 1..=40_000 {
            let s = f64::from((f64::from(i) * 1e-3) as f32);
            let expected = -libm::expm1(-s) / s;
            let found = f64::from(falloff(f32x8::splat(s as f32)).to_array()[0]);
            assert!((found - expected).abs() <= 1.5e-6 * expected, "{s}: {found} {expected}");
        }
        assert_eq!(falloff(f32x8::ZERO).to_array()[0], 1.0);
    }

    #[test]
    fn velocity_is_that_of_the_world() {
        let world = testing::paper_world("lfhh-3d-1", 0);
        let vortices = Vortices::new(&world);
        let strongest = (0..world.vortices().len()).map(|i| {
            let field = world.vortices();
            (field.circulation(i) / field.core_radius(i)).abs()
        });
        let tolerance = 2e-6 * strongest.fold(0.0, f64::max);
        let [x0, y0] = world.vortices().centre(0);
        for i in 0..1000 {
            let far = f64::from(i) * 10.0;
            let x = [1e-3, 0.1, 0.5, -0.5, -1.0, 2.0, 3.0, 0.0].map(|part| x0 + part * far);
            let y = [1e-4, 0.3, -0.2, 1.0, 2.0, -0.5, -1.0, 1.5].map(|part| y0 + part * far);
            let found = vortices.velocity(&x, &y).map(f32x8::to_array);
            for lane in 0..LANES {
                let expected = world.current([x[lane], y[lane], 0.0]);
                for axis in 0..2 {
                    assert!((f64::from(found[axis][lane]) - expected[axis]).abs() < tolerance, "{i} {lane}");
                }
            }
        }
    }
}
