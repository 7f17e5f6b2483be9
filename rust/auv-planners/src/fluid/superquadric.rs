//! Superquadrics, Gamma = |x/a|^ex + |y/b|^ey + |z/c|^ez (eq. 1): value, gradient (eq. 11) and where rays
//! from the centre meet a surface of one value.
//!
//! Terms of an axis along which a shape has no end are left out: its inverse semi-axis is 0.

use auv_world::math::{Vec3, exp, norm, sub};
use libm::{log, pow};

use super::shape::Contact;

/// A value beyond which a shape is too far to matter; it also keeps products finite.
pub const FARTHEST: f64 = 1e100;
/// Newton's steps end when the logarithm of the scale changes by less.
const PRECISION: f64 = 1e-13;
const MOST_STEPS: usize = 40;

/// A superquadric with axes along x, y, z.
#[derive(Debug, Clone)]
pub struct Superquadric {
    centre: Vec3,
    /// 1 / semi-axes (1/m).
    inverse: Vec3,
    exponents: Vec3,
    /// Exponents as whole numbers where they are, so that powers are products.
    whole: [Option<u32>; 3],
    /// The one exponent of all axes that count, if there is but one.
    common: Option<f64>,
    /// A ball of this radius round the centre holds it (m), in the axes that count.
    extent: f64,
    /// The shortest semi-axis (m).
    smallest: f64,
}

impl Superquadric {
    /// A shape; infinite semi-axes have no end.
    pub fn new(centre: Vec3, semi_axes: Vec3, exponents: Vec3) -> Self {
        let inverse = semi_axes.map(|a| 1.0 / a);
        let counts = |axis: &usize| inverse[*axis] > 0.0;
        let first = (0..3).find(counts).unwrap_or(0);
        let even = (0..3).filter(counts).all(|axis| exponents[axis] == exponents[first]);
        let ends = (0..3).filter(counts).map(|axis| semi_axes[axis]);
        // Up to exponents of 2 the shape lies in the ellipsoid, and that in the ball of its longest axis.
        let round = (0..3).filter(counts).all(|axis| exponents[axis] <= 2.0);
        let extent =
            if round { ends.clone().fold(0.0, f64::max) } else { ends.clone().map(|a| a * a).sum::<f64>().sqrt() };
        Self {
            centre,
            inverse,
            exponents,
            whole: exponents.map(|e| (e == e.floor() && e <= 64.0).then_some(e as u32)),
            common: even.then_some(exponents[first]),
            extent,
            smallest: ends.fold(f64::INFINITY, f64::min),
        }
    }

    /// Moves its centre.
    pub fn place(&mut self, centre: Vec3) {
        self.centre = centre;
    }

    /// Its centre (m).
    pub fn centre(&self) -> Vec3 {
        self.centre
    }

    /// The shortest semi-axis (m).
    pub fn smallest(&self) -> f64 {
        self.smallest
    }

    /// From the centre to a point, in the axes that count (m).
    #[inline]
    fn offset(&self, point: Vec3) -> Vec3 {
        let offset = sub(point, self.centre);
        std::array::from_fn(|axis| if self.inverse[axis] > 0.0 { offset[axis] } else { 0.0 })
    }

    /// Gamma and its gradient (1/m).
    #[inline]
    pub fn contact(&self, point: Vec3) -> Contact {
        let offset = sub(point, self.centre);
        let (mut gamma, mut gradient) = (0.0, [0.0; 3]);
        for axis in 0..3 {
            let scaled = (offset[axis] * self.inverse[axis]).abs();
            let slope = self.power_below(axis, scaled);
            gamma += slope * scaled;
            gradient[axis] = (self.exponents[axis] * slope * self.inverse[axis]).copysign(offset[axis]);
        }
        Contact { gamma, gradient }
    }

    /// Gamma alone.
    #[inline]
    pub fn gamma(&self, point: Vec3) -> f64 {
        self.terms(self.scaled(self.offset(point))).iter().sum()
    }

    /// Whether a point is so far that Gamma is surely more than 1.02, without working it out.
    #[inline]
    pub fn is_far(&self, point: Vec3) -> bool {
        let offset = self.offset(point);
        // Exponents are at least 1.
        let reach = 1.02 * self.extent;
        offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2] > reach * reach
    }

    /// q^(e - 1).
    #[inline]
    fn power_below(&self, axis: usize, q: f64) -> f64 {
        match self.whole[axis] {
            Some(2) => q,
            Some(e) => whole_power(q, e - 1),
            None => pow(q, self.exponents[axis] - 1.0),
        }
    }

    /// |x/a|, |y/b|, |z/c|.
    #[inline]
    fn scaled(&self, offset: Vec3) -> Vec3 {
        std::array::from_fn(|axis| (offset[axis] * self.inverse[axis]).abs())
    }

    #[inline]
    fn terms(&self, scaled: Vec3) -> Vec3 {
        std::array::from_fn(|axis| self.power_below(axis, scaled[axis]) * scaled[axis])
    }

    /// The scale of a (not too short) offset from the centre at which Gamma is `level`.
    #[inline]
    fn ray(&self, offset: Vec3, level: f64) -> f64 {
        let scaled = self.scaled(offset);
        if self.common == Some(2.0) {
            return (level / (scaled[0] * scaled[0] + scaled[1] * scaled[1] + scaled[2] * scaled[2])).sqrt();
        }
        // Scaled once more, so that the largest is 1: no term is too large or too small then.
        let largest = scaled[0].max(scaled[1]).max(scaled[2]);
        let terms = self.terms(scaled.map(|q| q / largest));
        let scale = match self.common {
            Some(e) => exp(log(level / (terms[0] + terms[1] + terms[2])) / e),
            None => self.ray_by_newton(terms, level),
        };
        scale / largest
    }

    /// Newton in L = ln s on ln sum t_i exp(e_i L), which is convex: from an upper end it only descends.
    fn ray_by_newton(&self, terms: Vec3, level: f64) -> f64 {
        let goal = log(level);
        // The largest term, 1, reaches the level here at the latest.
        let slowest = self.exponents[0].min(self.exponents[1]).min(self.exponents[2]);
        let mut scale = if goal > 0.0 { goal / slowest } else { 0.0 };
        for _ in 0..MOST_STEPS {
            let (mut sum, mut slope) = (0.0, 0.0);
            let mut growth = exp(self.exponents[0] * scale);
            for axis in 0..3 {
                // Cylinders and cones are round: two axes share their exponent.
                if axis > 0 && self.exponents[axis] != self.exponents[axis - 1] {
                    growth = exp(self.exponents[axis] * scale);
                }
                let term = terms[axis] * growth;
                sum += term;
                slope += self.exponents[axis] * term;
            }
            let step = (log(sum) - goal) * sum / slope;
            scale -= step;
            if step.abs() < PRECISION {
                break;
            }
        }
        exp(scale)
    }

    /// Signed distance to the surface along the ray from the centre (m): what eq. 8-9 call d(P, O_k).
    #[inline]
    pub fn ray_distance(&self, point: Vec3) -> f64 {
        let offset = self.offset(point);
        let length = norm(offset);
        if length < 1e-9 * self.smallest {
            return -self.smallest;
        }
        length * (1.0 - self.ray(offset, 1.0))
    }

    /// Signed distance (m), never more than the true one; `beyond` stands for all that are more than that.
    /// The plane that touches the surface where the ray leaves it parts a convex shape from the point.
    #[inline]
    pub fn clearance(&self, point: Vec3, beyond: f64) -> f64 {
        let offset = self.offset(point);
        let length = norm(offset);
        if length - self.extent >= beyond {
            return beyond;
        }
        if length < 1e-9 * self.smallest {
            return -self.smallest;
        }
        let scale = self.ray(offset, 1.0);
        if scale > 1.0 {
            return length * (1.0 - scale);
        }
        let surface = std::array::from_fn(|axis| self.centre[axis] + scale * offset[axis]);
        let normal = self.contact(surface).gradient;
        let across = normal[0] * offset[0] + normal[1] * offset[1] + normal[2] * offset[2];
        (across * (1.0 - scale) / norm(normal)).min(beyond)
    }

    /// The point on the ray from the centre at which Gamma is `level`; from the centre itself upwards.
    pub fn outside(&self, point: Vec3, level: f64) -> Vec3 {
        let mut offset = self.offset(point);
        if norm(offset) < 1e-9 * self.smallest {
            let axis = if self.inverse[2] > 0.0 { 2 } else { 0 };
            offset = [0.0; 3];
            offset[axis] = -1e-6 / self.inverse[axis];
        }
        let scale = self.ray(offset, level);
        std::array::from_fn(|axis| {
            if self.inverse[axis] > 0.0 { self.centre[axis] + scale * offset[axis] } else { point[axis] }
        })
    }
}

/// q^n as products, in one order on every machine.
#[inline]
fn whole_power(q: f64, n: u32) -> f64 {
    let (mut power, mut square, mut left) = (1.0, q, n);
    while left > 0 {
        if left & 1 == 1 {
            power *= square;
        }
        square *= square;
        left >>= 1;
    }
    power
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_box_by_hand() {
        let cube = Superquadric::new([0.0; 3], [1.0; 3], [8.0; 3]);
        assert_eq!(cube.contact([3.0, 0.0, 0.0]).gamma, 6561.0);
        assert!((cube.ray_distance([3.0, 0.0, 0.0]) - 2.0).abs() < 1e-12);
    }

    #[test]
    fn a_column_has_no_end() {
        let column = Superquadric::new([1.0, 2.0, 0.0], [2.0, 2.0, f64::INFINITY], [2.0; 3]);
        let contact = column.contact([5.0, 2.0, 1e6]);
        assert_eq!((contact.gamma, contact.gradient[2]), (4.0, 0.0));
        assert_eq!(column.clearance([5.0, 2.0, 1e6], 1e9), 2.0);
        assert_eq!(column.outside([2.0, 2.0, 7.0], 1.0), [3.0, 2.0, 7.0]);
    }

    proptest! {
        #[test]
        fn gradient_ray_and_clearance_are_those_of_the_surface(
            a in prop::array::uniform3(0.5..3.0_f64),
            kind in 0_usize..6,
            p in prop::array::uniform3(-6.0..6.0_f64),
        ) {
            let exponents = [[2.0; 3], [2.0, 2.0, 8.0], [8.0; 3], [2.0, 2.0, 1.0], [2.5, 3.1, 1.7], [2.0, 8.0, 40.0]][kind];
            let shape = Superquadric::new([0.1, -0.2, 0.3], a, exponents);
            let contact = shape.contact(p);
            prop_assert!((contact.gamma / shape.gamma(p) - 1.0).abs() < 1e-12);
            // Off the planes of symmetry, where exponents of 1 have a kink.
            prop_assume!(sub(p, shape.centre()).iter().all(|d| d.abs() > 1e-2) && contact.gamma < 1e9);
            let h = 1e-6;
            for axis in 0..3 {
                let at = |side: f64| { let mut q = p; q[axis] += side * h; shape.gamma(q) };
                let slope = (at(1.0) - at(-1.0)) / (2.0 * h);
                let scale = contact.gamma / h * 1e-9 + slope.abs() * 1e-5 + 1e-9;
                prop_assert!((slope - contact.gradient[axis]).abs() < scale, "{slope} {:?}", contact);
            }
            for level in [1.0, 1.012] {
                prop_assert!((shape.gamma(shape.outside(p, level)) / level - 1.0).abs() < 1e-9);
            }
            let clearance = shape.clearance(p, f64::INFINITY);
            prop_assert_eq!(clearance < 0.0, contact.gamma < 1.0);
            prop_assert!(clearance <= shape.ray_distance(p) + 1e-9);
            prop_assert_eq!(shape.clearance(p, 0.5), clearance.min(0.5));
            prop_assert!(!shape.is_far(p) || contact.gamma > 1.02);
        }
    }
}
