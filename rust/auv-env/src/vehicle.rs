//! A kinematic vehicle under line-of-sight guidance that crabs against the current.

use auv_world::math::{Vec2, Vec3, norm, sub};
use auv_world::scenario::Vehicle;

mod abreast;

pub use abreast::{HelmLanes, Row};

/// Of its speed the vehicle gives at most this part to holding against a cross current.
const CRAB: f64 = 0.98;

/// How fast a vehicle turns and climbs within one tick; made once an episode.
#[derive(Debug, Clone, Copy)]
pub struct Helm {
    speed: f64,
    inverse_speed: f64,
    /// Cosine and sine of the greatest turn in one tick.
    turn: (f64, f64),
    /// Cosine and sine of the steepest pitch.
    pitch: (f64, f64),
    station_radius: f64,
    flat: bool,
}

/// What the helm decides for one tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Order {
    /// Unit vector of the motion through the water.
    pub heading: Vec3,
    /// Speed through the water (m/s).
    pub speed: f64,
}

impl Helm {
    /// The helm of a vehicle for ticks of `tick_s`; in 2-D (`flat`) it never dives.
    pub fn new(vehicle: &Vehicle, tick_s: f64, station_radius: f64, flat: bool) -> Self {
        let turn = (vehicle.yaw_rate_radps * tick_s).min(std::f64::consts::PI);
        let pitch = vehicle.pitch_limit_rad.min(std::f64::consts::FRAC_PI_2);
        Self {
            speed: vehicle.speed_mps,
            inverse_speed: 1.0 / vehicle.speed_mps,
            turn: (libm::cos(turn), libm::sin(turn)),
            pitch: (libm::cos(pitch).max(0.0), libm::sin(pitch)),
            station_radius,
            flat,
        }
    }

    /// Steers from `position` with `heading` towards `waypoint` in a `current`.
    ///
    /// The wanted motion over ground is along the line of sight: the heading takes up the cross current,
    /// heading = (d sqrt(V^2 - c_perp^2) - c_perp) / V. Near the waypoint the vehicle keeps station with
    /// no more speed than the current asks for.
    pub fn steer(&self, position: Vec3, heading: Vec3, waypoint: Vec3, current: Vec2) -> Order {
        let mut sight = sub(waypoint, position);
        if self.flat {
            sight[2] = 0.0;
        }
        let distance = norm(sight);
        let current = [current[0], current[1], 0.0];
        if distance <= self.station_radius {
            let flow = norm(current);
            if flow == 0.0 {
                return Order { heading, speed: 0.0 };
            }
            let against = self.limit(heading, [-current[0] / flow, -current[1] / flow, 0.0]);
            return Order { heading: against, speed: flow.min(self.speed) };
        }
        let inverse = 1.0 / distance;
        let direction = sight.map(|component| component * inverse);
        let along = current[0] * direction[0] + current[1] * direction[1];
        let across: Vec3 = std::array::from_fn(|i| current[i] - along * direction[i]);
        let mut cross = norm(across);
        let mut scale = 1.0;
        if cross > CRAB * self.speed {
            scale = CRAB * self.speed / cross;
            cross = CRAB * self.speed;
        }
        let forward = (self.speed * self.speed - cross * cross).sqrt();
        let (forward, scale) = (forward * self.inverse_speed, scale * self.inverse_speed);
        let wanted = std::array::from_fn(|i| direction[i] * forward - across[i] * scale);
        Order { heading: self.limit(heading, wanted), speed: self.speed }
    }

    /// The heading nearest to `wanted` that yaw rate and pitch limit allow in one tick.
    fn limit(&self, heading: Vec3, wanted: Vec3) -> Vec3 {
        let level2 = |v: Vec3| v[0] * v[0] + v[1] * v[1];
        let aligned = heading[0] * wanted[0] + heading[1] * wanted[1];
        let within =
            aligned > 0.0 && aligned * aligned >= self.turn.0.max(0.0).powi(2) * level2(heading) * level2(wanted);
        // The usual case costs neither root nor quotient.
        if within && wanted[2].abs() < self.pitch.1 { wanted } else { self.turn_and_pitch(heading, wanted) }
    }

    fn turn_and_pitch(&self, heading: Vec3, wanted: Vec3) -> Vec3 {
        let length = |v: Vec3| (v[0] * v[0] + v[1] * v[1]).sqrt();
        let (had, asked) = (length(heading), length(wanted));
        let mut level = match (had > 1e-9, asked > 1e-9) {
            (true, _) => [heading[0] / had, heading[1] / had],
            (false, true) => [wanted[0] / asked, wanted[1] / asked],
            (false, false) => [0.0, 1.0],
        };
        if asked > 1e-9 {
            let goal = [wanted[0] / asked, wanted[1] / asked];
            if level[0] * goal[0] + level[1] * goal[1] >= self.turn.0 {
                level = goal;
            } else {
                let left = level[0] * goal[1] - level[1] * goal[0] >= 0.0;
                let (c, s) = (self.turn.0, if left { self.turn.1 } else { -self.turn.1 });
                level = [c * level[0] - s * level[1], s * level[0] + c * level[1]];
            }
        }
        let (horizontal, vertical) = if wanted[2].abs() > self.pitch.1 || asked < self.pitch.0 {
            (self.pitch.0, self.pitch.1.copysign(wanted[2]))
        } else {
            (asked, wanted[2])
        };
        [level[0] * horizontal, level[1] * horizontal, vertical]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn helm(vehicle: Vehicle) -> Helm {
        Helm::new(&vehicle, 15.0, 100.0, false)
    }

    #[test]
    fn crabs_so_that_the_track_points_at_the_waypoint() {
        let helm = helm(Vehicle { yaw_rate_radps: 10.0, ..Vehicle::default() });
        let current = [0.9, -0.4];
        let order = helm.steer([0.0; 3], [0.0, 1.0, 0.0], [3000.0, 4000.0, 1000.0], current);
        let track = [
            order.speed * order.heading[0] + current[0],
            order.speed * order.heading[1] + current[1],
            order.speed * order.heading[2],
        ];
        let speed = norm(track);
        let wanted = [3000.0, 4000.0, 1000.0].map(|v: f64| v / 26.0e6_f64.sqrt());
        for axis in 0..3 {
            assert!((track[axis] / speed - wanted[axis]).abs() < 1e-12);
        }
    }

    #[test]
    fn turns_no_faster_than_the_yaw_rate() {
        let helm = helm(Vehicle { yaw_rate_radps: 0.02, ..Vehicle::default() });
        let order = helm.steer([0.0; 3], [0.0, 1.0, 0.0], [5000.0, 0.0, 0.0], [0.0, 0.0]);
        assert!((libm::atan2(order.heading[0], order.heading[1]) - 0.3).abs() < 1e-12);
    }

    #[test]
    fn keeps_station_without_haste() {
        let helm = helm(Vehicle { yaw_rate_radps: 10.0, ..Vehicle::default() });
        let order = helm.steer([0.0; 3], [0.0, 1.0, 0.0], [10.0, 0.0, 0.0], [0.3, 0.4]);
        assert!((order.speed - 0.5).abs() < 1e-12 && (order.heading[0] + 0.6).abs() < 1e-12);
        assert_eq!(helm.steer([0.0; 3], [0.0, 1.0, 0.0], [10.0, 0.0, 0.0], [0.0, 0.0]).speed, 0.0);
    }

    proptest! {
        #[test]
        fn headings_are_unit_and_within_the_pitch_limit(
            at in prop::array::uniform3(-5e3..5e3_f64), c in prop::array::uniform2(-3.0..3.0_f64), yaw in 0.0..6.3_f64,
        ) {
            let limit = 0.5;
            let helm = helm(Vehicle { pitch_limit_rad: limit, ..Vehicle::default() });
            let order = helm.steer([0.0; 3], [libm::cos(yaw), libm::sin(yaw), 0.0], at, c);
            prop_assert!((norm(order.heading) - 1.0).abs() < 1e-9);
            prop_assert!(order.heading[2].abs() <= libm::sin(limit) + 1e-12);
        }
    }
}
