//! Odd places: goal at the start, start in rock, no obstacle, one obstacle, and what the options of guard and
//! goal do there.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;

use auv_planners::{Control, Plan, plan};
use auv_world::math::{Vec3, add_scaled, distance, sub};
use auv_world::scenario::{Peak, Peaks, Seabed};
use auv_world::{Scenario, World};

const PLANNERS: [&str; 4] = ["iifds", "iifds-ga", "iifds-iga", "iifds-de"];

fn scenario(name: &str) -> Scenario {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../auvgym/scenarios");
    Scenario::load(&folder.join(format!("{name}.toml"))).unwrap()
}

fn ask(name: &str, world: &World, [start, goal]: [Vec3; 2], parameters: &str) -> Plan {
    plan(name, world, start, goal, 1, parameters, &Control::none()).unwrap()
}

#[test]
fn a_goal_at_the_start_is_reached() {
    let world = World::new(scenario("iifds-static-dense"), 0, 0).unwrap();
    let start = world.mission().start_m;
    for planner in PLANNERS {
        let found = ask(planner, &world, [start, start], r#"{"max_evaluations": 4}"#);
        assert_eq!(found.waypoints, [start, start], "{planner}");
        assert!(found.feasible, "{planner}");
    }
}

/// The scenario is refused, by name; a plan from inside a rock leads out of it and says that it is not clear.
#[test]
fn a_start_in_rock() {
    let mut wrong = scenario("iifds-static-dense");
    wrong.missions[0].start_m = [1600.0, 2000.0, 3500.0];
    let message = World::new(wrong, 0, 0).unwrap_err().to_string();
    assert!(message.contains("missions[0].start_m"), "{message}");
    let world = World::new(scenario("iifds-static-dense"), 0, 0).unwrap();
    let ends = [[1600.0, 2000.0, 3500.0], world.mission().goal_m];
    let found = ask("iifds", &world, ends, r#"{"cost_options": {"collision": "segment"}}"#);
    assert!(!found.feasible);
    // Out after a few points, and never in again.
    let out = found.waypoints.iter().position(|point| world.clearance(*point) > 0.0).unwrap();
    assert!(found.waypoints[out..].iter().all(|point| world.clearance(*point) > 0.0));
    assert!(distance(found.waypoints[0], found.waypoints[out]) < 2000.0);
}

#[test]
fn no_obstacle_is_a_straight_line_and_one_is_gone_round() {
    let mut empty = scenario("iifds-static-dense");
    let first = empty.obstacles[0].clone();
    (empty.obstacles, empty.currents) = (Vec::new(), Vec::new());
    let ends = [empty.missions[0].start_m, empty.missions[0].goal_m];
    let options = r#"{"max_evaluations": 4, "cost_options": {"collision": "segment"}}"#;
    for planner in PLANNERS {
        let world = World::new(empty.clone(), 0, 0).unwrap();
        let found = ask(planner, &world, ends, options);
        assert!(found.feasible && (found.cost.path_length_m / distance(ends[0], ends[1]) - 1.0).abs() < 1e-9);
        let one = Scenario { obstacles: vec![first.clone()], ..empty.clone() };
        let world = World::new(one, 0, 0).unwrap();
        let found = ask(planner, &world, ends, options);
        assert!(found.feasible && found.waypoints.iter().all(|point| world.clearance(*point) > 0.0), "{planner}");
        assert!(found.cost.path_length_m > distance(ends[0], ends[1]));
    }
}

/// Terrain as an obstacle: Gaussian peaks between start and goal, with a coefficient of their own.
#[test]
fn peaks_are_gone_over_or_round_as_their_class_has_it() {
    let mut peaks = scenario("lfhh-3d-1");
    (peaks.obstacles, peaks.change, peaks.currents) = (Vec::new(), None, Vec::new());
    let peak = Peak { x_m: 10.2e3, y_m: 20e3, height_m: 6e3, a: 1.0, b: 1.0, sigma_m: 3e3 };
    peaks.seabed = Some(Seabed::Peaks(Peaks { floor_depth_m: 20e3, peaks: vec![peak] }));
    let world = World::new(peaks, 0, 0).unwrap();
    let ends = [[1e3, 5e3, 17e3], [19e3, 35e3, 17e3]];
    let line = |theta: f64| {
        let parameters = format!(
            r#"{{"retry": false, "classes": {{"seabed": {{"theta": {theta}}}}}, "cost_options": {{"collision": "segment"}}}}"#
        );
        ask("iifds", &world, ends, &parameters)
    };
    let straight = (0..=100).map(|i| world.clearance(add_scaled(ends[0], 0.01 * f64::from(i), sub(ends[1], ends[0]))));
    assert!(straight.fold(f64::INFINITY, f64::min) < 0.0, "nothing in the way");
    let (over, round) = (line(1.5), line(0.0));
    let highest = |plan: &Plan| plan.waypoints.iter().map(|point| point[2]).fold(f64::INFINITY, f64::min);
    for found in [&over, &round] {
        assert!(found.feasible && found.waypoints.iter().all(|point| world.clearance(*point) > 0.0));
    }
    assert!(highest(&over) < highest(&round));
}

#[test]
fn guard_and_goal_can_be_told_where_to_be() {
    let world = World::new(scenario("iifds-static-dense"), 0, 0).unwrap();
    let ends = [world.mission().start_m, world.mission().goal_m];
    let line = |flow: &str| {
        let parameters = format!(
            r#"{{"retry": false, "cost_options": {{"collision": "segment"}}, "flow": {{"step_m": 60, "unit_m": 1000 {flow}}}}}"#
        );
        ask("iifds", &world, ends, &parameters)
    };
    assert_eq!(line("").waypoints, line(r#", "guard_gamma": 1.01, "capture_m": 60"#).waypoints);
    let last = |plan: &Plan| distance(plan.waypoints[plan.waypoints.len() - 2], ends[1]);
    let (near, far) = (line(""), line(r#", "capture_m": 900"#));
    assert!(last(&near) <= 60.0 && (840.0..=900.0).contains(&last(&far)));
    let found = plan("iifds", &world, ends[0], ends[1], 0, r#"{"flow": {"guard_gamma": 2}}"#, &Control::none());
    assert!(found.unwrap_err().to_string().contains("guard_gamma = 2: must lie in 1 .. 1.015"));
}

#[test]
fn a_plan_tells_its_coefficients() {
    let world = World::new(scenario("iifds-static-dense"), 0, 0).unwrap();
    let ends = [world.mission().start_m, world.mission().goal_m];
    let tuned = ask("iifds-de", &world, ends, r#"{"max_evaluations": 60, "cost_options": {"collision": "segment"}}"#);
    let of = |name: &str| tuned.coefficients.iter().find(|one| one.0 == name).unwrap().1;
    // With them the flow draws the same line again.
    let parameters = format!(
        r#"{{"rho": {}, "sigma": {}, "theta": {}, "lambda": {}, "retry": false, "cost_options": {{"collision": "segment"}}}}"#,
        of("rho"),
        of("sigma"),
        of("theta"),
        of("lambda")
    );
    let again = ask("iifds", &world, ends, &parameters);
    assert_eq!(again.waypoints, tuned.waypoints);
    assert_eq!(again.coefficients.len(), 4);
}
