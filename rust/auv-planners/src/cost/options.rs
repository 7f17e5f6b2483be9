//! Which cost, and in which reading. The defaults are this project's readings of LFHH; the others are
//! there so that anyone can try them.

use auv_world::Scenario;
use serde::{Deserialize, Serialize};

use crate::error::{PlanError, within};

/// What planners minimise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Cost {
    /// LFHH's F: length, curvature, collisions, angle to the current (eq. 6-10).
    #[default]
    Lfhh,
    /// AFHH's cost: length, range of depth, length of the steps, blocked waypoints (Liu, Zhan et al. 2018,
    /// eq. 1-5).
    Afhh,
    /// Travel time with the current.
    Time,
    /// Energy with the current.
    Energy,
}

impl Cost {
    /// All names.
    pub const NAMES: [&'static str; 4] = ["lfhh", "afhh", "time", "energy"];

    /// The cost of that name.
    ///
    /// # Errors
    /// [`PlanError::Unknown`] listing the names.
    pub fn from_name(name: &str) -> Result<Self, PlanError> {
        match name {
            "lfhh" => Ok(Self::Lfhh),
            "afhh" => Ok(Self::Afhh),
            "time" => Ok(Self::Time),
            "energy" => Ok(Self::Energy),
            _ => Err(PlanError::unknown("cost", name, &Self::NAMES)),
        }
    }
}

/// Which angle eq. 8 limits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Angle {
    /// The change of direction must not exceed the limit.
    #[default]
    Turning,
    /// The angle between the two segments must not fall below the limit, as eq. 8 reads literally.
    Interior,
}

/// How eq. 9 tests a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Collision {
    /// Cost `afhh`: `waypoints`. Others: `segment` in 2-D or with a margin, else `cells`.
    #[default]
    Auto,
    /// The whole segment against the true shapes.
    Segment,
    /// Eight points of the segment in the cells of the nearest section.
    Cells,
    /// The segment's end point in the cells of the nearest section.
    Waypoints,
}

/// Which angles to the current count as 0 and 1 in eq. 10.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AlphaRange {
    /// 0 and pi.
    #[default]
    Fixed,
    /// The least and the greatest of the path itself.
    PerPath,
}

/// Readings and limits of a cost.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CostOptions {
    /// Which angle is limited.
    pub angle: Angle,
    /// T_theta of eq. 8 (rad).
    pub turn_limit_rad: f64,
    /// How collisions are tested.
    pub collision: Collision,
    /// Segments keep this clear of anything solid (m); only with `collision` `segment` or `auto`. The
    /// first and the last segment need no more than start and goal themselves have.
    pub margin_m: f64,
    /// The range of angles to the current.
    pub alpha: AlphaRange,
    /// Cost `afhh`: the longest step, in distances between sections (theta of its eq. 4).
    pub step_limit: f64,
}

impl Default for CostOptions {
    fn default() -> Self {
        Self {
            angle: Angle::Turning,
            turn_limit_rad: std::f64::consts::FRAC_PI_6,
            collision: Collision::Auto,
            margin_m: 0.0,
            alpha: AlphaRange::Fixed,
            step_limit: 1.75,
        }
    }
}

impl CostOptions {
    /// Checks every value.
    ///
    /// # Errors
    /// [`PlanError::Parameter`] naming the first that is not allowed.
    pub fn check(&self) -> Result<(), PlanError> {
        within("cost_options.turn_limit_rad", self.turn_limit_rad, 0.0, std::f64::consts::PI)?;
        within("cost_options.margin_m", self.margin_m, 0.0, 1e9)?;
        within("cost_options.step_limit", self.step_limit, 0.0, 1e9)?;
        if self.margin_m > 0.0 && matches!(self.collision, Collision::Cells | Collision::Waypoints) {
            let rule = "cells know no margin: needs collision = \"segment\" or \"auto\"";
            return Err(PlanError::parameter("cost_options.margin_m", self.margin_m, rule));
        }
        Ok(())
    }

    /// The collision test that `auto` means for a cost in a scenario.
    pub(crate) fn collision_in(&self, cost: Cost, scenario: &Scenario) -> Collision {
        match self.collision {
            Collision::Auto if cost == Cost::Afhh && self.margin_m == 0.0 => Collision::Waypoints,
            Collision::Auto if scenario.dimensions == 2 || self.margin_m > 0.0 => Collision::Segment,
            Collision::Auto => Collision::Cells,
            chosen => chosen,
        }
    }
}
