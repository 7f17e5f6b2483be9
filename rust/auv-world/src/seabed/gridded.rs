//! Gridded bathymetry: bilinear depth, and a clearance from its steepest slope.
//!
//! In 3-D a point `gap` above the floor is at least gap / sqrt(1 + slope^2) away from it. A 2-D world is a
//! plane at one depth: there the way to where the floor rises through that plane is at least gap / slope.

use crate::grid::{Axis, Plane, to_metres};
use crate::math::{Vec2, Vec3, add_scaled};
use crate::scenario::{GriddedSeabed, Projection};

/// A grid of depths, ready to be asked; beyond its edges the edge.
#[derive(Debug, Clone)]
pub struct GridFloor {
    plane: Plane,
    depth: Vec<f32>,
    /// The steepest slope of the grid.
    slope: f64,
    /// A metre of gap is at least this much distance.
    distance_per_gap: f64,
}

impl GridFloor {
    /// Prepares a checked grid; one in degrees is resampled to metres over the box (low, high). In a 2-D
    /// world (`flat`) distances are those in its plane.
    pub fn new(grid: &GriddedSeabed, projection: Option<&Projection>, (low, high): (Vec2, Vec2), flat: bool) -> Self {
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
        let mut floor = Self { plane, depth, slope: 0.0, distance_per_gap: 1.0 };
        floor.slope = floor.steepest_slope2().sqrt().max(1e-9);
        let slope = floor.slope;
        floor.distance_per_gap = if flat { 1.0 / slope } else { 1.0 / (1.0 + slope * slope).sqrt() };
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

    /// Signed distance to the floor (m): above it never more than the true one, below it minus the gap.
    pub fn clearance(&self, point: Vec3) -> f64 {
        let gap = self.depth(point[0], point[1]) - point[2];
        if gap > 0.0 { gap * self.distance_per_gap } else { gap }
    }

    /// How far a beam of unit `direction` runs before it meets the floor (m), at most `longest`: along the
    /// beam the gap closes by no more than the slope and the beam's own dive allow.
    pub fn range(&self, origin: Vec3, direction: Vec3, longest: f64) -> f64 {
        let horizontal = (direction[0] * direction[0] + direction[1] * direction[1]).sqrt();
        let closing = self.slope * horizontal + direction[2].max(0.0);
        let touch = 1e-3 * longest;
        let mut range = 0.0;
        while range < longest {
            let point = add_scaled(origin, range, direction);
            let free = (self.depth(point[0], point[1]) - point[2]) / closing;
            if free < touch {
                return range;
            }
            range += free;
        }
        longest
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Data;

    #[test]
    fn a_slope() {
        // Depth falls 1 m for each metre eastward: 45 degrees.
        let grid = GriddedSeabed {
            x_m: Some(vec![0.0, 100.0]),
            y_m: Some(vec![0.0, 100.0]),
            longitude_deg: None,
            latitude_deg: None,
            depth_m: Data::Numbers(vec![0.0, 100.0, 0.0, 100.0]),
        };
        let floor = GridFloor::new(&grid, None, ([0.0; 2], [100.0; 2]), false);
        assert_eq!(floor.depth(30.0, 50.0), 30.0);
        assert!((floor.clearance([50.0, 50.0, 0.0]) - 50.0 / 2.0_f64.sqrt()).abs() < 1e-9);
        assert_eq!(floor.clearance([10.0, 50.0, 30.0]), -20.0);
        assert!((floor.range([80.0, 50.0, 0.0], [-1.0, 0.0, 0.0], 500.0) - 80.0).abs() < 0.5);
        assert_eq!(floor.range([80.0, 50.0, 0.0], [1.0, 0.0, 0.0], 500.0), 500.0);
        let plane = GridFloor::new(&grid, None, ([0.0; 2], [100.0; 2]), true);
        assert!((plane.clearance([50.0, 50.0, 0.0]) - 50.0).abs() < 1e-6);
    }
}
