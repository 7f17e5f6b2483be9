//! RRT* and PRM*: free paths that come near to the shortest, for what they say they spend.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;

use auv_planners::{Control, Cost, CostOptions, Plan, path_cost, plan};
use auv_world::families::{Parameters, generate};
use auv_world::math::{Vec3, add_scaled, distance, sub};
use auv_world::scenario::{Current, Disc, Mission, Obstacle, Polygon, Uniform};
use auv_world::{Scenario, World};

const PLANNERS: [&str; 2] = ["rrt-star", "prm-star"];
const CENTRE: [f64; 2] = [10e3, 18e3];
const RADIUS: f64 = 4e3;

/// The first 2-D paper scenario with nothing in it.
fn empty() -> Scenario {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../auvgym/scenarios");
    let mut scenario = Scenario::load(&folder.join("lfhh-2d-1.toml")).unwrap();
    (scenario.change, scenario.currents) = (None, Vec::new());
    scenario.obstacles.clear();
    scenario.missions = vec![Mission { start_m: [9e3, 5e3, 0.0], goal_m: [12e3, 35e3, 0.0] }];
    scenario
}

fn disc_world() -> World {
    let mut scenario = empty();
    scenario.obstacles.push(Obstacle::Disc(Disc {
        position_m: CENTRE,
        radius_m: RADIUS,
        velocity_mps: [0.0; 2],
        manoeuvre: None,
    }));
    World::new(scenario, 0, 0).unwrap()
}

fn walled_world() -> World {
    let mut scenario = empty();
    scenario.obstacles.push(Obstacle::Polygon(Polygon {
        vertices_m: vec![[-1e3, 20e3], [21e3, 20e3], [21e3, 21e3], [-1e3, 21e3]],
        top_m: -1.0,
        bottom_m: 1.0,
        velocity_mps: [0.0; 2],
    }));
    World::new(scenario, 0, 0).unwrap()
}

/// The shortest way past a disc: a tangent, an arc and a tangent.
fn round_the_disc(start: Vec3, goal: Vec3) -> f64 {
    let from_centre = |point: Vec3| [point[0] - CENTRE[0], point[1] - CENTRE[1]];
    let (a, b) = (from_centre(start), from_centre(goal));
    let (to_a, to_b) = (a[0].hypot(a[1]), b[0].hypot(b[1]));
    let between = ((a[0] * b[0] + a[1] * b[1]) / (to_a * to_b)).acos();
    let arc = between - (RADIUS / to_a).acos() - (RADIUS / to_b).acos();
    assert!(arc > 0.0, "the disc is in the way");
    (to_a * to_a - RADIUS * RADIUS).sqrt() + (to_b * to_b - RADIUS * RADIUS).sqrt() + RADIUS * arc
}

fn ask(name: &str, world: &World, seed: u64, parameters: &str) -> Plan {
    let mission = world.mission();
    plan(name, world, mission.start_m, mission.goal_m, seed, parameters, &Control::none()).unwrap()
}

/// Starts at the start, ends at the goal, stays in the box, costs what it says and keeps its books.
fn check(world: &World, plan: &Plan, start: Vec3, goal: Vec3, cost: Cost) {
    let last = plan.waypoints.len() - 1;
    assert_eq!((plan.waypoints[0], plan.waypoints[last]), (start, goal));
    let domain = &world.scenario().domain;
    for point in &plan.waypoints[1..last] {
        assert!((0..3).all(|axis| (domain.min_m[axis]..=domain.max_m[axis]).contains(&point[axis])), "{point:?}");
    }
    let again = path_cost(world, &plan.waypoints, cost, &CostOptions::default()).unwrap();
    assert_eq!(plan.cost, again);
    assert_eq!(plan.cost.total.to_bits(), again.total.to_bits());
    assert!(plan.history.windows(2).all(|pair| pair[1].0 > pair[0].0 && pair[1].1 <= pair[0].1), "{:?}", plan.history);
    assert_eq!(plan.history.last().unwrap(), &(plan.evaluations, plan.cost.total));
}

/// The least clearance along a path, looked at every few metres.
fn least_clearance(world: &World, waypoints: &[Vec3]) -> f64 {
    let along = waypoints.windows(2).flat_map(|leg| {
        let pieces = (distance(leg[0], leg[1]) / 5.0).ceil().max(1.0);
        (0..=pieces as u32).map(move |i| add_scaled(leg[0], f64::from(i) / pieces, sub(leg[1], leg[0])))
    });
    along.map(|point| world.clearance(point)).fold(f64::INFINITY, f64::min)
}

#[test]
fn paths_converge_to_the_shortest_round_a_disc() {
    let world = disc_world();
    let mission = world.mission();
    let shortest = round_the_disc(mission.start_m, mission.goal_m);
    for (name, first, last) in [("rrt-star", 0.05, 0.003), ("prm-star", 0.12, 0.006)] {
        for shortcut in [true, false] {
            let excess = [500, 5_000, 50_000].map(|budget| {
                let parameters = format!(r#"{{"max_evaluations": {budget}, "shortcut": {shortcut}}}"#);
                let lengths = (0..5).map(|seed| {
                    let found = ask(name, &world, seed, &parameters);
                    assert!(found.feasible && found.evaluations == budget);
                    check(&world, &found, mission.start_m, mission.goal_m, Cost::Lfhh);
                    assert!(least_clearance(&world, &found.waypoints) > 0.0);
                    assert!(found.cost.path_length_m > shortest);
                    found.cost.path_length_m
                });
                lengths.sum::<f64>() / 5.0 / shortest - 1.0
            });
            assert!(excess[0] < first && excess[2] < last, "{name} {shortcut} {excess:?}");
            assert!(excess[1] < excess[0] && excess[2] < excess[1], "{name} {shortcut} {excess:?}");
        }
    }
}

#[test]
fn a_larger_budget_never_makes_the_path_of_a_tree_longer() {
    let world = disc_world();
    for seed in 0..4 {
        let lengths = [200, 400, 1_000, 3_000, 10_000].map(|budget| {
            let found = ask("rrt-star", &world, seed, &format!(r#"{{"max_evaluations": {budget}}}"#));
            if found.feasible { found.cost.path_length_m } else { f64::INFINITY }
        });
        assert!(lengths.windows(2).all(|pair| pair[1] <= pair[0]), "{lengths:?}");
    }
}

#[test]
fn plans_keep_their_promises() {
    for (family, cost) in [("lfhh-2d", "time"), ("lfhh-3d", "lfhh"), ("lfhh-3d", "afhh")] {
        for seed in 0..3 {
            let world = World::new(generate(family, seed, &Parameters::default()).unwrap(), seed, 0).unwrap();
            let mission = world.mission();
            for name in PLANNERS {
                for (budget, objective, margin) in [(1, "time", 0), (33, "length", 0), (1_500, "time", 150)] {
                    let parameters = format!(
                        r#"{{"max_evaluations": {budget}, "objective": "{objective}", "margin_m": {margin}, "cost": "{cost}"}}"#
                    );
                    let found = ask(name, &world, seed, &parameters);
                    check(&world, &found, mission.start_m, mission.goal_m, Cost::from_name(cost).unwrap());
                    assert!(found.evaluations == budget && !found.interrupted);
                    if found.feasible {
                        let clearance = least_clearance(&world, &found.waypoints);
                        assert!(clearance > 0.0);
                        let inner = &found.waypoints[1..found.waypoints.len() - 1];
                        assert!(least_clearance(&world, inner) >= f64::from(margin) - 1e-6);
                    }
                    assert_eq!(found, ask(name, &world, seed, &parameters));
                    let other = ask(name, &world, seed + 100, &parameters);
                    assert!(budget < 1_500 || other.waypoints != found.waypoints);
                }
            }
        }
    }
}

#[test]
fn the_straight_line_is_the_first_motion() {
    let world = World::new(empty(), 0, 0).unwrap();
    let mission = world.mission();
    for name in PLANNERS {
        let found = ask(name, &world, 0, "");
        assert!(found.feasible && found.evaluations == 1);
        assert_eq!(found.waypoints, [mission.start_m, mission.goal_m]);
        let here = plan(name, &world, mission.start_m, mission.start_m, 0, "", &Control::none()).unwrap();
        assert!(here.feasible && here.waypoints == [mission.start_m; 2]);
    }
}

#[test]
fn a_walled_off_goal_is_approached() {
    let world = walled_world();
    let mission = world.mission();
    for name in PLANNERS {
        let found = ask(name, &world, 0, r#"{"max_evaluations": 3000}"#);
        assert!(!found.feasible && found.evaluations == 3000 && found.cost.block > 2.0);
        check(&world, &found, mission.start_m, mission.goal_m, Cost::Lfhh);
        assert_eq!(found.history.len(), 1);
        let nearest = found.waypoints[found.waypoints.len() - 2];
        assert!((18.5e3..20e3).contains(&nearest[1]), "{nearest:?}");
        assert!(least_clearance(&world, &found.waypoints[..found.waypoints.len() - 1]) > 0.0);
    }
}

#[test]
fn hopeless_places_end_with_the_budget() {
    let world = disc_world();
    let goal = world.mission().goal_m;
    let inside = [CENTRE[0], CENTRE[1] + 1e3, 0.0];
    for name in PLANNERS {
        for (start, goal) in [(inside, goal), (goal, inside)] {
            for extra in ["", r#", "goal_bias": 1"#] {
                if name == "prm-star" && !extra.is_empty() {
                    continue;
                }
                let parameters = format!(r#"{{"max_evaluations": 300{extra}}}"#);
                let found = plan(name, &world, start, goal, 0, &parameters, &Control::none()).unwrap();
                assert!(!found.feasible && found.evaluations == 300);
                check(&world, &found, start, goal, Cost::Lfhh);
            }
        }
    }
}

#[test]
fn ends_may_lie_beside_the_box_and_near_solids() {
    let world = disc_world();
    let start = [-400.0, 17e3, 0.0];
    let goal = [CENTRE[0] + RADIUS + 20.0, CENTRE[1], 0.0];
    for name in PLANNERS {
        let found = plan(name, &world, start, goal, 0, r#"{"margin_m": 300}"#, &Control::none()).unwrap();
        assert!(found.feasible);
        check(&world, &found, start, goal, Cost::Lfhh);
        assert!(least_clearance(&world, &found.waypoints[..found.waypoints.len() - 1]) > 300.0 - 1e-6);
        assert!(least_clearance(&world, &found.waypoints) > 17.0);
    }
}

#[test]
fn a_current_that_cannot_be_beaten_stops_only_those_who_look_at_time() {
    let mut scenario = empty();
    scenario.currents.push(Current::Uniform(Uniform { velocity_mps: [0.0, -2.5] }));
    let world = World::new(scenario, 0, 0).unwrap();
    for name in PLANNERS {
        assert!(ask(name, &world, 0, r#"{"max_evaluations": 500}"#).feasible);
        let found = ask(name, &world, 0, r#"{"max_evaluations": 500, "objective": "time", "cost": "time"}"#);
        assert!(!found.feasible && found.evaluations == 500 && found.cost.current > 2.0);
    }
}

/// An ebb between two vortices, slower than the vehicle but not by much.
#[test]
fn the_fastest_path_leaves_a_strong_current() {
    let mut scenario = empty();
    scenario.missions = vec![Mission { start_m: [10e3, 5e3, 0.0], goal_m: [10e3, 35e3, 0.0] }];
    let vortices = r#"{"kind": "vortices", "core_radius_m": 3000, "vortices": [
        {"x_m": 6000, "y_m": 20000, "circulation_m2ps": -26000},
        {"x_m": 14000, "y_m": 20000, "circulation_m2ps": 26000}]}"#;
    scenario.currents = vec![serde_json::from_str(vortices).unwrap()];
    let against = World::new(scenario, 0, 0).unwrap();
    assert!((-1.9..-1.5).contains(&against.current([10e3, 20e3, 0.0])[1]));
    let seconds = |plan: &Plan| {
        let fine: Vec<Vec3> = plan
            .waypoints
            .windows(2)
            .flat_map(|leg| (0..100).map(move |i| add_scaled(leg[0], f64::from(i) / 100.0, sub(leg[1], leg[0]))))
            .chain([plan.waypoints[plan.waypoints.len() - 1]])
            .collect();
        path_cost(&against, &fine, Cost::Time, &CostOptions::default()).unwrap().time_s.unwrap()
    };
    let exact = ask("dijkstra", &against, 0, "");
    for name in PLANNERS {
        let straight = ask(name, &against, 0, "");
        let fast = ask(name, &against, 0, r#"{"objective": "time"}"#);
        assert_eq!(straight.evaluations, 1);
        assert!(seconds(&fast) < 0.9 * seconds(&straight));
        assert!(seconds(&fast) < 1.03 * seconds(&exact));
    }
}

#[test]
fn the_first_path_may_suffice() {
    let world = disc_world();
    for name in PLANNERS {
        let first = ask(name, &world, 0, r#"{"stop": "first-feasible"}"#);
        let whole = ask(name, &world, 0, r#"{"generations": 3}"#);
        assert!(first.feasible && first.evaluations < 2_000 && first.history.len() == 1);
        assert_eq!(whole.evaluations, 20_000);
        assert!(whole.cost.path_length_m < first.cost.path_length_m);
        let target = format!(r#"{{"target_cost": {}}}"#, whole.history[0].1);
        assert!(ask(name, &world, 0, &target).evaluations < 20_000);
    }
}

#[test]
fn parameters_are_checked() {
    let world = disc_world();
    let mission = world.mission();
    let refused = |name: &str, parameters: &str| {
        plan(name, &world, mission.start_m, mission.goal_m, 0, parameters, &Control::none()).unwrap_err().to_string()
    };
    for name in PLANNERS {
        for wrong in [r#"{"margin_m": -1}"#, r#"{"radius_factor": 0}"#] {
            assert!(refused(name, wrong).contains("must lie in"));
        }
        assert!(refused(name, r#"{"objective": "energy"}"#).contains("unknown variant `energy`"));
        let outside = plan(name, &world, [1e9, 0.0, 0.0], mission.goal_m, 0, "", &Control::none()).unwrap_err();
        assert!(outside.to_string().starts_with("start = [1000000000.0"));
    }
    assert!(refused("rrt-star", r#"{"samples": 9}"#).contains("unknown field `samples`"));
    assert!(refused("rrt-star", r#"{"goal_bias": 1.1}"#).contains("must lie in 0 .. 1"));
    assert!(refused("prm-star", r#"{"samples": 0}"#).contains("must lie in 1 .. 32768"));
}
