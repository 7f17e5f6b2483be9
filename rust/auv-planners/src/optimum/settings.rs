//! The planner's parameters: how fine the lattice is, and how far its steps reach.

use serde::Deserialize;

use super::lattice::Grain;
use crate::error::{PlanError, within};
use crate::parameters::Parameters;
use crate::sections::SectionProblem;

/// Lateral distance between places, in distances between sections, in 2-D ...
const LATERAL_2D: f64 = 0.2;
/// ... and in 3-D.
const LATERAL_3D: f64 = 0.5;
/// Distance between depths in distances between sections ...
const DEPTH: f64 = 0.5;
/// ... and no more than this part of the box's depth, for seas that are wide and shallow.
const LAYER: f64 = 1.0 / 20.0;
/// Longest lateral step in 3-D, in distances between sections. In 2-D steps reach everywhere.
const LATERAL_REACH: f64 = 3.0;
/// Longest step of depth, in distances between depths.
const DEPTH_REACH: f64 = 3.0;

/// Parameters of `section-optimum`. Of a length, 0 means the default.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Lateral distance between places of the lattice (m).
    pub lateral_m: f64,
    /// Distance between depths of the lattice (m), 3-D.
    pub depth_m: f64,
    /// Longest lateral step between sections (m).
    pub lateral_reach_m: f64,
    /// Longest step of depth between sections (m), 3-D.
    pub depth_reach_m: f64,
    /// Whether the best lattice path is refined between the places of the lattice.
    pub polish: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self { lateral_m: 0.0, depth_m: 0.0, lateral_reach_m: 0.0, depth_reach_m: 0.0, polish: true }
    }
}

impl Parameters for Settings {
    fn check(&self) -> Result<(), PlanError> {
        within("lateral_m", self.lateral_m, 0.0, 1e9)?;
        within("depth_m", self.depth_m, 0.0, 1e9)?;
        within("lateral_reach_m", self.lateral_reach_m, 0.0, 1e9)?;
        within("depth_reach_m", self.depth_reach_m, 0.0, 1e9)
    }
}

impl Settings {
    /// The lattice that a problem gets.
    pub fn grain(&self, problem: &SectionProblem) -> Grain {
        let spacing = problem.frame().spacing_m();
        let [top, bottom] = problem.frame().depth_bounds();
        let or = |given: f64, default: f64| if given > 0.0 { given } else { default };
        let deep = problem.has_depth();
        let lateral = or(self.lateral_m, spacing * if deep { LATERAL_3D } else { LATERAL_2D });
        let depth = or(self.depth_m, (spacing * DEPTH).min((bottom - top) * LAYER));
        let lateral_reach = or(self.lateral_reach_m, if deep { spacing * LATERAL_REACH } else { f64::INFINITY });
        let depth_reach = or(self.depth_reach_m, depth * DEPTH_REACH);
        Grain { step: [lateral, depth], reach: [lateral_reach, depth_reach] }
    }
}
