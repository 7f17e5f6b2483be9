//! Actions of waypoint mode: offsets in the goal-aligned frame, and the waypoints that they stand for.

use auv_world::math::{Vec3, add_scaled, sub};

use super::Episode;

/// An action of 0 along "forward" already goes this part of the reach forward, so that an untrained
/// policy moves; -1 still backs out by half the reach.
pub const FORWARD_BIAS: f64 = 0.25;

impl Episode {
    /// Where an action of offsets in [-1, 1] (forward, left[, up]) puts the waypoint (m): forward
    /// 0.25 + 0.75 a, the others a, times the reach, clipped to the box.
    pub fn waypoint_of(&self, action: &[f32]) -> Vec3 {
        let reach = self.world.scenario().episode.reach_m;
        let mut offset = [0.0; 3];
        for (entry, value) in offset.iter_mut().zip(action) {
            *entry = f64::from(*value);
        }
        offset[0] = FORWARD_BIAS + (1.0 - FORWARD_BIAS) * offset[0];
        self.clip(add_scaled(self.state.position, reach, self.frame().to_world(offset)))
    }

    /// The action whose waypoint is `waypoint`, or lies on the way to it if that is out of reach.
    pub fn action_for(&self, waypoint: Vec3) -> [f32; 3] {
        let reach = self.world.scenario().episode.reach_m;
        let offset = self.frame().from_world(sub(waypoint, self.state.position)).map(|v| v / reach);
        let back = 2.0 * FORWARD_BIAS - 1.0;
        let mut scale = 1.0_f64;
        for (entry, (low, high)) in offset.iter().zip([(back, 1.0), (-1.0, 1.0), (-1.0, 1.0)]) {
            if *entry > high {
                scale = scale.min(high / entry);
            } else if *entry < low {
                scale = scale.min(low / entry);
            }
        }
        let action = offset.map(|v| v * scale);
        let forward = (action[0] - FORWARD_BIAS) / (1.0 - FORWARD_BIAS);
        [forward, action[1], action[2]].map(|v| v.clamp(-1.0, 1.0) as f32)
    }

    /// A point moved into the box, `waypoint_margin_m` away from its side walls, surface and bottom.
    pub(super) fn clip(&self, mut point: Vec3) -> Vec3 {
        let (domain, margin) = (&self.world.scenario().domain, self.world.scenario().episode.waypoint_margin_m);
        for axis in 0..3 {
            let (low, high) = (domain.min_m[axis], domain.max_m[axis]);
            let margin = if axis == 1 { 0.0 } else { margin.min(0.5 * (high - low)) };
            point[axis] = point[axis].clamp(low + margin, high - margin);
        }
        point
    }
}
