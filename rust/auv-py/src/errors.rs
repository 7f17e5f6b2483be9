//! Errors of the engine as Python exceptions, all of them kinds of ValueError (or OSError for files).

use auv_env::EnvError;
use auv_planners::PlanError;
use auv_world::WorldError;
use pyo3::PyErr;
use pyo3::create_exception;
use pyo3::exceptions::PyValueError;

create_exception!(
    auvgym,
    ScenarioError,
    PyValueError,
    "A scenario that is not allowed: names file, key, value and what was allowed."
);
create_exception!(
    auvgym,
    ActionError,
    PyValueError,
    "An action that is not allowed: names the entry, its value and what was allowed."
);
create_exception!(
    auvgym,
    PlanningError,
    PyValueError,
    "A planner, parameter or path that is not allowed: names it, its value and what was allowed."
);

pub fn world(error: WorldError) -> PyErr {
    match &error {
        WorldError::Scenario { .. } | WorldError::Format { .. } => ScenarioError::new_err(error.to_string()),
        WorldError::Parameter { .. } => PyValueError::new_err(error.to_string()),
        // FileNotFoundError, PermissionError, ...: as Python itself would say it.
        WorldError::File { kind, .. } => std::io::Error::new(*kind, error.to_string()).into(),
    }
}

pub fn env(error: EnvError) -> PyErr {
    let message = error.to_string();
    let mut innermost = error;
    while let EnvError::Environment { error, .. } = innermost {
        innermost = *error;
    }
    match innermost {
        EnvError::World(WorldError::Scenario { .. } | WorldError::Format { .. }) => ScenarioError::new_err(message),
        EnvError::World(error @ WorldError::File { .. }) => world(error),
        EnvError::Action { .. } => ActionError::new_err(message),
        EnvError::Planning(PlanError::World(error @ WorldError::File { .. })) => world(error),
        EnvError::Planning(_) | EnvError::Setting { .. } => PlanningError::new_err(message),
        _ => PyValueError::new_err(message),
    }
}

pub fn planning(error: PlanError) -> PyErr {
    match error {
        PlanError::World(error) => world(error),
        error => PlanningError::new_err(error.to_string()),
    }
}
