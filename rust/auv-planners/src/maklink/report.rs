//! What a planner in a harbour says beside its path.

use auv_world::math::Vec3;

/// How a plan stands to the exact answer and to the danger zones.
#[derive(Debug, Clone, PartialEq)]
pub struct HarborReport {
    /// Length above that of the shortest path of all round the same zones, which planner `visibility` finds (m).
    /// Below 0 where smoothing cuts through zones. `None` if there is no way, or the caller interrupted.
    pub gap_m: Option<f64>,
    /// How deep the path gets into danger zones (m): 0 unless smoothing cuts into them.
    pub depth_m: f64,
    /// The path before smoothing, from start to goal (m).
    pub corners: Vec<Vec3>,
    /// The least value so far of what the planner minimises, after so many evaluations, generation by generation:
    /// of swarms the cost F, of others the length (m).
    pub trace: Vec<(u64, f64)>,
    /// Where there is no way: the polygons whose zones part the goal from the start.
    pub barriers: Vec<usize>,
}
