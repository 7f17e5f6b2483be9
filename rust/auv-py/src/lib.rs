//! `auvgym._core`: the engine as Python sees it. Bindings only; the Python package wraps them.

// As `unwrap_used` and `panic` everywhere; benches and examples may expect. Tests may all of it.
#![deny(clippy::expect_used, clippy::unreachable)]

mod batch;
mod episode;
mod errors;
mod field;
mod info;
mod interrupt;
mod maklink;
mod navigator;
mod planning;
mod points;
mod problem;
mod scenario;
mod world;

use pyo3::prelude::*;

#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// The compiled engine of auvgym.
#[pymodule]
mod _core {
    #[pymodule_export]
    use crate::batch::Batch;
    #[pymodule_export]
    use crate::episode::{Episode, Source, observation_layout, sonar_directions};
    #[pymodule_export]
    use crate::errors::{ActionError, PlanningError, ScenarioError};
    #[pymodule_export]
    use crate::field::TimeField;
    #[pymodule_export]
    use crate::maklink::maklink;
    #[pymodule_export]
    use crate::navigator::Navigator;
    #[pymodule_export]
    use crate::planning::{list_planners, path_cost, plan, replan, run_phases};
    #[pymodule_export]
    use crate::problem::SectionProblem;
    #[pymodule_export]
    use crate::scenario::{Scenario, families};
    #[pymodule_export]
    use crate::world::World;

    #[pymodule_init]
    fn init(module: &super::Bound<'_, super::PyModule>) -> super::PyResult<()> {
        super::PyModuleMethods::add(module, "__version__", env!("CARGO_PKG_VERSION"))
    }
}
