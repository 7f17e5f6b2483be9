//! Parameters of the sampling planners.

use serde::Deserialize;

use crate::error::{PlanError, within};
use crate::parameters::Parameters;

/// What a sampling planner minimises.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Objective {
    /// Length of the path.
    #[default]
    Length,
    /// Travel time through the present current.
    Time,
}

/// Parameters of RRT*.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RrtStar {
    /// What is minimised.
    pub objective: Objective,
    /// Paths keep this clear of solids (m); the first and the last motion no more than start and goal can.
    pub margin_m: f64,
    /// Whether paths found are shortened by leaving out waypoints.
    pub shortcut: bool,
    /// The radius of connection in units of the least with which the path is known to converge.
    pub radius_factor: f64,
    /// Longest motion (m; eta); 0 chooses 1/5 of the longest edge of the box.
    pub step_m: f64,
    /// Share of the samples that are the goal, until there is a path.
    pub goal_bias: f64,
}

impl Default for RrtStar {
    fn default() -> Self {
        Self {
            objective: Objective::Length,
            margin_m: 0.0,
            shortcut: true,
            radius_factor: 1.1,
            step_m: 0.0,
            goal_bias: 0.05,
        }
    }
}

impl Parameters for RrtStar {
    fn check(&self) -> Result<(), PlanError> {
        within("margin_m", self.margin_m, 0.0, 1e9)?;
        within("radius_factor", self.radius_factor, 0.01, 10.0)?;
        within("step_m", self.step_m, 0.0, 1e9)?;
        within("goal_bias", self.goal_bias, 0.0, 1.0)
    }
}

/// Parameters of PRM*.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PrmStar {
    /// What is minimised.
    pub objective: Objective,
    /// Paths keep this clear of solids (m); the first and the last motion no more than start and goal can.
    pub margin_m: f64,
    /// Whether paths found are shortened by leaving out waypoints.
    pub shortcut: bool,
    /// The radius of connection in units of the least with which the path is known to converge.
    pub radius_factor: f64,
    /// Samples of the first roadmap (n); the next ones have twice as many each.
    pub samples: usize,
}

impl Default for PrmStar {
    fn default() -> Self {
        Self { objective: Objective::Length, margin_m: 0.0, shortcut: true, radius_factor: 1.1, samples: 100 }
    }
}

impl Parameters for PrmStar {
    fn check(&self) -> Result<(), PlanError> {
        within("margin_m", self.margin_m, 0.0, 1e9)?;
        within("radius_factor", self.radius_factor, 0.01, 10.0)?;
        within("samples", self.samples, 1, super::prm_star::MOST_NODES)
    }
}
