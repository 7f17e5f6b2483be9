//! A meandering jet (IIFDS eq. 16-18): velocity (-dF/dy, dF/dx) of its stream function, in closed form.

use libm::{cos, cosh, sin};

use crate::math::Vec2;
use crate::scenario::Jet;

/// Velocity (m/s) at (x, y) in metres, `time_s` after the start.
pub fn velocity(jet: &Jet, x: f64, y: f64, time_s: f64) -> Vec2 {
    let t = jet.t + jet.time_scale_s.map_or(0.0, |scale| time_s / scale);
    let (sine, cosine) = (sin(jet.heading_rad), cos(jet.heading_rad));
    let (east, north) = ((x - jet.origin_m[0]) / jet.length_scale_m, (y - jet.origin_m[1]) / jet.length_scale_m);
    let (x, y) = (cosine * east + sine * north, cosine * north - sine * east);

    let b = jet.b0 + jet.e * cos(jet.omega * t + jet.chi);
    let phase = jet.k * (x - jet.c * t);
    let (sin_phase, cos_phase) = (sin(phase), cos(phase));
    let offset = y - b * cos_phase;
    let kb = jet.k * b;
    let width = (1.0 + kb * kb * sin_phase * sin_phase).sqrt();
    let cosh = cosh((offset / width).clamp(-300.0, 300.0));
    let profile = jet.peak_speed_mps / (cosh * cosh);
    let along = profile / width;
    let across = -profile
        * (kb * sin_phase / width - offset * kb * kb * jet.k * sin_phase * cos_phase / (width * width * width));
    [cosine * along - sine * across, sine * along + cosine * across]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set_1() -> Jet {
        Jet {
            t: 3.0,
            c: 1.2,
            k: 0.8,
            e: 0.1,
            b0: 2.2,
            omega: 0.4,
            chi: std::f64::consts::FRAC_PI_2,
            peak_speed_mps: 1.0,
            length_scale_m: 1000.0,
            time_scale_s: None,
            origin_m: [0.0, 0.0],
            heading_rad: 0.0,
        }
    }

    #[test]
    fn golden_numbers() {
        let set_2 = Jet { t: 4.0, k: 1.0, b0: 1.5, omega: 1.6, ..set_1() };
        for (jet, at, wanted) in [
            (set_1(), [2.0, 1.0], [0.5042850207, 0.7797034517]),
            (set_1(), [5.0, 0.5], [0.5222434171, -0.8511882906]),
            (set_1(), [0.0, 0.0], [0.08380735925, 0.1179016412]),
            (set_2.clone(), [0.0, 0.0], [0.5562185345, -0.8290430777]),
            (set_2, [5.0, 0.5], [0.4540978634, -0.3069402095]),
        ] {
            let found = velocity(&jet, 1000.0 * at[0], 1000.0 * at[1], 0.0);
            assert!((found[0] - wanted[0]).abs() < 1e-8 && (found[1] - wanted[1]).abs() < 1e-8, "{at:?} {found:?}");
        }
    }

    #[test]
    fn turns_with_its_heading() {
        let turned = Jet { heading_rad: std::f64::consts::FRAC_PI_2, ..set_1() };
        let (straight, turned) = (velocity(&set_1(), 2000.0, 1000.0, 0.0), velocity(&turned, -1000.0, 2000.0, 0.0));
        assert!((turned[0] + straight[1]).abs() < 1e-12 && (turned[1] - straight[0]).abs() < 1e-12);
    }
}
