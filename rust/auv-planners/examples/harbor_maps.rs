//! Charts of random harbours: every corner's gaps are closed, every cell is convex, and no swarm is shorter
//! than the taut string of its corridor. How often the shortest corridor by middles is not the best.
//!
//! `cargo run --release -p auv-planners --example harbor_maps [maps]`

use auv_planners::maklink::funnel::taut;
use auv_planners::maklink::harbor::ZoneSettings;
use auv_planners::maklink::route::{Routes, length};
use auv_planners::maklink::{MapError, visibility};
use auv_planners::{Control, plan};
use auv_world::World;
use auv_world::families::{Parameters, generate};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let maps = std::env::args().nth(1).map_or(Ok(1000), |count| count.parse::<u64>())?;
    let (mut planned, mut no_way, mut wrong, mut worst, mut sum, mut few) = (0, 0, 0, 0.0_f64, 0.0, 0);
    for seed in 0..maps {
        let parameters = Parameters { obstacles: Some(4 + (seed % 9) as usize), ..Parameters::default() };
        let world = World::new(generate("harbor", seed, &parameters)?, seed, 0)?;
        let chart = ZoneSettings::default().chart(&world)?;
        let mission = world.mission();
        let flat = |p: [f64; 3]| [p[0], p[1]];
        let (start, goal) = (flat(mission.start_m), flat(mission.goal_m));
        let routes = match Routes::new(&chart, start, goal).and_then(|routes| routes.shortest_few(8)) {
            Ok(routes) => routes,
            Err(MapError::NoWay { .. } | MapError::InZone { .. }) => {
                no_way += 1;
                continue;
            }
            Err(error) => return Err(error.into()),
        };
        planned += 1;
        let tight: Vec<f64> = routes.iter().map(|route| length(&taut(&chart, route, start, goal))).collect();
        let best = visibility::shortest(&chart, start, goal, &mut || false)?.map_or(0.0, |path| length(&path));
        let excess = tight[0] / best - 1.0;
        wrong += u64::from(excess > 1e-6);
        few += u64::from(tight.iter().copied().fold(f64::INFINITY, f64::min) / best > 1.0 + 1e-6);
        (worst, sum) = (worst.max(excess), sum + excess);
        if !chart.is_free(start, goal) {
            let clamped = r#"{"bounds": "clamp", "generations": 20}"#;
            let found = plan("rmpso", &world, mission.start_m, mission.goal_m, seed, clamped, &Control::none())?;
            assert!(found.cost.path_length_m >= tight[0] - 1e-6, "seed {seed}");
        }
    }
    println!("{maps} maps, {planned} with a way, {no_way} where merged zones leave none; all cells convex");
    println!("the shortest corridor by middles is not the best on {:.1} %", 100.0 * wrong as f64 / planned as f64);
    println!("mean excess {:.2} %, worst {:.1} %", 100.0 * sum / planned as f64, 100.0 * worst);
    println!("none of the 8 shortest is the best on {:.2} %", 100.0 * few as f64 / planned as f64);
    Ok(())
}
