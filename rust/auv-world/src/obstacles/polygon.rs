//! Simple polygons, extruded between two depths: exact signed distance.

use wide::f64x4;

use super::outline::Outline;
use crate::math::{Vec2, Vec3};
use crate::scenario::Polygon;

/// A polygon's prism at its present place.
#[derive(Debug, Clone)]
pub struct Prism {
    /// Relative to the centre (m).
    outline: Outline,
    centre: Vec2,
    top: f64,
    bottom: f64,
}

/// Mean of the corners (m).
pub fn centre(vertices: &[Vec2]) -> Vec2 {
    let n = vertices.len().max(1) as f64;
    let sum = vertices.iter().fold([0.0, 0.0], |sum, v| [sum[0] + v[0], sum[1] + v[1]]);
    [sum[0] / n, sum[1] / n]
}

impl Prism {
    /// The prism where the scenario has it.
    pub fn new(shape: &Polygon) -> Self {
        let centre = centre(&shape.vertices_m);
        Self { outline: Outline::new(&shape.vertices_m, centre), centre, top: shape.top_m, bottom: shape.bottom_m }
    }

    /// Moves its centre.
    pub fn place(&mut self, centre: Vec2) {
        self.centre = centre;
    }

    /// Corners at the present place (m).
    pub fn vertices(&self) -> impl Iterator<Item = Vec2> + '_ {
        self.outline.corners().map(|c| [c[0] + self.centre[0], c[1] + self.centre[1]])
    }

    /// Signed distance (m).
    pub fn clearance(&self, point: Vec3) -> f64 {
        super::prism_distance(self.outline.distance(self.relative(point)), self.top, self.bottom, point[2])
    }

    /// The corners of a box on the map that holds it with a little room (m).
    pub(super) fn bounds(&self) -> (Vec2, Vec2) {
        let (low, high) = self.outline.bounds();
        let moved = |v: Vec2| [v[0] + self.centre[0], v[1] + self.centre[1]];
        (moved(low), moved(high))
    }

    /// Whether it reaches from above to below `depth`, so that only the outline counts there.
    pub(super) fn reaches_through(&self, depth: f64) -> bool {
        self.top <= depth && depth <= self.bottom
    }

    /// Whether on the map a point lies in its outline or on it.
    #[inline]
    pub(super) fn covers(&self, point: Vec3) -> bool {
        let place = self.relative(point);
        self.outline.may_hold(place) && self.outline.distance(place) <= 0.0
    }

    /// [`Outline::may_stop`] where it is now.
    #[inline]
    pub(super) fn may_stop(&self, origin: Vec3, directions: &[f64x4; 2], longest: f64x4) -> u32 {
        self.outline.may_stop(self.relative(origin), directions, longest)
    }

    /// [`Outline::march`] where it is now.
    #[inline]
    pub(super) fn march(&self, origin: Vec3, directions: &[f64x4; 2], longest: f64x4) -> f64x4 {
        self.outline.march(self.centre, [origin[0], origin[1]], directions, longest)
    }

    fn relative(&self, point: Vec3) -> Vec2 {
        [point[0] - self.centre[0], point[1] - self.centre[1]]
    }
}

fn turn(a: Vec2, b: Vec2, c: Vec2) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Whether segments ab and cd share a point.
fn meet(a: Vec2, b: Vec2, c: Vec2, d: Vec2) -> bool {
    let on = |a: Vec2, b: Vec2, p: Vec2| {
        (a[0].min(b[0])..=a[0].max(b[0])).contains(&p[0]) && (a[1].min(b[1])..=a[1].max(b[1])).contains(&p[1])
    };
    let (t1, t2, t3, t4) = (turn(a, b, c), turn(a, b, d), turn(c, d, a), turn(c, d, b));
    (t1 * t2 < 0.0 && t3 * t4 < 0.0)
        || (t1 == 0.0 && on(a, b, c))
        || (t2 == 0.0 && on(a, b, d))
        || (t3 == 0.0 && on(c, d, a))
        || (t4 == 0.0 && on(c, d, b))
}

/// Checks that corners make a simple polygon with an inside; says what is wrong if not.
pub fn check_simple(corners: &[Vec2]) -> Result<(), String> {
    let n = corners.len();
    if !(3..=10_000).contains(&n) {
        return Err("a polygon has 3 .. 10000 corners".into());
    }
    for i in 0..n {
        let (a, b) = (corners[i], corners[(i + 1) % n]);
        if a == b {
            return Err(format!("corners {i} and {} are the same", (i + 1) % n));
        }
        for j in i + 2..n {
            if (i, j) != (0, n - 1) && meet(a, b, corners[j], corners[(j + 1) % n]) {
                return Err(format!("edges {i} and {j} meet: the polygon must not touch itself"));
            }
        }
    }
    let area: f64 = (0..n).map(|i| turn([0.0; 2], corners[i], corners[(i + 1) % n])).sum();
    if area == 0.0 {
        return Err("the corners lie on a line".into());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Prism {
        let vertices_m = vec![[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]];
        Prism::new(&Polygon { vertices_m, top_m: 2.0, bottom_m: 8.0, velocity_mps: [0.0; 2] })
    }

    #[test]
    fn signed_distance() {
        let prism = square();
        assert_eq!(prism.clearance([13.0, 14.0, 5.0]), 5.0);
        assert_eq!(prism.clearance([5.0, 5.0, 5.0]), -3.0);
        assert_eq!(prism.clearance([5.0, 5.0, 0.0]), 2.0);
        assert_eq!(prism.clearance([13.0, 5.0, -2.0]), 5.0);
        assert_eq!(prism.clearance([9.5, 5.0, 5.0]), -0.5);
    }

    #[test]
    fn refuses_what_is_not_simple() {
        assert!(check_simple(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]).is_ok());
        assert!(check_simple(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]).unwrap_err().contains("meet"));
        assert!(check_simple(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]).unwrap_err().contains("line"));
        assert!(check_simple(&[[0.0, 0.0], [1.0, 1.0]]).is_err());
    }
}
