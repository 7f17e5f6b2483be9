//! Costs of random candidates, re-planning in a window, and the whole six-phase experiment, on one core.

use std::path::Path;

use auv_planners::protocol::{Settings, run};
use auv_planners::replanning::{Window, replan};
use auv_planners::sections::SectionProblem;
use auv_planners::{Control, Cost, CostOptions, plan};
use auv_world::rng::{Purpose, Stream};
use auv_world::{Scenario, World};
use divan::counter::ItemsCount;

const CANDIDATES: usize = 256;

fn main() {
    divan::main();
}

fn scenario(name: &str) -> Scenario {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../auvgym/scenarios/{name}.toml"));
    Scenario::load(&path).expect("a shipped scenario")
}

fn world(name: &str) -> World {
    World::new(scenario(name), 0, 0).expect("a good world")
}

fn evaluate(bencher: divan::Bencher, name: &str, cost: Cost, spread_m: f64) {
    let world = world(name);
    let mission = world.mission();
    let options = CostOptions::default();
    let mut problem =
        SectionProblem::new(&world, mission.start_m, mission.goal_m, cost, &options).expect("a good mission");
    let found = plan("lfhh", &world, mission.start_m, mission.goal_m, 0, "", &Control::none()).expect("a plan");
    let mut stream = Stream::new(1, Purpose::Planner, 0);
    let inner = problem.inner();
    let candidates: Vec<Vec<f64>> = (0..CANDIDATES)
        .map(|_| {
            (0..problem.genes())
                .map(|gene| {
                    let waypoint = found.waypoints[gene % inner + 1];
                    let place = if gene < inner { waypoint[0] } else { waypoint[2] };
                    let (low, high) = (problem.low()[gene], problem.high()[gene]);
                    stream.uniform((place - spread_m).max(low), (place + spread_m).min(high))
                })
                .collect()
        })
        .collect();
    bencher
        .counter(ItemsCount::new(CANDIDATES))
        .bench_local(|| candidates.iter().map(|genes| problem.evaluate(genes).total).sum::<f64>());
}

/// Paths of 40 waypoints drawn from the whole box: the start of a search.
#[divan::bench(args = ["lfhh-2d-1", "lfhh-3d-1"])]
fn evaluate_random(bencher: divan::Bencher, name: &str) {
    evaluate(bencher, name, Cost::Lfhh, 1e9);
}

/// Paths of 40 waypoints within 1 km of a good path: the end of a search.
#[divan::bench(args = ["lfhh-2d-1", "lfhh-3d-1"])]
fn evaluate_converged(bencher: divan::Bencher, name: &str) {
    evaluate(bencher, name, Cost::Lfhh, 1e3);
}

/// The same, cost `afhh`.
#[divan::bench(args = ["lfhh-3d-1"])]
fn evaluate_afhh(bencher: divan::Bencher, name: &str) {
    evaluate(bencher, name, Cost::Afhh, 1e3);
}

/// A whole search with AFHH's cost: its paper's 5 000 000 evaluations, by its planner and its rivals.
#[divan::bench(args = ["afhh", "fhh", "pso", "rwde", "ade"], sample_count = 2)]
fn afhh_run(bencher: divan::Bencher, planner: &str) {
    let world = world("afhh-1");
    let mission = world.mission();
    let parameters = r#"{"cost": "afhh", "max_evaluations": 5000000, "stop": "exhaust"}"#;
    bencher
        .counter(ItemsCount::new(5_000_000_u64))
        .bench_local(|| plan(planner, &world, mission.start_m, mission.goal_m, 0, parameters, &Control::none()));
}

/// The same, cost `time`.
#[divan::bench(args = ["lfhh-2d-1", "lfhh-3d-1"])]
fn evaluate_time(bencher: divan::Bencher, name: &str) {
    evaluate(bencher, name, Cost::Time, 1e3);
}

/// A problem made from a world: cell map and obstacle lists.
#[divan::bench(args = ["lfhh-2d-1", "lfhh-3d-1"])]
fn make_problem(bencher: divan::Bencher, name: &str) {
    let world = world(name);
    let mission = world.mission();
    let options = CostOptions::default();
    bencher.bench_local(|| SectionProblem::new(&world, mission.start_m, mission.goal_m, Cost::Lfhh, &options));
}

/// The experiment: a plan and five re-plans.
#[divan::bench(args = ["lfhh-2d-1", "lfhh-3d-1"], sample_count = 20)]
fn six_phases(bencher: divan::Bencher, name: &str) {
    let world = world(name);
    let mut seed = 0;
    bencher.bench_local(|| {
        seed += 1;
        run(&world, "lfhh", seed, "", Settings::default(), &Control::none())
    });
}

/// A re-plan in the default window after the first change.
#[divan::bench(args = ["lfhh-2d-1", "lfhh-3d-1"], sample_count = 20)]
fn replan_in_window(bencher: divan::Bencher, name: &str) {
    let mut world = world(name);
    let mission = world.mission().clone();
    let path =
        plan("lfhh", &world, mission.start_m, mission.goal_m, 0, "", &Control::none()).expect("a plan").waypoints;
    world.apply_change(path[5]);
    let mut seed = 0;
    bencher.bench_local(|| {
        seed += 1;
        replan(&world, &path, path[5], "lfhh", seed, "", Window::default(), &Control::none())
    });
}
