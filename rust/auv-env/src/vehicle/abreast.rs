//! Four vehicles steered side by side, a lane each.

use auv_world::lanes::LANES;
use wide::f64x4;

use super::{CRAB, Helm};

/// One number of each vehicle.
pub type Row = [f64; LANES];

/// The helms of four vehicles.
#[derive(Debug, Clone, Default)]
pub struct HelmLanes {
    speed: Row,
    inverse_speed: Row,
    /// Squared cosine of the greatest turn in one tick; 0 if that is a right angle or more.
    turn2: Row,
    /// Sine of the steepest pitch.
    pitch: Row,
    station_radius: Row,
    /// 0 of vehicles that never dive, 1 of others.
    dives: Row,
}

impl HelmLanes {
    /// Puts a helm into a lane.
    pub fn put(&mut self, lane: usize, helm: &Helm) {
        self.speed[lane] = helm.speed;
        self.inverse_speed[lane] = helm.inverse_speed;
        self.turn2[lane] = helm.turn.0.max(0.0).powi(2);
        self.pitch[lane] = helm.pitch.1;
        self.station_radius[lane] = helm.station_radius;
        self.dives[lane] = f64::from(u8::from(!helm.flat));
    }

    /// The headings that [`Helm::steer`] orders at full speed, and a bit for each lane where it does just that: it
    /// need not keep station, give up against the current, or turn and dive as far as it can.
    #[inline(always)]
    pub fn steer(
        &self,
        position: [f64x4; 3],
        heading: [f64x4; 3],
        waypoint: [f64x4; 3],
        current: [f64x4; 2],
    ) -> ([f64x4; 3], u32) {
        let norm = |v: [f64x4; 3]| (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
        let level2 = |v: [f64x4; 3]| v[0] * v[0] + v[1] * v[1];
        let row = f64x4::new;
        let dives = row(self.dives).simd_gt(f64x4::ZERO);
        let mut sight: [f64x4; 3] = std::array::from_fn(|axis| waypoint[axis] - position[axis]);
        sight[2] = dives.select(sight[2], f64x4::ZERO);
        let distance = norm(sight);
        let current = [current[0], current[1], f64x4::ZERO];
        let inverse = f64x4::ONE / distance;
        let direction = sight.map(|component| component * inverse);
        let along = current[0] * direction[0] + current[1] * direction[1];
        let across: [f64x4; 3] = std::array::from_fn(|axis| current[axis] - along * direction[axis]);
        let cross = norm(across);
        let (speed, inverse_speed) = (row(self.speed), row(self.inverse_speed));
        let forward = (speed * speed - cross * cross).sqrt() * inverse_speed;
        let wanted: [f64x4; 3] = std::array::from_fn(|axis| direction[axis] * forward - across[axis] * inverse_speed);
        let aligned = heading[0] * wanted[0] + heading[1] * wanted[1];
        let usual = distance.simd_gt(row(self.station_radius))
            & cross.simd_le(f64x4::splat(CRAB) * speed)
            & aligned.simd_gt(f64x4::ZERO)
            & (aligned * aligned).simd_ge(row(self.turn2) * level2(heading) * level2(wanted))
            & wanted[2].abs().simd_lt(row(self.pitch));
        (wanted, usual.to_bitmask())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use auv_world::math::Vec3;
    use auv_world::scenario::Vehicle;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]
        #[test]
        fn side_by_side_each_is_steered_as_it_would_be_alone(
            waypoints in prop::array::uniform4(prop::array::uniform3(-900.0..900.0_f64)),
            currents in prop::array::uniform4(prop::array::uniform2(-2.2..2.2_f64)),
            yaws in prop::array::uniform4(0.0..6.3_f64),
            rates in prop::array::uniform4(0.01..0.3_f64),
            pitches in prop::array::uniform4(0.2..1.6_f64),
            flat in prop::array::uniform4(any::<bool>()),
        ) {
            let helms: [Helm; LANES] = std::array::from_fn(|lane| {
                let (yaw_rate_radps, pitch_limit_rad) = (rates[lane], pitches[lane]);
                let vehicle = Vehicle { yaw_rate_radps, pitch_limit_rad, ..Vehicle::default() };
                Helm::new(&vehicle, 15.0, 100.0, flat[lane])
            });
            let headings: [Vec3; LANES] = yaws.map(|yaw| [libm::cos(yaw), libm::sin(yaw), 0.0]);
            let mut lanes = HelmLanes::default();
            helms.iter().enumerate().for_each(|(lane, helm)| lanes.put(lane, helm));
            let columns = |rows: [Vec3; LANES]| [0, 1, 2].map(|axis| f64x4::new(rows.map(|row| row[axis])));
            let flow = [0, 1].map(|axis| f64x4::new(currents.map(|current| current[axis])));
            let (wanted, usual) = lanes.steer([f64x4::ZERO; 3], columns(headings), columns(waypoints), flow);
            for lane in (0..LANES).filter(|lane| usual >> lane & 1 == 1) {
                let alone = helms[lane].steer([0.0; 3], headings[lane], waypoints[lane], currents[lane]);
                prop_assert_eq!(alone.speed, helms[lane].speed);
                prop_assert_eq!(wanted.map(|axis| axis.to_array()[lane].to_bits()), alone.heading.map(f64::to_bits));
            }
        }
    }
}
