//! What a planner gives back.

use auv_world::math::Vec3;

use crate::cost::CostTerms;
use crate::maklink::HarborReport;

/// A planner's answer. If it found no feasible path it says so and gives the best of the others.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// The planner's name.
    pub planner: String,
    /// The path, from start to goal (m).
    pub waypoints: Vec<Vec3>,
    /// Whether the path breaks no constraint of its cost.
    pub feasible: bool,
    /// The cost of `waypoints`, to the last bit what [`crate::path_cost`] says of them.
    pub cost: CostTerms,
    /// Paths evaluated (planners on a grid: nodes settled; sampling planners: motions tested).
    pub evaluations: u64,
    /// Best total cost after so many evaluations: once for each generation, or path found.
    pub history: Vec<(u64, f64)>,
    /// Coefficients with which the path was drawn, by name: those of the flow planners, which tune them.
    pub coefficients: Vec<(&'static str, f64)>,
    /// Whether the caller interrupted it.
    pub interrupted: bool,
    /// What planners in harbours say of it.
    pub harbor: Option<Box<HarborReport>>,
}
