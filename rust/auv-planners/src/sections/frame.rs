//! Where the sections lie: a straight line through the world, cut at equal distances by vertical planes.
//!
//! A point has three coordinates here: its section (0 at the first plane, growing by 1 from plane to
//! plane), its lateral place (m, to the right when looking along) and its depth (m).

use auv_world::World;
use auv_world::math::{Vec2, Vec3};
use auv_world::scenario::{Domain, SectionFrame};

/// Sections for a scenario that says nothing about them.
const DEFAULT_COUNT: usize = 40;

/// The planes and their free width.
#[derive(Debug, Clone)]
pub struct Frame {
    origin: Vec2,
    along: Vec2,
    spacing: f64,
    low: Vec<f64>,
    high: Vec<f64>,
    depth: [f64; 2],
}

impl Frame {
    /// The frame that the world's scenario asks for: planes y = min_y + j spacing with the lateral place
    /// equal to x, or planes across the line from the mission's start to its goal. Without
    /// `[sections]`: 40 planes across the mission, as wide as the box.
    pub fn new(world: &World) -> Self {
        let scenario = world.scenario();
        let domain = &scenario.domain;
        let depth = [domain.min_m[2], domain.max_m[2]];
        let mission = world.mission();
        let sections = scenario.sections.as_ref();
        let count = sections.map_or(DEFAULT_COUNT, |sections| sections.count);
        let frame = sections.map_or(SectionFrame::Mission, |sections| sections.frame);
        let (origin, along, spacing, half_width) = match (frame, sections.and_then(|s| s.spacing_m)) {
            (SectionFrame::Domain, Some(spacing)) => ([0.0, domain.min_m[1]], [0.0, 1.0], spacing, f64::INFINITY),
            _ => {
                let (start, goal) = (mission.start_m, mission.goal_m);
                let way = [goal[0] - start[0], goal[1] - start[1]];
                let length = (way[0] * way[0] + way[1] * way[1]).sqrt();
                // A mission straight up or down has no direction of its own: look along y.
                let (along, length) =
                    if length > 0.0 { ([way[0] / length, way[1] / length], length) } else { ([0.0, 1.0], 1.0) };
                let half_width = sections.and_then(|s| s.half_width_m).unwrap_or(f64::INFINITY);
                ([start[0], start[1]], along, length / (count - 1) as f64, half_width)
            }
        };
        let mut frame = Self { origin, along, spacing, low: Vec::new(), high: Vec::new(), depth };
        for section in 0..count {
            let (low, high) = frame.free_width(section, domain);
            frame.low.push(low.max(-half_width));
            frame.high.push(high.min(half_width));
        }
        frame
    }

    /// From where to where the line of a section runs inside the box (lateral, m).
    fn free_width(&self, section: usize, domain: &Domain) -> (f64, f64) {
        let base = self.point(section, 0.0, 0.0);
        let right = self.right();
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in 0..2 {
            if right[axis].abs() < 1e-12 {
                continue;
            }
            let (a, b) =
                ((domain.min_m[axis] - base[axis]) / right[axis], (domain.max_m[axis] - base[axis]) / right[axis]);
            low = low.max(a.min(b));
            high = high.min(a.max(b));
        }
        (low, high.max(low))
    }

    /// Unit vector to the right.
    #[inline]
    pub fn right(&self) -> Vec2 {
        [self.along[1], -self.along[0]]
    }

    /// Number of sections.
    pub fn count(&self) -> usize {
        self.low.len()
    }

    /// Distance between sections (m).
    pub fn spacing_m(&self) -> f64 {
        self.spacing
    }

    /// Free width of a section: lowest and highest lateral place (m).
    pub fn lateral_bounds(&self, section: usize) -> [f64; 2] {
        [self.low[section], self.high[section]]
    }

    /// Least and greatest depth (m).
    pub fn depth_bounds(&self) -> [f64; 2] {
        self.depth
    }

    /// How far along a place is, in sections.
    #[inline]
    pub fn section(&self, x: f64, y: f64) -> f64 {
        ((x - self.origin[0]) * self.along[0] + (y - self.origin[1]) * self.along[1]) / self.spacing
    }

    /// Lateral place (m).
    #[inline]
    pub fn lateral(&self, x: f64, y: f64) -> f64 {
        let right = self.right();
        (x - self.origin[0]) * right[0] + (y - self.origin[1]) * right[1]
    }

    /// The point on a section at a lateral place and a depth (m).
    #[inline]
    pub fn point(&self, section: usize, lateral: f64, depth: f64) -> Vec3 {
        let base = self.base(section);
        let right = self.right();
        [base[0] + right[0] * lateral, base[1] + right[1] * lateral, depth]
    }

    /// The point of a section at lateral place 0 (m).
    #[inline]
    pub fn base(&self, section: usize) -> Vec2 {
        let distance = section as f64 * self.spacing;
        [self.origin[0] + self.along[0] * distance, self.origin[1] + self.along[1] * distance]
    }

    /// Unit vector along.
    pub fn along(&self) -> Vec2 {
        self.along
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn domain_frame_keeps_coordinates_exactly() {
        let world = testing::paper_world("lfhh-3d-1", 0);
        let frame = Frame::new(&world);
        assert_eq!(frame.count(), 40);
        for section in 0..40 {
            let point = frame.point(section, 1234.567, 89.01);
            assert_eq!(point, [1234.567, 1000.0 * section as f64, 89.01]);
            assert_eq!(frame.section(point[0], point[1]), section as f64);
            assert_eq!(frame.lateral(point[0], point[1]), 1234.567);
            assert_eq!(frame.lateral_bounds(section), [0.0, 20e3]);
        }
    }

    #[test]
    fn mission_frame_runs_from_start_to_goal_inside_the_box() {
        let world = testing::mission_frame_world();
        let frame = Frame::new(&world);
        let mission = world.mission();
        let (start, goal) = (mission.start_m, mission.goal_m);
        let last = frame.count() - 1;
        for (section, end) in [(0, start), (last, goal)] {
            let point = frame.point(section, 0.0, end[2]);
            assert!(auv_world::math::distance(point, end) < 1e-6);
        }
        let domain = &world.scenario().domain;
        for section in 0..=last {
            let [low, high] = frame.lateral_bounds(section);
            assert!(low <= 0.0 && high >= 0.0 && low >= -6e3 && high <= 6e3);
            for lateral in [low, high] {
                let point = frame.point(section, lateral, 0.0);
                assert!((0..2).all(|k| point[k] >= domain.min_m[k] - 1e-6 && point[k] <= domain.max_m[k] + 1e-6));
                assert!((frame.section(point[0], point[1]) - section as f64).abs() < 1e-9);
                assert!((frame.lateral(point[0], point[1]) - lateral).abs() < 1e-6);
            }
        }
    }
}
