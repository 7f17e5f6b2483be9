//! Parameters of the planners on a grid.

use auv_world::World;
use serde::{Deserialize, Serialize};

use crate::error::{PlanError, within};
use crate::parameters::Parameters;

/// How finely the world is looked at, and how far from solids.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Distance between nodes (m); 0 chooses 1/80 (2-D) or 1/40 (3-D) of the longest edge of the box.
    pub spacing_m: f64,
    /// Nodes and edges keep this clear of solids (m); without it the scenario's margin of waypoints.
    pub inflation_m: Option<f64>,
}

impl Parameters for Settings {
    fn check(&self) -> Result<(), PlanError> {
        within("spacing_m", self.spacing_m, 0.0, 1e9)?;
        within("inflation_m", self.inflation_m.unwrap_or(0.0), 0.0, 1e9)
    }
}

impl Settings {
    /// The clearance asked for, or the default for a world (m).
    pub(super) fn inflation_in(&self, world: &World) -> f64 {
        self.inflation_m.unwrap_or(world.scenario().episode.waypoint_margin_m)
    }

    /// The spacing asked for, or `part` of the default for a world (m).
    pub(super) fn spacing_or(&self, world: &World, part: f64) -> f64 {
        if self.spacing_m > 0.0 {
            return self.spacing_m;
        }
        let domain = &world.scenario().domain;
        let longest = (0..3).map(|axis| domain.max_m[axis] - domain.min_m[axis]).fold(0.0, f64::max);
        part * longest / if world.scenario().dimensions == 2 { 80.0 } else { 40.0 }
    }
}
