//! What the coefficients are tuned for (eq. 20-25), or time, or energy.

use auv_world::World;
use auv_world::kinematics::ground_speed;
use auv_world::math::{Vec3, acos, add_scaled, norm, sub};
use serde::Deserialize;

use crate::error::{PlanError, within};

/// What is minimised.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// A of eq. 25: weighted length (km) and mean angle to the current.
    #[default]
    Paper,
    /// Travel time (s) of a vehicle that crabs along the line.
    Time,
    /// The energy (J) that takes.
    Energy,
}

/// What is minimised, and its weights.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Objective {
    /// What.
    pub kind: Kind,
    /// eta1: weight of the length in km.
    pub eta1: f64,
    /// eta2: weight of the mean angle to the current (rad).
    pub eta2: f64,
}

impl Default for Objective {
    /// The paper's table 2.
    fn default() -> Self {
        Self { kind: Kind::Paper, eta1: 1.0, eta2: 20.0 }
    }
}

const KM: f64 = 1000.0;
/// A ground speed below this part of the speed through water counts as beaten.
const SLOWEST: f64 = 0.05;

impl Objective {
    /// Checks every value.
    ///
    /// # Errors
    /// [`PlanError::Parameter`] naming the first that is not allowed.
    pub fn check(&self) -> Result<(), PlanError> {
        within("objective.eta1", self.eta1, 0.0, 1e9)?;
        within("objective.eta2", self.eta2, 0.0, 1e9)
    }

    /// The value of a line that meets nothing.
    pub fn value(&self, world: &World, path: &[Vec3]) -> f64 {
        match self.kind {
            Kind::Paper => {
                let [length, angle] = length_and_angle(world, path);
                self.eta1 * length / KM + self.eta2 * angle
            }
            Kind::Time => time(world, path),
            Kind::Energy => {
                let vehicle = &world.scenario().vehicle;
                time(world, path) * vehicle.power_w(vehicle.speed_mps)
            }
        }
    }
}

/// The segments of a path: middle, direction, length (m).
fn segments(path: &[Vec3]) -> impl Iterator<Item = (Vec3, Vec3, f64)> {
    path.windows(2).map(|pair| {
        let step = sub(pair[1], pair[0]);
        let length = norm(step);
        let direction = if length > 0.0 { step.map(|s| s / length) } else { [0.0; 3] };
        (add_scaled(pair[0], 0.5, step), direction, length)
    })
}

/// A1 (m) and A2 (rad) of eq. 21-22; the angle to water at rest is a right one.
pub fn length_and_angle(world: &World, path: &[Vec3]) -> [f64; 2] {
    let (mut length, mut angle, mut count) = (0.0, 0.0, 0.0);
    for (middle, direction, step) in segments(path) {
        let [u, v] = world.current(middle);
        let speed = (u * u + v * v).sqrt();
        let cosine = if speed > 0.0 { (u * direction[0] + v * direction[1]) / speed } else { 0.0 };
        length += step;
        angle += acos(cosine);
        count += 1.0;
    }
    [length, angle / count]
}

/// Travel time (s); infinite if the current wins anywhere.
fn time(world: &World, path: &[Vec3]) -> f64 {
    let speed = world.scenario().vehicle.speed_mps;
    segments(path)
        .map(|(middle, direction, length)| {
            let over_ground = ground_speed(direction, world.current(middle), speed);
            if over_ground > SLOWEST * speed { length / over_ground } else { f64::INFINITY }
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use auv_world::scenario::{Current, Uniform};

    #[test]
    fn terms_by_hand() {
        let mut scenario = testing::paper_scenario("iifds-threat1");
        scenario.currents = vec![Current::Uniform(Uniform { velocity_mps: [1.0, 0.0] })];
        let world = World::new(scenario.clone(), 0, 0).unwrap();
        let path = [[0.0, 0.0, 100.0], [1e3, 0.0, 100.0], [1e3, 3e3, 100.0], [0.0, 3e3, 100.0]];
        let [length, angle] = length_and_angle(&world, &path);
        assert_eq!(length, 5e3);
        assert!((angle - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
        let objective = Objective { eta1: 2.0, eta2: 10.0, ..Objective::default() };
        assert!((objective.value(&world, &path) - 10.0 - 5.0 * std::f64::consts::PI).abs() < 1e-9);
        // 3 m/s along, the root of 3 across, 1 m/s against.
        let seconds = Objective { kind: Kind::Time, ..objective }.value(&world, &path);
        assert!((seconds - 1e3 / 3.0 - 3e3 / 3.0_f64.sqrt() - 1e3).abs() < 1e-9);
        let joules = Objective { kind: Kind::Energy, ..objective }.value(&world, &path);
        assert!((joules / seconds - 100.0).abs() < 1e-9);
        scenario.currents = vec![Current::Uniform(Uniform { velocity_mps: [0.0, 2.0] })];
        let beaten = World::new(scenario, 0, 0).unwrap();
        assert_eq!(Objective { kind: Kind::Time, ..objective }.value(&beaten, &path), f64::INFINITY);
    }
}
