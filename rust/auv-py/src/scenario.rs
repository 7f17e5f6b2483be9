//! `Scenario`.

use std::path::PathBuf;

use auv_world::families::{FAMILIES, Parameters, generate};
use auv_world::settings;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyType;

use crate::errors;

/// The families that scenarios can be drawn from.
#[pyfunction]
pub fn families() -> Vec<&'static str> {
    FAMILIES.to_vec()
}

/// Parameters of a family from JSON.
pub fn parameters(json: &str) -> PyResult<Parameters> {
    let wrong = |message: String| PyValueError::new_err(format!("parameters of the family: {message}"));
    let value = serde_json::from_str(json).map_err(|error| wrong(error.to_string()))?;
    settings::read(value).map_err(|message| wrong(settings::suggest(message)))
}

/// Everything a world is made of, checked.
#[pyclass(frozen, module = "auvgym._core")]
#[derive(Clone)]
pub struct Scenario(pub auv_world::Scenario);

#[pymethods]
impl Scenario {
    #[staticmethod]
    fn from_toml(text: &str) -> PyResult<Self> {
        auv_world::Scenario::from_toml(text).map(Self).map_err(errors::world)
    }

    #[staticmethod]
    fn from_json(text: &str) -> PyResult<Self> {
        auv_world::Scenario::from_json(text).map(Self).map_err(errors::world)
    }

    #[staticmethod]
    fn load(path: PathBuf) -> PyResult<Self> {
        auv_world::Scenario::load(&path).map(Self).map_err(errors::world)
    }

    #[staticmethod]
    fn generate(family: &str, seed: u64, parameters_json: &str) -> PyResult<Self> {
        let scenario = generate(family, seed, &parameters(parameters_json)?).map_err(errors::world)?;
        scenario.check().map_err(errors::world)?;
        Ok(Self(scenario))
    }

    fn to_toml(&self) -> PyResult<String> {
        self.0.to_toml().map_err(errors::world)
    }

    fn to_json(&self) -> PyResult<String> {
        self.0.to_json().map_err(errors::world)
    }

    fn save(&self, path: PathBuf) -> PyResult<()> {
        self.0.save(&path).map_err(errors::world)
    }

    #[getter]
    fn hash(&self) -> PyResult<String> {
        self.0.hash().map_err(errors::world)
    }

    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    #[getter]
    fn description(&self) -> &str {
        &self.0.description
    }

    #[getter]
    fn family(&self) -> &str {
        &self.0.family
    }

    #[getter]
    fn dimensions(&self) -> u8 {
        self.0.dimensions
    }

    #[getter]
    fn notes(&self) -> Vec<String> {
        self.0.notes.clone()
    }

    #[getter]
    fn missions(&self) -> usize {
        self.0.missions.len()
    }

    /// (longitude, latitude) of the projection's centre, if there is one.
    #[getter]
    fn projection(&self) -> Option<(f64, f64)> {
        self.0.projection.as_ref().map(|projection| (projection.longitude_deg, projection.latitude_deg))
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.0 == other.0
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        let class: Bound<'py, PyType> = py.get_type::<Self>();
        Ok((class.getattr("from_toml")?, (self.to_toml()?,)))
    }
}
