//! What is measured, as Python has it: a dict of one episode, or a dict of columns of many.

use auv_env::Outcome;
use auv_env::measures::Measures;
use auv_env::observation::Mode;
use numpy::{Element, PyArray1};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

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

/// Many episodes', a column each; where there is no row zeros stand, and None for an outcome. With `masks` a column
/// `_name` beside each says where there is one.
pub fn columns<'py>(
    py: Python<'py>,
    rows: &[Option<Measures>],
    mode: Mode,
    masks: bool,
) -> PyResult<Bound<'py, PyDict>> {
    fn column<'py, T: Element + Default>(
        py: Python<'py>,
        rows: &[Option<Measures>],
        value: impl Fn(&Measures) -> T,
    ) -> Bound<'py, PyArray1<T>> {
        PyArray1::from_iter(py, rows.iter().map(|row| row.as_ref().map(&value).unwrap_or_default()))
    }
    let info = PyDict::new(py);
    let mask = masks.then(|| PyArray1::from_iter(py, rows.iter().map(Option::is_some)));
    macro_rules! mask {
        ($name:expr) => {
            if let Some(mask) = &mask {
                info.set_item(intern!(py, concat!("_", stringify!($name))), mask)?;
            }
        };
    }
    macro_rules! put {
        ($name:ident, $value:expr) => {
            info.set_item(intern!(py, stringify!($name)), column(py, rows, $value))?;
            mask!($name);
        };
    }
    entries!(mode, put);
    let names = Outcome::ALL.map(|outcome| PyString::intern(py, outcome.name()).into_any().unbind());
    let named = |row: &Option<Measures>| match row {
        Some(row) => names[row.outcome as usize].clone_ref(py),
        None => py.None(),
    };
    info.set_item(intern!(py, "outcome"), PyArray1::from_iter(py, rows.iter().map(named)))?;
    mask!(outcome);
    Ok(info)
}
