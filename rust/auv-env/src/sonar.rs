//! The sonar's beams, in the goal-aligned frame.

use std::sync::LazyLock;

use auv_world::math::Vec3;
use libm::{cos, sin};

/// Unit vectors (forward, left, up) of the beams: in 2-D 24, every 15 degrees from forward to the left;
/// in 3-D 52: elevations 0, +-25, +-55 degrees, each with azimuths 0, +-20, +-45, +-75, +-120, 180, then
/// straight up and straight down.
pub fn beams(dimensions: u8) -> &'static [Vec3] {
    static LEVEL: LazyLock<Vec<Vec3>> = LazyLock::new(|| (0..24).map(|i| beam(15.0 * f64::from(i), 0.0)).collect());
    static AROUND: LazyLock<Vec<Vec3>> = LazyLock::new(|| {
        let azimuths = [0.0, 20.0, -20.0, 45.0, -45.0, 75.0, -75.0, 120.0, -120.0, 180.0];
        let elevations = [0.0, 25.0, -25.0, 55.0, -55.0];
        let all =
            elevations.iter().flat_map(|&elevation| azimuths.iter().map(move |&azimuth| beam(azimuth, elevation)));
        all.chain([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]).collect()
    });
    if dimensions == 2 { &LEVEL } else { &AROUND }
}

/// The beam at these angles (degrees).
fn beam(azimuth: f64, elevation: f64) -> Vec3 {
    let (azimuth, elevation) = (azimuth.to_radians(), elevation.to_radians());
    [cos(elevation) * cos(azimuth), cos(elevation) * sin(azimuth), sin(elevation)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unit_and_forward_first() {
        for (dimensions, count) in [(2, 24), (3, 52)] {
            let beams = beams(dimensions);
            assert_eq!(beams.len(), count);
            assert_eq!(beams[0], [1.0, 0.0, 0.0]);
            assert!(beams.iter().all(|b| (auv_world::math::norm(*b) - 1.0).abs() < 1e-12));
        }
        assert!(beams(2)[6][1] > 0.999);
    }
}
