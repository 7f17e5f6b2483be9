//! The LFHH paper's experiment on the shipped scenarios: mean cost F of the five re-plans, its standard
//! deviation over the seeds, and the runs in which all five are feasible. The maps are this project's own,
//! with vortices placed so that LFHH comes out at the paper's level: that level is a fit, not a confirmation.
//!
//! `cargo run --release -p auv-planners --example protocol [planner [seeds [parameters as JSON]]]`

use std::path::Path;
use std::time::Instant;

use auv_planners::Control;
use auv_planners::protocol::{Settings, run};
use auv_world::{Scenario, World};

const SCENARIOS: [&str; 4] = ["lfhh-2d-1", "lfhh-3d-1", "lfhh-3d-2", "lfhh-3d-3"];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let planner = arguments.first().map_or("lfhh", String::as_str);
    let seeds: u64 = arguments.get(1).map_or(Ok(30), |text| text.parse())?;
    let parameters = arguments.get(2).map_or("", String::as_str);
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../auvgym/scenarios");
    println!("{planner} {parameters}, {seeds} seeds");
    println!("scenario   mission  F mean (sd)     F first  all feasible  evaluations  attempts  seconds");
    for name in SCENARIOS {
        let scenario = Scenario::load(&folder.join(format!("{name}.toml")))?;
        for mission in 0..scenario.missions.len() {
            let began = Instant::now();
            let world = World::new(scenario.clone(), 0, mission)?;
            let runs: Vec<_> = (0..seeds)
                .map(|seed| run(&world, planner, seed, parameters, Settings::default(), &Control::none()))
                .collect::<Result<_, _>>()?;
            let seconds = began.elapsed().as_secs_f64() / seeds as f64;
            let mean = |value: &dyn Fn(usize) -> f64| (0..runs.len()).map(value).sum::<f64>() / seeds as f64;
            let cost = mean(&|i| runs[i].mean_cost);
            let deviation =
                (mean(&|i| (runs[i].mean_cost - cost).powi(2)) * seeds as f64 / (seeds as f64 - 1.0)).sqrt();
            let first = mean(&|i| runs[i].phases[0].cost.total);
            let feasible = runs.iter().filter(|run| run.feasible).count();
            let evaluations = mean(&|i| runs[i].evaluations as f64);
            let attempts = mean(&|i| runs[i].phases.iter().map(|phase| f64::from(phase.attempts)).sum());
            println!(
                "{name}  {mission}        {cost:.3} ({deviation:.3})   {first:.3}    {feasible:>2}/{seeds}         \
                 {evaluations:>9.0}    {attempts:>5.1}    {seconds:.3}"
            );
        }
    }
    Ok(())
}
