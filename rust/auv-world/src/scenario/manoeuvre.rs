//! Manoeuvres in closed form: how far one leads until some time, and how fast it goes then.

use super::check::{Checked, MOST, all_finite, at_most, finite, positive};
use super::{Leg, Manoeuvre};
use crate::error::WorldError;
use crate::math::{Vec3, add_scaled, norm};

/// Shortest period of a zigzag (s).
const SHORTEST_S: f64 = 1e-3;

impl Manoeuvre {
    /// How far it leads from the start until a time (s), for the velocity (m/s) that it departs from (m).
    pub fn travel(&self, velocity: Vec3, time_s: f64) -> Vec3 {
        match self {
            Self::Turn { rate_radps: rate } => {
                let angle = rate * time_s;
                let half = libm::sin(0.5 * angle);
                // The integrals of sine and cosine; 1 - cos written so that small angles keep their digits.
                let (along, across) = (libm::sin(angle) / rate, 2.0 * half * half / rate);
                let [u, v, w] = velocity;
                [u * along - v * across, u * across + v * along, w * time_s]
            }
            Self::Zigzag { angle_rad, period_s } => {
                let (along, across) = (libm::cos(*angle_rad) * time_s, libm::sin(*angle_rad) * wave(time_s, *period_s));
                let [u, v, w] = velocity;
                [u * along - v * across, v * along + u * across, w * time_s]
            }
            Self::Legs { legs } => {
                let mut place = [0.0; 3];
                for (from, to, velocity) in spans(legs, velocity) {
                    place = add_scaled(place, (time_s.min(to) - from).max(0.0), velocity);
                }
                place
            }
        }
    }

    /// Velocity (m/s) at a time (s), for the one that it departs from.
    pub fn velocity(&self, velocity: Vec3, time_s: f64) -> Vec3 {
        match self {
            Self::Turn { rate_radps } => turned(velocity, rate_radps * time_s),
            Self::Zigzag { angle_rad, period_s } => {
                let part = (time_s / period_s).rem_euclid(1.0);
                turned(velocity, if (0.25..0.75).contains(&part) { -angle_rad } else { *angle_rad })
            }
            Self::Legs { legs } => {
                legs.iter().take_while(|leg| leg.from_s <= time_s).last().map_or(velocity, |leg| leg.velocity_mps)
            }
        }
    }

    /// The greatest speed (m/s) it brings beyond that of the velocity it departs from.
    pub fn fastest_mps(&self) -> f64 {
        match self {
            Self::Turn { .. } | Self::Zigzag { .. } => 0.0,
            Self::Legs { legs } => legs.iter().map(|leg| norm(leg.velocity_mps)).fold(0.0, f64::max),
        }
    }
}

/// A velocity, turned on the map from x towards y.
fn turned([u, v, w]: Vec3, angle: f64) -> Vec3 {
    let (cosine, sine) = (libm::cos(angle), libm::sin(angle));
    [u * cosine - v * sine, u * sine + v * cosine, w]
}

/// A triangular wave of slope 1 or -1 that rises through 0 at the start.
fn wave(time_s: f64, period_s: f64) -> f64 {
    let part = (time_s / period_s).rem_euclid(1.0);
    period_s
        * if part < 0.25 {
            part
        } else if part < 0.75 {
            0.5 - part
        } else {
            part - 1.0
        }
}

/// Begin, end and velocity of every stretch, the first at that of the obstacle.
fn spans(legs: &[Leg], first: Vec3) -> impl Iterator<Item = (f64, f64, Vec3)> {
    let begins = std::iter::once((0.0, first)).chain(legs.iter().map(|leg| (leg.from_s, leg.velocity_mps)));
    let ends = legs.iter().map(|leg| leg.from_s).chain(std::iter::once(f64::INFINITY));
    begins.zip(ends).map(|((from, velocity), to)| (from, to, velocity))
}

pub(super) fn check_manoeuvre(key: &str, manoeuvre: Option<&Manoeuvre>, velocity: Vec3) -> Checked {
    let still = velocity[0] == 0.0 && velocity[1] == 0.0;
    match manoeuvre {
        Some(Manoeuvre::Turn { .. } | Manoeuvre::Zigzag { .. }) if still => {
            Err(WorldError::key(key, "a change of course", "needs a velocity_mps on the map that is not 0"))
        }
        Some(Manoeuvre::Turn { rate_radps }) => {
            let name = format!("{key}.rate_radps");
            finite(&name, *rate_radps)?;
            if *rate_radps != 0.0 { Ok(()) } else { Err(WorldError::key(name, rate_radps, "must not be 0")) }
        }
        Some(Manoeuvre::Zigzag { angle_rad, period_s }) => {
            finite(&format!("{key}.angle_rad"), *angle_rad)?;
            let name = format!("{key}.period_s");
            finite(&name, *period_s)?;
            if *period_s >= SHORTEST_S {
                Ok(())
            } else {
                Err(WorldError::key(name, period_s, format!("must be at least {SHORTEST_S}")))
            }
        }
        Some(Manoeuvre::Legs { legs }) => {
            at_most(&format!("{key}.legs"), legs.len(), MOST)?;
            for (i, leg) in legs.iter().enumerate() {
                let from = format!("{key}.legs[{i}].from_s");
                positive(&from, leg.from_s)?;
                all_finite(&format!("{key}.legs[{i}].velocity_mps"), &leg.velocity_mps)?;
                if i > 0 && leg.from_s <= legs[i - 1].from_s {
                    return Err(WorldError::key(from, leg.from_s, "must be later than that of the leg before"));
                }
            }
            Ok(())
        }
        None => Ok(()),
    }
}

/// Discs reach through all depths: their legs lead along the map.
pub(super) fn check_on_the_map(key: &str, manoeuvre: Option<&Manoeuvre>) -> Checked {
    let Some(Manoeuvre::Legs { legs }) = manoeuvre else { return Ok(()) };
    match legs.iter().position(|leg| leg.velocity_mps[2] != 0.0) {
        Some(i) => {
            let name = format!("{key}[{i}].velocity_mps[2]");
            Err(WorldError::key(name, legs[i].velocity_mps[2], "must be 0 for a disc, which moves on the map only"))
        }
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn legs() -> Manoeuvre {
        let leg = |from_s: f64, velocity_mps: Vec3| Leg { from_s, velocity_mps };
        Manoeuvre::Legs { legs: vec![leg(10.0, [0.0, 2.0, 0.0]), leg(15.0, [0.0; 3]), leg(20.0, [0.0, 0.0, -3.0])] }
    }

    #[test]
    fn by_hand() {
        let ahead = [2.0, 0.0, 0.1];
        assert_eq!(legs().travel(ahead, 21.0), [20.0, 10.0, 1.0 - 3.0]);
        assert_eq!(legs().travel(ahead, 5.0), [10.0, 0.0, 0.5]);
        assert_eq!((legs().velocity(ahead, 16.0), legs().velocity(ahead, 9.0)), ([0.0; 3], ahead));
        assert_eq!(legs().fastest_mps(), 3.0);
        let turn = Manoeuvre::Turn { rate_radps: 0.01 };
        // After half a circle of radius v / rate it is two radii to the side and runs back.
        let half = std::f64::consts::PI / 0.01;
        let (there, back) = (turn.travel([2.0, 0.0, 0.0], half), turn.velocity([2.0, 0.0, 0.0], half));
        assert!(there[0].abs() < 1e-9 && (there[1] - 400.0).abs() < 1e-9 && (back[0] + 2.0).abs() < 1e-12);
        let zigzag = Manoeuvre::Zigzag { angle_rad: 0.5, period_s: 100.0 };
        let period = zigzag.travel([2.0, 0.0, 0.0], 100.0);
        assert!((period[0] - 200.0 * libm::cos(0.5)).abs() < 1e-9 && period[1].abs() < 1e-9);
        assert!((zigzag.travel([2.0, 0.0, 0.0], 25.0)[1] - 50.0 * libm::sin(0.5)).abs() < 1e-9);
    }

    proptest! {
        /// The velocity is the rate of the way, and no faster than it says.
        #[test]
        fn velocity_is_the_rate_of_travel(
            kind in 0..3_usize, time in 0.0..5e3_f64, rate in 1e-6..0.05_f64, velocity in prop::array::uniform3(-3.0..3.0_f64),
        ) {
            let manoeuvre = match kind {
                0 => Manoeuvre::Turn { rate_radps: if time > 2e3 { rate } else { -rate } },
                1 => Manoeuvre::Zigzag { angle_rad: 40.0 * rate, period_s: 1.0 / rate },
                _ => legs(),
            };
            let h = 1e-3;
            let (before, after) = (manoeuvre.travel(velocity, time - h), manoeuvre.travel(velocity, time + h));
            let (early, late) = (manoeuvre.velocity(velocity, time - h), manoeuvre.velocity(velocity, time + h));
            let most = norm(velocity).max(manoeuvre.fastest_mps());
            prop_assert!(norm(early) <= most + 1e-12);
            for axis in 0..3 {
                let slope = (after[axis] - before[axis]) / (2.0 * h);
                let (low, high) = (early[axis].min(late[axis]), early[axis].max(late[axis]));
                prop_assert!((low - 1e-3..=high + 1e-3).contains(&slope), "{slope} {early:?} {late:?}");
            }
        }
    }
}
