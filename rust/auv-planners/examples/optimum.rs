//! What the population planners leave: for windows of the paper's experiment on the shipped scenarios, the cost
//! of a planner's path and of the section optimum of the same problem.
//!
//! `cargo run --release -p auv-planners --example optimum [planner [parameters as JSON [optimum's parameters]]]`

use std::path::Path;
use std::time::Instant;

use auv_planners::plan;
use auv_planners::protocol::{Settings, run};
use auv_planners::{Control, Plan};
use auv_world::{Scenario, World};

const SCENARIOS: [&str; 4] = ["lfhh-2d-1", "lfhh-3d-1", "lfhh-3d-2", "lfhh-3d-3"];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let argument = |i: usize| arguments.get(i).map_or("", String::as_str);
    let planner = if arguments.is_empty() { "lfhh" } else { argument(0) };
    let (parameters, own) = (argument(1), argument(2));
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../auvgym/scenarios");
    println!("scenario   mission phase   F {planner}  F optimum   gap     feasible     evaluations        seconds");
    for name in SCENARIOS {
        let scenario = Scenario::load(&folder.join(format!("{name}.toml")))?;
        for mission in 0..scenario.missions.len() {
            let mut world = World::new(scenario.clone(), 0, mission)?;
            let flown = run(&world, "lfhh", 0, "", Settings::default(), &Control::none())?;
            for (number, phase) in flown.phases.iter().enumerate() {
                if number > 0 {
                    world.apply_change(phase.vehicle_m);
                }
                let (start, goal) =
                    (phase.vehicle_m, phase.waypoints[phase.window_sections.min(phase.waypoints.len() - 1)]);
                let timed = |name: &str, parameters: &str| -> Result<(Plan, f64), auv_planners::PlanError> {
                    let began = Instant::now();
                    let found = plan(name, &world, start, goal, 0, parameters, &Control::none())?;
                    Ok((found, began.elapsed().as_secs_f64()))
                };
                let (theirs, their_time) = timed(planner, parameters)?;
                let (ours, our_time) = timed("section-optimum", own)?;
                println!(
                    "{name}  {mission}       {number}       {:.4}  {:.4}     {:+.4}  {}/{}  {:>7} {:>4}   {their_time:.3} {our_time:.3}",
                    theirs.cost.total,
                    ours.cost.total,
                    theirs.cost.total - ours.cost.total,
                    theirs.feasible,
                    ours.feasible,
                    theirs.evaluations,
                    ours.evaluations,
                );
            }
        }
    }
    Ok(())
}
