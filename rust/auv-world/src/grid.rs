//! Regular grids in up to four dimensions: axes, and linear interpolation that leaves missing corners out.

use crate::math::Vec2;
use crate::scenario::Projection;

/// Ascending coordinates along one axis of a grid.
#[derive(Debug, Clone)]
pub struct Axis {
    values: Vec<f64>,
    /// 1 / spacing where the spacing is even: a product instead of a search.
    inverse_spacing: Option<f64>,
}

impl Axis {
    /// An axis over ascending values.
    pub fn new(values: Vec<f64>) -> Self {
        let n = values.len();
        let even = n > 1 && {
            let spacing = (values[n - 1] - values[0]) / (n - 1) as f64;
            values.iter().enumerate().all(|(i, v)| (values[0] + spacing * i as f64 - v).abs() < 1e-9 * spacing)
        };
        let inverse_spacing = even.then(|| (n - 1) as f64 / (values[n - 1] - values[0]));
        Self { values, inverse_spacing }
    }

    /// Number of values.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// The values.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The cell that holds `value` and how far along it lies in 0..=1; beyond the ends, the end.
    #[inline]
    pub fn locate(&self, value: f64) -> (usize, f64) {
        let last = self.values.len() - 1;
        if last == 0 || value <= self.values[0] {
            return (0, 0.0);
        }
        if value >= self.values[last] {
            return (last - 1, 1.0);
        }
        match self.inverse_spacing {
            Some(inverse) => {
                let position = (value - self.values[0]) * inverse;
                let cell = (position as usize).min(last - 1);
                (cell, position - cell as f64)
            }
            None => {
                let cell = self.values.partition_point(|v| *v <= value) - 1;
                (cell, (value - self.values[cell]) / (self.values[cell + 1] - self.values[cell]))
            }
        }
    }
}

/// Horizontal axes in metres and what makes them from degrees.
#[derive(Debug, Clone)]
pub struct Plane {
    /// Columns (m).
    pub x: Axis,
    /// Rows (m).
    pub y: Axis,
}

/// Resamples layers of a grid in degrees to a local grid in metres at half the native spacing, which
/// keeps a linear interpolation of it true to the native one.
///
/// `layers` values are in C order (layer, latitude, longitude). Gives the plane and the resampled layers.
pub fn to_metres(
    projection: &Projection,
    (longitude, latitude): (&[f64], &[f64]),
    (low, high): (Vec2, Vec2),
    layers: &[&[f32]],
) -> (Plane, Vec<Vec<f32>>) {
    let (columns, rows) = (Axis::new(longitude.to_vec()), Axis::new(latitude.to_vec()));
    let native = |axis: &Axis| (axis.values[axis.len() - 1] - axis.values[0]) / (axis.len() - 1) as f64;
    let degree = crate::projection::EARTH_RADIUS_M.to_radians();
    let spacing =
        0.5 * degree * native(&rows).min(native(&columns) * libm::cos(projection.latitude_deg.to_radians()).max(0.01));
    let axis = |low: f64, high: f64| {
        let cells = ((high - low) / spacing).ceil().clamp(1.0, 4000.0);
        Axis::new((0..=cells as usize).map(|i| low + (high - low) * i as f64 / cells).collect())
    };
    let plane = Plane { x: axis(low[0], high[0]), y: axis(low[1], high[1]) };
    let mut resampled = vec![Vec::with_capacity(plane.x.len() * plane.y.len()); layers.len()];
    let width = columns.len();
    for &y in plane.y.values() {
        for &x in plane.x.values() {
            let [mut lon, lat] = projection.inverse([x, y]);
            // The same meridian may be written as 290 or as -70.
            while lon < longitude[0] - 1e-9 && lon + 360.0 <= longitude[width - 1] {
                lon += 360.0;
            }
            while lon > longitude[width - 1] && lon - 360.0 >= longitude[0] {
                lon -= 360.0;
            }
            let (column, across) = columns.locate(lon);
            let (row, along) = rows.locate(lat);
            let corner = row * width + column;
            for (layer, out) in layers.iter().zip(&mut resampled) {
                let corners = [layer[corner], layer[corner + 1], layer[corner + width], layer[corner + width + 1]];
                out.push(bilinear(corners, across, along) as f32);
            }
        }
    }
    (plane, resampled)
}

/// Linear interpolation in a cell; corners that are NaN are left out, all NaN gives NaN.
#[inline]
fn bilinear(corners: [f32; 4], across: f64, along: f64) -> f64 {
    let weights = [(1.0 - across) * (1.0 - along), across * (1.0 - along), (1.0 - across) * along, across * along];
    let (mut sum, mut weight) = (0.0, 0.0);
    for (corner, w) in corners.iter().zip(weights) {
        if !corner.is_nan() && w > 0.0 {
            sum += w * f64::from(*corner);
            weight += w;
        }
    }
    sum / weight
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn locates_on_even_and_uneven_axes() {
        for axis in [Axis::new(vec![0.0, 1.0, 2.0, 3.0]), Axis::new(vec![0.0, 1.0, 2.5, 7.0])] {
            assert_eq!(axis.locate(-1.0), (0, 0.0));
            assert_eq!(axis.locate(0.25), (0, 0.25));
            assert_eq!(axis.locate(1.0), (1, 0.0));
            assert_eq!(axis.locate(99.0), (2, 1.0));
        }
        assert_eq!(Axis::new(vec![5.0]).locate(7.0), (0, 0.0));
    }

    #[test]
    fn missing_corners_are_left_out() {
        assert_eq!(bilinear([1.0, f32::NAN, 1.0, 3.0], 0.5, 0.5), 5.0 / 3.0);
        assert!(bilinear([f32::NAN; 4], 0.5, 0.5).is_nan());
    }
}
