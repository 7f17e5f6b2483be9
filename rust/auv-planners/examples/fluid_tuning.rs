//! The comparison of tuners in table 2 of Yao & Zhao (2018), on a field of this project: best, mean and
//! standard deviation of A = A1 + 20 A2 over the seeds, and lines drawn.
//!
//! `cargo run --release -p auv-planners --example fluid_tuning [seeds]`

use std::path::Path;

use auv_planners::Control;
use auv_planners::fluid::tuning::{Mutation, tune_differential, tune_genetic};
use auv_planners::registry::Request;
use auv_world::{Scenario, World};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let seeds: u64 = std::env::args().nth(1).map_or(Ok(10), |text| text.parse())?;
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../auvgym/scenarios/iifds-static-dense.toml");
    let world = World::new(Scenario::load(&path)?, 0, 0)?;
    println!("flow         tuner               best    mean      sd   lines");
    for (flow, options) in
        [("literal", r#""options": "literal""#), ("no guard", r#""guard": false"#), ("recommended", r#""guard": true"#)]
    {
        for (name, planner, own) in [
            ("GA", "iifds-ga", ""),
            ("IGA, printed", "iifds-iga", r#""leaders": "printed","#),
            ("IGA", "iifds-iga", ""),
            ("IGA, no early end", "iifds-iga", r#""stall": 0,"#),
            ("DE 800", "iifds-de", r#""max_evaluations": 800,"#),
            ("DE 2000", "iifds-de", ""),
        ] {
            let parameters = format!(
                r#"{{{own} "cost_options": {{"collision": "segment"}}, "flow": {{"step_m": 60, "unit_m": 1000, {options}}}}}"#
            );
            let mut values = Vec::new();
            let mut lines = 0;
            for seed in 0..seeds {
                let request = Request {
                    planner,
                    world: &world,
                    start: world.mission().start_m,
                    goal: world.mission().goal_m,
                    seed,
                    stream: 0,
                    parameters: &parameters,
                    control: Control::none(),
                    evaluations_left: None,
                };
                let tuned = match planner {
                    "iifds-ga" => tune_genetic(&request, Mutation::Uniform)?,
                    "iifds-iga" => tune_genetic(&request, Mutation::GreyWolf)?,
                    _ => tune_differential(&request)?,
                };
                values.push(tuned.value);
                lines += tuned.plan.evaluations;
            }
            let n = values.len() as f64;
            let best = values.iter().copied().fold(f64::INFINITY, f64::min);
            let mean = values.iter().sum::<f64>() / n;
            let sd = (values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / (n - 1.0).max(1.0)).sqrt();
            println!("{flow:<11}  {name:<18}  {best:>5.2}   {mean:>5.2}   {sd:>5.2}   {:>5}", lines / seeds);
        }
    }
    Ok(())
}
