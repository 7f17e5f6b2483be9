//! What is measured of an episode, and how it stands.

use serde::{Deserialize, Serialize};

/// How an episode stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Outcome {
    /// Not over.
    Running,
    /// Within the goal radius.
    Goal,
    /// Inside something solid.
    Collision,
    /// Beyond the margin round the box.
    OutOfBounds,
    /// No energy left.
    Energy,
    /// No time left.
    Timeout,
}

impl Outcome {
    /// All, in order.
    pub const ALL: [Self; 6] =
        [Self::Running, Self::Goal, Self::Collision, Self::OutOfBounds, Self::Energy, Self::Timeout];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Running => "running",
            Self::Goal => "goal",
            Self::Collision => "collision",
            Self::OutOfBounds => "out_of_bounds",
            Self::Energy => "energy",
            Self::Timeout => "timeout",
        }
    }
}

/// Whether an episode keeps where the vehicle was and what was ordered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Record {
    /// Every tick and action, for pictures and replays.
    Everything,
    /// Nothing but the present: a few tens of kilobytes less.
    Nothing,
}

/// What is measured of an episode, SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measures {
    /// Time since the start (s).
    pub time_s: f64,
    /// Energy spent (J).
    pub energy_j: f64,
    /// Length of the path over ground (m).
    pub path_length_m: f64,
    /// Least clearance so far (m).
    pub min_clearance_m: f64,
    /// Distance to the goal (m).
    pub distance_to_goal_m: f64,
    /// Planner evaluations charged.
    pub evaluations: u64,
    /// Plans after the first.
    pub replans: u64,
    /// Time spent holding station while a plan was made (s).
    pub planning_s: f64,
    /// Plans after the first that found no way and were not taken.
    pub failed_plans: u64,
    /// Whether the planner found the plan in flight to break no constraint.
    pub plan_feasible: bool,
    /// Map changes so far.
    pub map_changes: usize,
    /// Whether the last leg ended with one.
    pub map_changed: bool,
    /// How the episode stands.
    pub outcome: Outcome,
}

impl Default for Measures {
    fn default() -> Self {
        Self {
            time_s: 0.0,
            energy_j: 0.0,
            path_length_m: 0.0,
            min_clearance_m: 0.0,
            distance_to_goal_m: 0.0,
            evaluations: 0,
            replans: 0,
            planning_s: 0.0,
            failed_plans: 0,
            plan_feasible: false,
            map_changes: 0,
            map_changed: false,
            outcome: Outcome::Running,
        }
    }
}

/// What an episode may spend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Straight line from start to goal (m).
    pub distance_m: f64,
    /// Time limit (s).
    pub time_s: f64,
    /// Energy budget (J).
    pub energy_j: f64,
}
