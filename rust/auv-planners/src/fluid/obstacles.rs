//! What a world holds, as bodies in the flow.

use auv_world::World;
use auv_world::math::Vec3;
use auv_world::scenario::Obstacle;
use auv_world::seabed::Floor;
use libm::pow;

use super::field::{Body, Coefficients};
use super::shape::{Distance, Shape};
use super::superquadric::Superquadric;

/// Kinds of obstacle, which may have coefficients of their own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Class {
    /// A ball.
    Sphere,
    /// A disc on the map.
    Disc,
    /// A vertical cylinder.
    Cylinder,
    /// A superquadric.
    Superquadric,
    /// An extruded polygon.
    Polygon,
    /// A sea floor that is not level. A level one is a wall of the box.
    Seabed,
}

/// The bodies of a world as it is now, `margin` (m) larger than they are: first its obstacles in order,
/// with their velocities, then the sea floor. Obstacles that miss the plane of a 2-D world are left out.
pub fn bodies(world: &World, margin: f64, coefficients: impl Fn(Class) -> Coefficients) -> Vec<Body> {
    let flat = world.scenario().dimensions == 2;
    let plane = flat.then_some(world.scenario().domain.min_m[2]);
    let mut bodies = Vec::new();
    let mut solids = world.solids().iter();
    for (i, obstacle) in world.scenario().obstacles.iter().enumerate() {
        let position = world.obstacle_position(i);
        let solid = match obstacle {
            Obstacle::Sphere(_) | Obstacle::Disc(_) => None,
            _ => solids.next(),
        };
        let measured = |scale: f64| {
            let source = solid?.clone();
            Some(Shape::Solid(Distance { source, scale, margin, flat }))
        };
        let (class, shape) = match obstacle {
            Obstacle::Sphere(sphere) => {
                let axes = [sphere.radius_m + margin; 3];
                (Class::Sphere, superquadric(plane, position, axes, [2.0; 3]))
            }
            Obstacle::Disc(disc) => {
                let axes = [disc.radius_m + margin, disc.radius_m + margin, f64::INFINITY];
                (Class::Disc, superquadric(None, position, axes, [2.0; 3]))
            }
            Obstacle::Superquadric(shape) => {
                let axes = shape.semi_axes_m.map(|a| a + margin);
                (Class::Superquadric, superquadric(plane, position, axes, shape.exponents))
            }
            Obstacle::Cylinder(cylinder) => (Class::Cylinder, measured(cylinder.radius_m)),
            Obstacle::Polygon(_) => (Class::Polygon, measured(obstacle.extent_m())),
        };
        bodies.extend(shape.map(|shape| {
            let mut body = Body::new(shape, coefficients(class));
            body.velocity = world.obstacle_velocity(i);
            body
        }));
    }
    if matches!(world.floor(), Floor::Peaks(_) | Floor::Gridded(_)) {
        let shape = Distance { source: Box::new(world.clone()), scale: floor_scale(world), margin, flat };
        bodies.push(Body::new(Shape::Floor(shape), coefficients(Class::Seabed)));
    }
    bodies
}

/// A tenth of the box's depth; in 2-D a twentieth of its shorter side.
fn floor_scale(world: &World) -> f64 {
    let domain = &world.scenario().domain;
    let side = |axis: usize| domain.max_m[axis] - domain.min_m[axis];
    if world.scenario().dimensions == 2 { 0.05 * side(0).min(side(1)) } else { 0.1 * side(2) }
}

/// A superquadric, or what the plane of a 2-D world cuts out of it: there the term of z is a constant.
fn superquadric(plane: Option<f64>, centre: Vec3, axes: Vec3, exponents: Vec3) -> Option<Shape> {
    let Some(z) = plane else { return Some(Shape::Superquadric(Superquadric::new(centre, axes, exponents))) };
    let left = 1.0 - pow((z - centre[2]).abs() / axes[2], exponents[2]);
    if left <= 0.0 {
        return None;
    }
    let [a, b] = [0, 1].map(|axis| axes[axis] * pow(left, 1.0 / exponents[axis]));
    Some(Shape::Superquadric(Superquadric::new(centre, [a, b, f64::INFINITY], [exponents[0], exponents[1], 2.0])))
}
