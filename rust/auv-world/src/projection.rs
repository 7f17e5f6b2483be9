//! Where local metres lie on the Earth: the spherical azimuthal equidistant projection. Distances and
//! bearings from the centre are true, so a mission centred there keeps its lengths.

use libm::{acos, asin, atan2, cos, sin};

use crate::math::Vec2;
use crate::scenario::Projection;

/// Mean radius of the Earth (m).
pub const EARTH_RADIUS_M: f64 = 6_371_008.8;

impl Projection {
    /// Local (x east, y north) in metres of a longitude and latitude in degrees.
    pub fn forward(&self, longitude_deg: f64, latitude_deg: f64) -> Vec2 {
        let (sin0, cos0) = (sin(self.latitude_deg.to_radians()), cos(self.latitude_deg.to_radians()));
        let (latitude, along) = (latitude_deg.to_radians(), (longitude_deg - self.longitude_deg).to_radians());
        let (sin1, cos1) = (sin(latitude), cos(latitude));
        let angle = acos((sin0 * sin1 + cos0 * cos1 * cos(along)).clamp(-1.0, 1.0));
        let east = cos1 * sin(along);
        let north = cos0 * sin1 - sin0 * cos1 * cos(along);
        let length = (east * east + north * north).sqrt();
        // Near the centre arccos loses half the digits; the chord's sine does not.
        let angle = if angle < 1.0 { asin(length.min(1.0)) } else { angle };
        let scale = if length > 0.0 { EARTH_RADIUS_M * angle / length } else { 0.0 };
        [east * scale, north * scale]
    }

    /// (longitude, latitude) in degrees of a local point in metres.
    pub fn inverse(&self, point: Vec2) -> Vec2 {
        let (sin0, cos0) = (sin(self.latitude_deg.to_radians()), cos(self.latitude_deg.to_radians()));
        let rho = (point[0] * point[0] + point[1] * point[1]).sqrt();
        if rho == 0.0 {
            return [self.longitude_deg, self.latitude_deg];
        }
        let (sine, cosine) = (sin(rho / EARTH_RADIUS_M), cos(rho / EARTH_RADIUS_M));
        let latitude = asin((cosine * sin0 + point[1] * sine * cos0 / rho).clamp(-1.0, 1.0));
        let along = atan2(point[0] * sine, rho * cos0 * cosine - point[1] * sin0 * sine);
        [self.longitude_deg + along.to_degrees(), latitude.to_degrees()]
    }

    /// Unit vector in local axes of "east" at a point.
    pub fn east(&self, point: Vec2) -> Vec2 {
        let [longitude, latitude] = self.inverse(point);
        let (ahead, behind) = (self.forward(longitude + 1e-4, latitude), self.forward(longitude - 1e-4, latitude));
        let step = [ahead[0] - behind[0], ahead[1] - behind[1]];
        let length = (step[0] * step[0] + step[1] * step[1]).sqrt();
        if length > 0.0 { [step[0] / length, step[1] / length] } else { [1.0, 0.0] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_degree_of_latitude() {
        let projection = Projection { longitude_deg: -70.0, latitude_deg: 38.0 };
        let north = projection.forward(-70.0, 39.0);
        assert!(north[0].abs() < 1e-9 && (north[1] - EARTH_RADIUS_M.to_radians()).abs() < 1e-6);
    }

    proptest! {
        #[test]
        fn there_and_back(lon in -8.0..8.0_f64, lat in -8.0..8.0_f64, lat0 in -70.0..70.0_f64) {
            let projection = Projection { longitude_deg: 179.0, latitude_deg: lat0 };
            let back = projection.inverse(projection.forward(179.0 + lon, lat0 + lat));
            prop_assert!((back[0] - 179.0 - lon).abs() < 1e-9 && (back[1] - lat0 - lat).abs() < 1e-9);
        }
    }
}
