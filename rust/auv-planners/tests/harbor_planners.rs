//! Planners in harbours: what they find on the reference maps, and the promises that every planner keeps.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::cell::Cell;
use std::path::Path;

use auv_planners::{Control, Cost, CostOptions, Plan, PlanError, path_cost, plan};
use auv_world::math::Vec3;
use auv_world::scenario::{Cylinder, Disc, Mission, Obstacle, Polygon};
use auv_world::{Scenario, World};

const PLANNERS: [&str; 6] = ["maklink-dijkstra", "maklink-aco", "maklink-pso", "rmpso", "funnel", "visibility"];
const SWARMS: [&str; 3] = ["maklink-aco", "maklink-pso", "rmpso"];
/// Shortest way by the middles of links, and the best path (m).
const KNOWN: [(&str, f64, f64); 4] = [
    ("harbor-p", 252.262, 175.989),
    ("harbor-a", 252.259, 176.010),
    ("harbor-b", 252.237, 175.570),
    ("harbor-book", 187.703, 171.285),
];

fn scenario(name: &str) -> Scenario {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../auvgym/scenarios");
    Scenario::load(&folder.join(format!("{name}.toml"))).unwrap()
}

fn world(name: &str) -> World {
    World::new(scenario(name), 0, 0).unwrap()
}

fn try_ask(name: &str, world: &World, seed: u64, parameters: &str) -> Result<Plan, PlanError> {
    let mission = world.mission();
    plan(name, world, mission.start_m, mission.goal_m, seed, parameters, &Control::none())
}

fn ask(name: &str, world: &World, seed: u64, parameters: &str) -> Plan {
    try_ask(name, world, seed, parameters).unwrap()
}

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

fn close(found: f64, known: f64) {
    assert!((found - known).abs() < 1e-3, "{found} is not {known}");
}

#[test]
fn exact_planners_find_the_known_lengths() {
    for (name, middles, best) in KNOWN {
        let world = world(name);
        let length = |planner: &str, parameters: &str| {
            let found = ask(planner, &world, 0, parameters);
            assert!(found.feasible);
            found.cost.path_length_m
        };
        close(length("maklink-dijkstra", ""), middles);
        close(length("funnel", ""), best);
        close(length("funnel", r#"{"corridors": 8}"#), best);
        close(length("visibility", ""), best);
    }
}

#[test]
fn swarms_come_near_and_never_below() {
    for (name, middles, best) in KNOWN {
        let world = world(name);
        for planner in SWARMS {
            let mut sum = 0.0;
            for seed in 0..10 {
                let found = ask(planner, &world, seed, "");
                assert!(found.feasible && found.cost.path_length_m > best - 1e-3, "{planner} {name}");
                sum += found.cost.path_length_m / 10.0;
            }
            let most = if planner == "maklink-aco" { 1.09 * best } else { best + 0.15 };
            assert!(sum < most && sum < middles, "{planner} {name} {sum}");
        }
    }
}

#[test]
fn plans_keep_their_promises() {
    for name in ["harbor-p", "harbor-a", "harbor-raster"] {
        let world = world(name);
        let mission = world.mission();
        for planner in PLANNERS {
            for (budget, cost) in [(1, "lfhh"), (2, "time"), (79, "lfhh"), (1_234, "energy")] {
                let parameters =
                    format!(r#"{{"max_evaluations": {budget}, "cost": "{cost}", "zones": {{"distance_m": 0.4}}}}"#);
                let found = ask(planner, &world, 3, &parameters);
                check(&world, &found, mission.start_m, mission.goal_m, Cost::from_name(cost).unwrap());
                assert!(found.evaluations <= budget && !found.interrupted && found.feasible, "{name} {planner}");
                assert!(!SWARMS.contains(&planner) || found.evaluations == budget);
                assert_eq!(found, ask(planner, &world, 3, &parameters));
            }
        }
        let seeds = [0, 1].map(|seed| ask("rmpso", &world, seed, r#"{"generations": 5}"#).waypoints);
        assert!(name == "harbor-raster" || seeds[0] != seeds[1]);
    }
}

#[test]
fn every_reading_runs() {
    let world = world("harbor-a");
    let mission = world.mission();
    for inertia in ["linear", "printed", "reinforced"] {
        for bounds in ["clamp", "penalty"] {
            for (unit, v_max) in [("metres", 3.0), ("ratio", 0.1)] {
                for objective in ["length", "current", "current-radians", "time"] {
                    let parameters = format!(
                        r#"{{"inertia": "{inertia}", "bounds": "{bounds}", "unit": "{unit}", "v_max": {v_max},
                            "objective": "{objective}", "offset": -0.63}}"#
                    );
                    let found = ask("rmpso", &world, 1, &parameters);
                    check(&world, &found, mission.start_m, mission.goal_m, Cost::Lfhh);
                    assert!(found.feasible && found.evaluations == 80 * 151);
                    let length = found.cost.path_length_m;
                    assert!((176.0..200.0).contains(&length), "{parameters} {length}");
                }
            }
        }
    }
}

#[test]
fn budgets_generations_and_stops() {
    let world = world("harbor-p");
    assert_eq!(ask("rmpso", &world, 0, r#"{"generations": 0}"#).evaluations, 80);
    assert_eq!(ask("maklink-aco", &world, 0, "").evaluations, 80 * 150);
    assert_eq!(ask("rmpso", &world, 0, r#"{"stop": "first-feasible"}"#).evaluations, 80);
    let target = ask("rmpso", &world, 0, "").cost.total;
    let early = ask("rmpso", &world, 0, &format!(r#"{{"target_cost": {}}}"#, target + 0.01));
    assert!(early.cost.total <= target + 0.01 && early.evaluations < 80 * 151);
}

#[test]
fn interruption_gives_the_best_so_far() {
    let world = world("harbor-p");
    let mission = world.mission();
    for planner in SWARMS {
        let asked = Cell::new(0);
        let question = || {
            asked.set(asked.get() + 1);
            asked.get() > 10
        };
        let control = Control::ask(&question);
        let found = plan(planner, &world, mission.start_m, mission.goal_m, 0, "", &control).unwrap();
        assert!(found.interrupted && found.feasible && found.evaluations == 80 * 11, "{planner} {}", found.evaluations);
        check(&world, &found, mission.start_m, mission.goal_m, Cost::Lfhh);
    }
    for planner in PLANNERS {
        let control = Control::ask(&|| true);
        let found = plan(planner, &world, mission.start_m, mission.goal_m, 0, "", &control).unwrap();
        check(&world, &found, mission.start_m, mission.goal_m, Cost::Lfhh);
    }
}

#[test]
fn no_way_is_an_answer() {
    let mut scenario = scenario("harbor-p");
    scenario.obstacles.push(Obstacle::Polygon(Polygon {
        vertices_m: vec![[98.0, -5.0], [104.0, -5.0], [104.0, 205.0], [98.0, 205.0]],
        top_m: -1.0,
        bottom_m: 1.0,
        velocity_mps: [0.0; 2],
    }));
    let world = World::new(scenario, 0, 0).unwrap();
    let mission = world.mission();
    for planner in PLANNERS {
        let found = ask(planner, &world, 0, "");
        assert!(!found.feasible, "{planner}");
        check(&world, &found, mission.start_m, mission.goal_m, Cost::Lfhh);
        let report = found.harbor.unwrap();
        assert_eq!((report.gap_m, report.barriers), (None, vec![5]), "{planner}");
    }
}

#[test]
fn start_in_a_zone_is_led_out_or_refused() {
    let world = world("harbor-book");
    let goal = world.mission().goal_m;
    // A metre from the corner of an obstacle, and outside the box where a vehicle may drift.
    for start in [[39.0, 140.0, 0.0], [-2.0, 100.0, 0.0]] {
        for planner in PLANNERS {
            let found = plan(planner, &world, start, goal, 0, "", &Control::none()).unwrap();
            assert!(found.feasible, "{planner}");
            check(&world, &found, start, goal, Cost::Lfhh);
            let refusal = plan(planner, &world, start, goal, 0, r#"{"zones": {"snap": false}}"#, &Control::none());
            let text = refusal.unwrap_err().to_string();
            assert!(text.starts_with("the start ["), "{text}");
        }
    }
}

#[test]
fn discs_and_cylinders_are_taken_as_polygons() {
    let mut scenario = scenario("harbor-p");
    scenario.obstacles = vec![
        Obstacle::Disc(Disc { position_m: [90.0, 135.0], radius_m: 20.0, velocity_mps: [0.0; 2], manoeuvre: None }),
        Obstacle::Cylinder(Cylinder {
            position_m: [120.0, 90.0],
            radius_m: 10.0,
            top_m: -1.0,
            bottom_m: 1.0,
            velocity_mps: [0.0; 2],
        }),
    ];
    scenario.missions = vec![Mission { start_m: [20.0, 180.0, 0.0], goal_m: [160.0, 90.0, 0.0] }];
    let world = World::new(scenario, 0, 0).unwrap();
    for planner in PLANNERS {
        let found = ask(planner, &world, 0, "");
        assert!(found.feasible && found.cost.path_length_m > 166.5, "{planner}");
    }
    // With many sides and no distance: nearly the tangents and the arc.
    let fine = ask("visibility", &world, 0, r#"{"zones": {"distance_m": 0.001, "sides": 200}}"#).cost.path_length_m;
    let rough = ask("visibility", &world, 0, r#"{"zones": {"distance_m": 0.001, "sides": 8}}"#).cost.path_length_m;
    assert!(fine < rough, "{fine} {rough}");
}

#[test]
fn worlds_without_outlines_are_refused() {
    for (name, what) in [("lfhh-3d-1", "third dimension"), ("iifds-threat1", "third dimension")] {
        for planner in PLANNERS {
            let text = try_ask(planner, &world(name), 0, "").unwrap_err().to_string();
            assert!(text.starts_with("world = ") && text.contains(what), "{text}");
        }
    }
    let mut vortices = scenario("lfhh-2d-1");
    vortices.change = None;
    let world = World::new(vortices, 0, 0).unwrap();
    let text = try_ask("rmpso", &world, 0, r#"{"objective": "time"}"#).unwrap_err().to_string();
    assert!(text.starts_with("objective = "), "{text}");
    for planner in PLANNERS {
        let found = ask(planner, &world, 0, r#"{"zones": {"distance_m": 100}}"#);
        check(&world, &found, world.mission().start_m, world.mission().goal_m, Cost::Lfhh);
        assert!(found.feasible, "{planner}");
    }
}

#[test]
fn wrong_parameters_are_named() {
    let world = world("harbor-p");
    for (planner, parameters, name) in [
        ("rmpso", r#"{"population": 0}"#, "population"),
        ("rmpso", r#"{"v_max": 0}"#, "v_max"),
        ("funnel", r#"{"corridors": 0}"#, "corridors"),
        ("visibility", r#"{"zones": {"distance_m": -1}}"#, "zones.distance_m"),
        ("maklink-dijkstra", r#"{"zones": {"mitre_limit": 0.5}}"#, "zones.mitre_limit"),
        ("maklink-aco", r#"{"zones": {"sides": 2}}"#, "zones.sides"),
        ("funnel", r#"{"cut_m": -1}"#, "cut_m"),
        ("rmpso", r#"{"points": 0}"#, "points"),
        ("rmpso", r#"{"reach_m": -1}"#, "reach_m"),
    ] {
        let text = try_ask(planner, &world, 0, parameters).unwrap_err().to_string();
        assert!(text.starts_with(name), "{text}");
    }
}

#[test]
fn reports_say_gap_depth_and_progress() {
    for (name, _, best) in KNOWN {
        let world = world(name);
        for planner in PLANNERS {
            let found = ask(planner, &world, 1, "");
            let report = found.harbor.as_ref().unwrap();
            close(report.gap_m.unwrap(), found.cost.path_length_m - best);
            assert_eq!((report.depth_m, report.corners.as_slice()), (0.0, found.waypoints.as_slice()));
            assert!(report.trace.windows(2).all(|pair| pair[1].0 > pair[0].0 && pair[1].1 <= pair[0].1));
            let generations = if SWARMS.contains(&planner) { 150 } else { 1 };
            assert!(report.trace.len() >= generations && report.barriers.is_empty());
            let smooth = ask(planner, &world, 1, r#"{"smoothing": "fillet", "cut_m": 0.3}"#);
            let report = smooth.harbor.as_ref().unwrap();
            assert!(smooth.feasible && report.depth_m <= 1e-6, "{planner} {name} {}", report.depth_m);
            assert!(smooth.waypoints.len() > report.corners.len() && report.gap_m.unwrap() > 0.0);
            let cut = ask(planner, &world, 1, r#"{"smoothing": "bezier"}"#);
            let depth = cut.harbor.as_ref().unwrap().depth_m;
            assert_eq!(cut.feasible, depth <= 1e-6, "{planner} {name} {depth}");
            check(&world, &cut, world.mission().start_m, world.mission().goal_m, Cost::Lfhh);
        }
        assert!(ask("funnel", &world, 0, r#"{"smoothing": "bezier"}"#).harbor.unwrap().depth_m > 1.0);
    }
    let open = try_ask("astar", &world("harbor-a"), 0, "").unwrap();
    assert!(open.harbor.is_none());
}

#[test]
fn swarms_beside_the_line_cross_a_raster() {
    let world = world("harbor-raster");
    let reading = r#""places": "line", "reach_m": 16, "zones": {"distance_m": 0.01}"#;
    for planner in ["maklink-pso", "rmpso"] {
        for bounds in ["clamp", "penalty"] {
            for unit in [r#""metres", "v_max": 3"#, r#""ratio", "v_max": 0.1"#] {
                let parameters = format!(r#"{{{reading}, "bounds": "{bounds}", "unit": {unit}}}"#);
                let found = ask(planner, &world, 1, &parameters);
                check(&world, &found, world.mission().start_m, world.mission().goal_m, Cost::Lfhh);
                assert!(found.feasible && found.evaluations == 80 * 151 && found.waypoints.len() == 10);
                assert!(
                    (46.55..50.53).contains(&found.cost.path_length_m),
                    "{parameters} {}",
                    found.cost.path_length_m
                );
                assert_eq!(found, ask(planner, &world, 1, &parameters));
            }
        }
    }
    // Without a gradient some never leave a blocked beginning.
    let binary = |seed| {
        let parameters = format!(r#"{{{reading}, "bounds": "clamp", "penalty": "binary"}}"#);
        ask("rmpso", &world, seed, &parameters).feasible
    };
    let free = (0..20).filter(|&seed| binary(seed)).count();
    assert!((5..20).contains(&free), "{free}");
}
