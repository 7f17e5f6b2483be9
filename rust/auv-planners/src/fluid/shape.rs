//! Whatever the water flows round: a function Gamma that is 1 on the surface, less inside, more outside.
//!
//! Superquadrics have one by themselves (eq. 1). Solids known by their signed distance d, and the sea
//! floor, take Gamma = (1 + d / L)^2: that of a ball of radius L whose surface they have.

use auv_world::World;
use auv_world::math::{Vec3, add_scaled, norm};
use auv_world::obstacles::Solid;

use super::superquadric::Superquadric;

/// Gamma at a point and its gradient (1/m), which points outwards.
#[derive(Debug, Clone, Copy)]
pub struct Contact {
    /// Gamma.
    pub gamma: f64,
    /// Its gradient (1/m).
    pub gradient: Vec3,
}

/// A shape at its present place.
#[derive(Debug, Clone)]
pub enum Shape {
    /// A superquadric.
    Superquadric(Superquadric),
    /// A solid known by its signed distance.
    Solid(Distance<Solid>),
    /// A sea floor that is not flat.
    Floor(Distance<Box<World>>),
}

/// A shape known by its distance.
#[derive(Debug, Clone)]
pub struct Distance<S> {
    /// What is asked.
    pub source: S,
    /// L: within about this the flow feels it (m).
    pub scale: f64,
    /// Solids are this much larger than they are (m).
    pub margin: f64,
    /// Whether only the plane of a 2-D world counts.
    pub flat: bool,
}

/// Derivatives are taken over this part of L.
const DIFFERENCE: f64 = 1e-3;
/// Slopes that count as none.
const LEVEL: f64 = 1e-12;

impl<S> Distance<S> {
    /// The vector whose components are half the differences of a function over `h` either way.
    fn slope(&self, point: Vec3, h: f64, function: impl Fn(Vec3) -> f64) -> Vec3 {
        let axes = if self.flat { 2 } else { 3 };
        let mut slope = [0.0; 3];
        for (axis, slope) in slope.iter_mut().enumerate().take(axes) {
            let (mut low, mut high) = (point, point);
            low[axis] -= h;
            high[axis] += h;
            *slope = (function(high) - function(low)) / (2.0 * h);
        }
        slope
    }

    /// Gamma from the distance (m) and the unit normal.
    fn contact(&self, distance: f64, normal: Vec3) -> Contact {
        // Never quite 0, so that there is a way out of the deepest rock.
        let ratio = (1.0 + (distance - self.margin) / self.scale).max(1e-3);
        Contact { gamma: ratio * ratio, gradient: normal.map(|n| 2.0 * ratio / self.scale * n) }
    }

    /// The distance (m) at which Gamma is `level`.
    fn distance_at(&self, level: f64) -> f64 {
        self.scale * (level.sqrt() - 1.0) + self.margin
    }
}

impl Distance<Solid> {
    fn measure(&self, point: Vec3) -> (f64, Vec3) {
        let slope = self.slope(point, DIFFERENCE * self.scale, |p| self.source.clearance(p));
        let length = norm(slope);
        (self.source.clearance(point), if length > LEVEL { slope.map(|s| s / length) } else { [0.0, 0.0, -1.0] })
    }
}

impl Distance<Box<World>> {
    /// To first order the distance is the gap above the floor over the root of 1 + slope^2; in a 2-D
    /// world, where the floor may rise through the plane, over the slope.
    fn measure(&self, point: Vec3) -> (f64, Vec3) {
        let depth = |p: Vec3| self.source.floor_depth(p[0], p[1]);
        let mut rate = self.slope(point, DIFFERENCE * self.scale, |p| depth(p) - p[2]);
        if !self.flat {
            rate[2] = -1.0;
        }
        let steepness = norm(rate);
        let gap = depth(point) - point[2];
        // A level floor has no way out in its plane.
        if steepness > LEVEL { (gap / steepness, rate.map(|r| r / steepness)) } else { (f64::INFINITY, [0.0; 3]) }
    }
}

impl Shape {
    /// Gamma and its gradient.
    #[inline]
    pub fn contact(&self, point: Vec3) -> Contact {
        match self {
            Self::Superquadric(shape) => shape.contact(point),
            Self::Solid(shape) => {
                let (distance, normal) = shape.measure(point);
                shape.contact(distance, normal)
            }
            Self::Floor(shape) => {
                let (distance, normal) = shape.measure(point);
                shape.contact(distance, normal)
            }
        }
    }

    /// Gamma.
    pub fn gamma(&self, point: Vec3) -> f64 {
        match self {
            Self::Superquadric(shape) => shape.gamma(point),
            _ => self.contact(point).gamma,
        }
    }

    /// Whether Gamma is surely more than 1.02, where that is quickly said.
    #[inline]
    pub fn is_far(&self, point: Vec3) -> bool {
        match self {
            Self::Superquadric(shape) => shape.is_far(point),
            _ => false,
        }
    }

    /// d(P, O_k) of eq. 8-9 (m): along the ray from the centre, or the distance where there is no centre.
    #[inline]
    pub fn distance(&self, point: Vec3) -> f64 {
        match self {
            Self::Superquadric(shape) => shape.ray_distance(point),
            Self::Solid(shape) => shape.source.clearance(point) - shape.margin,
            Self::Floor(shape) => shape.measure(point).0 - shape.margin,
        }
    }

    /// Signed distance (m), never more than the true one; `beyond` stands for all that are more than that.
    #[inline]
    pub fn clearance(&self, point: Vec3, beyond: f64) -> f64 {
        match self {
            Self::Superquadric(shape) => shape.clearance(point, beyond),
            Self::Solid(shape) => (shape.source.clearance(point) - shape.margin).min(beyond),
            Self::Floor(shape) => shape.source.floor().clearance(point, beyond + shape.margin) - shape.margin,
        }
    }

    /// The point at which Gamma is `level`, out from `point`.
    pub fn outside(&self, point: Vec3, level: f64) -> Vec3 {
        /// Curved surfaces need more than one step along the normal.
        const STEPS: usize = 3;
        let walk = |measure: &dyn Fn(Vec3) -> (f64, Vec3), wanted: f64| {
            (0..STEPS).fold(point, |place, _| {
                let (distance, normal) = measure(place);
                if distance.is_finite() { add_scaled(place, (wanted - distance).max(0.0), normal) } else { place }
            })
        };
        match self {
            Self::Superquadric(shape) => shape.outside(point, level),
            Self::Solid(shape) => walk(&|p| shape.measure(p), shape.distance_at(level)),
            Self::Floor(shape) => walk(&|p| shape.measure(p), shape.distance_at(level)),
        }
    }

    /// A length that is short beside the shape (m): steps along its surface need not be shorter.
    pub fn smallest(&self) -> f64 {
        match self {
            Self::Superquadric(shape) => shape.smallest(),
            Self::Solid(shape) => shape.scale,
            Self::Floor(shape) => shape.scale,
        }
    }
}
