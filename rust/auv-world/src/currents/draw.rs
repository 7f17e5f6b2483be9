//! Drawing vortices: where they are, which way they turn, how fast.

use super::{RING_RADIUS, VortexField};
use crate::math::Vec2;
use crate::rng::Stream;
use crate::scenario::VortexDraw;

impl VortexDraw {
    /// Draws a centre in the box (low, high) and the sign of a circulation.
    pub fn sample(&self, stream: &mut Stream, low: Vec2, high: Vec2) -> (Vec2, f64) {
        let mut along = |normal: &Option<Vec2>, low: f64, high: f64| match normal {
            Some([mean, deviation]) => stream.normal(*mean, *deviation).clamp(low, high),
            None => stream.uniform(low, high),
        };
        let centre = [along(&self.x_normal_m, low[0], high[0]), along(&self.y_normal_m, low[1], high[1])];
        (centre, if self.random_sign { stream.sign() } else { 1.0 })
    }
}

/// Scales all circulations so that the fastest summed current on the vortices' rings of greatest speed,
/// sampled at eight points on each, is `peak` (m/s).
pub fn scale_to_peak(vortices: &mut VortexField, peak: f64) {
    let mut fastest2 = 0.0_f64;
    let diagonal = std::f64::consts::FRAC_1_SQRT_2;
    // Where they are on a ring of radius 1, four at a time.
    let points = [
        ([1.0, diagonal, 0.0, -diagonal], [0.0, diagonal, 1.0, diagonal]),
        ([-1.0, -diagonal, 0.0, diagonal], [0.0, -diagonal, -1.0, -diagonal]),
    ];
    for i in 0..vortices.len() {
        let [x, y] = vortices.centre(i);
        let ring = RING_RADIUS * vortices.core_radius(i);
        for (dx, dy) in points {
            let [u, v] = vortices.velocities(dx.map(|dx| x + ring * dx), dy.map(|dy| y + ring * dy));
            fastest2 = u.iter().zip(v).fold(fastest2, |fastest2, (u, v)| fastest2.max(u * u + v * v));
        }
    }
    if fastest2 > 0.0 {
        let scale = peak / fastest2.sqrt();
        for i in 0..vortices.len() {
            vortices.spin(i, scale * vortices.circulation(i));
        }
    }
}
