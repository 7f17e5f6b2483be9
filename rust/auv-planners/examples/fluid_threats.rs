//! How often a vehicle that follows the flow arrives unharmed among random threats: four sets of them, and
//! several sets of rules.
//!
//! `cargo run --release -p auv-planners --example fluid_threats [threats of each set]`

use auv_planners::fluid::Flow;
use auv_planners::fluid::threats::{Navigator, Noise, Rules, Side};
use auv_world::World;
use auv_world::families::{Parameters, world};
use auv_world::math::{add_scaled, distance, sub};
use auv_world::rng::{Purpose, Stream};

/// Threats in a world, the fastest (m/s), and the standard deviation of measurements (m).
const SETS: [(&str, usize, f64, f64); 4] = [
    ("1 threat to 1.8 m/s", 1, 1.8, 0.0),
    ("3 threats to 1.8 m/s", 3, 1.8, 0.0),
    ("1 threat to 3 m/s", 1, 3.0, 0.0),
    ("1 threat, 20 m noise", 1, 1.8, 20.0),
];
const TICK: f64 = 6.0;
/// Looks at the truth in a tick.
const LOOKS: usize = 4;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let count: u64 = std::env::args().nth(1).map_or(Ok(200), |text| text.parse())?;
    let (plain, literal) = (Flow::default(), serde_json::from_str(r#"{"options": "literal"}"#)?);
    let bare = Rules { margin_m: 0.0, ignore_receding: false, barrier_per_s: 0.0, ..Rules::default() };
    let rules: [(&str, &Flow, Rules); 8] = [
        ("literal, reverse", &literal, bare),
        ("literal, same side", &literal, Rules { side: Side::Same, ..bare }),
        ("relative", &plain, Rules { relative: true, ..bare }),
        ("recommended", &plain, bare),
        ("+ margin", &plain, Rules { margin_m: 300.0, ..bare }),
        ("+ barrier", &plain, Rules { barrier_per_s: 0.002, ..bare }),
        ("+ barrier, receding", &plain, Rules { margin_m: 0.0, ..Rules::default() }),
        ("all three: default", &plain, Rules::default()),
    ];
    println!("{count} worlds of each set: arrived unharmed %, least clearance of those (m), mean length (km)");
    print!("{:<22}", "");
    SETS.iter().for_each(|set| print!("{:<26}", set.0));
    println!();
    for (name, flow, rules) in rules {
        print!("{name:<22}");
        for (_, threats, fastest, noise) in SETS {
            let (mut good, mut least, mut lengths) = (0_u32, f64::INFINITY, 0.0);
            for seed in 0..count {
                let (arrived, clearance, length) = fly(seed, threats, fastest, noise, flow, rules)?;
                if arrived && clearance > 0.0 {
                    good += 1;
                    least = least.min(clearance);
                    lengths += length;
                }
            }
            let share = 100.0 * f64::from(good) / count as f64;
            print!("{share:>5.1}  {least:>6.1}  {:>6.2}     ", lengths / f64::from(good) / 1e3);
        }
        println!();
    }
    Ok(())
}

/// Whether a vehicle arrives in three times the straight way's time, its least clearance and its path (m).
fn fly(
    seed: u64,
    threats: usize,
    fastest: f64,
    noise: f64,
    flow: &Flow,
    rules: Rules,
) -> Result<(bool, f64, f64), Box<dyn std::error::Error>> {
    let parameters = Parameters {
        obstacles: Some(threats),
        obstacle_speed_mps: Some(fastest),
        current_ratio: Some(0.0),
        ..Parameters::default()
    };
    let mut world: World = world("iifds", seed, &parameters)?;
    let mut stream = Stream::new(seed, Purpose::Sensor, 0);
    let [rho, sigma] = [(); 2].map(|()| stream.uniform(1.0, 2.5));
    let expected = Noise { measurement_m: noise.max(1.0), ..rules.noise };
    let rules = Rules { rho, sigma, noise: expected, ..rules };
    let (start, goal) = (world.mission().start_m, world.mission().goal_m);
    let speed = world.scenario().vehicle.speed_mps;
    let radii: Vec<f64> = world.extents().to_vec();
    let mut navigator = Navigator::new(&world, [start, goal], &radii, 1.0, flow, rules);
    let (mut here, mut time, mut length, mut clearance) = (start, 0.0, 0.0, f64::INFINITY);
    while time < 3.0 * distance(start, goal) / speed {
        for threat in 0..threats {
            let seen = world.obstacle_position(threat).map(|p| if noise > 0.0 { stream.normal(p, noise) } else { p });
            navigator.measure(threat, seen, time);
        }
        let next = navigator.course(here, time, TICK).waypoint;
        for look in 1..=LOOKS {
            let part = look as f64 / LOOKS as f64;
            world.set_time(time + part * TICK);
            clearance = clearance.min(world.spheres().clearance(add_scaled(here, part, sub(next, here))));
        }
        length += distance(here, next);
        (here, time) = (next, time + TICK);
        if here == goal {
            return Ok((true, clearance, length));
        }
    }
    Ok((false, clearance, length))
}
