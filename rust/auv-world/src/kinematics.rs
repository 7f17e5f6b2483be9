//! What a current does to a vehicle's speed over ground.

use crate::math::{Vec2, Vec3, add_scaled, norm, sub};
use crate::world::World;

/// Speed over ground (m/s) along a unit `direction` of a vehicle that crabs so that it keeps to it,
/// V_par + sqrt(V^2 - V_perp^2); zero or less where the current wins.
#[inline]
pub fn ground_speed(direction: Vec3, current: Vec2, speed: f64) -> f64 {
    let along = current[0] * direction[0] + current[1] * direction[1];
    let across2 = (current[0] * current[0] + current[1] * current[1] - along * along).max(0.0);
    let left2 = speed * speed - across2;
    if left2 <= 0.0 { -1.0 } else { along + left2.sqrt() }
}

/// Time (s) from `from` to `to` (m) along a straight line in the present currents, which are asked at
/// the middle of each of `pieces` parts; infinite where the current wins.
pub fn travel_time(world: &World, from: Vec3, to: Vec3, speed: f64, pieces: usize) -> f64 {
    let step = sub(to, from);
    let length = norm(step);
    if length == 0.0 {
        return 0.0;
    }
    let direction = step.map(|component| component / length);
    let part = length / pieces as f64;
    let mut time = 0.0;
    for piece in 0..pieces {
        let middle = add_scaled(from, (piece as f64 + 0.5) / pieces as f64, step);
        let over_ground = ground_speed(direction, world.current(middle), speed);
        if over_ground <= 0.01 * speed {
            return f64::INFINITY;
        }
        time += part / over_ground;
    }
    time
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn with_across_and_against() {
        let east = [1.0, 0.0, 0.0];
        assert_eq!(ground_speed(east, [0.5, 0.0], 2.0), 2.5);
        assert_eq!(ground_speed(east, [-0.5, 0.0], 2.0), 1.5);
        assert!((ground_speed(east, [0.0, 1.2], 2.0) - 1.6).abs() < 1e-12);
        assert!(ground_speed(east, [0.0, 2.1], 2.0) < 0.0);
        assert!(ground_speed(east, [-2.1, 0.0], 2.0) < 0.0);
    }
}
