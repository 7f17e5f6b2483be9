//! Waypoints beside the straight line from start to goal, where no links say between what they lie: a raster map
//! in the paper. Every obstacle stands for itself there, since zones that are put together close corners of rasters.

use auv_world::math::Vec2;
use serde::Deserialize;

use super::area::Area;
use super::fitness::BLOCKED;
use super::zone::Zone;

/// What a blocked path pays.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Penalty {
    /// 100 for each blocked leg, so that fewer are better.
    #[default]
    Graded,
    /// 100, however much of it is blocked (eq. 7).
    Binary,
}

/// What blocks legs, and what that costs.
#[derive(Debug, Clone)]
pub struct Line {
    /// The area, which no leg may leave.
    pub area: Area,
    /// Obstacles, each by itself.
    pub obstacles: Vec<Zone>,
    /// What a blocked path pays.
    pub penalty: Penalty,
}

impl Line {
    /// Whether a leg leaves the area or enters an obstacle.
    pub fn blocks(&self, from: Vec2, to: Vec2) -> bool {
        !(self.area.contains(from) && self.area.contains(to)) || self.obstacles.iter().any(|zone| zone.meets(from, to))
    }

    /// What so many blocked legs cost.
    pub fn cost(&self, blocked: u32) -> f64 {
        match self.penalty {
            Penalty::Graded => BLOCKED * f64::from(blocked),
            Penalty::Binary => BLOCKED * f64::from(blocked.min(1)),
        }
    }
}
