//! Planning: `plan`, `replan`, `path_cost`, `run_phases`.

use auv_planners::{Control, Cost, CostOptions, CostTerms, PlanError, protocol, registry, replanning};
use auv_world::math::Vec3;
use auv_world::settings;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors;
use crate::interrupt;
use crate::points;
use crate::world::World;

/// (planner, waypoints, feasible, cost, evaluations, history, window, harbor, coefficients).
type FoundPlan<'py> = (
    String,
    Bound<'py, PyArray2<f64>>,
    bool,
    Bound<'py, PyDict>,
    u64,
    Bound<'py, PyArray2<f64>>,
    Option<usize>,
    Option<HarborReport<'py>>,
    Bound<'py, PyDict>,
);

/// (gap_m, depth_m, corners, trace, barriers).
type HarborReport<'py> = (Option<f64>, f64, Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>, Vec<usize>);

/// Runs planning without the GIL; Ctrl-C stops it within a fraction of a second.
fn run<T: Send>(py: Python<'_>, work: impl FnOnce(&Control<'_>) -> Result<T, PlanError> + Send) -> PyResult<T> {
    interrupt::run(py, work, errors::planning)
}

fn terms<'py>(py: Python<'py>, cost: &CostTerms) -> PyResult<Bound<'py, PyDict>> {
    let terms = PyDict::new(py);
    for (name, value) in cost.named() {
        terms.set_item(name, value)?;
    }
    terms.set_item("feasible", f64::from(u8::from(cost.feasible)))?;
    Ok(terms)
}

fn found(py: Python<'_>, plan: auv_planners::Plan, window: Option<usize>) -> PyResult<FoundPlan<'_>> {
    let history = progress(py, &plan.history)?;
    let waypoints = points::table(py, &plan.waypoints)?;
    let harbor = match plan.harbor {
        Some(report) => {
            let corners = points::table(py, &report.corners)?;
            Some((report.gap_m, report.depth_m, corners, progress(py, &report.trace)?, report.barriers))
        }
        None => None,
    };
    let coefficients = PyDict::new(py);
    for (name, value) in &plan.coefficients {
        coefficients.set_item(name, value)?;
    }
    let cost = terms(py, &plan.cost)?;
    Ok((plan.planner, waypoints, plan.feasible, cost, plan.evaluations, history, window, harbor, coefficients))
}

/// Best values against evaluations, (m, 2) float64.
fn progress<'py>(py: Python<'py>, values: &[(u64, f64)]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let rows: Vec<[f64; 2]> = values.iter().map(|&(spent, best)| [spent as f64, best]).collect();
    PyArray1::from_slice(py, rows.as_flattened()).reshape([rows.len(), 2])
}

/// Names of the planners.
#[pyfunction]
pub fn list_planners() -> Vec<&'static str> {
    registry::planner_names()
}

/// Plans through the world as it is now.
#[pyfunction]
pub fn plan<'py>(
    py: Python<'py>,
    world: &World,
    planner: &str,
    start: Option<Vec3>,
    goal: Option<Vec3>,
    seed: u64,
    parameters_json: &str,
) -> PyResult<FoundPlan<'py>> {
    let world = world.0.clone();
    let start = points::finite("start", start.unwrap_or(world.mission().start_m))?;
    let goal = points::finite("goal", goal.unwrap_or(world.mission().goal_m))?;
    let plan = run(py, |control| registry::plan(planner, &world, start, goal, seed, parameters_json, control))?;
    found(py, plan, None)
}

/// Re-plans within a window of a global path.
#[pyfunction]
pub fn replan<'py>(
    py: Python<'py>,
    world: &World,
    path: PyReadonlyArray2<'py, f64>,
    position: Vec3,
    planner: &str,
    seed: u64,
    window: usize,
    parameters_json: &str,
) -> PyResult<FoundPlan<'py>> {
    let path = points::rows::<3>("path", &path)?.to_vec();
    let position = points::finite("position", position)?;
    let world = world.0.clone();
    let window = replanning::Window { sections: window, ..replanning::Window::default() };
    let replan = run(py, |control| {
        replanning::replan(&world, &path, position, planner, seed, parameters_json, window, control)
    })?;
    found(py, replan.plan, Some(replan.sections))
}

/// Readings of a cost from JSON.
pub fn cost_options(json: &str) -> PyResult<CostOptions> {
    let wrong = |message: String| errors::PlanningError::new_err(format!("options of the cost: {message}"));
    let options = serde_json::from_str(json).map_err(|error| wrong(error.to_string()))?;
    settings::read(options).map_err(|message| wrong(settings::suggest(message)))
}

/// The terms of a cost for any path.
#[pyfunction]
pub fn path_cost<'py>(
    py: Python<'py>,
    world: &World,
    waypoints: PyReadonlyArray2<'py, f64>,
    cost: &str,
    options_json: &str,
) -> PyResult<Bound<'py, PyDict>> {
    let rows = points::rows::<3>("waypoints", &waypoints)?;
    let cost = Cost::from_name(cost).map_err(errors::planning)?;
    let options = cost_options(options_json)?;
    let cost = auv_planners::path_cost(&world.0, rows, cost, &options).map_err(errors::planning)?;
    terms(py, &cost)
}

/// (cost, feasible, evaluations, window, position).
type Phase = (f64, bool, u64, usize, Vec3);

/// The papers' protocol, phase by phase.
#[pyfunction]
pub fn run_phases(
    py: Python<'_>,
    world: &World,
    planner: &str,
    seed: u64,
    window: Option<usize>,
    parameters_json: &str,
) -> PyResult<Vec<Phase>> {
    let world = world.0.clone();
    let window = window.map_or_else(replanning::Window::whole, |sections| replanning::Window {
        sections,
        ..replanning::Window::default()
    });
    let settings = protocol::Settings { window, ..protocol::Settings::default() };
    let run = run(py, |control| protocol::run(&world, planner, seed, parameters_json, settings, control))?;
    let phases = run.phases.into_iter();
    Ok(phases
        .map(|phase| (phase.cost.total, phase.feasible, phase.evaluations, phase.window_sections, phase.vehicle_m))
        .collect())
}
