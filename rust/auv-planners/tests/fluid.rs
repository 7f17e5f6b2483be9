//! What the planners of the flow promise.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use auv_planners::fluid::Flow;
use auv_planners::fluid::threats::{Navigator, Rules};
use auv_planners::{Control, Cost, CostOptions, Plan, path_cost, plan};
use auv_world::families::{Parameters, generate};
use auv_world::math::{Vec3, add_scaled, sub};
use auv_world::rng::{Purpose, Stream};
use auv_world::scenario::{
    Cylinder, Data, Domain, Flat, GriddedSeabed, Mission, Obstacle, Polygon, Seabed, Superquadric,
};
use auv_world::{Scenario, World};
use proptest::prelude::*;

const PLANNERS: [&str; 4] = ["iifds", "iifds-ga", "iifds-iga", "iifds-de"];
const WORLDS: [&str; 6] =
    ["lfhh-2d-1", "lfhh-3d-1", "iifds-static-dense", "iifds-astar", "iifds-threats3", "iifds-complex"];

fn scenario(name: &str) -> Scenario {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../auvgym/scenarios");
    Scenario::load(&folder.join(format!("{name}.toml"))).unwrap()
}

fn world(name: &str) -> World {
    World::new(scenario(name), 0, 0).unwrap()
}

fn ask(name: &str, world: &World, seed: u64, parameters: &str) -> Plan {
    let mission = world.mission();
    plan(name, world, mission.start_m, mission.goal_m, seed, parameters, &Control::none()).unwrap()
}

/// The least clearance of the line at many points.
fn clearance(world: &World, line: &[Vec3]) -> f64 {
    let leg = |leg: &[Vec3]| {
        let (from, step) = (leg[0], sub(leg[1], leg[0]));
        (0..16).map(|k| world.clearance(add_scaled(from, f64::from(k) / 16.0, step))).fold(f64::INFINITY, f64::min)
    };
    line.windows(2).map(leg).fold(f64::INFINITY, f64::min)
}

/// Starts at the start, ends at the goal, stays in the box, costs what it says, and is clear if it says so.
fn check(world: &World, plan: &Plan, [start, goal]: [Vec3; 2], cost: Cost, options: &CostOptions) {
    assert_eq!((plan.waypoints[0], *plan.waypoints.last().unwrap()), (start, goal));
    let domain = &world.scenario().domain;
    for point in &plan.waypoints[1..plan.waypoints.len() - 1] {
        for axis in 0..3 {
            let (low, high) = (domain.min_m[axis].min(start[axis]), domain.max_m[axis].max(start[axis]));
            assert!((low.min(goal[axis])..=high.max(goal[axis])).contains(&point[axis]), "{point:?}");
        }
    }
    let again = path_cost(world, &plan.waypoints, cost, options).unwrap();
    assert_eq!(plan.cost.total.to_bits(), again.total.to_bits());
    assert_eq!(plan.cost, again);
    assert!(plan.history.windows(2).all(|pair| pair[1].0 > pair[0].0 && pair[1].1 <= pair[0].1));
    assert_eq!(plan.history.last().unwrap(), &(plan.evaluations, plan.cost.total));
    if plan.feasible && world.clearance(start) > 0.0 && world.clearance(goal) > 0.0 {
        assert!(clearance(world, &plan.waypoints) > 0.0);
    }
}

fn ends(world: &World) -> [Vec3; 2] {
    [world.mission().start_m, world.mission().goal_m]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn plans_keep_their_promises(
        planner in prop::sample::select(PLANNERS.to_vec()),
        name in prop::sample::select(WORLDS.to_vec()),
        cost in prop::sample::select(vec!["lfhh", "time", "energy"]),
        margin_m in prop::sample::select(vec![0.0, 100.0]),
        budget in 1..60u64,
        seed in 0..100u64,
        options in prop::sample::select(vec!["literal", "recommended"]),
    ) {
        let world = world(name);
        let parameters = format!(
            r#"{{"max_evaluations": {budget}, "cost": "{cost}", "flow": {{"options": "{options}"}},
                "cost_options": {{"margin_m": {margin_m}, "collision": "segment"}}}}"#
        );
        let found = ask(planner, &world, seed, &parameters);
        let options = CostOptions { margin_m, collision: auv_planners::cost::Collision::Segment, ..CostOptions::default() };
        check(&world, &found, ends(&world), Cost::from_name(cost).unwrap(), &options);
        prop_assert!(found.evaluations <= budget);
        prop_assert_eq!(&found, &ask(planner, &world, seed, &parameters));
    }

    /// Also in obstacles and rock, beyond the box, and where both are one place.
    #[test]
    fn plans_start_anywhere(
        planner in prop::sample::select(PLANNERS.to_vec()),
        name in prop::sample::select(vec!["lfhh-3d-1", "lfhh-2d-1"]),
        from in prop::array::uniform3(-0.01..1.01_f64),
        to in prop::array::uniform3(-0.01..1.01_f64),
        same in prop::sample::select(vec![false, false, false, true]),
    ) {
        let world = world(name);
        let domain = &world.scenario().domain;
        let place = |part: Vec3| {
            std::array::from_fn(|axis| domain.min_m[axis] + part[axis] * (domain.max_m[axis] - domain.min_m[axis]))
        };
        let (start, goal) = (place(from), place(if same { from } else { to }));
        let found = plan(planner, &world, start, goal, 1, r#"{"max_evaluations": 3}"#, &Control::none()).unwrap();
        check(&world, &found, [start, goal], Cost::Lfhh, &CostOptions::default());
    }

    #[test]
    fn lines_are_clear_in_random_boxes(seed in 0..1000u64, family in prop::sample::select(vec!["lfhh-2d", "lfhh-3d"])) {
        let world = World::new(generate(family, seed, &Parameters::default()).unwrap(), seed, 0).unwrap();
        let found = ask("iifds", &world, 0, r#"{"cost_options": {"collision": "segment"}}"#);
        check(&world, &found, ends(&world), Cost::Lfhh, &CostOptions { collision: auv_planners::cost::Collision::Segment, ..CostOptions::default() });
        prop_assert!(found.feasible || found.evaluations == 6);
    }
}

/// Twelve superquadrics that overlap; `examples/fluid_rates.rs` does this 400 times.
#[test]
fn dense_fields_are_passed_without_touching() {
    let frame = Scenario { currents: Vec::new(), ..scenario("iifds-static-dense") };
    let depth = frame.domain.max_m[2];
    for seed in 0..20 {
        let mut stream = Stream::new(seed, Purpose::Family, 101);
        let mut obstacles = Vec::new();
        while obstacles.len() < 12 {
            let [x, y] = [9e3, 10e3].map(|side| stream.uniform(1e3, side));
            let width = stream.uniform(0.8e3, 1.5e3);
            let exponents = [[2.0; 3], [2.0, 2.0, 8.0], [8.0; 3], [2.0, 2.0, 1.0]][stream.below(4)];
            if x.max(y) > 1.1 * width && (10e3 - x).max(11e3 - y) > 1.1 * width {
                obstacles.push(Obstacle::Superquadric(Superquadric {
                    position_m: [x, y, depth],
                    semi_axes_m: [width, 0.9 * width, stream.uniform(1.3e3, 2.4e3)],
                    exponents,
                    velocity_mps: [0.0; 3],
                }));
            }
        }
        let world = World::new(Scenario { obstacles, ..frame.clone() }, seed, 0).unwrap();
        let [rho, sigma] = [(); 2].map(|()| stream.uniform(1.0, 3.0));
        let theta = stream.uniform(0.0, std::f64::consts::PI);
        let parameters = format!(
            r#"{{"rho": {rho}, "sigma": {sigma}, "theta": {theta}, "cost_options": {{"collision": "segment"}}}}"#
        );
        let found = ask("iifds", &world, 0, &parameters);
        assert!(found.feasible && clearance(&world, &found.waypoints) > 0.0, "{seed}");
    }
}

#[test]
fn all_shipped_worlds_have_a_clear_line() {
    for name in ["lfhh-2d-1", "lfhh-3d-1", "lfhh-3d-2", "lfhh-3d-3"].iter().chain(&WORLDS) {
        let scenario = scenario(name);
        for mission in 0..scenario.missions.len() {
            let world = World::new(scenario.clone(), 0, mission).unwrap();
            let found = ask("iifds", &world, 0, r#"{"cost_options": {"collision": "segment"}}"#);
            assert!(found.feasible && clearance(&world, &found.waypoints) > 0.0, "{name} {mission}");
        }
    }
}

/// Lengths that the formulas gave once, in an implementation of their own.
#[test]
fn lengths_hold() {
    let length = |name: &str, parameters: &str, flow: &str| {
        let parameters =
            format!(r#"{{{parameters}, "retry": false, "flow": {{"step_m": 12, "unit_m": 1000 {flow}}}}}"#);
        ask("iifds", &world(name), 0, &parameters).cost.path_length_m / 1e3
    };
    let literal = r#", "options": "literal""#;
    for (found, expected) in [
        (length("iifds-static-dense", r#""theta": 0.3"#, literal), 17.385),
        (length("iifds-static-dense", r#""rho": 2, "theta": 2.6"#, literal), 19.140),
        (length("iifds-static-dense", r#""theta": 0.3"#, ""), 16.227),
        (length("iifds-static-dense", r#""rho": 2, "theta": 2.6"#, ""), 16.160),
        (length("iifds-static-dense", r#""rho": 1.5, "sigma": 2, "theta": 1.4"#, ""), 16.303),
        (length("iifds-astar", r#""rho": 1.1, "sigma": 1.1, "theta": 0"#, literal), 15.000),
        (length("iifds-astar", r#""rho": 1.1, "sigma": 1.1, "theta": 0"#, r#", "guard": false"#), 14.948),
    ] {
        assert!((found - expected).abs() < 2e-3, "{found} {expected}");
    }
}

#[test]
fn other_shapes_and_a_sea_floor_from_data_are_gone_round() {
    for dimensions in [2, 3] {
        let depth = if dimensions == 2 { 0.0 } else { 4e3 };
        let mut scenario = scenario(if dimensions == 2 { "lfhh-2d-1" } else { "iifds-threat1" });
        (scenario.change, scenario.sections) = (None, None);
        scenario.domain = Domain { min_m: [0.0; 3], max_m: [20e3, 20e3, depth], margin_m: 500.0 };
        scenario.missions = vec![Mission { start_m: [10e3, 1e3, 0.5 * depth], goal_m: [10e3, 19e3, 0.5 * depth] }];
        // An island on the way, whose top rises above the surface.
        let axis: Vec<f64> = (0..=40).map(|i| 500.0 * f64::from(i)).collect();
        let depths = axis.iter().flat_map(|y| {
            axis.iter().map(move |x| {
                let (dx, dy) = (x - 9.5e3, y - 15e3);
                3.9e3 - 5e3 * libm::exp(-(dx * dx + dy * dy) / 3e6)
            })
        });
        let depth_m = Data::Numbers(depths.collect());
        scenario.seabed = Some(Seabed::Gridded(GriddedSeabed {
            x_m: Some(axis.clone()),
            y_m: Some(axis.clone()),
            longitude_deg: None,
            latitude_deg: None,
            depth_m,
        }));
        let still = [0.0; 2];
        let (top_m, bottom_m) = (-10.0, 9e3);
        scenario.obstacles = vec![
            Obstacle::Cylinder(Cylinder {
                position_m: [10.2e3, 4e3],
                radius_m: 1e3,
                top_m,
                bottom_m,
                velocity_mps: still,
            }),
            Obstacle::Superquadric(Superquadric {
                position_m: [9.5e3, 7e3, 0.0],
                semi_axes_m: [1.5e3, 1e3, 5e3],
                exponents: [4.0, 2.0, 2.0],
                velocity_mps: [0.0; 3],
            }),
            Obstacle::Polygon(Polygon {
                vertices_m: vec![[9e3, 9e3], [12e3, 9e3], [12e3, 11e3], [11e3, 10e3], [9e3, 11e3]],
                top_m,
                bottom_m,
                velocity_mps: still,
            }),
        ];
        let world = World::new(scenario, 0, 0).unwrap();
        let found = ask("iifds", &world, 0, r#"{"cost_options": {"collision": "segment"}}"#);
        assert!(found.feasible, "{dimensions}");
        assert!(clearance(&world, &found.waypoints) > 0.0);
    }
}

#[test]
fn a_level_floor_is_a_wall() {
    let mut scenario = scenario("iifds-threat1");
    scenario.seabed = Some(Seabed::Flat(Flat { depth_m: 3200.0 }));
    let world = World::new(scenario, 0, 0).unwrap();
    let found = ask("iifds", &world, 0, r#"{"theta": -1.57, "cost_options": {"collision": "segment"}}"#);
    assert!(found.feasible && found.waypoints.iter().all(|point| point[2] < 3200.0));
    assert!(found.waypoints.iter().any(|point| point[2] > 3190.0));
}

#[test]
fn interruption_gives_the_best_so_far() {
    let world = world("lfhh-3d-1");
    let [start, goal] = ends(&world);
    for planner in PLANNERS {
        for patience in [0, 2] {
            let asked = AtomicU64::new(0);
            let question = || asked.fetch_add(1, Ordering::Relaxed) >= patience;
            let fine = r#"{"flow": {"step_m": 5}}"#;
            let found = plan(planner, &world, start, goal, 2, fine, &Control::ask(&question)).unwrap();
            assert!(found.interrupted && found.evaluations == 1);
            check(&world, &found, [start, goal], Cost::Lfhh, &CostOptions::default());
        }
    }
}

/// Clearances (km) from the threats over a whole way among them, for the coefficients of an implementation
/// of its own: without current nor barrier, threats seen exactly every 6 s, the sphere 30 s ahead.
#[test]
fn clearances_from_threats_hold() {
    for (name, rho, sigma, share, expected) in [
        ("iifds-threat1", 1.0, 1.0, 0.0, 0.912),
        ("iifds-threat1", 1.2, 1.0, 0.2, 0.979),
        ("iifds-threat1", 1.5, 1.2, 0.3, 1.394),
        ("iifds-threat1", 1.0, 1.5, 0.5, 1.540),
        ("iifds-threats3", 1.0, 1.0, 0.0, 0.209),
        ("iifds-threats3", 1.2, 1.0, 0.2, 0.261),
        ("iifds-threats3", 1.5, 1.2, 0.3, 0.432),
        ("iifds-threats3", 1.0, 1.5, 0.5, 0.452),
        ("iifds-threats3", 1.5, 1.5, 0.1, 0.366),
    ] {
        let rules =
            Rules { rho, sigma, share, margin_m: 0.0, ignore_receding: false, barrier_per_s: 0.0, ..Rules::default() };
        let (arrived, found) = fly(name, 1.0, rules);
        assert!(arrived && (found / 1e3 - expected).abs() < 0.03, "{name} {rho} {sigma} {share}: {found} {expected}");
    }
}

/// The default rules on all ways among threats, with the coefficients above.
#[test]
fn the_default_rules_are_never_hit() {
    for (name, lambda) in
        [("iifds-threat1", 1.0), ("iifds-threats3", 1.0), ("iifds-complex", 0.6), ("iifds-complex", 1.0)]
    {
        for (rho, sigma, share) in [(1.0, 1.0, 0.0), (1.2, 1.0, 0.2), (1.5, 1.2, 0.3), (1.0, 1.5, 0.5), (1.5, 1.5, 0.1)]
        {
            let (arrived, found) = fly(name, lambda, Rules { rho, sigma, share, ..Rules::default() });
            assert!(arrived && found > 0.0, "{name} {lambda} {rho} {sigma} {share}: {found}");
        }
    }
}

/// Whether a vehicle that is led among the moving obstacles of a world arrives, and its least clearance (m).
fn fly(name: &str, lambda: f64, rules: Rules) -> (bool, f64) {
    let mut world = world(name);
    let [start, goal] = ends(&world);
    let moving: Vec<usize> = (0..world.extents().len()).filter(|i| world.obstacle_velocity(*i) != [0.0; 3]).collect();
    let radii: Vec<f64> = moving.iter().map(|i| world.extents()[*i]).collect();
    let flow = Flow { step_m: 12.0, unit_m: Some(1e3), ..Flow::default() };
    let mut navigator = Navigator::new(&world, [start, goal], &radii, lambda, &flow, rules);
    let (mut here, mut least) = (start, f64::INFINITY);
    for tick in 0..3000 {
        let time = 6.0 * f64::from(tick);
        for (threat, i) in moving.iter().enumerate() {
            navigator.measure(threat, world.obstacle_position(*i), time);
        }
        let next = navigator.course(here, time, 6.0).waypoint;
        for part in [0.25, 0.5, 0.75, 1.0] {
            world.set_time(time + 6.0 * part);
            let place = add_scaled(here, part, sub(next, here));
            least = least.min(world.spheres().clearance(place));
            // What is at rest is not touched, either.
            assert!(world.solids().iter().all(|solid| solid.clearance(place) > 0.0), "{name} {place:?}");
        }
        here = next;
        if here == goal {
            return (true, least);
        }
    }
    (false, least)
}

#[test]
fn errors_name_what_is_wrong() {
    let world = world("iifds-threat1");
    let [start, goal] = ends(&world);
    for (wrong, expected) in [
        (r#"{"rho": 0}"#, "rho = 0: must lie in"),
        (r#"{"theta": 4}"#, "theta = 4: must lie in"),
        (r#"{"lambda": 1.5}"#, "lambda = 1.5: must lie in 0 .. 1"),
        (r#"{"classes": {"disc": {"sigma": -1}}}"#, "classes.disc.sigma = -1"),
        (r#"{"flow": {"step_m": -1}}"#, "step_m = -1"),
        (r#"{"flow": {"options": "leteral"}}"#, "did you mean `literal`?"),
        (r#"{"flow": {"gard": true}}"#, "did you mean `guard`?"),
    ] {
        let error = plan("iifds", &world, start, goal, 0, wrong, &Control::none()).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
}
