//! A heading that no threat forbids: the gap h to each may shrink no faster than alpha h.

use auv_world::math::{Vec3, add_scaled, dot, norm, sub};

/// A threat as it is now.
#[derive(Debug, Clone, Copy)]
pub struct Ball {
    /// Centre (m).
    pub centre: Vec3,
    /// Velocity (m/s).
    pub velocity: Vec3,
    /// Radius (m).
    pub radius: f64,
}

/// Where threats contradict each other the last ones are not heard.
const SWEEPS: usize = 8;

/// The unit direction nearest to `wanted` for which d.n >= (n.u - alpha h) / speed holds for every threat,
/// n being the unit vector from its centre and u its velocity; straight away from one that is faster than
/// all directions.
pub fn turned_away(wanted: Vec3, here: Vec3, speed: f64, alpha: f64, threats: &[Ball]) -> Vec3 {
    let mut direction = wanted;
    for _ in 0..SWEEPS {
        let mut worst = (1e-12, [0.0; 3], 0.0);
        for threat in threats {
            let offset = sub(here, threat.centre);
            let distance = norm(offset);
            if distance == 0.0 {
                continue;
            }
            let normal = offset.map(|o| o / distance);
            let least = (dot(normal, threat.velocity) - alpha * (distance - threat.radius)) / speed;
            let missing = least.min(1.0) - dot(normal, direction);
            if missing > worst.0 {
                worst = (missing, normal, least.min(1.0));
            }
        }
        let (missing, normal, least) = worst;
        if missing <= 1e-12 {
            break;
        }
        direction = tilted(direction, normal, least);
    }
    direction
}

/// The direction in the plane of `direction` and `normal` that has `least` along the normal.
fn tilted(direction: Vec3, normal: Vec3, least: f64) -> Vec3 {
    let along = add_scaled(direction, -dot(direction, normal), normal);
    let length = norm(along);
    let side = if length > 1e-9 {
        along.map(|a| a / length)
    } else {
        // Straight at it: any way round; to the left on the map, or north over a summit.
        let level = (normal[0] * normal[0] + normal[1] * normal[1]).sqrt();
        if level > 1e-9 { [normal[1] / level, -normal[0] / level, 0.0] } else { [0.0, 1.0, 0.0] }
    };
    let across = (1.0 - least * least).max(0.0).sqrt();
    std::array::from_fn(|axis| least * normal[axis] + across * side[axis])
}

#[cfg(test)]
mod tests {
    use super::*;
    use auv_world::rng::{Purpose, Stream};

    #[test]
    fn by_hand() {
        let threat = Ball { centre: [1000.0, 0.0, 0.0], velocity: [-1.0, 0.0, 0.0], radius: 500.0 };
        // It closes 1 m/s by itself, h = 500 m, alpha h = 1 m/s: no more may be added, so d.n = 0.
        let turned = turned_away([1.0, 0.0, 0.0], [0.0; 3], 2.0, 0.002, &[threat]);
        assert!(turned[0].abs() < 1e-12 && (norm(turned) - 1.0).abs() < 1e-12);
        let away = turned_away([-0.6, 0.8, 0.0], [0.0; 3], 2.0, 0.002, &[threat]);
        assert_eq!(away, [-0.6, 0.8, 0.0]);
        let fast = Ball { velocity: [-9.0, 0.0, 0.0], ..threat };
        assert_eq!(turned_away([1.0, 0.0, 0.0], [0.0; 3], 2.0, 0.002, &[fast])[0], -1.0);
    }

    #[test]
    fn one_threat_is_always_obeyed() {
        let mut stream = Stream::new(1, Purpose::Planner, 0);
        for _ in 0..2000 {
            let mut draw = |size: f64| [(); 3].map(|()| stream.uniform(-size, size));
            let (wanted, centre, velocity) = (draw(1.0), draw(3000.0), draw(1.0));
            let wanted = wanted.map(|w| w / norm(wanted));
            let threat = Ball { centre, velocity, radius: 700.0 };
            let turned = turned_away(wanted, [0.0; 3], 2.0, 0.002, &[threat]);
            let normal = centre.map(|c| -c / norm(centre));
            let least = (dot(normal, velocity) - 0.002 * (norm(centre) - 700.0)) / 2.0;
            assert!((norm(turned) - 1.0).abs() < 1e-9 && dot(turned, normal) >= least.min(1.0) - 1e-9);
        }
    }
}
