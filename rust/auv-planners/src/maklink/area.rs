//! The rectangle in which everything happens.

use auv_world::math::Vec2;

use super::error::MapError;

/// Points within this of a wall count as on it (m).
const ON_WALL: f64 = 1e-6;

/// A rectangle with closed walls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Area {
    low: Vec2,
    high: Vec2,
}

impl Area {
    /// The rectangle between two corners (m).
    ///
    /// # Errors
    /// [`MapError::Area`] if it has no width or height, or a number is not finite.
    pub fn new(low: Vec2, high: Vec2) -> Result<Self, MapError> {
        let fits = (0..2).all(|axis| low[axis].is_finite() && high[axis].is_finite() && low[axis] < high[axis]);
        // Zeros have no sign here, so that equal points have equal bits.
        let [low, high] = [low, high].map(|corner| corner.map(|value| value + 0.0));
        if fits { Ok(Self { low, high }) } else { Err(MapError::Area { low, high }) }
    }

    /// Its corners, counter-clockwise from the lowest.
    pub fn corners(&self) -> [Vec2; 4] {
        let ([x0, y0], [x1, y1]) = (self.low, self.high);
        [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
    }

    /// Whether a point is in it or on a wall.
    pub fn contains(&self, point: Vec2) -> bool {
        (0..2).all(|axis| (self.low[axis]..=self.high[axis]).contains(&point[axis]))
    }

    /// The nearest point of it.
    pub fn nearest(&self, point: Vec2) -> Vec2 {
        std::array::from_fn(|axis| point[axis].clamp(self.low[axis], self.high[axis]))
    }

    /// Whether a point is on a wall.
    pub fn on_wall(&self, point: Vec2) -> bool {
        (0..2).any(|axis| point[axis] == self.low[axis] || point[axis] == self.high[axis])
    }

    /// The axis along which a wall runs that two points share.
    #[inline]
    pub fn shared_wall(&self, a: Vec2, b: Vec2) -> Option<usize> {
        let on = |across: usize| a[across] == b[across] && [self.low[across], self.high[across]].contains(&a[across]);
        (0..2).find(|&along| on(1 - along))
    }

    /// The nearest points of the four walls.
    pub fn feet(&self, point: Vec2) -> [Vec2; 4] {
        let ([x0, y0], [x1, y1], [x, y]) = (self.low, self.high, point);
        [[x0, y], [x1, y], [x, y0], [x, y1]]
    }

    /// Length of the diagonal (m).
    pub fn diagonal(&self) -> f64 {
        let [dx, dy] = [self.high[0] - self.low[0], self.high[1] - self.low[1]];
        (dx * dx + dy * dy).sqrt()
    }

    /// What of a convex ring is inside, wall after wall (Sutherland and Hodgman). Boolean operations on an
    /// integer grid would move every corner; this moves only those that are cut off, exactly onto the wall.
    pub fn clip(&self, ring: Vec<Vec2>) -> Vec<Vec2> {
        let mut ring = ring;
        for (axis, wall, sense) in
            [(0, self.low[0], 1.0), (0, self.high[0], -1.0), (1, self.low[1], 1.0), (1, self.high[1], -1.0)]
        {
            let inside = |p: Vec2| sense * (p[axis] - wall);
            let mut kept = Vec::with_capacity(ring.len() + 1);
            for i in 0..ring.len() {
                let (from, to) = (ring[i], ring[(i + 1) % ring.len()]);
                let (a, b) = (inside(from), inside(to));
                if a >= 0.0 {
                    kept.push(from);
                }
                if (a < 0.0) != (b < 0.0) {
                    let mut cut: Vec2 = std::array::from_fn(|k| from[k] + a / (a - b) * (to[k] - from[k]));
                    cut[axis] = wall;
                    kept.push(cut);
                }
            }
            for point in &mut kept {
                if inside(*point) < ON_WALL {
                    point[axis] = wall;
                }
            }
            ring = kept;
        }
        ring
    }
}
