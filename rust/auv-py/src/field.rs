//! `TimeField`: the time to the goal from everywhere.

use auv_planners::grid;
use auv_world::math::Vec3;
use numpy::PyArray1;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::errors::PlanningError;
use crate::interrupt::Signals;
use crate::points;
use crate::world::World;

/// Grid settings from Python's arguments.
pub fn settings(spacing_m: Option<f64>, inflation_m: Option<f64>) -> PyResult<grid::Settings> {
    for (name, value) in [("spacing_m", spacing_m.unwrap_or(1.0)), ("inflation_m", inflation_m.unwrap_or(0.0))] {
        if !(value.is_finite() && value >= 0.0) {
            return Err(PlanningError::new_err(format!("{name} = {value}: must be finite and not negative")));
        }
    }
    Ok(grid::Settings { spacing_m: spacing_m.unwrap_or(0.0), inflation_m })
}

/// Times to the goal over a grid, through the world as it was when this was made.
#[pyclass(frozen, module = "auvgym._core")]
pub struct TimeField(grid::TimeField);

#[pymethods]
impl TimeField {
    #[new]
    #[pyo3(signature = (world, goal=None, spacing_m=None, inflation_m=None))]
    fn new(
        py: Python<'_>,
        world: &World,
        goal: Option<Vec3>,
        spacing_m: Option<f64>,
        inflation_m: Option<f64>,
    ) -> PyResult<Self> {
        let settings = settings(spacing_m, inflation_m)?;
        let goal = points::finite("goal", goal.unwrap_or(world.0.mission().goal_m))?;
        let world = world.0.clone();
        let mut signals = Signals::new();
        let field = py.detach(|| grid::TimeField::new(&world, goal, settings, &mut || signals.stop()));
        signals.finish()?;
        field.map(Self).ok_or_else(|| PyRuntimeError::new_err("interrupted"))
    }

    #[getter]
    fn evaluations(&self) -> u64 {
        self.0.settled()
    }

    /// Where to steer from `position`, within `reach_m`; None if nothing is in free reach.
    fn best_waypoint<'py>(
        &self,
        py: Python<'py>,
        world: &World,
        position: Vec3,
        reach_m: f64,
    ) -> PyResult<Option<Bound<'py, PyArray1<f64>>>> {
        let position = points::finite("position", position)?;
        let waypoint = py.detach(|| self.0.best_waypoint(&world.0, position, reach_m));
        Ok(waypoint.map(|waypoint| points::point(py, waypoint)))
    }
}
