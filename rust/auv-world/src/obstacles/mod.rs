//! Solid obstacles, one file for each shape: signed distance and the range of a sonar beam.
//!
//! Spheres and discs, which the section worlds have by the dozen, are kept as structures of arrays;
//! the other shapes one by one.

mod nearest;
mod outline;
pub mod polygon;
mod round;
mod solids;
mod superquadric;

pub use nearest::Nearest;
pub use round::{BeamColumns, Beams, Discs, Echo, Spheres};
pub use solids::Solids;

use crate::math::{Vec2, Vec3, add_scaled};
use crate::scenario::{Cylinder, Manoeuvre, Obstacle, Superquadric};

/// A shape that is neither sphere nor disc, at its present place.
#[derive(Debug, Clone)]
pub enum Solid {
    /// A vertical cylinder and its centre.
    Cylinder(Cylinder),
    /// A superquadric.
    Superquadric(Superquadric),
    /// A polygon's prism.
    Polygon(polygon::Prism),
}

impl Solid {
    /// Moves it.
    pub fn place(&mut self, position: Vec3) {
        match self {
            Self::Cylinder(shape) => shape.position_m = [position[0], position[1]],
            Self::Superquadric(shape) => shape.position_m = position,
            Self::Polygon(prism) => prism.place([position[0], position[1]]),
        }
    }

    /// Signed distance (m), never more than the true one.
    pub fn clearance(&self, point: Vec3) -> f64 {
        match self {
            Self::Cylinder(shape) => {
                let (dx, dy) = (point[0] - shape.position_m[0], point[1] - shape.position_m[1]);
                prism_distance((dx * dx + dy * dy).sqrt() - shape.radius_m, shape.top_m, shape.bottom_m, point[2])
            }
            Self::Superquadric(shape) => superquadric::clearance(shape, point),
            Self::Polygon(prism) => prism.clearance(point),
        }
    }

    /// The corners of a box on the map (m) beyond which its clearance is no less than the distance to the box. A
    /// superquadric's clearance is less than its distance, so that no box tells anything.
    fn bounds(&self) -> (Vec2, Vec2) {
        match self {
            Self::Cylinder(shape) => {
                let reach = shape.radius_m * (1.0 + 1e-9);
                (shape.position_m.map(|v| v - reach), shape.position_m.map(|v| v + reach))
            }
            Self::Superquadric(_) => ([f64::NEG_INFINITY; 2], [f64::INFINITY; 2]),
            Self::Polygon(prism) => prism.bounds(),
        }
    }

    /// How far a beam runs before it meets the shape (m), at most `longest`.
    pub fn range(&self, origin: Vec3, direction: Vec3, longest: f64) -> f64 {
        march(origin, direction, longest, |point| self.clearance(point))
    }
}

/// Signed distance to a vertical prism from the signed distance to its outline and its two depths.
fn prism_distance(outline: f64, top: f64, bottom: f64, depth: f64) -> f64 {
    let vertical = (top - depth).max(depth - bottom);
    if outline > 0.0 && vertical > 0.0 {
        (outline * outline + vertical * vertical).sqrt()
    } else {
        outline.max(vertical)
    }
}

/// A beam has met a surface when it is nearer than this (m, and as a fraction of its longest range).
pub(crate) const TOUCH: f64 = 1e-3;
/// It stands still after so many steps.
pub(crate) const STEPS: usize = 256;

/// Walks along a beam by a clearance that never overestimates, until it touches.
pub(crate) fn march(origin: Vec3, direction: Vec3, longest: f64, clearance: impl Fn(Vec3) -> f64) -> f64 {
    let touch = TOUCH * longest;
    let mut range = 0.0;
    for _ in 0..STEPS {
        let free = clearance(add_scaled(origin, range, direction));
        if free < touch {
            return range;
        }
        range += free;
        if range >= longest {
            return longest;
        }
    }
    range
}

impl Obstacle {
    /// Where it starts: its centre (discs, cylinders and polygons at the depth of their middle or 0) (m).
    pub fn position_m(&self) -> Vec3 {
        match self {
            Self::Sphere(shape) => shape.position_m,
            Self::Disc(shape) => [shape.position_m[0], shape.position_m[1], 0.0],
            Self::Cylinder(shape) => [shape.position_m[0], shape.position_m[1], 0.5 * (shape.top_m + shape.bottom_m)],
            Self::Superquadric(shape) => shape.position_m,
            Self::Polygon(shape) => {
                let [x, y] = polygon::centre(&shape.vertices_m);
                [x, y, 0.5 * (shape.top_m + shape.bottom_m)]
            }
        }
    }

    /// Its velocity (m/s); only spheres and superquadrics move in depth.
    pub fn velocity_mps(&self) -> Vec3 {
        let flat = |velocity: [f64; 2]| [velocity[0], velocity[1], 0.0];
        match self {
            Self::Sphere(shape) => shape.velocity_mps,
            Self::Disc(shape) => flat(shape.velocity_mps),
            Self::Cylinder(shape) => flat(shape.velocity_mps),
            Self::Superquadric(shape) => shape.velocity_mps,
            Self::Polygon(shape) => flat(shape.velocity_mps),
        }
    }

    /// How it departs from that velocity, if it does.
    pub fn manoeuvre(&self) -> Option<&Manoeuvre> {
        match self {
            Self::Sphere(shape) => shape.manoeuvre.as_ref(),
            Self::Disc(shape) => shape.manoeuvre.as_ref(),
            Self::Cylinder(_) | Self::Superquadric(_) | Self::Polygon(_) => None,
        }
    }

    /// Whether it reaches through all depths, so that only the distance on the map counts.
    pub fn is_flat(&self) -> bool {
        !matches!(self, Self::Sphere(_) | Self::Superquadric(_))
    }

    /// Radius of a circle or ball round its centre that holds it (m).
    pub fn extent_m(&self) -> f64 {
        match self {
            Self::Sphere(shape) => shape.radius_m,
            Self::Disc(shape) => shape.radius_m,
            Self::Cylinder(shape) => shape.radius_m,
            Self::Superquadric(shape) => shape.semi_axes_m.iter().map(|a| a * a).sum::<f64>().sqrt(),
            Self::Polygon(shape) => {
                let [x, y] = polygon::centre(&shape.vertices_m);
                let farthest = |best: f64, v: &[f64; 2]| best.max((v[0] - x) * (v[0] - x) + (v[1] - y) * (v[1] - y));
                shape.vertices_m.iter().fold(0.0, farthest).sqrt()
            }
        }
    }
}
