//! The goal-aligned frame: forward is the horizontal direction to the goal, then left, then up.

use auv_world::math::{Vec2, Vec3};

/// A horizontal frame at the vehicle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Unit vector towards the goal on the map.
    pub forward: Vec2,
}

impl Frame {
    /// The frame at `position` with a goal at `goal`; on top of the goal it keeps to +y.
    pub fn towards(position: Vec3, goal: Vec3) -> Self {
        let (dx, dy) = (goal[0] - position[0], goal[1] - position[1]);
        let length = (dx * dx + dy * dy).sqrt();
        Self { forward: if length > 1e-6 { [dx / length, dy / length] } else { [0.0, 1.0] } }
    }

    /// (forward, left) of a horizontal vector in world axes.
    #[inline]
    pub fn flat(&self, v: Vec2) -> Vec2 {
        let [ex, ey] = self.forward;
        [v[0] * ex + v[1] * ey, v[1] * ex - v[0] * ey]
    }

    /// (forward, left, up) of a vector in world axes.
    #[inline]
    pub fn from_world(&self, v: Vec3) -> Vec3 {
        let [forward, left] = self.flat([v[0], v[1]]);
        [forward, left, -v[2]]
    }

    /// World axes of (forward, left, up).
    #[inline]
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        let [ex, ey] = self.forward;
        [v[0] * ex - v[1] * ey, v[0] * ey + v[1] * ex, -v[2]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn left_is_left_and_up_is_up() {
        let north = Frame::towards([0.0; 3], [0.0, 5.0, 0.0]);
        assert_eq!(north.to_world([0.0, 1.0, 0.0]), [-1.0, 0.0, 0.0]);
        assert_eq!(north.to_world([0.0, 0.0, 1.0])[2], -1.0);
        let slanted = Frame::towards([1.0, 2.0, 3.0], [4.0, 6.0, 9.0]);
        let back = slanted.from_world(slanted.to_world([0.3, -0.7, 0.2]));
        assert!((back[0] - 0.3).abs() < 1e-15 && (back[1] + 0.7).abs() < 1e-15 && back[2] == 0.2);
    }
}
