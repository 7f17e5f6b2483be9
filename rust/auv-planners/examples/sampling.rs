//! The sampling planners against Dijkstra's algorithm on the shipped scenarios: length and travel time of
//! their paths against the budget, and what is evaluated (motions; nodes) in a second.
//!
//! `cargo run --release -p auv-planners --example sampling [seeds [parameters as JSON]]`

use std::path::Path;
use std::time::Instant;

use auv_planners::{Control, Plan, plan};
use auv_world::{Scenario, World};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let seeds: u64 = arguments.first().map_or(Ok(5), |text| text.parse())?;
    let own = arguments.get(1).map_or("{}", String::as_str).trim().trim_start_matches('{').trim_end_matches('}');
    let own = if own.is_empty() { String::new() } else { format!(", {own}") };
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../auvgym/scenarios");
    println!("scenario   planner   budget  found  length (m)  turns  time (s)  evaluations  ms    evaluations/s");
    for name in ["lfhh-2d-1", "lfhh-3d-1"] {
        let world = World::new(Scenario::load(&folder.join(format!("{name}.toml")))?, 0, 0)?;
        let mission = world.mission();
        let ask = |planner: &str, seed: u64, parameters: &str| {
            plan(planner, &world, mission.start_m, mission.goal_m, seed, parameters, &Control::none())
        };
        for planner in ["dijkstra", "astar"] {
            let began = Instant::now();
            let found = ask(planner, 0, r#"{"inflation_m": 0, "cost": "time"}"#)?;
            report(name, planner, 0, &[found], began);
        }
        for planner in ["rrt-star", "prm-star"] {
            for budget in [1_000_u64, 5_000, 20_000] {
                let parameters = format!(r#"{{"max_evaluations": {budget}, "cost": "time"{own}}}"#);
                let began = Instant::now();
                let plans = (0..seeds).map(|seed| ask(planner, seed, &parameters)).collect::<Result<Vec<_>, _>>()?;
                report(name, planner, budget, &plans, began);
            }
        }
    }
    Ok(())
}

fn report(name: &str, planner: &str, budget: u64, plans: &[Plan], began: Instant) {
    let seconds = began.elapsed().as_secs_f64();
    let found: Vec<&Plan> = plans.iter().filter(|plan| plan.feasible).collect();
    let mean = |value: &dyn Fn(&Plan) -> f64| found.iter().map(|plan| value(plan)).sum::<f64>() / found.len() as f64;
    let runs = plans.len() as f64;
    let evaluations = plans.iter().map(|plan| plan.evaluations as f64).sum::<f64>();
    println!(
        "{name}  {planner:<8}  {budget:>6}  {:>2}/{runs:<2}  {:>10.0}  {:>5.1}  {:>8.0}  {:>11.0}  {:>4.1}  {:>11.0}",
        found.len(),
        mean(&|plan| plan.cost.path_length_m),
        mean(&|plan| plan.waypoints.len() as f64 - 2.0),
        mean(&|plan| plan.cost.time_s.unwrap_or(f64::NAN)),
        evaluations / runs,
        1e3 * seconds / runs,
        evaluations / seconds,
    );
}
