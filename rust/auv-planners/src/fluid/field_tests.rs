//! The golden numbers of eq. 1-13, and that nothing flows into a surface.

use super::super::superquadric::Superquadric;
use super::*;
use auv_world::rng::{Purpose, Stream};
use std::f64::consts::{FRAC_PI_2, PI};

const KM: f64 = 1000.0;

/// As printed, with distances in kilometres.
const LITERAL: Modulation =
    Modulation { least_factor: 0.0, unit_m: KM, tail: true, escape: false, union_exponent: 0.0, relative: false };

/// Kilometres and a height to metres and a depth.
fn place([x, y, height]: Vec3) -> Vec3 {
    [KM * x, KM * y, -KM * height]
}

fn body(centre: Vec3, semi_axes: Vec3, exponents: Vec3, [rho, sigma, theta]: Vec3) -> Body {
    let shape = Superquadric::new(place(centre), semi_axes.map(|a| KM * a), exponents);
    Body::new(Shape::Superquadric(shape), Coefficients { rho, sigma, theta })
}

fn assert_near(found: Vec3, expected: Vec3) {
    let mirrored = [found[0], found[1], -found[2]];
    assert!((0..3).all(|axis| (mirrored[axis] - expected[axis]).abs() < 1e-8), "{mirrored:?} {expected:?}");
}

#[test]
fn a_sphere_met_head_on() {
    let turned = |theta: f64| {
        let sphere = body([5.0, 0.0, 0.0], [1.0; 3], [2.0; 3], [1.0, 1.0, theta]);
        // A factor of 1: no scaling.
        let modulation = Modulation { least_factor: 1.0, unit_m: 1e9, ..LITERAL };
        let mut field = Field::new(vec![sphere], modulation, false);
        field.velocity(place([3.0, 0.0, 0.0]), place([10.0, 0.0, 0.0]), [1.0, 0.0, 0.0])
    };
    assert_near(turned(0.0), [0.75, -0.25, 0.0]);
    assert_near(turned(FRAC_PI_2), [0.75, 0.0, 0.25]);
    assert_near(turned(PI), [0.75, 0.25, 0.0]);
    assert_near(turned(-FRAC_PI_2), [0.75, 0.0, -0.25]);
}

#[test]
fn a_sphere_and_a_cylinder() {
    let (point, goal) = (place([3.2, 0.4, 0.3]), place([10.0, 0.0, 0.0]));
    let coefficients = [1.5, 0.8, 0.7];
    let sphere = body([5.0, 0.0, 0.0], [1.0; 3], [2.0; 3], coefficients);
    let cylinder = body([4.0, 2.0, 0.0], [0.8, 1.0, 1.5], [2.0, 2.0, 8.0], coefficients);
    assert!((sphere.shape.distance(point) - 868.154169).abs() < 1e-6);
    assert!((cylinder.shape.distance(point) - 852.504716).abs() < 1e-6);
    assert!((cylinder.shape.gamma(point) - 3.560002560).abs() < 1e-9);
    let to_goal = sub(goal, point);
    let undisturbed = to_goal.map(|step| 2.0 * step / norm(to_goal));
    let mut field = Field::new(vec![sphere.clone()], LITERAL, false);
    assert_near(field.velocity(point, goal, undisturbed), [0.615739903, -0.588914186, 0.762463492]);
    let normal = sphere.shape.contact(point).gradient;
    let tangent = field.tangent(normal.map(|n| n / norm(normal)), sphere.direction);
    assert_near(tangent, [0.064928529, 0.769071055, -0.635856901]);
    let mut field = Field::new(vec![sphere, cylinder], LITERAL, false);
    assert_near(field.velocity(point, goal, undisturbed), [1.226166776, -0.792952317, 0.523413205]);
    assert!((field.weights[0] - 0.506930943).abs() < 1e-9 && (field.weights[1] - 0.493069057).abs() < 1e-9);
}

#[test]
fn a_tangent_over_a_summit() {
    let field = Field::new(Vec::new(), LITERAL, false);
    for theta in [0.0, 0.4, FRAC_PI_2, 3.0] {
        let direction = [libm::cos(theta), libm::sin(theta)];
        for z in [-1.0, 1.0] {
            let tangent = field.tangent([0.0, 0.0, z], direction);
            assert!((norm(tangent) - 1.0).abs() < 1e-12 && tangent[2] == 0.0);
        }
    }
}

/// Eq. 7 keeps the flow out for all coefficients: 10 000 of them, on the surfaces of all kinds of shape.
#[test]
fn nothing_flows_into_a_surface() {
    let mut stream = Stream::new(3, Purpose::Planner, 0);
    for i in 0..10_000 {
        let exponents = [[2.0; 3], [2.0, 2.0, 8.0], [8.0; 3], [2.0, 2.0, 1.0]][i % 4];
        let axes = [(); 3].map(|()| stream.uniform(0.4, 2.0));
        let coefficients = [stream.uniform(0.2, 5.0), stream.uniform(0.2, 5.0), stream.uniform(-PI, PI)];
        let subject = body([1.0, 2.0, 3.0], axes, exponents, coefficients);
        // To where rounding leaves Gamma = 1, which small coefficients magnify.
        let outwards = [(); 3].map(|()| stream.uniform(-3.0, 3.0) * KM);
        let surface = subject.shape.outside(add_scaled(place([1.0, 2.0, 3.0]), 1.0, outwards), 1.0);
        let flow = [(); 3].map(|()| stream.uniform(-2.0, 2.0));
        let gradient = subject.shape.contact(surface).gradient;
        let modulation = Modulation { least_factor: 0.5, tail: i % 3 == 0, ..LITERAL };
        let mut field = Field::new(vec![subject], modulation, false);
        let found = field.velocity(surface, place([30.0, 0.0, 0.0]), flow);
        let inwards = dot(found, gradient) / norm(gradient);
        assert!(inwards > -1e-8 * norm(flow), "{inwards}");
        assert!(!modulation.tail || inwards.abs() < 1e-8 * norm(flow));
    }
}

#[test]
fn no_obstacle_one_obstacle_and_thousands() {
    let (goal, flow) = (place([30.0, 0.0, 0.0]), [2.0, 0.0, 0.0]);
    assert_eq!(Field::new(Vec::new(), LITERAL, false).velocity([0.0; 3], goal, flow), flow);
    let near = body([2.0, 0.1, 0.0], [1.0; 3], [2.0; 3], [1.0, 1.0, 0.3]);
    let alone = Field::new(vec![near.clone()], LITERAL, false).velocity([0.0; 3], goal, flow);
    let mut many = vec![near];
    for i in 0..3000 {
        many.push(body([1e7 + f64::from(i), 0.0, 0.0], [1.0; 3], [30.0, 40.0, 100.0], [1.0, 1.0, 0.3]));
    }
    let found = Field::new(many, LITERAL, false).velocity([0.0; 3], goal, flow);
    // So far away they weigh nothing.
    assert_eq!(found, alone);
}

#[test]
fn every_place_has_a_flow() {
    let mut stream = Stream::new(4, Purpose::Planner, 0);
    for i in 0..2000 {
        let bodies = (0..i % 4)
            .map(|k| {
                let exponents = [[2.0; 3], [2.0, 2.0, 8.0], [8.0; 3], [2.0, 2.0, 1.0]][k];
                let centre = if i % 5 == 0 { [0.0; 3] } else { [(); 3].map(|()| stream.uniform(-1.0, 1.0)) };
                body(centre, [1.0, 0.5, 2.0], exponents, [1.0, 2.0, stream.uniform(-PI, PI)])
            })
            .collect();
        let modulation = Modulation {
            least_factor: [0.0, 0.5][i % 2],
            escape: i % 3 == 0,
            union_exponent: [0.0, 6.0][i / 2 % 2],
            ..LITERAL
        };
        let mut field = Field::new(bodies, modulation, i % 7 == 0);
        let point = if i % 3 == 0 { [0.0; 3] } else { place([(); 3].map(|()| stream.uniform(-2.0, 2.0))) };
        let found = field.velocity(point, if i % 11 == 0 { point } else { place([9.0, 0.0, 0.0]) }, [2.0, 0.0, 0.1]);
        assert!(found.iter().all(|v| v.is_finite()), "{i} {found:?}");
    }
}

/// On the surface of a moving obstacle the flow keeps up with it.
#[test]
fn a_moving_surface_pushes_the_flow() {
    let mut sphere = body([0.0; 3], [1.0; 3], [2.0; 3], [1.0, 1.0, 0.3]);
    sphere.velocity = [1.5, 0.0, 0.0];
    let mut field = Field::new(vec![sphere], Modulation { relative: true, least_factor: 0.5, ..LITERAL }, false);
    let found = field.velocity([KM, 0.0, 0.0], [9.0 * KM, 0.0, 0.0], [1.0, 0.4, 0.0]);
    assert!((found[0] - 1.5).abs() < 1e-9);
}

#[test]
fn overlapping_spheres_become_one() {
    let pair = || [[0.0, 0.0, 0.0], [1.2, 0.0, 0.0]].map(|c| body(c, [1.0; 3], [2.0; 3], [1.0, 1.0, 0.3])).to_vec();
    let mut field = Field::new(pair(), Modulation { union_exponent: 6.0, ..LITERAL }, false);
    let seam = place([0.6, 0.7, 0.2]);
    field.look(seam);
    let [one, other] = [0, 1].map(|i| field.bodies[i].shape.contact(seam));
    assert_eq!(field.entries.len(), 1);
    let expected = libm::pow(libm::pow(one.gamma, -6.0) + libm::pow(other.gamma, -6.0), -1.0 / 6.0);
    let found = field.entries[0];
    assert!((found.gamma / expected - 1.0).abs() < 1e-12);
    for axis in 0..3 {
        let share = |g: f64| libm::pow(expected / g, 7.0);
        let slope = share(one.gamma) * one.gradient[axis] + share(other.gamma) * other.gradient[axis];
        assert!((found.gradient[axis] - slope).abs() < 1e-15);
    }
    // Apart they stay two.
    let mut far = pair();
    far.push(body([5.0, 0.0, 0.0], [1.0; 3], [2.0; 3], [1.0, 1.0, 0.3]));
    let mut field = Field::new(far, Modulation { union_exponent: 6.0, ..LITERAL }, false);
    field.look(seam);
    assert_eq!(field.entries.len(), 2);
}

/// Inside an obstacle the flow leads out, from the very centre upwards.
#[test]
fn inside_an_obstacle_the_flow_leads_out() {
    let mut stream = Stream::new(5, Purpose::Planner, 0);
    for i in 0..500 {
        let exponents = [[2.0; 3], [2.0, 2.0, 8.0], [8.0; 3], [2.0, 2.0, 1.0]][i % 4];
        let subject = body([0.0; 3], [1.0, 0.7, 1.4], exponents, [1.0, 2.0, 0.3]);
        let point = [(); 3].map(|()| stream.uniform(-300.0, 300.0));
        let gradient = subject.shape.contact(point).gradient;
        let mut field = Field::new(vec![subject], Modulation { escape: true, ..LITERAL }, false);
        let found = field.velocity(point, place([9.0, 0.0, 0.0]), [2.0, 0.3, -0.1]);
        assert!(dot(found, gradient) > 0.0);
        let up = field.velocity([0.0; 3], place([9.0, 0.0, 0.0]), [2.0, 0.0, 0.0]);
        // The tip of a cone's kink counts as its lower half.
        assert!(up[2] < 0.0 || exponents[2] == 1.0);
    }
}

/// Fig. 4: a uniform current with a vertical part, and a sphere that one passes over or beside: least
/// clearances (km) of an implementation of its own.
#[test]
fn a_uniform_current_changes_the_clearance() {
    let clearance = |theta: f64, lambda: f64| {
        let sphere = body([5.0, 0.0, 1.0], [1.0; 3], [2.0; 3], [1.0, 1.0, theta]);
        let mut field = Field::new(vec![sphere], LITERAL, false);
        let (goal, mut here, mut least) = (place([10.0, 0.0, 1.0]), place([0.0, 0.0, 1.0]), f64::INFINITY);
        // V = (-0.25, 0.25, -0.5) m/s with heights, V0 = 1.5 m/s, 2 m/s over ground, 6 s.
        let current = [-0.25, 0.25, 0.5];
        for _ in 0..5000 {
            let to_goal = sub(goal, here);
            let left = norm(to_goal);
            if left < 12.0 {
                break;
            }
            let flow = std::array::from_fn(|axis| lambda * 1.5 * to_goal[axis] / left + (1.0 - lambda) * current[axis]);
            let velocity = field.velocity(here, goal, flow);
            here = add_scaled(here, 12.0 / norm(velocity), velocity);
            least = least.min(field.bodies()[0].shape.distance(here) / KM);
        }
        least
    };
    for (theta, lambda, expected) in
        [(FRAC_PI_2, 1.0, 0.798), (FRAC_PI_2, 0.5, 0.535), (0.0, 1.0, 0.812), (0.0, 0.5, 1.083)]
    {
        let found = clearance(theta, lambda);
        assert!((found - expected).abs() < 2e-3, "{theta} {lambda}: {found} {expected}");
    }
}
