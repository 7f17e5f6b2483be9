//! How often a vehicle that follows the flow arrives unharmed among random threats: four sets of them on
//! straight courses and four that manoeuvre, and several sets of rules.
//!
//! `cargo run --release -p auv-planners --example fluid_threats [threats of each set]`

use auv_planners::fluid::Flow;
use auv_planners::fluid::threats::{Noise, Prediction, Rules, Side};
use auv_world::families::Manoeuvres;
use flights::{STRAIGHT, Set, fly};

#[path = "rates/flights.rs"]
mod flights;

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let count: u64 = std::env::args().nth(1).map_or(Ok(200), |text| text.parse())?;
    let (plain, literal) = (Flow::default(), serde_json::from_str(r#"{"options": "literal"}"#)?);
    let default = Rules::default();
    let bare = Rules { margin_m: 0.0, ignore_receding: false, barrier_per_s: 0.0, ..default };
    let agile = |process: f64| Rules { noise: Noise { process, ..default.noise }, ..default };
    let rules: [(&str, &Flow, Rules); 14] = [
        ("literal, reverse", &literal, bare),
        ("literal, same side", &literal, Rules { side: Side::Same, ..bare }),
        ("relative", &plain, Rules { relative: true, ..bare }),
        ("recommended", &plain, bare),
        ("+ latch of 30 degrees", &plain, Rules { latch_rad: 30_f64.to_radians(), ..bare }),
        ("+ latch for good", &plain, Rules { latch_rad: std::f64::consts::FRAC_PI_2, ..bare }),
        ("+ all of the horizon", &plain, Rules { prediction: Prediction::All, ..bare }),
        ("+ margin", &plain, Rules { margin_m: 300.0, ..bare }),
        ("+ barrier", &plain, Rules { barrier_per_s: 0.002, ..bare }),
        ("+ barrier, receding", &plain, Rules { margin_m: 0.0, ..default }),
        ("all three: default", &plain, default),
        ("  latch for good", &plain, Rules { latch_rad: std::f64::consts::FRAC_PI_2, ..default }),
        ("  process 1e-4", &plain, agile(1e-4)),
        ("  process 1e-3", &plain, agile(1e-3)),
    ];
    println!("{count} worlds of each set: arrived unharmed %, least clearance of those (m), mean length (km)");
    table(count, &STRAIGHT, &rules)?;
    println!();
    println!("the same threats, half of them in circles, half zigzagging");
    table(count, &STRAIGHT.map(|set| Set { manoeuvres: Manoeuvres::Mixed, ..set }), &rules)
}

fn table(count: u64, sets: &[Set], rules: &[(&str, &Flow, Rules)]) -> Result<(), Failure> {
    print!("{:<24}", "");
    sets.iter().for_each(|set| print!("{:<26}", set.name));
    println!();
    for (name, flow, rules) in rules {
        print!("{name:<24}");
        for set in sets {
            let (mut good, mut least, mut lengths) = (0_u32, f64::INFINITY, 0.0);
            for seed in 0..count {
                let (arrived, clearance, length) = fly(seed, *set, flow, *rules)?;
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
