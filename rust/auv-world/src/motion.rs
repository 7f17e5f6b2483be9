//! How things move between map changes: at constant velocity, or as their manoeuvre has it, reflected by the
//! walls of the box. Places are functions of the time alone, so that time may run either way.

use crate::math::{Vec3, sub};
use crate::scenario::{Domain, Manoeuvre};

/// Something that moves from where it last was put.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Body {
    /// Where it was put (m).
    pub base: Vec3,
    /// Its velocity (m/s) but for manoeuvres.
    pub velocity: Vec3,
}

impl Body {
    /// Where it is (m), put there at the first time and looked for at the second (s).
    #[inline]
    pub fn place(&self, manoeuvre: Option<&Manoeuvre>, times: [f64; 2], domain: &Domain) -> Vec3 {
        let travel = self.travel(manoeuvre, times);
        std::array::from_fn(|axis| reflect(self.base[axis], travel[axis], domain.min_m[axis], domain.max_m[axis]))
    }

    /// Its velocity then (m/s), turned about by the walls it has met.
    pub fn velocity(&self, manoeuvre: Option<&Manoeuvre>, times: [f64; 2], domain: &Domain) -> Vec3 {
        let travel = self.travel(manoeuvre, times);
        let velocity = manoeuvre.map_or(self.velocity, |manoeuvre| manoeuvre.velocity(self.velocity, times[1]));
        std::array::from_fn(|axis| {
            let away = reflects(self.base[axis], travel[axis], domain.min_m[axis], domain.max_m[axis]);
            if away { -velocity[axis] } else { velocity[axis] }
        })
    }

    /// How far it has gone (m) but for walls.
    #[inline]
    fn travel(&self, manoeuvre: Option<&Manoeuvre>, [put, now]: [f64; 2]) -> Vec3 {
        match manoeuvre {
            None => self.velocity.map(|speed| speed * (now - put)),
            Some(manoeuvre) => sub(manoeuvre.travel(self.velocity, now), manoeuvre.travel(self.velocity, put)),
        }
    }
}

/// Where `start` is after `travel` metres along one axis between two walls.
#[inline]
pub fn reflect(start: f64, travel: f64, low: f64, high: f64) -> f64 {
    let width = high - low;
    if travel == 0.0 {
        return start;
    }
    if width <= 0.0 {
        return low;
    }
    // Unfolded, the walls repeat with period 2 * width; every second image runs backwards.
    let unfolded = (start - low + travel).rem_euclid(2.0 * width);
    low + if unfolded <= width { unfolded } else { 2.0 * width - unfolded }
}

/// Whether, after `travel`, it runs back: it has met the walls an odd number of times.
pub fn reflects(start: f64, travel: f64, low: f64, high: f64) -> bool {
    let width = high - low;
    travel != 0.0 && width > 0.0 && (start - low + travel).rem_euclid(2.0 * width) > width
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn bounces() {
        assert_eq!(reflect(8.0, 4.0, 0.0, 10.0), 8.0);
        assert_eq!(reflect(8.0, -9.0, 0.0, 10.0), 1.0);
        assert_eq!(reflect(8.0, 0.0, 0.0, 10.0), 8.0);
        assert!(reflects(8.0, 4.0, 0.0, 10.0) && !reflects(8.0, 1.0, 0.0, 10.0));
    }

    proptest! {
        #[test]
        fn stays_inside_and_comes_back(start in 0.0..10.0_f64, travel in -1e4..1e4_f64) {
            let there = reflect(start, travel, 0.0, 10.0);
            prop_assert!((0.0..=10.0).contains(&there));
            prop_assert!((reflect(start, travel + 20.0, 0.0, 10.0) - there).abs() < 1e-9);
        }
    }
}
