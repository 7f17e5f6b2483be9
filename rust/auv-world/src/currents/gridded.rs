//! A current on a grid in space and time: linear in between, missing corners left out.

use crate::grid::{Axis, Plane, to_metres};
use crate::math::{Vec2, Vec3};
use crate::scenario::{GriddedCurrent, Projection};

/// A gridded current, ready to be asked.
#[derive(Debug, Clone)]
pub struct GriddedField {
    plane: Plane,
    depth: Axis,
    time: Axis,
    /// (u, v) interleaved in C order (time, depth, y, x): one cache line serves both.
    velocity: Vec<Vec2F>,
}

type Vec2F = [f32; 2];

impl GriddedField {
    /// Prepares a checked grid. A grid in degrees is resampled to metres over the box (low, high) and its
    /// eastward and northward components are turned into local axes.
    pub fn new(grid: &GriddedCurrent, projection: Option<&Projection>, (low, high): (Vec2, Vec2)) -> Self {
        let values = |data: &crate::scenario::Data| data.values().unwrap_or_default();
        let (u, v) = (values(&grid.u_mps), values(&grid.v_mps));
        let axis = |values: &Option<Vec<f64>>| Axis::new(values.clone().unwrap_or_else(|| vec![0.0]));
        let (depth, time) = (axis(&grid.depth_m), axis(&grid.time_s));
        if let (Some(longitude), Some(latitude), Some(projection)) =
            (&grid.longitude_deg, &grid.latitude_deg, projection)
        {
            let size = longitude.len() * latitude.len();
            let layers: Vec<&[f32]> = u.chunks_exact(size).chain(v.chunks_exact(size)).collect();
            let (plane, resampled) = to_metres(projection, (longitude, latitude), (low, high), &layers);
            let (east, north) = resampled.split_at(resampled.len() / 2);
            let axes: Vec<Vec2> = plane
                .y
                .values()
                .iter()
                .flat_map(|&y| plane.x.values().iter().map(move |&x| projection.east([x, y])))
                .collect();
            let velocity = east
                .iter()
                .zip(north)
                .flat_map(|(east, north)| east.iter().zip(north).zip(&axes))
                .map(|((&u, &v), axis)| {
                    let (u, v) = (f64::from(u), f64::from(v));
                    [(u * axis[0] - v * axis[1]) as f32, (u * axis[1] + v * axis[0]) as f32]
                })
                .collect();
            return Self { plane, depth, time, velocity };
        }
        let plane = Plane { x: axis(&grid.x_m), y: axis(&grid.y_m) };
        let velocity = u.into_iter().zip(v).map(|(u, v)| [u, v]).collect();
        Self { plane, depth, time, velocity }
    }

    /// Whether it changes with time.
    pub fn is_steady(&self) -> bool {
        self.time.len() == 1
    }

    /// Whether it is the same at all depths.
    pub fn is_level(&self) -> bool {
        self.depth.len() == 1
    }

    /// Velocity (m/s) at a point (m) and time (s); zero where nothing near is known. Beyond the ends of
    /// depth and time the last value holds.
    pub fn velocity(&self, point: Vec3, time_s: f64) -> Vec2 {
        let (column, across) = self.plane.x.locate(point[0]);
        let (row, along) = self.plane.y.locate(point[1]);
        let (level, down) = self.depth.locate(point[2]);
        let (slice, later) = self.time.locate(time_s);
        let width = self.plane.x.len();
        let layer = width * self.plane.y.len();
        let (mut u, mut v, mut total) = (0.0, 0.0, 0.0);
        for (slice, at_time) in [(slice, 1.0 - later), (slice + 1, later)] {
            if at_time == 0.0 {
                continue;
            }
            for (level, at_depth) in [(level, 1.0 - down), (level + 1, down)] {
                if at_depth == 0.0 {
                    continue;
                }
                let start = (slice * self.depth.len() + level) * layer + row * width + column;
                for (offset, weight) in [
                    (0, (1.0 - across) * (1.0 - along)),
                    (1, across * (1.0 - along)),
                    (width, (1.0 - across) * along),
                    (width + 1, across * along),
                ] {
                    if weight == 0.0 {
                        continue;
                    }
                    let value = self.velocity[start + offset];
                    let weight = weight * at_time * at_depth;
                    if !(value[0].is_nan() || value[1].is_nan()) {
                        u += weight * f64::from(value[0]);
                        v += weight * f64::from(value[1]);
                        total += weight;
                    }
                }
            }
        }
        if total > 0.0 { [u / total, v / total] } else { [0.0, 0.0] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Data;

    fn grid() -> GriddedCurrent {
        // u = x + 10 depth + 100 time, v = -y, on unit axes.
        let mut u = Vec::new();
        let mut v = Vec::new();
        for time in 0..2 {
            for depth in 0..2 {
                for y in 0..2 {
                    for x in 0..3 {
                        u.push(f64::from(x + 10 * depth + 100 * time));
                        v.push(f64::from(-y));
                    }
                }
            }
        }
        GriddedCurrent {
            x_m: Some(vec![0.0, 1.0, 2.0]),
            y_m: Some(vec![0.0, 1.0]),
            longitude_deg: None,
            latitude_deg: None,
            depth_m: Some(vec![0.0, 1.0]),
            time_s: Some(vec![0.0, 1.0]),
            u_mps: Data::Numbers(u),
            v_mps: Data::Numbers(v),
        }
    }

    #[test]
    fn linear_in_every_axis() {
        let field = GriddedField::new(&grid(), None, ([0.0; 2], [2.0, 1.0]));
        let found = field.velocity([1.25, 0.5, 0.25], 0.75);
        assert!((found[0] - (1.25 + 2.5 + 75.0)).abs() < 1e-5 && (found[1] + 0.5).abs() < 1e-6);
        assert_eq!(field.velocity([9.0, 9.0, 9.0], 9.0), [112.0, -1.0]);
    }

    #[test]
    fn missing_is_left_out() {
        let mut holes = grid();
        if let Data::Numbers(u) = &mut holes.u_mps {
            u[0] = f64::NAN;
        }
        let field = GriddedField::new(&holes, None, ([0.0; 2], [2.0, 1.0]));
        assert_eq!(field.velocity([0.5, 0.0, 0.0], 0.0), [1.0, 0.0]);
        assert_eq!(field.velocity([0.0, 0.0, 0.0], 0.0), [0.0, 0.0]);
    }

    #[test]
    fn degrees_become_metres() {
        let projection = Projection { longitude_deg: 1.0, latitude_deg: 45.0 };
        let degrees = GriddedCurrent {
            x_m: None,
            y_m: None,
            longitude_deg: Some(vec![0.0, 1.0, 2.0]),
            latitude_deg: Some(vec![44.0, 45.0, 46.0]),
            depth_m: None,
            time_s: None,
            u_mps: Data::Numbers(vec![1.0; 9]),
            v_mps: Data::Numbers(vec![0.0; 9]),
        };
        let field = GriddedField::new(&degrees, Some(&projection), ([-5e4, -5e4], [5e4, 5e4]));
        assert!((field.velocity([0.0, 0.0, 0.0], 0.0)[0] - 1.0).abs() < 1e-5);
        // East of the centre in the northern hemisphere, east bends to the north of local x ... by the
        // convergence of the meridians, sin(latitude) times the difference in longitude.
        let turned = field.velocity([4e4, 0.0, 0.0], 0.0);
        let convergence = 45.0_f64.to_radians().sin() * (projection.inverse([4e4, 0.0])[0] - 1.0).to_radians();
        assert!((turned[1] - convergence).abs() < 2e-4, "{turned:?} {convergence}");
    }
}
