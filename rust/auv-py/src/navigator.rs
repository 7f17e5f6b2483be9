//! `Navigator`: the flow as a law of motion among threats.

use auv_planners::fluid::threats;
use auv_world::math::Vec3;
use auv_world::settings;
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::errors;
use crate::points;
use crate::world::World;

/// (velocity, waypoint).
type Course<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>);

/// A vehicle's way from start to goal among threats that it sees.
#[pyclass(module = "auvgym._core")]
pub struct Navigator(threats::Navigator);

/// (centre, velocity, radius).
type Threat = (Vec3, Vec3, f64);

#[pymethods]
impl Navigator {
    /// A navigator that knows what is at rest in the world, its box and its current, but no threat.
    #[new]
    fn new(world: &World, start: Vec3, goal: Vec3, parameters_json: &str) -> PyResult<Self> {
        let wrong = |message: String| errors::PlanningError::new_err(format!("parameters of the navigator: {message}"));
        let value = serde_json::from_str(parameters_json).map_err(|error| wrong(error.to_string()))?;
        let own: threats::Settings = settings::read(value).map_err(|message| wrong(settings::suggest(message)))?;
        let ends = [points::finite("start", start)?, points::finite("goal", goal)?];
        own.navigator(&world.0, ends).map(Self).map_err(errors::planning)
    }

    /// Takes in that something of a radius (m) was measured to be somewhere (m).
    fn see(&mut self, position: Vec3, radius_m: f64, time_s: f64) -> PyResult<()> {
        if !(radius_m.is_finite() && radius_m > 0.0) {
            return Err(PyValueError::new_err(format!("radius_m = {radius_m}: must be finite and positive")));
        }
        self.0.see(points::finite("position", position)?, radius_m, points::time(time_s)?);
        Ok(())
    }

    /// Forgets the threats that were seen last before a time (s).
    fn forget(&mut self, before_s: f64) -> PyResult<()> {
        self.0.forget(points::time(before_s)?);
        Ok(())
    }

    /// The threats that are known, as they are expected to be.
    fn threats(&self, time_s: f64) -> PyResult<Vec<Threat>> {
        let known = self.0.threats(points::time(time_s)?);
        Ok(known.into_iter().map(|ball| (ball.centre, ball.velocity, ball.radius)).collect())
    }

    /// Velocity over ground (m/s) for the next `tick_s` seconds, and where it leads (m).
    fn course<'py>(&mut self, py: Python<'py>, position: Vec3, time_s: f64, tick_s: f64) -> PyResult<Course<'py>> {
        let position = points::finite("position", position)?;
        let course = self.0.course(position, points::time(time_s)?, points::time(tick_s)?);
        Ok((points::point(py, course.velocity), points::point(py, course.waypoint)))
    }
}
