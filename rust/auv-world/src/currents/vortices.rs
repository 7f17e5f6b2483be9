//! Lamb-Oseen vortices (LFHH eq. 3-5), as a structure of arrays.

use wide::{f64x2, f64x4};

use crate::lanes::{Column, LANES, exp_pair};
use crate::math::Vec2;

/// Speed of a Lamb-Oseen vortex is greatest at this many core radii from its centre ...
pub const RING_RADIUS: f64 = 1.120_906;
/// ... where it is this times eta / (2 pi zeta).
pub const RING_SPEED: f64 = 0.638_173;

/// Vortices at one time.
#[derive(Debug, Clone, Default)]
pub struct VortexField {
    x: Column,
    y: Column,
    /// eta / (2 pi).
    strength: Column,
    /// 1 / zeta^2.
    inverse_core2: Column,
}

impl VortexField {
    /// Appends a vortex: centre (m), circulation (m^2/s), core radius (m).
    pub fn push(&mut self, centre: Vec2, circulation: f64, core_radius: f64) {
        self.x.push(centre[0], 0.0);
        self.y.push(centre[1], 0.0);
        self.strength.push(circulation / std::f64::consts::TAU, 0.0);
        self.inverse_core2.push(1.0 / (core_radius * core_radius), 1.0);
    }

    /// Moves vortex `i`.
    pub fn place(&mut self, i: usize, centre: Vec2) {
        self.x[i] = centre[0];
        self.y[i] = centre[1];
    }

    /// Sets the circulation of vortex `i` (m^2/s).
    pub fn spin(&mut self, i: usize, circulation: f64) {
        self.strength[i] = circulation / std::f64::consts::TAU;
    }

    /// Number of vortices.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// Centre of vortex `i` (m).
    pub fn centre(&self, i: usize) -> Vec2 {
        [self.x[i], self.y[i]]
    }

    /// Circulation of vortex `i` (m^2/s).
    pub fn circulation(&self, i: usize) -> f64 {
        self.strength[i] * std::f64::consts::TAU
    }

    /// Core radius of vortex `i` (m).
    pub fn core_radius(&self, i: usize) -> f64 {
        1.0 / self.inverse_core2[i].sqrt()
    }

    /// Velocity at (x, y) in m/s: u = -eta (y - y0) / (2 pi r^2) (1 - exp(-r^2 / zeta^2)), v likewise
    /// with x; at the centre the factor's limit eta / (2 pi zeta^2).
    #[inline]
    pub fn velocity(&self, x: f64, y: f64) -> Vec2 {
        let (x, y) = (f64x2::splat(x), f64x2::splat(y));
        // In four lanes that are added up at the end, two at a time: those far away cost less.
        let (mut u, mut v) = ([f64x2::ZERO; 2], [f64x2::ZERO; 2]);
        let centres = self.x.halves().zip(self.y.halves());
        for ((cx, cy), (strength, inverse_core2)) in
            centres.zip(self.strength.halves().zip(self.inverse_core2.halves()))
        {
            for half in 0..2 {
                let (dx, dy) = (x - cx[half], y - cy[half]);
                let factor = strength[half] * falloff(dx * dx + dy * dy, inverse_core2[half]);
                u[half] -= factor * dy;
                v[half] += factor * dx;
            }
        }
        let total = |[ab, cd]: [f64x2; 2]| {
            let ([a, b], [c, d]) = (ab.to_array(), cd.to_array());
            (a + b) + (c + d)
        };
        [total(u), total(v)]
    }

    /// Velocity (m/s) at each of four points: bit for bit [`VortexField::velocity`].
    pub fn velocities(&self, x: [f64; LANES], y: [f64; LANES]) -> [[f64; LANES]; 2] {
        let (x, y) = (halves(x), halves(y));
        let mut sums = Sums::default();
        for i in 0..self.len() {
            let [cx, cy] = self.centre(i).map(f64x2::splat);
            let (strength, inverse_core2) = (f64x2::splat(self.strength[i]), f64x2::splat(self.inverse_core2[i]));
            for half in 0..2 {
                sums.add(i % LANES, half, [x[half] - cx, y[half] - cy], strength, inverse_core2);
            }
        }
        sums.total().map(f64x4::to_array)
    }
}

/// From here on 1 - exp(-s) is 1 to the last bit.
const ALL_GONE: f64 = 38.0;

/// (1 - exp(-r^2 / zeta^2)) / r^2, with its limit 1 / zeta^2 at the centre.
#[inline(always)]
fn falloff(r2: f64x2, inverse_core2: f64x2) -> f64x2 {
    let s = r2 * inverse_core2;
    if s.simd_gt(f64x2::splat(ALL_GONE)).all() {
        // Far from most vortices most of the time: no exponential.
        return f64x2::ONE / r2;
    }
    let central = s.simd_lt(f64x2::splat(1e-8));
    let factor = (f64x2::ONE - exp_pair(-s)) / central.select(f64x2::ONE, r2);
    central.select(inverse_core2, factor)
}

/// Where there is no vortex: so far away that it costs no exponential.
const FAR: f64 = 1e15;

/// The vortices of four worlds, a lane each.
#[derive(Debug, Clone, Default)]
pub struct VortexLanes {
    rows: Vec<VortexRow>,
}

/// One vortex of each of four worlds.
#[derive(Debug, Clone, Copy)]
struct VortexRow {
    x: [f64; LANES],
    y: [f64; LANES],
    strength: [f64; LANES],
    inverse_core2: [f64; LANES],
}

impl VortexLanes {
    /// Leaves a lane without vortices.
    pub fn clear(&mut self, lane: usize) {
        self.put(lane, &VortexField::default());
    }

    /// Puts the vortices of a world into a lane.
    pub fn put(&mut self, lane: usize, field: &VortexField) {
        if self.rows.len() < field.len() {
            let none =
                VortexRow { x: [FAR; LANES], y: [FAR; LANES], strength: [0.0; LANES], inverse_core2: [1.0; LANES] };
            self.rows.resize(field.len(), none);
        }
        for (i, row) in self.rows.iter_mut().enumerate() {
            if i < field.len() {
                (row.x[lane], row.y[lane]) = (field.x[i], field.y[i]);
                (row.strength[lane], row.inverse_core2[lane]) = (field.strength[i], field.inverse_core2[i]);
            } else {
                (row.x[lane], row.y[lane], row.strength[lane]) = (FAR, FAR, 0.0);
            }
        }
    }

    /// Velocity (m/s) at one point of each world: bit for bit [`VortexField::velocity`].
    #[inline(always)]
    pub fn velocity(&self, x: [f64; LANES], y: [f64; LANES]) -> [f64x4; 2] {
        let (x, y) = (halves(x), halves(y));
        let mut sums = Sums::default();
        for (i, row) in self.rows.iter().enumerate() {
            let (cx, cy) = (halves(row.x), halves(row.y));
            let (strength, inverse_core2) = (halves(row.strength), halves(row.inverse_core2));
            for half in 0..2 {
                let offset = [x[half] - cx[half], y[half] - cy[half]];
                sums.add(i % LANES, half, offset, strength[half], inverse_core2[half]);
            }
        }
        sums.total()
    }
}

/// Velocities at four points: every fourth vortex has a sum of its own, as in [`VortexField::velocity`].
#[derive(Default)]
struct Sums {
    u: [[f64x2; 2]; LANES],
    v: [[f64x2; 2]; LANES],
}

impl Sums {
    #[inline(always)]
    fn add(&mut self, sum: usize, half: usize, [dx, dy]: [f64x2; 2], strength: f64x2, inverse_core2: f64x2) {
        let factor = strength * falloff(dx * dx + dy * dy, inverse_core2);
        self.u[sum][half] -= factor * dy;
        self.v[sum][half] += factor * dx;
    }

    #[inline(always)]
    fn total(self) -> [f64x4; 2] {
        [self.u, self.v].map(|[a, b, c, d]| {
            let [[p, q], [r, s]] = [0, 1].map(|half| ((a[half] + b[half]) + (c[half] + d[half])).to_array());
            f64x4::new([p, q, r, s])
        })
    }
}

#[inline(always)]
fn halves([a, b, c, d]: [f64; LANES]) -> [f64x2; 2] {
    [f64x2::new([a, b]), f64x2::new([c, d])]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn ring_speed_and_centre() {
        let mut field = VortexField::default();
        let (eta, zeta) = (2000.0, 1200.0);
        field.push([0.0, 0.0], eta, zeta);
        let ring = field.velocity(RING_RADIUS * zeta, 0.0);
        assert!((ring[1] - RING_SPEED * eta / (std::f64::consts::TAU * zeta)).abs() < 1e-6);
        assert_eq!(field.velocity(0.0, 0.0), [0.0, 0.0]);
        let near = field.velocity(1e-3, 0.0)[1];
        assert!((near - eta / std::f64::consts::TAU / (zeta * zeta) * 1e-3).abs() < 1e-12);
        assert!(field.velocity(0.9 * RING_RADIUS * zeta, 0.0)[1] < ring[1]);
        assert!(field.velocity(1.1 * RING_RADIUS * zeta, 0.0)[1] < ring[1]);
    }

    #[test]
    fn far_away_the_exponential_changes_nothing() {
        for i in 0..20_000 {
            let s = ALL_GONE + 0.05 * f64::from(i);
            assert_eq!(1.0 - crate::math::exp(-s), 1.0);
            let [far, near] = [s, 0.5].map(|s| 1e6 * s);
            let alone = falloff(f64x2::splat(far), f64x2::splat(1e-6)).to_array();
            // Beside one that is near it is taken with an exponential.
            let beside = falloff(f64x2::new([far, near]), f64x2::splat(1e-6)).to_array();
            assert_eq!(alone[0].to_bits(), beside[0].to_bits());
        }
    }

    #[test]
    fn sums_an_odd_number() {
        let mut field = VortexField::default();
        for i in 0..3 {
            field.push([1000.0 * f64::from(i), 0.0], 500.0, 1200.0);
        }
        let mut sum = [0.0; 2];
        for i in 0..3 {
            let mut one = VortexField::default();
            one.push([1000.0 * f64::from(i), 0.0], 500.0, 1200.0);
            let velocity = one.velocity(300.0, 700.0);
            sum = [sum[0] + velocity[0], sum[1] + velocity[1]];
        }
        let total = field.velocity(300.0, 700.0);
        assert!((total[0] - sum[0]).abs() < 1e-15 && (total[1] - sum[1]).abs() < 1e-15);
    }

    proptest! {
        #[test]
        fn four_worlds_side_by_side_are_what_each_is_alone(
            seeds in prop::array::uniform4(prop::collection::vec(prop::array::uniform4(-1.0..1.0_f64), 0..11)),
            points in prop::array::uniform4(prop::array::uniform2(-2e4..2e4_f64)),
            again in 0..4_usize,
        ) {
            let fields = seeds.map(|vortices| {
                let mut field = VortexField::default();
                for [x, y, eta, zeta] in vortices {
                    field.push([2e4 * x, 2e4 * y], 1e4 * eta, 3000.0 + 2500.0 * zeta);
                }
                field
            });
            let mut lanes = VortexLanes::default();
            (0..LANES).for_each(|lane| lanes.put(lane, &fields[3 - lane]));
            (0..LANES).for_each(|lane| lanes.put(lane, &fields[lane]));
            lanes.put(again, &fields[again]);
            let [x, y] = [0, 1].map(|axis| points.map(|point| point[axis]));
            let together = lanes.velocity(x, y).map(f64x4::to_array);
            let at_each = fields[again].velocities(x, y);
            for lane in 0..LANES {
                let alone = fields[lane].velocity(points[lane][0], points[lane][1]);
                // A sum of nothing may be either zero.
                prop_assert_eq!([0, 1].map(|axis| (0.0 + together[axis][lane]).to_bits()), alone.map(|v| (0.0 + v).to_bits()));
                let alone = fields[again].velocity(points[lane][0], points[lane][1]);
                prop_assert_eq!(at_each.map(|row| row[lane].to_bits()), alone.map(f64::to_bits));
            }
        }
    }
}
