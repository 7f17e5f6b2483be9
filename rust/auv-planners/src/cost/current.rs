//! The current along a path: its angle to each segment (LFHH eq. 3-5 and 10) and the ground speed.

use auv_world::World;

use super::angle::{self, single};
use super::track::{LANES, Lanes, Track};

/// From here on, in r^2 / zeta^2, 1 - exp(-r^2 / zeta^2) counts as 1: it is, to 1e-9.
const CORE_END: f64 = 21.0;
/// Below this r^2 / zeta^2 a vortex turns like a solid body.
const CENTRE: f64 = 1e-8;
/// Fewest and most points of a segment at which the ground speed is sampled.
const SAMPLES: (f64, f64) = (3.0, 64.0);
/// A ground speed of less than this part of the speed through water counts as beaten.
const SLOWEST: f64 = 0.05;

/// The current of a world at one time.
#[derive(Debug, Clone)]
pub struct Flow {
    field: Field,
    /// Along a path the current is looked at this often (m).
    resolution: f64,
}

#[derive(Debug, Clone)]
enum Field {
    /// Lamb-Oseen vortices and nothing else.
    Vortices {
        /// For angles.
        single: Box<angle::Vortices>,
        /// For times: x, y, eta / (2 pi), 1 / zeta^2, and the square of the radius where the core ends.
        double: Vec<[f64; 5]>,
    },
    /// Anything.
    Any(Box<World>),
}

impl Flow {
    /// The current of the world as it is now.
    pub fn new(world: &World) -> Self {
        let domain = &world.scenario().domain;
        let longest = (0..3).map(|axis| domain.max_m[axis] - domain.min_m[axis]).fold(0.0, f64::max);
        if !world.only_vortices() {
            return Self { field: Field::Any(Box::new(world.clone())), resolution: longest / 100.0 };
        }
        let field = world.vortices();
        let vortex = |i| {
            let ([x, y], zeta) = (field.centre(i), field.core_radius(i));
            [x, y, field.circulation(i) / std::f64::consts::TAU, 1.0 / (zeta * zeta), CORE_END * zeta * zeta]
        };
        let double = (0..field.len()).map(vortex).collect();
        Self {
            field: Field::Vortices { single: Box::new(angle::Vortices::new(world)), double },
            resolution: longest / 40.0,
        }
    }

    /// Velocity (m/s) at one point for each lane.
    #[inline(always)]
    fn velocity(&self, x: &Lanes, y: &Lanes, z: &Lanes) -> [Lanes; 2] {
        match &self.field {
            Field::Vortices { double, .. } => sum_vortices(double, x, y),
            Field::Any(world) => {
                let (mut u, mut v) = ([0.0; LANES], [0.0; LANES]);
                for lane in 0..LANES {
                    [u[lane], v[lane]] = world.current([x[lane], y[lane], z[lane]]);
                }
                [u, v]
            }
        }
    }

    /// Angle between each segment's heading on the map and the current at its middle, in units of pi; 1/2
    /// where there is no current or no heading. Written to the track's results.
    #[inline]
    pub fn angles(&self, track: &mut Track) {
        for first in (0..track.padded()).step_by(LANES) {
            let (dx, dy) = (single(lanes(&track.dx, first)), single(lanes(&track.dy, first)));
            let [x, y, z] = at(track, first, &[0.5; LANES]);
            let [u, v] = match &self.field {
                Field::Vortices { single, .. } => single.velocity(&x, &y),
                Field::Any(_) => self.velocity(&x, &y, &z).map(angle::single),
            };
            let angles = angle::between(u * dx + v * dy, u * dy - v * dx).to_array();
            for (result, angle) in track.result[first..].iter_mut().zip(angles) {
                *result = f64::from(angle);
            }
        }
    }

    /// Time along each segment (s) for a vehicle of that speed through water (m/s), written to the
    /// track's results; names the segments on which the current beats it.
    ///
    /// Ground speed is V_par + sqrt(V_w^2 - V_perp^2), sampled evenly at three points or, where the segment
    /// spans more than three stretches of the world's resolution, at one for each. A beaten vehicle is charged
    /// as if it crept, so that better plans still cost less.
    pub fn times(&self, track: &mut Track, speed: f64, mut beaten: impl FnMut(usize)) {
        let creep = SLOWEST * speed;
        for first in (0..track.padded()).step_by(LANES) {
            let (dx, dy) = (lanes(&track.dx, first), lanes(&track.dy, first));
            let length = lanes(&track.length, first);
            let mut samples = [0.0; LANES];
            for lane in 0..LANES {
                samples[lane] = (length[lane] / self.resolution).ceil().clamp(SAMPLES.0, SAMPLES.1);
            }
            let most = samples.iter().fold(0.0, |a: f64, b| a.max(*b));
            let mut slowness = [0.0; LANES];
            let mut slow = [false; LANES];
            for sample in 0..most as usize {
                let sample = sample as f64;
                let mut part = [0.0; LANES];
                for lane in 0..LANES {
                    part[lane] = (sample + 0.5) / samples[lane];
                }
                let [x, y, z] = at(track, first, &part);
                let [u, v] = self.velocity(&x, &y, &z);
                for lane in 0..LANES {
                    let inverse = if length[lane] > 0.0 { 1.0 / length[lane] } else { 0.0 };
                    let along = (u[lane] * dx[lane] + v[lane] * dy[lane]) * inverse;
                    let across2 = u[lane] * u[lane] + v[lane] * v[lane] - along * along;
                    let ground = along + (speed * speed - across2).max(0.0).sqrt();
                    let passes = across2 < speed * speed && ground >= creep;
                    // A shorter segment in these lanes has no such sample.
                    let counts = sample < samples[lane];
                    slowness[lane] += if counts { 1.0 / if passes { ground } else { creep } } else { 0.0 };
                    slow[lane] |= !passes & counts;
                }
            }
            for lane in 0..LANES {
                track.result[first + lane] = length[lane] * slowness[lane] / samples[lane];
                if slow[lane] && first + lane < track.segments() {
                    beaten(first + lane);
                }
            }
        }
    }
}

#[inline(always)]
fn lanes(values: &[f64], first: usize) -> Lanes {
    let mut lanes = [0.0; LANES];
    lanes.copy_from_slice(&values[first..first + LANES]);
    lanes
}

/// The points that divide LANES segments at a part of their way each.
#[inline(always)]
fn at(track: &Track, first: usize, part: &Lanes) -> [Lanes; 3] {
    let place = |from: &[f64], step: &[f64]| {
        let (from, step) = (lanes(from, first), lanes(step, first));
        std::array::from_fn(|lane| from[lane] + part[lane] * step[lane])
    };
    [place(&track.x, &track.dx), place(&track.y, &track.dy), place(&track.z, &track.dz)]
}

/// exp(-s) for 0 <= s < CORE_END, to 8e-9 of itself: half the work of the full exponential.
#[inline(always)]
fn decay(s: f64) -> f64 {
    /// Adding and taking away 1.5 * 2^52 rounds to the nearest integer and leaves it in the low bits.
    const ROUNDER: f64 = 6_755_399_441_055_744.0;
    let s = if s < CORE_END { s } else { CORE_END };
    let shifted = ROUNDER - s * std::f64::consts::LOG2_E;
    let r = -s - (shifted - ROUNDER) * std::f64::consts::LN_2;
    let r2 = r * r;
    // Taylor to degree 7, in pairs.
    let low = (1.0 + r) + r2 * (0.5 + r * (1.0 / 6.0));
    let high = (1.0 / 24.0 + r * (1.0 / 120.0)) + r2 * (1.0 / 720.0 + r * (1.0 / 5040.0));
    let power = low + r2 * r2 * high;
    power * f64::from_bits(shifted.to_bits().wrapping_add(1023) << 52)
}

/// The sum of Lamb-Oseen vortices (LFHH eq. 3-4).
#[inline(always)]
fn sum_vortices(vortices: &[[f64; 5]], x: &Lanes, y: &Lanes) -> [Lanes; 2] {
    let (mut u, mut v) = ([0.0; LANES], [0.0; LANES]);
    for &[x0, y0, strength, inverse_core2, core_end2] in vortices {
        let (mut dx, mut dy, mut r2) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            dx[lane] = x[lane] - x0;
            dy[lane] = y[lane] - y0;
            r2[lane] = dx[lane] * dx[lane] + dy[lane] * dy[lane];
        }
        let mut factor = [strength; LANES];
        // Most vortices are far from most segments: no exponential then.
        if r2.iter().fold(false, |near, r2| near | (*r2 < core_end2)) {
            for lane in 0..LANES {
                let s = r2[lane] * inverse_core2;
                factor[lane] *= 1.0 - decay(s);
                // At the centre (1 - exp(-s)) / r^2 tends to 1 / zeta^2.
                let centre = s < CENTRE;
                factor[lane] = if centre { strength * inverse_core2 } else { factor[lane] };
                r2[lane] = if centre { 1.0 } else { r2[lane] };
            }
        }
        for lane in 0..LANES {
            let spin = factor[lane] / r2[lane];
            u[lane] -= spin * dy[lane];
            v[lane] += spin * dx[lane];
        }
    }
    [u, v]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn decay_agrees_with_libm() {
        for i in 0..=21_000 {
            let s = f64::from(i) * 1e-3;
            let expected = libm::exp(-s);
            assert!((decay(s) - expected).abs() <= 8e-9 * expected, "{s}");
            assert!((1.0 - decay(s) - (1.0 - expected)).abs() <= 2e-8 * (1.0 - expected), "{s}");
        }
    }

    #[test]
    fn velocity_is_that_of_the_world() {
        let world = testing::paper_world("lfhh-3d-1", 0);
        let flow = Flow::new(&world);
        assert!(matches!(flow.field, Field::Vortices { .. }));
        let any = Flow { field: Field::Any(Box::new(world.clone())), resolution: flow.resolution };
        let [x0, y0] = world.vortices().centre(0);
        for i in 0..1000 {
            let far = f64::from(i) * 10.0;
            let x = [1e-3, 0.1, 0.5, -0.5, -1.0, 2.0, 3.0, 0.0].map(|part| x0 + part * far);
            let y = [1e-4, 0.3, -0.2, 1.0, 2.0, -0.5, -1.0, 1.5].map(|part| y0 + part * far);
            let (fast, slow) = (flow.velocity(&x, &y, &[0.0; LANES]), any.velocity(&x, &y, &[0.0; LANES]));
            for axis in 0..2 {
                for lane in 0..LANES {
                    assert!((fast[axis][lane] - slow[axis][lane]).abs() < 1e-8, "{i} {lane}");
                }
            }
        }
    }
}
