//! The nodes of a regular grid over the box, and straight legs between places in it.

use auv_world::World;
use auv_world::kinematics::travel_time;
use auv_world::math::{Vec3, add_scaled, distance, sub};

use super::Settings;

/// Most nodes a grid may have.
const MOST_NODES: f64 = 4e6;

/// A regular grid; node indices run along x first, then y, then z.
#[derive(Debug, Clone)]
pub struct Grid {
    origin: Vec3,
    spacing: Vec3,
    counts: [usize; 3],
    speed: f64,
    inflation: f64,
}

impl Grid {
    /// The grid of a world. One finer than memory allows is made coarser.
    pub fn new(world: &World, settings: Settings) -> Self {
        let domain = &world.scenario().domain;
        let size: Vec3 = std::array::from_fn(|axis| domain.max_m[axis] - domain.min_m[axis]);
        let nodes = |spacing: f64| size.iter().map(|edge| (edge / spacing).round() + 1.0).product::<f64>();
        let mut wanted = settings.spacing_or(world, 1.0);
        while nodes(wanted) > MOST_NODES {
            // As if all three edges counted; where they do not, again.
            wanted *= libm::cbrt(nodes(wanted) / MOST_NODES).max(1.001);
        }
        let counts: [usize; 3] = std::array::from_fn(|axis| (size[axis] / wanted).round() as usize + 1);
        let spacing: Vec3 = std::array::from_fn(|axis| match counts[axis] {
            1 => wanted,
            count => size[axis] / (count - 1) as f64,
        });
        let speed = world.scenario().vehicle.speed_mps;
        Self { origin: domain.min_m, spacing, counts, speed, inflation: settings.inflation_in(world) }
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.counts.iter().product()
    }

    /// Nodes of one depth.
    pub fn layer(&self) -> usize {
        self.counts[0] * self.counts[1]
    }

    /// Nodes along x, y, z.
    pub fn counts(&self) -> [usize; 3] {
        self.counts
    }

    /// Distance between nodes along x, y, z (m).
    pub fn spacing(&self) -> Vec3 {
        self.spacing
    }

    /// The vehicle's speed through water (m/s).
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// The clearance that nodes keep (m).
    pub fn inflation(&self) -> f64 {
        self.inflation
    }

    /// The greatest distance between nodes along an axis (m).
    pub fn widest(&self) -> f64 {
        self.spacing.iter().fold(0.0, |a: f64, b| a.max(*b))
    }

    /// Which node along x, y, z.
    pub fn cell(&self, node: usize) -> [usize; 3] {
        [node % self.counts[0], node / self.counts[0] % self.counts[1], node / self.layer()]
    }

    /// Where a node lies (m).
    pub fn place(&self, node: usize) -> Vec3 {
        let cell = self.cell(node);
        std::array::from_fn(|axis| self.origin[axis] + cell[axis] as f64 * self.spacing[axis])
    }

    /// Nodes no farther than `radius` from a point, in order of their index.
    pub fn nodes_within(&self, point: Vec3, radius: f64) -> Vec<usize> {
        let range = |axis: usize| {
            let low = ((point[axis] - radius - self.origin[axis]) / self.spacing[axis]).ceil().max(0.0) as usize;
            let high = ((point[axis] + radius - self.origin[axis]) / self.spacing[axis]).floor();
            let high = if high < 0.0 { 0 } else { (high as usize + 1).min(self.counts[axis]) };
            low..high
        };
        let mut nodes = Vec::new();
        for iz in range(2) {
            for iy in range(1) {
                for ix in range(0) {
                    let node = ix + self.counts[0] * (iy + self.counts[1] * iz);
                    if distance(self.place(node), point) <= radius {
                        nodes.push(node);
                    }
                }
            }
        }
        nodes
    }

    /// The nodes by which a way may begin at `position`, and the time to get there (s). Rings 1, 2, ...
    /// look ever farther.
    pub fn entries(&self, world: &World, position: Vec3, ring: u32) -> impl Iterator<Item = (usize, f64)> {
        self.nodes_within(position, 1.5 * self.widest() * f64::from(ring))
            .into_iter()
            .map(move |node| (node, travel_time(world, position, self.place(node), self.speed, 4)))
            .filter(|(_, seconds)| seconds.is_finite())
    }

    /// Whether the segment ab is free. Near start and goal the inflation gives way to what room there is.
    pub fn free(&self, world: &World, a: Vec3, at_a: f64, b: Vec3, at_b: f64) -> bool {
        let margin = self.inflation.min(at_a).min(at_b).max(0.0);
        self.clear_of(world, a, at_a, b, at_b, margin)
    }

    /// Whether the segment ab keeps `margin` from everything solid: balls of the clearances at its ends
    /// cover it, or both of its halves are covered.
    pub fn clear_of(&self, world: &World, a: Vec3, at_a: f64, b: Vec3, at_b: f64, margin: f64) -> bool {
        let length = distance(a, b);
        if at_a < margin || at_b < margin {
            return false;
        }
        if at_a + at_b - 2.0 * margin >= length {
            return true;
        }
        if length < 0.02 * self.spacing[0] {
            return true;
        }
        let middle = add_scaled(a, 0.5, sub(b, a));
        let at_middle = world.clearance(middle);
        self.clear_of(world, a, at_a, middle, at_middle, margin)
            && self.clear_of(world, middle, at_middle, b, at_b, margin)
    }

    /// How long a straight leg takes (s); `None` if it is not free.
    pub fn leg(&self, world: &World, a: Vec3, b: Vec3) -> Option<f64> {
        let pieces = (2.0 * distance(a, b) / self.spacing[0]).ceil().clamp(1.0, 64.0) as usize;
        let seconds = travel_time(world, a, b, self.speed, pieces);
        (seconds.is_finite() && self.free(world, a, world.clearance(a), b, world.clearance(b))).then_some(seconds)
    }
}
