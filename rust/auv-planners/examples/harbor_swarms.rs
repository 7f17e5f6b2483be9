//! Lengths that swarms end with on the reference maps, and the iteration at which they are within 1 % of their end.
//!
//! `cargo run --release -p auv-planners --example harbor_swarms [seeds] [clamp|penalty]`

use std::path::Path;

use auv_planners::maklink::fitness::{Corridor, Objective};
use auv_planners::maklink::harbor::{ZoneSettings, drift};
use auv_planners::maklink::route::Routes;
use auv_planners::maklink::swarm::{Bounds, Inertia, Rules, Swarm};
use auv_world::rng::{Purpose, Stream};
use auv_world::{Scenario, World};

const SIZE: usize = 80;
const ITERATIONS: u64 = 150;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let seeds = std::env::args().nth(1).map_or(Ok(2000), |count| count.parse::<u64>())?;
    let clamp = std::env::args().nth(2).is_none_or(|bounds| bounds == "clamp");
    let bounds = if clamp { Bounds::Clamp } else { Bounds::Penalty };
    println!("map   inertia               mean +- sd        median   95 %     iteration");
    for name in ["harbor-p", "harbor-a", "harbor-b"] {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../auvgym/scenarios/{name}.toml"));
        let world = World::new(Scenario::load(&file)?, 0, 0)?;
        let chart = ZoneSettings::default().chart(&world)?;
        let ends = [world.mission().start_m, world.mission().goal_m].map(|p| [p[0], p[1]]);
        let route = Routes::new(&chart, ends[0], ends[1])?.shortest()?;
        let corridor = Corridor::new(&chart, &route, ends, false, Objective::Length, drift(&world, Objective::Length)?);
        for (label, inertia, offset) in [
            ("linear", Inertia::Linear, 0.0),
            ("printed", Inertia::Printed, 0.0),
            ("reinforced -0.63", Inertia::Reinforced, -0.63),
            ("reinforced +0.63", Inertia::Reinforced, 0.63),
        ] {
            let (v_max, cognitive, social, iterations) = (3.0, 2.0, 2.0, ITERATIONS);
            let rules = Rules { inertia, offset, bounds, v_max, cognitive, social, iterations };
            let mut ends = Vec::new();
            let mut reached = 0;
            for seed in 0..seeds {
                let mut random = Stream::new(seed, Purpose::Planner, 0);
                let mut swarm = Swarm::new(&corridor, rules, SIZE, SIZE, &mut random);
                let mut trace = Vec::new();
                for _ in 0..ITERATIONS {
                    swarm.step(SIZE, &mut random);
                    trace.push(swarm.best_cost());
                }
                let end = swarm.best_cost();
                reached += trace.iter().position(|cost| *cost <= 1.01 * end).map_or(0, |at| at + 1);
                ends.push(2.0 * end);
            }
            let n = seeds as f64;
            let mean = ends.iter().sum::<f64>() / n;
            let deviation = (ends.iter().map(|end| (end - mean) * (end - mean)).sum::<f64>() / (n - 1.0)).sqrt();
            ends.sort_by(f64::total_cmp);
            let [median, late] = [0.5, 0.95].map(|part| ends[(part * (n - 1.0)) as usize]);
            let it = reached as f64 / n;
            println!("{name:11} {label:17} {mean:8.3} +- {deviation:5.3}  {median:8.3} {late:8.3}  {it:5.1}");
        }
    }
    Ok(())
}
