//! What the section optimum promises on whole worlds: nobody is better, and it stops when it must.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use auv_planners::optimum::{gap, reference};
use auv_planners::replanning::{Window, replan};
use auv_planners::{Control, Cost, CostOptions, Plan, path_cost, plan};
use auv_world::families::{Parameters, generate};
use auv_world::scenario::{Obstacle, Polygon};
use auv_world::{Scenario, World};
use proptest::prelude::*;

fn scenario(name: &str) -> Scenario {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../auvgym/scenarios");
    Scenario::load(&folder.join(format!("{name}.toml"))).unwrap()
}

fn ask_with(name: &str, world: &World, parameters: &str, control: &Control<'_>) -> Plan {
    let mission = world.mission();
    plan(name, world, mission.start_m, mission.goal_m, 0, parameters, control).unwrap()
}

fn ask(world: &World, parameters: &str) -> Plan {
    ask_with("section-optimum", world, parameters, &Control::none())
}

/// Costs what it says, and its history ends where it does.
fn check(world: &World, plan: &Plan, cost: Cost, options: &CostOptions) {
    let mission = world.mission();
    assert_eq!(plan.waypoints[0], mission.start_m);
    assert_eq!(plan.waypoints[plan.waypoints.len() - 1], mission.goal_m);
    let again = path_cost(world, &plan.waypoints, cost, options).unwrap();
    assert_eq!(plan.cost.total.to_bits(), again.total.to_bits());
    assert_eq!(plan.feasible, again.feasible);
    assert!(plan.history.windows(2).all(|pair| pair[1].0 > pair[0].0 && pair[1].1 <= pair[0].1));
    assert_eq!(plan.history.last(), Some(&(plan.evaluations, plan.cost.total)));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 8, ..ProptestConfig::default() })]

    #[test]
    fn plans_keep_their_promises(
        seed in 0..1000u64,
        family in prop::sample::select(vec!["lfhh-2d", "lfhh-3d"]),
        cost in prop::sample::select(vec!["lfhh", "afhh", "time", "energy"]),
        margin_m in prop::sample::select(vec![0.0, 150.0]),
        budget in 1..40u64,
    ) {
        let world = World::new(generate(family, seed, &Parameters::default()).unwrap(), seed, 0).unwrap();
        let options = CostOptions { margin_m, ..CostOptions::default() };
        let own = format!(
            r#""lateral_m": 1500, "depth_m": 3000, "cost": "{cost}", "cost_options": {{"margin_m": {margin_m}}}"#
        );
        let found = ask(&world, &format!(r#"{{{own}, "max_evaluations": {budget}}}"#));
        check(&world, &found, Cost::from_name(cost).unwrap(), &options);
        prop_assert!(found.evaluations >= 1 && found.evaluations <= budget && !found.interrupted);
        prop_assert_eq!(&found, &ask(&world, &format!(r#"{{{own}, "max_evaluations": {budget}}}"#)));
        let whole = ask(&world, &format!("{{{own}}}"));
        check(&world, &whole, Cost::from_name(cost).unwrap(), &options);
        prop_assert!(whole.cost.total <= found.cost.total);
        let lattice = ask(&world, &format!(r#"{{{own}, "polish": false}}"#));
        prop_assert!(whole.cost.total <= lattice.cost.total);
    }
}

#[test]
fn nobody_is_better_on_the_papers_worlds() {
    for (name, missions) in [("lfhh-2d-1", 3), ("lfhh-3d-1", 1), ("lfhh-3d-3", 1)] {
        for mission in 0..missions {
            let world = World::new(scenario(name), 0, mission).unwrap();
            let best = ask(&world, "");
            check(&world, &best, Cost::Lfhh, &CostOptions::default());
            assert!(best.feasible, "{name} {mission}");
            let theirs = ask_with("lfhh", &world, r#"{"stop": "exhaust"}"#, &Control::none());
            assert!(best.cost.total < theirs.cost.total, "{name} {mission}");
        }
    }
}

#[test]
fn nobody_is_better_at_the_other_costs() {
    for name in ["lfhh-2d-1", "lfhh-3d-1"] {
        let world = World::new(scenario(name), 0, 0).unwrap();
        for (planner, cost) in [("lfhh", "time"), ("rwde", "energy"), ("afhh", "afhh")] {
            let best = ask(&world, &format!(r#"{{"cost": "{cost}"}}"#));
            check(&world, &best, Cost::from_name(cost).unwrap(), &CostOptions::default());
            assert!(best.feasible, "{name} {cost}");
            let parameters = format!(r#"{{"cost": "{cost}", "max_evaluations": 10000, "stop": "exhaust"}}"#);
            let theirs = ask_with(planner, &world, &parameters, &Control::none());
            assert!(best.cost.total < theirs.cost.total, "{name} {cost}: {} {}", best.cost.total, theirs.cost.total);
        }
    }
}

#[test]
fn windows_are_planned_and_gaps_are_not_below_zero() {
    let mut world = World::new(scenario("lfhh-2d-1"), 0, 0).unwrap();
    let global = ask(&world, "").waypoints;
    world.apply_change(global[6]);
    let window = Window::default();
    for planner in ["lfhh", "section-optimum"] {
        let done = replan(&world, &global, global[6], planner, 1, "", window, &Control::none()).unwrap();
        let gap = gap(&world, &done.window, Cost::Lfhh, &CostOptions::default(), &Control::none()).unwrap();
        assert!(if planner == "lfhh" { gap > 0.01 } else { gap == 0.0 }, "{planner}: {gap}");
    }
}

#[test]
fn a_reference_is_the_planners_answer() {
    let world = World::new(scenario("lfhh-2d-1"), 0, 1).unwrap();
    let mission = world.mission();
    let options = CostOptions::default();
    let found = reference(&world, mission.start_m, mission.goal_m, Cost::Time, &options, &Control::none()).unwrap();
    assert_eq!(found, ask(&world, r#"{"cost": "time"}"#));
}

#[test]
fn a_walled_off_goal_has_no_feasible_plan() {
    let mut scenario = scenario("lfhh-2d-1");
    scenario.change = None;
    let vertices_m = vec![[-1e3, 20e3], [21e3, 20e3], [21e3, 21e3], [-1e3, 21e3]];
    let (top_m, bottom_m, velocity_mps) = (-1.0, 1.0, [0.0; 2]);
    scenario.obstacles.push(Obstacle::Polygon(Polygon { vertices_m, top_m, bottom_m, velocity_mps }));
    let world = World::new(scenario, 0, 0).unwrap();
    for cost in ["lfhh", "time"] {
        let found = ask(&world, &format!(r#"{{"cost": "{cost}"}}"#));
        check(&world, &found, Cost::from_name(cost).unwrap(), &CostOptions::default());
        // The wall is as wide as a section is long: two segments cannot but touch it, three where it begins.
        assert!(!found.feasible && found.cost.block <= 2.0 + 3.0 / 39.0 + 1e-9, "{:?}", found.cost);
    }
}

#[test]
fn ends_without_a_section_between_are_joined() {
    let world = World::new(scenario("lfhh-3d-1"), 0, 0).unwrap();
    let (start, goal) = ([5e3, 3.1e3, 5e3], [5e3, 3.9e3, 5e3]);
    let found = plan("section-optimum", &world, start, goal, 0, "", &Control::none()).unwrap();
    assert_eq!((found.waypoints, found.evaluations), (vec![start, goal], 1));
    let found = plan("section-optimum", &world, start, [6e3, 4.9e3, 6e3], 0, "", &Control::none()).unwrap();
    assert_eq!(found.waypoints.len(), 3);
}

#[test]
fn interruption_gives_the_best_so_far() {
    let world = World::new(scenario("lfhh-2d-1"), 0, 0).unwrap();
    let asked = AtomicU64::new(0);
    let count = || {
        asked.fetch_add(1, Ordering::Relaxed);
        false
    };
    let whole = ask_with("section-optimum", &world, "", &Control::ask(&count));
    let all = asked.load(Ordering::Relaxed);
    assert!(!whole.interrupted && all > 100);
    let mut last = f64::INFINITY;
    for part in [0, 1, 20, 40, 60, 80, 99] {
        let asked = AtomicU64::new(0);
        let question = || asked.fetch_add(1, Ordering::Relaxed) >= all * part / 100;
        let found = ask_with("section-optimum", &world, "", &Control::ask(&question));
        check(&world, &found, Cost::Lfhh, &CostOptions::default());
        assert!(found.interrupted && found.evaluations >= 1);
        assert!(found.cost.total <= last);
        last = found.cost.total;
    }
    assert!(last < 2.0);
}

#[test]
fn wrong_parameters_are_named() {
    let world = World::new(scenario("lfhh-2d-1"), 0, 0).unwrap();
    let mission = world.mission();
    for wrong in [r#"{"lateral_m": -1}"#, r#"{"depth_reach_m": 1e10}"#] {
        let error = plan("section-optimum", &world, mission.start_m, mission.goal_m, 0, wrong, &Control::none());
        assert!(error.unwrap_err().to_string().contains("must lie in"));
    }
    // Far too fine or too coarse a lattice is an answer, too.
    for odd in [r#"{"lateral_m": 1e-6, "max_evaluations": 1}"#, r#"{"lateral_m": 1e8}"#] {
        assert!(ask(&world, odd).evaluations >= 1);
    }
}
