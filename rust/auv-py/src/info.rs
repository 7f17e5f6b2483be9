//! What is measured, as Python has it: a dict of one episode, or a dict of columns of many.

use auv_env::Outcome;
use auv_env::measures::Measures;
use auv_env::observation::Mode;
use numpy::{Element, PyArray1};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Names of outcomes; `outcome` in a column is an index into them.
#[pyfunction]
pub fn outcomes() -> Vec<&'static str> {
    OUTCOMES.map(Outcome::name).to_vec()
}

const OUTCOMES: [Outcome; 6] =
    [Outcome::Running, Outcome::Goal, Outcome::Collision, Outcome::OutOfBounds, Outcome::Energy, Outcome::Timeout];

/// Every entry but `outcome`, the last ones only where plans are flown.
macro_rules! entries {
    ($mode:expr, $put:ident) => {
        $put!(time_s, |row| row.time_s);
        $put!(energy_j, |row| row.energy_j);
        $put!(path_length_m, |row| row.path_length_m);
        $put!(min_clearance_m, |row| row.min_clearance_m);
        $put!(distance_to_goal_m, |row| row.distance_to_goal_m);
        $put!(evaluations, |row| row.evaluations as i64);
        $put!(replans, |row| row.replans as i64);
        $put!(map_changes, |row| row.map_changes as i64);
        $put!(map_changed, |row| row.map_changed);
        $put!(is_success, |row| row.outcome == Outcome::Goal);
        if $mode == Mode::Replan {
            $put!(planning_s, |row| row.planning_s);
            $put!(failed_plans, |row| row.failed_plans as i64);
            $put!(plan_feasible, |row| row.plan_feasible);
        }
    };
}

/// One episode's.
pub fn one<'py>(py: Python<'py>, now: &Measures, mode: Mode) -> PyResult<Bound<'py, PyDict>> {
    fn of<T>(now: &Measures, value: impl Fn(&Measures) -> T) -> T {
        value(now)
    }
    let info = PyDict::new(py);
    macro_rules! put {
        ($name:ident, $value:expr) => {
            info.set_item(intern!(py, stringify!($name)), of(now, $value))?;
        };
    }
    entries!(mode, put);
    info.set_item(intern!(py, "outcome"), now.outcome.name())?;
    Ok(info)
}

/// Many episodes', a column each. Where there is no row zeros stand, and in `outcome` the number behind the last of
/// [`outcomes`].
pub fn columns<'py>(py: Python<'py>, rows: &[Option<Measures>], mode: Mode) -> PyResult<Bound<'py, PyDict>> {
    fn column<'py, T: Element + Default>(
        py: Python<'py>,
        rows: &[Option<Measures>],
        value: impl Fn(&Measures) -> T,
    ) -> Bound<'py, PyArray1<T>> {
        PyArray1::from_iter(py, rows.iter().map(|row| row.as_ref().map(&value).unwrap_or_default()))
    }
    let info = PyDict::new(py);
    macro_rules! put {
        ($name:ident, $value:expr) => {
            info.set_item(intern!(py, stringify!($name)), column(py, rows, $value))?;
        };
    }
    entries!(mode, put);
    let number = |row: &Option<Measures>| {
        let known = row.and_then(|row| OUTCOMES.iter().position(|outcome| *outcome == row.outcome));
        known.unwrap_or(OUTCOMES.len()) as i64
    };
    info.set_item(intern!(py, "outcome"), PyArray1::from_iter(py, rows.iter().map(number)))?;
    Ok(info)
}
