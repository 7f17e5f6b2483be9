//! A uniform current and a vehicle that holds its course in it (velocity synthesis, eq. 9).

use auv_world::math::Vec2;

/// A vehicle in a uniform current.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drift {
    /// Speed through water V_A (m/s).
    pub speed: f64,
    /// The current V_C (m/s).
    pub current: Vec2,
}

impl Drift {
    /// The sine of the crab angle alpha_3 - alpha_2 on a leg: the current across it over the vehicle's speed. More
    /// than 1 in size where the vehicle cannot hold the course. Legs without length have none.
    #[inline]
    pub fn crab_sine(&self, leg: Vec2, length: f64) -> f64 {
        if length < SHORTEST {
            return 0.0;
        }
        (self.current[0] * leg[1] - self.current[1] * leg[0]) / (length * self.speed)
    }

    /// The heading alpha_3 (rad) that holds a course alpha_2, and the speed over ground V_E = V_A cos(alpha_3 -
    /// alpha_2) + V_C cos(alpha_1 - alpha_2) (m/s); `None` where the current wins.
    pub fn heading(&self, leg: Vec2) -> Option<(f64, f64)> {
        let length = (leg[0] * leg[0] + leg[1] * leg[1]).sqrt();
        if length < SHORTEST {
            return None;
        }
        let sine = self.crab_sine(leg, length);
        if sine.abs() > 1.0 {
            return None;
        }
        let along = (self.current[0] * leg[0] + self.current[1] * leg[1]) / length;
        let over_ground = self.speed * (1.0 - sine * sine).sqrt() + along;
        let heading = libm::atan2(leg[1], leg[0]) + libm::asin(sine);
        (over_ground > 0.0).then_some((wrap(heading), over_ground))
    }

    /// The travel time of a leg (s): length / V_E, infinite where the current wins.
    #[inline]
    pub fn time(&self, leg: Vec2, length: f64) -> f64 {
        if length < SHORTEST {
            return 0.0;
        }
        let sine = self.crab_sine(leg, length);
        let along = (self.current[0] * leg[0] + self.current[1] * leg[1]) / length;
        let over_ground = self.speed * (1.0 - sine * sine).max(0.0).sqrt() + along;
        if sine.abs() > 1.0 || over_ground <= 0.0 { f64::INFINITY } else { length / over_ground }
    }

    /// The travel time of a path (s).
    pub fn path_time(&self, path: &[Vec2]) -> f64 {
        let legs = path.windows(2).map(|pair| [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]]);
        legs.map(|leg| self.time(leg, (leg[0] * leg[0] + leg[1] * leg[1]).sqrt())).sum()
    }
}

/// Shorter legs have no direction (m).
const SHORTEST: f64 = 1e-9;

/// An angle in -pi .. pi.
fn wrap(angle: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    angle - turn * libm::round(angle / turn)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sum_of_both_velocities_runs_along_the_course() {
        for degrees in (0..360).step_by(7) {
            let course = f64::from(degrees).to_radians();
            for drift in [[0.3, 0.0], [-0.2, 0.9], [0.0, -1.4]].map(|current| Drift { speed: 1.5, current }) {
                let leg = [20.0 * libm::cos(course), 20.0 * libm::sin(course)];
                let Some((heading, over_ground)) = drift.heading(leg) else {
                    assert!(drift.time(leg, 20.0).is_infinite());
                    continue;
                };
                let velocity =
                    [1.5 * libm::cos(heading) + drift.current[0], 1.5 * libm::sin(heading) + drift.current[1]];
                for axis in 0..2 {
                    assert!((velocity[axis] - over_ground * leg[axis] / 20.0).abs() < 1e-12);
                }
                assert!((drift.time(leg, 20.0) - 20.0 / over_ground).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn a_current_faster_than_the_vehicle_wins() {
        let drift = Drift { speed: 1.0, current: [0.0, 1.1] };
        assert!(drift.heading([1.0, 0.0]).is_none() && drift.heading([0.0, -1.0]).is_none());
        assert!((drift.heading([0.0, 1.0]).unwrap().1 - 2.1).abs() < 1e-12);
        assert_eq!(drift.time([0.0, 0.0], 0.0), 0.0);
    }
}
