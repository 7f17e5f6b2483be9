//! What a world holds, as bodies in the flow.

use auv_world::World;
use auv_world::math::Vec3;
use auv_world::obstacles::Solid;
use auv_world::scenario::Superquadric as Numbers;
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

/// The bodies of a world as it is now, `margin` (m) larger than they are; `velocities` of obstacles are
/// not looked at.
pub fn bodies(world: &World, margin: f64, coefficients: impl Fn(Class) -> Coefficients) -> Vec<Body> {
    let flat = world.scenario().dimensions == 2;
    let plane = flat.then_some(world.scenario().domain.min_m[2]);
    let mut bodies = Vec::new();
    let mut add = |class: Class, shape: Option<Shape>| {
        bodies.extend(shape.map(|shape| Body::new(shape, coefficients(class))));
    };
    for i in 0..world.spheres().len() {
        let (centre, radius) = world.spheres().get(i);
        add(Class::Sphere, superquadric(plane, centre, [radius + margin; 3], [2.0; 3]));
    }
    for i in 0..world.discs().len() {
        let ([x, y], radius) = world.discs().get(i);
        let axes = [radius + margin, radius + margin, f64::INFINITY];
        add(Class::Disc, superquadric(None, [x, y, 0.0], axes, [2.0; 3]));
    }
    for solid in world.solids() {
        match solid {
            Solid::Superquadric(Numbers { position_m, semi_axes_m, exponents, .. }) => {
                let axes = semi_axes_m.map(|a| a + margin);
                add(Class::Superquadric, superquadric(plane, *position_m, axes, *exponents));
            }
            Solid::Cylinder(cylinder) => {
                add(Class::Cylinder, Some(by_distance(solid, cylinder.radius_m, margin, flat)));
            }
            Solid::Polygon(prism) => {
                // As large as the farthest corner from the mean of the corners.
                let corners = || prism.vertices();
                let count = corners().count().max(1) as f64;
                let centre = [0, 1].map(|axis| corners().map(|corner| corner[axis]).sum::<f64>() / count);
                let distance2 = |c: [f64; 2]| (c[0] - centre[0]).powi(2) + (c[1] - centre[1]).powi(2);
                let scale = corners().map(distance2).fold(0.0, f64::max).sqrt();
                add(Class::Polygon, Some(by_distance(solid, scale, margin, flat)));
            }
        }
    }
    if matches!(world.floor(), Floor::Peaks(_) | Floor::Gridded(_)) {
        let shape = Distance { source: Box::new(world.clone()), scale: floor_scale(world), margin, flat };
        add(Class::Seabed, Some(Shape::Floor(shape)));
    }
    bodies
}

fn by_distance(solid: &Solid, scale: f64, margin: f64, flat: bool) -> Shape {
    Shape::Solid(Distance { source: solid.clone(), scale, margin, flat })
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
