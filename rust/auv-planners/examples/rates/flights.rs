//! Flights among random threats.

use auv_planners::fluid::Flow;
use auv_planners::fluid::threats::{Navigator, Noise, Rules};
use auv_world::World;
use auv_world::families::{Manoeuvres, Parameters, world};
use auv_world::math::{add_scaled, distance, sub};
use auv_world::rng::{Purpose, Stream};

use super::Failure;

/// Random threats of one kind.
#[derive(Debug, Clone, Copy)]
pub struct Set {
    /// In words.
    pub name: &'static str,
    /// Threats in a world.
    pub threats: usize,
    /// Speed of the fastest (m/s).
    pub fastest: f64,
    /// Standard deviation of measurements (m).
    pub noise: f64,
    /// How they manoeuvre.
    pub manoeuvres: Manoeuvres,
}

/// The four sets of threats on straight courses.
pub const STRAIGHT: [Set; 4] = [
    Set { name: "1 threat to 1.8 m/s", threats: 1, fastest: 1.8, noise: 0.0, manoeuvres: Manoeuvres::None },
    Set { name: "3 threats to 1.8 m/s", threats: 3, fastest: 1.8, noise: 0.0, manoeuvres: Manoeuvres::None },
    Set { name: "1 threat to 3 m/s", threats: 1, fastest: 3.0, noise: 0.0, manoeuvres: Manoeuvres::None },
    Set { name: "1 threat, 20 m noise", threats: 1, fastest: 1.8, noise: 20.0, manoeuvres: Manoeuvres::None },
];

const TICK: f64 = 6.0;
/// Looks at the truth in a tick.
const LOOKS: usize = 4;

/// Whether a vehicle arrives in three times the straight way's time, its least clearance and its path (m).
pub fn fly(seed: u64, set: Set, flow: &Flow, rules: Rules) -> Result<(bool, f64, f64), Failure> {
    let Set { threats, fastest, noise, manoeuvres, .. } = set;
    let parameters = Parameters {
        obstacles: Some(threats),
        obstacle_speed_mps: Some(fastest),
        current_ratio: Some(0.0),
        manoeuvres: Some(manoeuvres),
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
