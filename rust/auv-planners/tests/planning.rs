//! What every plan must satisfy, for every planner by name.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use auv_planners::protocol::{Settings, Trigger, run};
use auv_planners::replanning::{Window, replan};
use auv_planners::{Control, Cost, CostOptions, Plan, path_cost, plan, planner_names};
use auv_world::families::{Parameters, generate};
use auv_world::math::{Vec3, distance};
use auv_world::scenario::{Obstacle, Polygon};
use auv_world::{Scenario, World};
use proptest::prelude::*;

/// The planners that put waypoints on sections and search with a population.
const SECTION_PLANNERS: [&str; 8] = ["lfhh", "fhh", "fhh-lts", "afhh", "eda-g", "ade", "rwde", "pso"];

/// Planners of harbours know polygons in a plane only; `harbor_planners.rs` asks the same of them.
const IN_HARBOURS: [&str; 6] = ["maklink-dijkstra", "maklink-aco", "maklink-pso", "rmpso", "funnel", "visibility"];

/// The planners that plan in every world.
fn planners_anywhere() -> impl Iterator<Item = &'static str> {
    planner_names().into_iter().filter(|name| !IN_HARBOURS.contains(name))
}

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

/// Starts at the start, ends at the goal, stays in the box, and costs what it says.
fn check(world: &World, plan: &Plan, start: Vec3, goal: Vec3, cost: Cost, options: &CostOptions) {
    assert_eq!(plan.waypoints[0], start);
    assert_eq!(plan.waypoints[plan.waypoints.len() - 1], goal);
    let domain = &world.scenario().domain;
    for point in &plan.waypoints[1..plan.waypoints.len() - 1] {
        for axis in 0..3 {
            // A mission's frame is turned, so that its bounds are exact to rounding only.
            let (low, high) = (domain.min_m[axis] - 1e-6, domain.max_m[axis] + 1e-6);
            assert!((low..=high).contains(&point[axis]), "{point:?}");
        }
    }
    let again = path_cost(world, &plan.waypoints, cost, options).unwrap();
    assert_eq!(format!("{:?}", plan.cost), format!("{again:?}"));
    assert_eq!(plan.cost.total.to_bits(), again.total.to_bits());
    assert!(plan.history.windows(2).all(|pair| pair[1].0 > pair[0].0 && pair[1].1 <= pair[0].1));
    assert_eq!(plan.history.last(), Some(&(plan.evaluations, plan.cost.total)));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn plans_keep_their_promises(
        seed in 0..1000u64,
        family in prop::sample::select(vec!["lfhh-2d", "lfhh-3d"]),
        cost in prop::sample::select(vec!["lfhh", "afhh", "time", "energy"]),
        margin_m in prop::sample::select(vec![0.0, 150.0]),
        budget in 1..1500u64,
        planner in prop::sample::select(SECTION_PLANNERS.to_vec()),
    ) {
        let world = World::new(generate(family, seed, &Parameters::default()).unwrap(), seed, 0).unwrap();
        let parameters = format!(
            r#"{{"max_evaluations": {budget}, "cost": "{cost}", "cost_options": {{"margin_m": {margin_m}}}, "population": 40}}"#
        );
        let found = ask(planner, &world, seed, &parameters);
        let options = CostOptions { margin_m, ..CostOptions::default() };
        let mission = world.mission();
        check(&world, &found, mission.start_m, mission.goal_m, Cost::from_name(cost).unwrap(), &options);
        prop_assert!(found.evaluations <= budget);
        prop_assert!(found.feasible || found.evaluations == budget);
        prop_assert_eq!(&found, &ask(planner, &world, seed, &parameters));
    }

    #[test]
    fn plans_start_anywhere(
        x in 0.0..20e3_f64, y in 0.0..38e3_f64, z in 0.0..19e3_f64, gx in 0.0..20e3_f64, gy in 0.0..40e3_f64,
    ) {
        let world = world("lfhh-3d-1");
        let (start, goal) = ([x, y, z], [gx, gy, 5e3]);
        let found = plan("lfhh", &world, start, goal, 1, r#"{"max_evaluations": 300}"#, &Control::none()).unwrap();
        check(&world, &found, start, goal, Cost::Lfhh, &CostOptions::default());
    }
}

#[test]
fn the_registry_names_and_suggests() {
    assert!(SECTION_PLANNERS.iter().all(|name| planner_names().contains(name)));
    let world = world("lfhh-2d-1");
    let mission = world.mission();
    let error = plan("lfhhh", &world, mission.start_m, mission.goal_m, 0, "", &Control::none()).unwrap_err();
    let text = error.to_string();
    assert!(text.contains("did you mean \"lfhh\"?") && text.contains("fhh-lts"), "{text}");
    let error = plan("lfhh", &world, [1e9, 0.0, 0.0], mission.goal_m, 0, "", &Control::none()).unwrap_err();
    assert!(error.to_string().starts_with("start = [1000000000.0"), "{error}");
    for wrong in [r#"{"learning_rate": 1.5}"#, r#"{"population": 3}"#, r#"{"bins": 101}"#, r#"{"selected": 201}"#] {
        let error = plan("lfhh", &world, mission.start_m, mission.goal_m, 0, wrong, &Control::none()).unwrap_err();
        assert!(error.to_string().contains("must lie in"), "{error}");
    }
}

/// Parameters with which a planner works through much or little, yet comes to its end by itself.
fn bounded(name: &str) -> &'static str {
    match name {
        "rrt-star" | "prm-star" => r#"{"max_evaluations": 3000}"#,
        "astar" | "dijkstra" => r#"{"spacing_m": 600}"#,
        "iifds" => r#"{"flow": {"step_m": 20}}"#,
        "iifds-ga" | "iifds-iga" | "iifds-de" => r#"{"generations": 3, "population": 8}"#,
        "section-optimum" => r#"{"lateral_m": 1000, "depth_m": 2000}"#,
        _ => r#"{"generations": 30, "population": 40, "stop": "exhaust"}"#,
    }
}

/// What `bounded` allows, with a budget: the planners on a grid end by themselves.
fn limited(name: &str, budget: u64) -> String {
    format!(r#"{{"max_evaluations": {budget}, {}"#, bounded(name).trim_start_matches('{'))
        .replace(r#", "max_evaluations": 3000"#, "")
}

#[test]
fn a_budget_of_one_evaluates_one_path() {
    let world = world("lfhh-3d-1");
    for name in planners_anywhere() {
        let found = ask(name, &world, 3, &limited(name, 1));
        check(&world, &found, world.mission().start_m, world.mission().goal_m, Cost::Lfhh, &CostOptions::default());
        let exact = matches!(name, "astar" | "dijkstra");
        assert!(found.evaluations == 1 || exact, "{name}");
        assert_eq!(found.history, [(found.evaluations, found.cost.total)], "{name}");
    }
}

#[test]
fn the_same_seed_gives_the_same_plan() {
    let world = world("lfhh-3d-1");
    for name in planners_anywhere() {
        assert_eq!(ask(name, &world, 7, bounded(name)), ask(name, &world, 7, bounded(name)), "{name}");
    }
}

#[test]
fn budgets_and_generations_are_exact() {
    let world = world("lfhh-3d-2");
    let spent = |parameters: &str| ask("lfhh", &world, 5, parameters).evaluations;
    assert_eq!(spent(r#"{"generations": 0}"#), 200);
    assert_eq!(spent(r#"{"generations": 7, "stop": "exhaust"}"#), 1600);
    assert_eq!(spent(r#"{"max_evaluations": 12345, "stop": "exhaust"}"#), 12345);
    assert_eq!(spent(r#"{"stop": "exhaust", "population": 20}"#), 20 * 301);
    let history = ask("lfhh", &world, 5, r#"{"generations": 3, "stop": "exhaust"}"#).history;
    assert_eq!(history.iter().map(|(spent, _)| *spent).collect::<Vec<_>>(), [200, 400, 600, 800]);
}

#[test]
fn first_feasible_stops_early_and_a_larger_budget_never_hurts() {
    let world = world("lfhh-3d-1");
    let first = ask("lfhh", &world, 1, "");
    assert!(first.feasible && first.cost.total < 2.0 && first.evaluations < 60_200);
    let exhausted = ask("lfhh", &world, 1, r#"{"stop": "exhaust"}"#);
    assert_eq!(exhausted.evaluations, 60_200);
    assert!(exhausted.cost.total <= first.cost.total);
}

#[test]
fn a_walled_off_goal_has_no_feasible_plan() {
    let mut scenario = scenario("lfhh-2d-1");
    scenario.change = None;
    let vertices_m = vec![[-1e3, 20e3], [21e3, 20e3], [21e3, 21e3], [-1e3, 21e3]];
    scenario.obstacles.push(Obstacle::Polygon(Polygon {
        vertices_m,
        top_m: -1.0,
        bottom_m: 1.0,
        velocity_mps: [0.0; 2],
    }));
    let world = World::new(scenario, 0, 0).unwrap();
    let mission = world.mission();
    for name in planners_anywhere() {
        let found = ask(name, &world, 0, bounded(name));
        assert!(!found.feasible && !found.interrupted && found.cost.block > 2.0, "{name}");
        check(&world, &found, mission.start_m, mission.goal_m, Cost::Lfhh, &CostOptions::default());
    }
}

/// Interrupted at the first question, half way and at the last, every planner gives an honest plan.
#[test]
fn interruption_gives_the_best_so_far() {
    let world = world("lfhh-3d-1");
    let mission = world.mission();
    for name in planners_anywhere() {
        let run = |patience: u64| {
            let asked = AtomicU64::new(0);
            let question = || asked.fetch_add(1, Ordering::Relaxed) >= patience;
            let control = Control::ask(&question);
            let found = plan(name, &world, mission.start_m, mission.goal_m, 2, bounded(name), &control).unwrap();
            (found, asked.load(Ordering::Relaxed))
        };
        let (whole, questions) = run(u64::MAX);
        assert!(!whole.interrupted && questions > 0, "{name}");
        for patience in [0, questions / 2, questions - 1] {
            let (found, asked) = run(patience);
            assert!(found.interrupted && found.evaluations <= whole.evaluations, "{name} {patience}");
            assert!(asked <= patience + 2, "{name} goes on when told to stop");
            check(&world, &found, mission.start_m, mission.goal_m, Cost::Lfhh, &CostOptions::default());
        }
    }
}

/// What came before an interruption is what an equal budget gives.
#[test]
fn an_interruption_changes_nothing_before_it() {
    let world = world("lfhh-3d-1");
    let mission = world.mission();
    for name in SECTION_PLANNERS.into_iter().chain(["rrt-star", "prm-star"]) {
        let asked = AtomicU64::new(0);
        let question = || asked.fetch_add(1, Ordering::Relaxed) >= 12;
        let control = Control::ask(&question);
        let found = plan(name, &world, mission.start_m, mission.goal_m, 2, bounded(name), &control).unwrap();
        assert!(found.interrupted, "{name}");
        let again = ask(name, &world, 2, &limited(name, found.evaluations));
        assert_eq!(again, Plan { interrupted: false, ..found }, "{name}");
    }
    let set = AtomicBool::new(true);
    let flag = Control::flag(&set);
    assert!(plan("lfhh", &world, mission.start_m, mission.goal_m, 2, "", &flag).unwrap().interrupted);
}

#[test]
fn a_replan_joins_the_old_path() {
    let mut world = world("lfhh-3d-1");
    let global = ask("lfhh", &world, 0, "").waypoints;
    let vehicle = global[5];
    world.apply_change(vehicle);
    let window = Window { sections: 10, grow: true };
    let done = replan(&world, &global, vehicle, "lfhh", 7, "", window, &Control::none()).unwrap();
    assert!(done.window.feasible && done.sections >= 10);
    let target = 5 + done.sections;
    check(&world, &done.window, vehicle, global[target], Cost::Lfhh, &CostOptions::default());
    check(&world, &done.plan, vehicle, global[39], Cost::Lfhh, &CostOptions::default());
    assert_eq!(done.plan.waypoints.len(), 35);
    assert_eq!(&done.plan.waypoints[..=done.sections], &done.window.waypoints[..]);
    assert_eq!(&done.plan.waypoints[done.sections..], &global[target..]);
    let again = replan(&world, &global, vehicle, "lfhh", 7, "", window, &Control::none()).unwrap();
    assert_eq!(done, again);
}

#[test]
fn a_replan_starts_between_sections_and_ends_at_the_goal() {
    let world = world("lfhh-2d-1");
    let global = ask("lfhh", &world, 0, "").waypoints;
    let vehicle = [global[7][0] + 120.0, 7400.0, 0.0];
    let replanned = |window| replan(&world, &global, vehicle, "lfhh", 7, "", window, &Control::none()).unwrap();
    let done = replanned(Window { sections: 3, grow: false });
    assert_eq!(done.window.waypoints[0], vehicle);
    assert_eq!(done.window.waypoints.len(), 4);
    assert_eq!(done.window.waypoints[3], global[10]);
    assert_eq!((done.sections, done.attempts), (3, 1));
    let whole = replanned(Window::whole());
    assert_eq!(whole.window, Plan { evaluations: whole.window.evaluations, ..whole.plan.clone() });
    assert_eq!(whole.sections, 32);
}

#[test]
fn a_window_grows_to_the_end_and_shares_the_budget() {
    let mut scenario = scenario("lfhh-2d-1");
    scenario.change = None;
    let vertices_m = vec![[-1e3, 30e3], [21e3, 30e3], [21e3, 31e3], [-1e3, 31e3]];
    scenario.obstacles.push(Obstacle::Polygon(Polygon {
        vertices_m,
        top_m: -1.0,
        bottom_m: 1.0,
        velocity_mps: [0.0; 2],
    }));
    let world = World::new(scenario, 0, 0).unwrap();
    let mission = world.mission();
    let global: Vec<Vec3> = (0..40).map(|j| [mission.start_m[0], 1e3 * f64::from(j), 0.0]).collect();
    let window = Window { sections: 31, grow: true };
    let parameters = r#"{"generations": 2, "population": 20}"#;
    let done = replan(&world, &global, global[0], "lfhh", 0, parameters, window, &Control::none()).unwrap();
    assert_eq!((done.attempts, done.sections, done.plan.evaluations), (9, 39, 9 * 60));
    assert!(!done.plan.feasible);
    let parameters = r#"{"generations": 2, "population": 20, "max_evaluations": 150}"#;
    let done = replan(&world, &global, global[0], "lfhh", 0, parameters, window, &Control::none()).unwrap();
    assert_eq!((done.attempts, done.plan.evaluations), (3, 150));
    let error = replan(&world, &global[..1], global[0], "lfhh", 0, "", window, &Control::none()).unwrap_err();
    assert!(error.to_string().starts_with("global_path = 1 points"), "{error}");
}

#[test]
fn the_protocol_has_six_phases_and_repeats_itself() {
    let world = World::new(scenario("lfhh-3d-1"), 0, 1).unwrap();
    let done = |trigger| {
        let settings = Settings { trigger, ..Settings::default() };
        run(&world, "lfhh", 4, "", settings, &Control::none()).unwrap()
    };
    let run = done(Trigger::PathLength);
    assert_eq!(run, done(Trigger::PathLength));
    assert_eq!(run.phases.len(), 6);
    let mean = run.phases[1..].iter().map(|phase| phase.cost.total).sum::<f64>() / 5.0;
    assert_eq!(run.mean_cost, mean);
    assert_eq!(run.evaluations, run.phases.iter().map(|phase| phase.evaluations).sum::<u64>());
    for pair in run.phases.windows(2) {
        // The vehicle stands on the last waypoint of the old path that it could reach within 6 km.
        let reached = pair[0].waypoints.iter().position(|point| *point == pair[1].vehicle_m).unwrap();
        let travelled: f64 = pair[0].waypoints[..=reached].windows(2).map(|leg| distance(leg[0], leg[1])).sum();
        let next = distance(pair[0].waypoints[reached], pair[0].waypoints[reached + 1]);
        assert!(travelled <= 6e3 && travelled + next > 6e3);
    }
    let run = done(Trigger::Progress);
    let along: Vec<f64> = run.phases.iter().map(|phase| phase.vehicle_m[1]).collect();
    assert_eq!(along, [0.0, 6e3, 12e3, 18e3, 24e3, 30e3]);
}

/// F of LFHH is a fit of the scenarios' vortices to the paper's level; what is held here is that nothing
/// moves it unseen. Thirty seeds give 0.64 (sd 0.08) and 29 feasible.
#[test]
fn the_level_of_the_cost_holds() {
    let world = world("lfhh-3d-1");
    let runs: Vec<_> =
        (0..6).map(|seed| run(&world, "lfhh", seed, "", Settings::default(), &Control::none()).unwrap()).collect();
    let mean = runs.iter().map(|run| run.mean_cost).sum::<f64>() / 6.0;
    assert!((0.55..0.75).contains(&mean), "{mean}");
}
