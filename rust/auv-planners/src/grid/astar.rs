//! Planner `astar`: the fastest way over a grid, through the present map and currents.

use super::{Settings, plan};
use crate::cost::path_cost;
use crate::error::{PlanError, within};
use crate::parameters::Parameters;
use crate::plan::Plan;
use crate::registry::Request;
use crate::sections::check_place;

impl Parameters for Settings {
    fn check(&self) -> Result<(), PlanError> {
        within("spacing_m", self.spacing_m, 0.0, 1e9)?;
        within("inflation_m", self.inflation_m, 0.0, 1e9)
    }
}

/// Answers a request with the path of least travel time. `feasible` says that a way was found that keeps
/// clear of everything solid and on which the vehicle beats the current; `cost` judges the path by the
/// request's cost like any other. `max_evaluations` does not apply: the search is exact and ends by itself.
///
/// # Errors
/// [`PlanError`] naming the parameter, start or goal that is not allowed.
pub fn plan_astar(request: &Request<'_>) -> Result<Plan, PlanError> {
    let (common, settings) = request.parse::<Settings>()?;
    check_place(request.world, "start", request.start)?;
    check_place(request.world, "goal", request.goal)?;
    let found = plan(request.world, request.start, request.goal, settings, &mut || request.control.interrupted());
    let (waypoints, feasible, evaluations) = match &found {
        Some(path) => (path.waypoints.clone(), path.feasible, path.evaluations),
        None => (vec![request.start, request.goal], false, 0),
    };
    let cost = path_cost(request.world, &waypoints, common.cost, &common.cost_options)?;
    let history = vec![(evaluations, cost.total)];
    let planner = request.planner.to_owned();
    Ok(Plan { planner, waypoints, feasible, cost, evaluations, history, interrupted: found.is_none() })
}
