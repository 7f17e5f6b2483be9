//! Families of scenarios: (family, parameters, seed) -> Scenario.
//!
//! `lfhh-2d` and `lfhh-3d` draw worlds like those of the LFHH paper: a sea surface with discs, a box with
//! spheres over peaks; vortices; a map that changes every 6 km travelled. The `debiased` variant, the
//! default, draws everything evenly over the box and the vortices' senses at random; the `paper` variant
//! keeps the papers' distributions, whose equal-signed vortices round x = 13.5 km make the east side
//! flow to the goal. `afhh` draws tanks like those of the AFHH paper, a thousandth of that size: spheres
//! over peaks in still water, and nothing ever changes. `iifds` draws threats on courses that meet the vehicle,
//! `harbor` basins with polygons.

mod draw;
mod harbor;
mod iifds;
mod layout;

use serde::{Deserialize, Serialize};

use crate::World;
use crate::error::WorldError;
use crate::scenario::Scenario;
use draw::Draw;
use layout::{LAYOUTS, Layout};

/// The families there are.
pub const FAMILIES: [&str; 5] = ["lfhh-2d", "lfhh-3d", "afhh", "iifds", "harbor"];

/// How hard a world is: the time limit and the currents make it so, not the number of obstacles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Difficulty {
    /// Weak currents.
    Easy,
    /// Currents that matter.
    #[default]
    Normal,
    /// Currents nearly as fast as the vehicle, or faster.
    Hard,
}

/// Whose distributions are drawn from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Variant {
    /// Everything even over the box, vortices turning either way.
    #[default]
    Debiased,
    /// The papers' distributions.
    Paper,
}

/// How threats manoeuvre.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Manoeuvres {
    /// Not at all.
    #[default]
    None,
    /// Each goes round in a circle of its own.
    Turn,
    /// Each zigzags about its course.
    Zigzag,
    /// Each does one of these.
    Mixed,
}

/// Parameters of the families; what is left out follows from family, difficulty and variant. Not every
/// family knows them all.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Parameters {
    /// How hard.
    pub difficulty: Difficulty,
    /// Whose distributions.
    pub variant: Variant,
    /// Number of discs (lfhh-2d 22) or spheres (lfhh-3d 70; afhh 60, 120, 200 by difficulty) or threats
    /// (iifds 3) or polygons (harbor 8, 14, 20 by difficulty).
    pub obstacles: Option<usize>,
    /// Number of vortices (6, afhh 0).
    pub vortices: Option<usize>,
    /// Number of peaks (lfhh-3d 12, afhh 5), 3-D only.
    pub peaks: Option<usize>,
    /// f: the fastest summed current of every map over the vehicle's speed, sampled on the vortices'
    /// rings of greatest speed.
    pub current_ratio: Option<f64>,
    /// Instead of `current_ratio`: the ring speed of one vortex over the vehicle's speed. The summed
    /// field of equal-signed vortices is about twice as fast.
    pub ring_ratio: Option<f64>,
    /// Time limit over still-water straight-line time.
    pub time_factor: Option<f64>,
    /// Vehicle speed through water (m/s), 2 (afhh 0.5).
    pub vehicle_speed_mps: Option<f64>,
    /// Path length between map changes (m), 6000 (afhh 0); 0 = the map never changes.
    pub change_every_m: Option<f64>,
    /// Speed of every obstacle between changes (m/s), 0.
    pub obstacle_speed_mps: Option<f64>,
    /// Speed of every vortex centre between changes (m/s), 0.
    pub vortex_drift_mps: Option<f64>,
    /// How threats manoeuvre (iifds only), not at all.
    pub manoeuvres: Option<Manoeuvres>,
    /// Noise of seen obstacles (m), 0 (iifds 20).
    pub sensor_noise_m: Option<f64>,
    /// Number of vessels under way, 0 (harbor only).
    pub vessels: Option<usize>,
}

/// Draws a scenario of a family.
///
/// # Errors
/// [`WorldError`] for an unknown family or a parameter that is not allowed, by name.
pub fn generate(family: &str, seed: u64, parameters: &Parameters) -> Result<Scenario, WorldError> {
    if parameters.manoeuvres.is_some() && family != "iifds" {
        return Err(WorldError::parameter("manoeuvres", "given", "only the threats of the family iifds manoeuvre"));
    }
    match family {
        "iifds" => return iifds::draw(seed, parameters),
        "harbor" => return harbor::draw(seed, parameters),
        _ => {}
    }
    let layout = LAYOUTS.iter().find(|layout| layout.name == family).ok_or_else(|| {
        let allowed = format!("the families are {}", FAMILIES.join(", "));
        WorldError::parameter("family", format!("\"{family}\""), allowed)
    })?;
    Draw::new(layout, seed, parameters)?.scenario(seed)
}

/// A number that may be left out.
fn not_negative(name: &str, value: Option<f64>, default: f64) -> Result<f64, WorldError> {
    match value {
        Some(value) if !(value.is_finite() && value >= 0.0) => {
            Err(WorldError::parameter(name, value, "must be a finite number, not negative"))
        }
        value => Ok(value.unwrap_or(default)),
    }
}

/// A count that may be left out.
fn few(name: &str, value: Option<usize>) -> Result<(), WorldError> {
    match value {
        Some(count) if count > 10_000 => Err(WorldError::parameter(name, count, "at most 10000")),
        _ => Ok(()),
    }
}

/// The world of a drawn scenario, for episodes by the thousand: what a family draws is known to be allowed
/// (a test holds that), so it is not checked again.
///
/// # Errors
/// As [`generate`].
pub fn world(family: &str, seed: u64, parameters: &Parameters) -> Result<World, WorldError> {
    generate(family, seed, parameters).map(|scenario| World::trusted(scenario, seed))
}

#[cfg(test)]
mod tests {
    use super::draw::MARGIN;
    use super::*;
    use crate::rng::{Purpose, Stream};

    #[test]
    fn same_seed_same_scenario_and_it_is_allowed() {
        for family in FAMILIES {
            for (seed, difficulty) in [(1, Difficulty::Easy), (2, Difficulty::Normal), (3, Difficulty::Hard)] {
                for variant in [Variant::Debiased, Variant::Paper] {
                    let parameters = Parameters { difficulty, variant, ..Parameters::default() };
                    let one = generate(family, seed, &parameters).unwrap();
                    assert_eq!(one, generate(family, seed, &parameters).unwrap());
                    one.check().unwrap();
                    let point = [7e3, 2e4, 9e3];
                    let trusted = world(family, seed, &parameters).unwrap();
                    assert_eq!(trusted.clearance(point), World::new(one, seed, 0).unwrap().clearance(point));
                }
            }
        }
        let normal = Parameters::default();
        assert_ne!(generate("lfhh-2d", 1, &normal).unwrap(), generate("lfhh-2d", 2, &normal).unwrap());
    }

    #[test]
    fn the_fastest_current_is_the_ratio() {
        let parameters = Parameters { current_ratio: Some(0.5), ..Parameters::default() };
        let mut world = World::new(generate("lfhh-2d", 5, &parameters).unwrap(), 5, 0).unwrap();
        for _ in 0..3 {
            let mut fastest = 0.0_f64;
            for i in 0..200 {
                for j in 0..400 {
                    let [u, v] = world.current([f64::from(i) * 100.0, f64::from(j) * 100.0, 0.0]);
                    fastest = fastest.max((u * u + v * v).sqrt());
                }
            }
            // Sampled at eight points a ring: a little more in between.
            assert!((0.99..1.15).contains(&fastest), "{fastest}");
            assert!(world.apply_change([10_000.0, 20_000.0, 0.0]));
        }
    }

    #[test]
    fn a_change_keeps_away_from_the_vehicle() {
        let mut world = World::new(generate("lfhh-3d", 8, &Parameters::default()).unwrap(), 8, 0).unwrap();
        let vehicle = world.mission().start_m;
        let before = world.spheres().clearance(vehicle);
        assert!(before >= 1e3 * MARGIN);
        for _ in 0..50 {
            world.apply_change(vehicle);
            assert!(world.spheres().clearance(vehicle) >= 1e3 * MARGIN - 1e-9);
            assert!(world.spheres().clearance(world.mission().goal_m) >= 1e3 * MARGIN - 1e-9);
        }
    }

    /// A random walk in worlds at rest and in motion: following the nearest solid changes no bit of the clearance.
    #[test]
    fn following_a_neighbour_finds_what_looking_round_does() {
        for family in FAMILIES {
            for speed in [None, Some(0.8)] {
                let vessels = (family == "harbor" && speed.is_some()).then_some(6);
                let moving = Parameters { obstacle_speed_mps: speed, vessels, ..Parameters::default() };
                let mut world = world(family, 4, &moving).unwrap();
                let mut stream = Stream::new(9, Purpose::Planner, 0);
                let (low, high) = (world.scenario().domain.min_m, world.scenario().domain.max_m);
                let stride = 2e-3 * (high[1] - low[1]);
                let (mut point, mut neighbour) = (world.mission().start_m, None);
                for tick in 0..4000 {
                    world.set_time(15.0 * f64::from(tick));
                    for axis in 0..usize::from(world.scenario().dimensions) {
                        point[axis] = (point[axis] + stream.uniform(-stride, stride)).clamp(low[axis], high[axis]);
                    }
                    let within = if tick % 3 == 0 { f64::INFINITY } else { 40.0 * stride };
                    let followed = world.clearance_along(point, within, &mut neighbour);
                    let looked = world.clearance_within(point, within);
                    assert_eq!(followed.to_bits(), looked.to_bits(), "{family} {speed:?} {tick}");
                }
            }
        }
    }

    #[test]
    fn unknown_and_contradictory() {
        let normal = Parameters::default();
        assert!(generate("lfhh", 1, &normal).unwrap_err().to_string().contains("lfhh-2d"));
        let both = Parameters { ring_ratio: Some(0.1), current_ratio: Some(0.1), ..normal.clone() };
        assert!(generate("lfhh-2d", 1, &both).is_err());
        let crowded = Parameters { obstacles: Some(20_000), ..normal };
        assert!(generate("lfhh-2d", 1, &crowded).unwrap_err().to_string().contains("obstacles"));
    }
}
