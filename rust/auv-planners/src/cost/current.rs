//! The current along a path: its angle to each segment (LFHH eq. 3-5 and 10) and the ground speed.

use auv_world::World;
use auv_world::math::exp;

use super::angle;
use super::track::{LANES, Lanes, Track};

/// exp(-s) vanishes beside 1 in double precision above this.
const CORE_END: f64 = 37.5;
/// Below this r^2 / zeta^2 a vortex turns like a solid body.
const CENTRE: f64 = 1e-8;
/// Where along a segment the ground speed is sampled.
const SAMPLES: [f64; 3] = [1.0 / 6.0, 0.5, 5.0 / 6.0];
/// A ground speed of less than this part of the speed through water counts as beaten.
const SLOWEST: f64 = 0.05;

/// The current of a world at one time.
#[derive(Debug, Clone)]
pub enum Flow {
    /// Lamb-Oseen vortices and nothing else: x, y, eta / (2 pi), 1 / zeta^2.
    Vortices(Vec<[f64; 4]>),
    /// Anything.
    Any(Box<World>),
}

impl Flow {
    /// The current of the world as it is now.
    pub fn new(world: &World) -> Self {
        if !world.only_vortices() {
            return Self::Any(Box::new(world.clone()));
        }
        let field = world.vortices();
        let vortex = |i| {
            let ([x, y], zeta) = (field.centre(i), field.core_radius(i));
            [x, y, field.circulation(i) / std::f64::consts::TAU, 1.0 / (zeta * zeta)]
        };
        Self::Vortices((0..field.len()).map(vortex).collect())
    }

    /// Velocity (m/s) at one point for each lane.
    #[inline(always)]
    fn velocity(&self, x: &Lanes, y: &Lanes, z: &Lanes) -> [Lanes; 2] {
        match self {
            Self::Vortices(vortices) => sum_vortices(vortices, x, y),
            Self::Any(world) => {
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
            let (dx, dy) = (lanes(&track.dx, first), lanes(&track.dy, first));
            let [x, y, z] = at(track, first, 0.5);
            let [u, v] = self.velocity(&x, &y, &z);
            let result = &mut track.result[first..first + LANES];
            for lane in 0..LANES {
                let (dot, cross) = (u[lane] * dx[lane] + v[lane] * dy[lane], u[lane] * dy[lane] - v[lane] * dx[lane]);
                result[lane] = angle::between(dot, cross) * std::f64::consts::FRAC_1_PI;
            }
        }
    }

    /// Time along each segment (s) for a vehicle of that speed through water (m/s), written to the
    /// track's results; gives the number of segments on which the current beats it.
    ///
    /// Ground speed is V_par + sqrt(V_w^2 - V_perp^2), sampled at three points. A beaten vehicle is
    /// charged as if it crept, so that better plans still cost less.
    pub fn times(&self, track: &mut Track, speed: f64) -> usize {
        let mut slow = [false; LANES];
        let mut beaten = 0;
        let creep = SLOWEST * speed;
        for first in (0..track.padded()).step_by(LANES) {
            let (dx, dy) = (lanes(&track.dx, first), lanes(&track.dy, first));
            let length = lanes(&track.length, first);
            let mut slowness = [0.0; LANES];
            slow.fill(false);
            for sample in SAMPLES {
                let [x, y, z] = at(track, first, sample);
                let [u, v] = self.velocity(&x, &y, &z);
                for lane in 0..LANES {
                    let inverse = if length[lane] > 0.0 { 1.0 / length[lane] } else { 0.0 };
                    let along = (u[lane] * dx[lane] + v[lane] * dy[lane]) * inverse;
                    let across2 = u[lane] * u[lane] + v[lane] * v[lane] - along * along;
                    let ground = along + (speed * speed - across2).max(0.0).sqrt();
                    let passes = across2 < speed * speed && ground >= creep;
                    slowness[lane] += 1.0 / if passes { ground } else { creep };
                    slow[lane] |= !passes;
                }
            }
            for lane in 0..LANES {
                track.result[first + lane] = length[lane] * slowness[lane] / SAMPLES.len() as f64;
                beaten += usize::from(slow[lane] && first + lane < track.segments());
            }
        }
        beaten
    }
}

#[inline(always)]
fn lanes(values: &[f64], first: usize) -> Lanes {
    let mut lanes = [0.0; LANES];
    lanes.copy_from_slice(&values[first..first + LANES]);
    lanes
}

/// The points that divide LANES segments at `part` of their way.
#[inline(always)]
fn at(track: &Track, first: usize, part: f64) -> [Lanes; 3] {
    let place = |from: &[f64], step: &[f64]| {
        let (from, step) = (lanes(from, first), lanes(step, first));
        std::array::from_fn(|lane| from[lane] + part * step[lane])
    };
    [place(&track.x, &track.dx), place(&track.y, &track.dy), place(&track.z, &track.dz)]
}

/// The sum of Lamb-Oseen vortices (LFHH eq. 3-4).
#[inline(always)]
fn sum_vortices(vortices: &[[f64; 4]], x: &Lanes, y: &Lanes) -> [Lanes; 2] {
    let (mut u, mut v) = ([0.0; LANES], [0.0; LANES]);
    for &[x0, y0, strength, inverse_core2] in vortices {
        let (mut dx, mut dy, mut r2, mut s) = ([0.0; LANES], [0.0; LANES], [0.0; LANES], [0.0; LANES]);
        let mut nearest = f64::INFINITY;
        for lane in 0..LANES {
            dx[lane] = x[lane] - x0;
            dy[lane] = y[lane] - y0;
            r2[lane] = dx[lane] * dx[lane] + dy[lane] * dy[lane];
            s[lane] = r2[lane] * inverse_core2;
            nearest = if s[lane] < nearest { s[lane] } else { nearest };
        }
        let mut factor = [0.0; LANES];
        if nearest > CORE_END {
            for lane in 0..LANES {
                factor[lane] = strength / r2[lane];
            }
        } else {
            for lane in 0..LANES {
                let outside = strength * (1.0 - exp(-s[lane])) / r2[lane];
                factor[lane] = if s[lane] < CENTRE { strength * inverse_core2 } else { outside };
            }
        }
        for lane in 0..LANES {
            u[lane] -= factor[lane] * dy[lane];
            v[lane] += factor[lane] * dx[lane];
        }
    }
    [u, v]
}
