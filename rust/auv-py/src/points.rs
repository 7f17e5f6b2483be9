//! Points across the border: finite or refused.

use auv_world::math::Vec3;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// (n, width) float64, C order, every entry finite.
pub fn rows<'a, const WIDTH: usize>(name: &str, points: &'a PyReadonlyArray2<'_, f64>) -> PyResult<&'a [[f64; WIDTH]]> {
    if points.shape()[1] != WIDTH {
        let message = format!("{name} has shape {:?}: must be (n, {WIDTH})", points.shape());
        return Err(PyValueError::new_err(message));
    }
    let values =
        points.as_slice().map_err(|_| PyValueError::new_err(format!("{name} must be contiguous in C order")))?;
    if let Some(i) = values.iter().position(|value| !value.is_finite()) {
        let (row, column) = (i / WIDTH, i % WIDTH);
        return Err(PyValueError::new_err(format!("{name}[{row}, {column}] = {}: must be finite", values[i])));
    }
    Ok(values.as_chunks::<WIDTH>().0)
}

/// A point whose entries are finite.
pub fn finite(name: &str, point: Vec3) -> PyResult<Vec3> {
    match point.iter().position(|value| !value.is_finite()) {
        Some(i) => Err(PyValueError::new_err(format!("{name}[{i}] = {}: must be finite", point[i]))),
        None => Ok(point),
    }
}

/// A time that is finite.
pub fn time(time_s: f64) -> PyResult<f64> {
    if time_s.is_finite() {
        Ok(time_s)
    } else {
        Err(PyValueError::new_err(format!("time_s = {time_s}: must be finite")))
    }
}

/// (n, 3) float64 for Python.
pub fn table<'py>(py: Python<'py>, points: &[Vec3]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    PyArray1::from_slice(py, points.as_flattened()).reshape([points.len(), 3])
}

/// (3,) float64 for Python.
pub fn point<'py>(py: Python<'py>, point: Vec3) -> Bound<'py, PyArray1<f64>> {
    PyArray1::from_slice(py, &point)
}
