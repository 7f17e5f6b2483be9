//! `SectionProblem`: a section problem for any optimiser.

use std::sync::Mutex;

use auv_planners::{Cost, CostOptions, sections};
use auv_world::math::Vec3;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::errors;
use crate::planning::cost_options;
use crate::points;
use crate::world::World;

/// A box of numbers and a cost. The evaluator has room for one path at a time, hence the lock.
#[pyclass(frozen, module = "auvgym._core")]
pub struct SectionProblem(Mutex<sections::SectionProblem>);

impl SectionProblem {
    /// The problem; one that another thread left while it panicked is as good as before.
    fn get(&self) -> std::sync::MutexGuard<'_, sections::SectionProblem> {
        self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }
}

#[pymethods]
impl SectionProblem {
    #[new]
    fn new(world: &World, start: Option<Vec3>, goal: Option<Vec3>, cost: &str, options_json: &str) -> PyResult<Self> {
        let start = points::finite("start", start.unwrap_or(world.0.mission().start_m))?;
        let goal = points::finite("goal", goal.unwrap_or(world.0.mission().goal_m))?;
        let cost = Cost::from_name(cost).map_err(errors::planning)?;
        let options: CostOptions = cost_options(options_json)?;
        let problem = sections::SectionProblem::new(&world.0, start, goal, cost, &options).map_err(errors::planning)?;
        Ok(Self(Mutex::new(problem)))
    }

    #[getter]
    fn low<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.get().low())
    }

    #[getter]
    fn high<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.get().high())
    }

    /// Total cost of each row of genes.
    fn evaluate<'py>(&self, py: Python<'py>, genes: PyReadonlyArray2<'py, f64>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let count = self.get().genes();
        if genes.shape()[1] != count {
            let message = format!("genes has shape {:?}: must be (n, {count})", genes.shape());
            return Err(PyValueError::new_err(message));
        }
        let rows = genes.shape()[0];
        let values = genes.as_slice().map_err(|_| PyValueError::new_err("genes must be contiguous in C order"))?;
        if let Some(i) = values.iter().position(|value| !value.is_finite()) {
            let (row, gene) = (i / count, i % count);
            return Err(PyValueError::new_err(format!("genes[{row}, {gene}] = {}: must be finite", values[i])));
        }
        let totals = py.detach(|| {
            let mut problem = self.get();
            (0..rows).map(|row| problem.evaluate(&values[row * count..][..count]).total).collect::<Vec<_>>()
        });
        Ok(PyArray1::from_vec(py, totals))
    }

    /// The path of one candidate, (n, 3) m.
    fn path<'py>(&self, py: Python<'py>, genes: PyReadonlyArray1<'py, f64>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let problem = self.get();
        let genes = genes.as_slice().map_err(|_| PyValueError::new_err("genes must be contiguous"))?;
        if genes.len() != problem.genes() {
            let message = format!("genes has shape ({},): must be ({},)", genes.len(), problem.genes());
            return Err(PyValueError::new_err(message));
        }
        points::table(py, &problem.path(genes))
    }
}
