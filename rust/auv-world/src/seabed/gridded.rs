//! Gridded bathymetry: bilinear depth, and a clearance from its steepest slope.

use crate::grid::{Axis, Plane, to_metres};
use crate::math::{Vec2, Vec3};
use crate::scenario::{GriddedSeabed, Projection};

/// A grid of depths, ready to be asked; beyond its edges the edge.
#[derive(Debug, Clone)]
pub struct GridFloor {
    plane: Plane,
    depth: Vec<f32>,
    /// 1 / sqrt(1 + slope^2) for the steepest slope of the grid.
    steepest: f64,
}

impl GridFloor {
    /// Prepares a checked grid; one in degrees is resampled to metres over the box (low, high).
    pub fn new(grid: &GriddedSeabed, projection: Option<&Projection>, (low, high): (Vec2, Vec2)) -> Self {
        let values = grid.depth_m.values().unwrap_or_default();
        let (plane, depth) = match (&grid.longitude_deg, &grid.latitude_deg, projection) {
            (Some(longitude), Some(latitude), Some(projection)) => {
                let (plane, mut layers) = to_metres(projection, (longitude, latitude), (low, high), &[&values]);
                (plane, layers.swap_remove(0))
            }
            _ => {
                let axis = |values: &Option<Vec<f64>>| Axis::new(values.clone().unwrap_or_else(|| vec![0.0]));
                (Plane { x: axis(&grid.x_m), y: axis(&grid.y_m) }, values)
            }
        };
        let mut floor = Self { plane, depth, steepest: 1.0 };
        let slope2 = floor.steepest_slope2();
        floor.steepest = 1.0 / (1.0 + slope2).sqrt();
        floor
    }

    /// Square of the steepest slope: in a bilinear cell each derivative is greatest on an edge.
    fn steepest_slope2(&self) -> f64 {
        let (x, y) = (self.plane.x.values(), self.plane.y.values());
        let width = x.len();
        let at = |row: usize, column: usize| f64::from(self.depth[row * width + column]);
        let mut steepest = 0.0_f64;
        for row in 0..y.len() - 1 {
            for column in 0..width - 1 {
                let (dx, dy) = (x[column + 1] - x[column], y[row + 1] - y[row]);
                let east = |row: usize| ((at(row, column + 1) - at(row, column)) / dx).abs();
                let north = |column: usize| ((at(row + 1, column) - at(row, column)) / dy).abs();
                let (east, north) = (east(row).max(east(row + 1)), north(column).max(north(column + 1)));
                steepest = steepest.max(east * east + north * north);
            }
        }
        steepest
    }

    /// Depth of the floor (m).
    pub fn depth(&self, x: f64, y: f64) -> f64 {
        let (column, across) = self.plane.x.locate(x);
        let (row, along) = self.plane.y.locate(y);
        let start = row * self.plane.x.len() + column;
        let at = |offset: usize| f64::from(self.depth[start + offset]);
        let width = self.plane.x.len();
        let south = at(0) + across * (at(1) - at(0));
        let north = at(width) + across * (at(width + 1) - at(width));
        south + along * (north - south)
    }

    /// Signed distance to the floor (m), never more than the true one.
    pub fn clearance(&self, point: Vec3) -> f64 {
        let gap = self.depth(point[0], point[1]) - point[2];
        if gap > 0.0 { gap * self.steepest } else { gap }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Data;

    #[test]
    fn a_slope() {
        // Depth falls 1 m for each metre eastward: 45 degrees.
        let floor = GridFloor::new(
            &GriddedSeabed {
                x_m: Some(vec![0.0, 100.0]),
                y_m: Some(vec![0.0, 100.0]),
                longitude_deg: None,
                latitude_deg: None,
                depth_m: Data::Numbers(vec![0.0, 100.0, 0.0, 100.0]),
            },
            None,
            ([0.0; 2], [100.0; 2]),
        );
        assert_eq!(floor.depth(30.0, 50.0), 30.0);
        assert!((floor.clearance([50.0, 50.0, 0.0]) - 50.0 / 2.0_f64.sqrt()).abs() < 1e-9);
        assert_eq!(floor.clearance([10.0, 50.0, 30.0]), -20.0);
    }
}
