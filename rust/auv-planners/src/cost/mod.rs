//! What a path costs: LFHH's F (eq. 6-10), AFHH's (its eq. 1-5), travel time or energy, for any polyline.

mod angle;
mod collision;
mod current;
mod evaluator;
mod flown;
mod options;
mod segments;
mod track;

pub use evaluator::Evaluator;
pub use flown::flown_cost;
pub use options::{AlphaRange, Angle, Collision, Cost, CostOptions};
pub(crate) use segments::Segments;

use auv_world::World;
use auv_world::math::Vec3;

use crate::error::PlanError;

/// Added to the share of offending segments, so that every infeasible path costs more than any feasible
/// one (LFHH eq. 8-9).
pub const PENALTY: f64 = 2.0;

/// The cost of a path, term by term.
///
/// `total = first + curvature + block + current`, where `first` is `length` (cost `lfhh`), `length + depth +
/// smooth` (cost `afhh`, which has no curvature or current) or the excess over still water (costs `time`, `energy`).
/// Penalties are 0 or lie in 2 ..= 3, so a feasible path of cost `lfhh` or `afhh` has a total below 2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CostTerms {
    /// The sum that planners minimise.
    pub total: f64,
    /// Whether no constraint is broken.
    pub feasible: bool,
    /// 1 - distance from start to goal / path length, in 0 .. 1 (LFHH eq. 7).
    pub length: f64,
    /// 0, or 2 + share of the turns that are too sharp (LFHH eq. 8).
    pub curvature: f64,
    /// 0, or 2 + share of the segments that collide (LFHH eq. 9). Cost `afhh`: share of the waypoints that
    /// are blocked (its eq. 5), start excepted.
    pub block: f64,
    /// Cost `lfhh`: mean angle between segments and current in units of pi (LFHH eq. 10). Costs `time` and
    /// `energy`: 0, or 2 + share of the segments along which the current beats the vehicle.
    pub current: f64,
    /// Length of the path (m).
    pub path_length_m: f64,
    /// Cost `afhh`: range of depth / depth of the box, in 0 ..= 1 (its eq. 3).
    pub depth: Option<f64>,
    /// Cost `afhh`: 0, or 2 + share of the segments that are too long (its eq. 4).
    pub smooth: Option<f64>,
    /// Costs `time` and `energy`: 1 - still-water time along the straight line / travel time; below 0
    /// if the current helps.
    pub excess: Option<f64>,
    /// Costs `time` and `energy`: travel time (s).
    pub time_s: Option<f64>,
    /// Costs `time` and `energy`: energy spent (J).
    pub energy_j: Option<f64>,
}

impl CostTerms {
    /// All numbers with their names, for tables and mappings.
    pub fn named(&self) -> Vec<(&'static str, f64)> {
        let mut terms = vec![("total", self.total), ("length", self.length), ("block", self.block)];
        if self.smooth.is_none() {
            terms.extend([("curvature", self.curvature), ("current", self.current)]);
        }
        terms.push(("path_length_m", self.path_length_m));
        let optional = [
            ("depth", self.depth),
            ("smooth", self.smooth),
            ("excess", self.excess),
            ("time_s", self.time_s),
            ("energy_j", self.energy_j),
        ];
        terms.extend(optional.into_iter().filter_map(|(name, value)| Some((name, value?))));
        terms
    }
}

/// The cost of any path through the world as it is now.
///
/// # Errors
/// [`PlanError`] if there are fewer than two waypoints, a coordinate is not finite, or an option is not
/// allowed.
pub fn path_cost(world: &World, waypoints: &[Vec3], cost: Cost, options: &CostOptions) -> Result<CostTerms, PlanError> {
    if waypoints.len() < 2 {
        return Err(PlanError::parameter(
            "waypoints",
            format!("{} points", waypoints.len()),
            "a path needs at least 2",
        ));
    }
    if let Some((i, point)) = waypoints.iter().enumerate().find(|(_, p)| p.iter().any(|v| !v.is_finite())) {
        return Err(PlanError::parameter(format!("waypoints[{i}]"), format!("{point:?}"), "must be finite"));
    }
    let mut evaluator = Evaluator::for_path(world, cost, options, waypoints)?;
    Ok(evaluator.terms_of(waypoints))
}

#[cfg(test)]
mod tests;
