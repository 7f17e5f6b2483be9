//! The cost against a slow reference written plainly from the equations, and by hand.

use auv_world::math::{Vec3, distance};
use auv_world::rng::{Purpose, Stream};
use auv_world::scenario::{Current, Uniform};
use auv_world::{Scenario, World};

use super::{AlphaRange, Angle, Collision, Cost, CostOptions, CostTerms, path_cost};
use crate::testing;

/// F of LFHH (eq. 6-10): turning angle, cells at eight points (3-D) or exact discs (2-D), alpha / pi.
fn reference(world: &World, path: &[Vec3]) -> [f64; 4] {
    let segments = path.len() - 1;
    let minus = |a: Vec3, b: Vec3| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let dot = |a: Vec3, b: Vec3| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let long: f64 = path.windows(2).map(|s| distance(s[0], s[1])).sum();
    let length = 1.0 - distance(path[0], path[segments]) / long;
    let penalty = |count: usize| if count > 0 { count as f64 / segments as f64 + 2.0 } else { 0.0 };
    let sharp = path.windows(3).filter(|p| {
        let (a, b) = (minus(p[1], p[0]), minus(p[2], p[1]));
        libm::acos(dot(a, b) / (dot(a, a) * dot(b, b)).sqrt()) > std::f64::consts::FRAC_PI_6
    });
    let flat = world.scenario().dimensions == 2;
    let blocked =
        path.windows(2).filter(|s| if flat { cuts_disc(world, s[0], s[1]) } else { meets_cell(world, s[0], s[1]) });
    let angles = path.windows(2).map(|s| {
        let d = minus(s[1], s[0]);
        let middle = [s[0][0] + 0.5 * d[0], s[0][1] + 0.5 * d[1], 0.0];
        let [u, v] = world.current(middle);
        libm::acos((u * d[0] + v * d[1]) / ((u * u + v * v) * (d[0] * d[0] + d[1] * d[1])).sqrt())
    });
    let current = angles.sum::<f64>() / std::f64::consts::PI / segments as f64;
    [length, penalty(sharp.count()), penalty(blocked.count()), current]
}

fn cuts_disc(world: &World, a: Vec3, b: Vec3) -> bool {
    let discs = world.discs();
    (0..discs.len()).any(|i| {
        let ([x, y], radius) = discs.get(i);
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let t = (((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
        distance([a[0] + t * dx, a[1] + t * dy, 0.0], [x, y, 0.0]) < radius
    })
}

/// Cells of 1 km with sections at whole kilometres, as in the papers' worlds.
fn meets_cell(world: &World, a: Vec3, b: Vec3) -> bool {
    (1..=8).any(|k| {
        let p: Vec3 = std::array::from_fn(|axis| a[axis] + (b[axis] - a[axis]) * f64::from(k) / 8.0);
        let whole = |v: f64, most: f64| (v / 1e3).floor().clamp(0.0, most);
        let centre =
            [whole(p[0], 19.0) * 1e3 + 500.0, whole(p[1] + 500.0, 39.0) * 1e3, whole(p[2], 19.0) * 1e3 + 500.0];
        world.clearance(centre) < 0.0
    })
}

fn terms(world: &World, path: &[Vec3]) -> CostTerms {
    path_cost(world, path, Cost::Lfhh, &CostOptions::default()).unwrap()
}

fn agree(world: &World, path: &[Vec3]) {
    let (ours, reference) = (terms(world, path), reference(world, path));
    for (name, ours, reference) in [
        ("length", ours.length, reference[0]),
        ("curvature", ours.curvature, reference[1]),
        ("block", ours.block, reference[2]),
        ("current", ours.current, reference[3]),
        ("total", ours.total, reference.iter().sum()),
    ] {
        assert!((ours - reference).abs() < 1e-6, "{name}: {ours} but {reference}: {path:?}");
    }
    assert_eq!(ours.feasible, reference[1] + reference[2] == 0.0);
}

#[test]
fn agrees_with_the_reference_on_section_paths() {
    let mut stream = Stream::new(3, Purpose::Planner, 0);
    for name in ["lfhh-2d-1", "lfhh-3d-1", "lfhh-3d-2", "lfhh-3d-3"] {
        let world = testing::paper_world(name, 0);
        let depth = world.scenario().domain.max_m[2];
        for round in 0..200 {
            // From wild paths to nearly straight ones, on which few segments offend.
            let spread = [1.0, 0.2, 0.05, 0.01][round % 4];
            let middle = [stream.uniform(4e3, 16e3), depth * stream.uniform(0.1, 0.5)];
            let points = 2 + stream.below(39);
            let path: Vec<Vec3> = (0..points)
                .map(|section| {
                    let x = middle[0] + spread * stream.uniform(-4e3, 4e3);
                    let z = middle[1] * (1.0 + spread * stream.uniform(-1.0, 1.0));
                    [x, 1e3 * section as f64, z]
                })
                .collect();
            agree(&world, &path);
        }
    }
}

#[test]
fn agrees_with_the_reference_on_any_polyline() {
    let mut stream = Stream::new(4, Purpose::Planner, 0);
    for name in ["lfhh-2d-1", "lfhh-3d-1"] {
        let world = testing::paper_world(name, 0);
        let depth = world.scenario().domain.max_m[2];
        for _ in 0..300 {
            let reach = [500.0, 3e3, 40e3][stream.below(3)];
            let mut point = [stream.uniform(0.0, 20e3), stream.uniform(0.0, 39e3), depth * stream.uniform(0.0, 1.0)];
            let path: Vec<Vec3> = (0..2 + stream.below(20))
                .map(|_| {
                    // Past the last section the nearest one counts, which the reference knows only to 39 km.
                    for (axis, most) in [20e3, 39e3, depth].into_iter().enumerate() {
                        point[axis] = stream.uniform((point[axis] - reach).max(0.0), (point[axis] + reach).min(most));
                    }
                    point
                })
                .collect();
            agree(&world, &path);
        }
    }
}

/// A still 2-D sea without obstacles, or with one uniform current.
fn open_sea(current: Option<[f64; 2]>) -> World {
    let mut scenario: Scenario = testing::paper_scenario("lfhh-2d-1");
    scenario.obstacles.clear();
    scenario.change = None;
    scenario.currents = current.map(|velocity_mps| Current::Uniform(Uniform { velocity_mps })).into_iter().collect();
    World::new(scenario, 0, 0).unwrap()
}

fn flat(points: &[[f64; 2]]) -> Vec<Vec3> {
    points.iter().map(|p| [p[0], p[1], 0.0]).collect()
}

#[test]
fn angles_are_turning_angles() {
    let world = open_sea(None);
    let with = |angle, path: &[Vec3]| {
        path_cost(&world, path, Cost::Lfhh, &CostOptions { angle, ..CostOptions::default() }).unwrap().curvature
    };
    let straight = flat(&[[1e3, 0.0], [1e3, 1e3], [1e3, 2e3]]);
    let right_angle = flat(&[[1e3, 0.0], [1e3, 1e3], [2e3, 1e3]]);
    let hairpin = flat(&[[1e3, 0.0], [1e3, 1e3], [1.1e3, 0.0]]);
    assert_eq!([&straight, &right_angle, &hairpin].map(|path| with(Angle::Turning, path)), [0.0, 2.5, 2.5]);
    assert_eq!([&straight, &right_angle, &hairpin].map(|path| with(Angle::Interior, path)), [0.0, 0.0, 2.5]);
    // tan 30 degrees = 0.5774: turns of 29.9 and 30.1 degrees.
    assert_eq!(with(Angle::Turning, &flat(&[[1e3, 0.0], [1e3, 1e3], [1e3 + 575.0, 2e3]])), 0.0);
    assert_eq!(with(Angle::Turning, &flat(&[[1e3, 0.0], [1e3, 1e3], [1e3 + 580.0, 2e3]])), 2.5);
}

#[test]
fn shares_are_of_segments() {
    let world = open_sea(None);
    // Of four segments three turns, two of them sharp.
    let path = flat(&[[1e3, 0.0], [1e3, 1e3], [2e3, 1e3], [2e3, 2e3], [2e3, 3e3]]);
    let cost = terms(&world, &path);
    assert_eq!((cost.curvature, cost.block, cost.current), (2.5, 0.0, 0.5));
    assert_eq!(cost.path_length_m, 4e3);
    assert!((cost.length - (1.0 - 10f64.sqrt() / 4.0)).abs() < 1e-15);
    assert!(!cost.feasible);
}

#[test]
fn angles_to_the_current() {
    let world = open_sea(Some([0.0, 0.3]));
    let along = flat(&[[1e3, 0.0], [1e3, 1e3]]);
    let back = flat(&[[1e3, 1e3], [1e3, 0.0]]);
    let across = flat(&[[1e3, 0.0], [2e3, 0.0]]);
    assert_eq!([&along, &across, &back].map(|path| terms(&world, path).current), [0.0, 0.5, 1.0]);
    // Angles 0, 45 and 90 degrees: fixed range 1/4, the path's own range 1/2.
    let path = flat(&[[1e3, 0.0], [1e3, 1e3], [2e3, 2e3], [3e3, 2e3]]);
    let options = CostOptions { alpha: AlphaRange::PerPath, ..CostOptions::default() };
    assert!((terms(&world, &path).current - 0.25).abs() < 1e-7);
    assert!((path_cost(&world, &path, Cost::Lfhh, &options).unwrap().current - 0.5).abs() < 1e-7);
}

#[test]
fn times_by_hand() {
    let time = |current, path: &[[f64; 2]]| {
        path_cost(&open_sea(Some(current)), &flat(path), Cost::Time, &CostOptions::default()).unwrap()
    };
    // The vehicle makes 2 m/s through water.
    let with = time([0.0, 0.5], &[[1e3, 0.0], [1e3, 1e3]]);
    assert!((with.time_s.unwrap() - 1e3 / 2.5).abs() < 1e-9);
    assert!((with.total - (1.0 - 500.0 / 400.0)).abs() < 1e-12 && with.feasible);
    let across = time([0.0, 1.2], &[[1e3, 0.0], [2e3, 0.0]]);
    assert!((across.time_s.unwrap() - 1e3 / 1.6).abs() < 1e-9);
    let power = 20.0 + 10.0 * 8.0;
    assert!((across.energy_j.unwrap() - power * 1e3 / 1.6).abs() < 1e-6);
    // Two of three segments against a current that beats it.
    let beaten = time([0.0, -2.5], &[[1e3, 0.0], [1e3, 1e3], [1e3, 2e3], [1e3, 0.0]]);
    assert!((beaten.current - (2.0 + 2.0 / 3.0)).abs() < 1e-12 && !beaten.feasible);
    let sideways = time([0.0, -2.5], &[[1e3, 0.0], [2e3, 0.0]]);
    assert!((sideways.current - 3.0).abs() < 1e-12);
}

#[test]
fn waypoint_test_looks_at_ends_only() {
    let world = testing::paper_world("lfhh-3d-1", 0);
    let options = CostOptions { collision: Collision::Waypoints, ..CostOptions::default() };
    let mut stream = Stream::new(5, Purpose::Planner, 0);
    for _ in 0..100 {
        let path: Vec<Vec3> =
            (0..40).map(|j| [stream.uniform(0.0, 20e3), 1e3 * f64::from(j), stream.uniform(0.0, 20e3)]).collect();
        let inside = path[1..].iter().filter(|p| {
            let whole = |v: f64| (v / 1e3).floor() * 1e3 + 500.0;
            world.clearance([whole(p[0]), p[1], whole(p[2])]) < 0.0
        });
        let expected = match inside.count() {
            0 => 0.0,
            count => 2.0 + count as f64 / 39.0,
        };
        let block = path_cost(&world, &path, Cost::Lfhh, &options).unwrap().block;
        assert!((block - expected).abs() < 1e-12);
    }
}

/// The least clearance along a segment, looked at every part in a thousand.
fn least_clearance(world: &World, a: Vec3, b: Vec3) -> f64 {
    let clearance =
        |k: i32| world.clearance(std::array::from_fn(|axis| a[axis] + (b[axis] - a[axis]) * f64::from(k) / 1e3));
    (0..=1000).map(clearance).fold(f64::INFINITY, f64::min)
}

#[test]
fn segments_keep_their_margin_to_any_solid() {
    let mut stream = Stream::new(6, Purpose::Planner, 0);
    for (world, margin_m) in [
        (testing::paper_world("lfhh-2d-1", 0), 300.0),
        (testing::other_solids_world(), 0.0),
        (testing::other_solids_world(), 250.0),
        (testing::paper_world("lfhh-3d-1", 0), 400.0),
    ] {
        let options = CostOptions { margin_m, collision: Collision::Segment, ..CostOptions::default() };
        let depth = world.scenario().domain.max_m[2];
        let (mut free, mut met) = (0, 0);
        for _ in 0..300 {
            let mut point = || [stream.uniform(0.0, 20e3), stream.uniform(0.0, 40e3), depth * stream.uniform(0.0, 1.0)];
            let (a, b) = (point(), point());
            let b: Vec3 = std::array::from_fn(|axis| a[axis] + 0.1 * (b[axis] - a[axis]));
            // A far first and last segment leave the middle one without the leniency of the ends.
            let around = [[a[0], a[1] - 0.5, a[2]], a, b, [b[0], b[1] + 0.5, b[2]]];
            let cost = path_cost(&world, &around, Cost::Lfhh, &options).unwrap();
            let least = least_clearance(&world, a, b);
            if cost.block == 0.0 {
                assert!(least >= margin_m - 1e-6, "{least} {margin_m}");
                free += 1;
            } else {
                // Conservative, but by little: world clearances may be underestimates near peaks.
                met += 1;
                assert!(least < margin_m + 2.0 || depth > 0.0, "{least} {margin_m} {around:?}");
            }
        }
        assert!(free > 10 && met > 10, "{free} {met}");
    }
}

#[test]
fn a_vehicle_within_the_margin_may_leave() {
    let world = testing::paper_world("lfhh-2d-1", 0);
    let ([x, y], radius) = world.discs().get(0);
    let near = [x - radius - 50.0, y, 0.0];
    let options = CostOptions { margin_m: 300.0, ..CostOptions::default() };
    let block =
        |to: Vec3| path_cost(&world, &[near, to, [to[0] - 100.0, to[1], 0.0]], Cost::Lfhh, &options).unwrap().block;
    assert_eq!(block([x - radius - 900.0, y, 0.0]), 0.0);
    assert!(block([x - radius - 20.0, y, 0.0]) > 2.0);
    assert!(block([x + radius + 900.0, y, 0.0]) > 2.0);
}

#[test]
fn what_is_no_path_is_refused() {
    let world = open_sea(None);
    let cost = |path: &[Vec3]| path_cost(&world, path, Cost::Lfhh, &CostOptions::default());
    assert!(cost(&[[0.0; 3]]).unwrap_err().to_string().contains("1 points"));
    assert!(cost(&[[0.0; 3], [f64::NAN; 3]]).unwrap_err().to_string().starts_with("waypoints[1] = "));
    // Two equal points are a path of length 0.
    assert_eq!(cost(&[[1e3, 1e3, 0.0]; 2]).unwrap().length, 0.0);
    assert!(
        Cost::from_name("tiem")
            .unwrap_err()
            .to_string()
            .contains("did you mean \"time\"? known: lfhh, afhh, time, energy")
    );
}

#[test]
fn afhh_by_hand() {
    // Sections 1 km apart in a box 20 km deep; the limit of a step is 1.75 km.
    let world = testing::paper_world("lfhh-3d-1", 0);
    let cost = |path: &[Vec3]| path_cost(&world, path, Cost::Afhh, &CostOptions::default()).unwrap();
    let free = |path: &[Vec3]| path[1..].iter().filter(|p| meets_cell(&world, **p, **p)).count();
    let path = [[1e3, 0.0, 1e3], [1e3, 1e3, 1.5e3], [1e3, 2e3, 1e3], [1e3, 3e3, 1e3]];
    assert_eq!(free(&path), 0);
    let found = cost(&path);
    let length = 2.0 * (1e6 + 0.25e6f64).sqrt() + 1e3;
    assert!((found.length - (1.0 - 3e3 / length)).abs() < 1e-12);
    assert_eq!((found.depth, found.smooth, found.block), (Some(500.0 / 20e3), Some(0.0), 0.0));
    assert!((found.total - found.length - 0.025).abs() < 1e-12 && found.feasible);
    // One of three steps of 1 km along and 1.5 km aside is 1.80 km long.
    let long = cost(&[[1e3, 0.0, 1e3], [2.5e3, 1e3, 1e3], [2.5e3, 2e3, 1e3], [2.5e3, 3e3, 1e3]]);
    assert_eq!((long.smooth, long.feasible), (Some(2.0 + 1.0 / 3.0), false));
    let wider = CostOptions { step_limit: 1.81, ..CostOptions::default() };
    let path = [[1e3, 0.0, 1e3], [2.5e3, 1e3, 1e3], [2.5e3, 2e3, 1e3], [2.5e3, 3e3, 1e3]];
    assert_eq!(path_cost(&world, &path, Cost::Afhh, &wider).unwrap().smooth, Some(0.0));
    // One of four waypoints lies under the sea floor.
    let deep = cost(&[[1e3, 0.0, 1e3], [1e3, 1e3, 20e3 - 1.0], [1e3, 2e3, 1e3], [1e3, 3e3, 1e3]]);
    let floor = world.floor_depth(1.5e3, 1e3);
    let blocked = usize::from(19.5e3 > floor);
    assert_eq!(deep.block, if blocked > 0 { 2.25 } else { 0.0 });
}
