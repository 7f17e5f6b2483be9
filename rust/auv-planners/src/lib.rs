//! Path planners for dynamic oceans: a problem in, a plan and its counted budget out.
//!
//! [`registry::plan`] runs any planner by name, [`path_cost`] judges any path, [`replanning::replan`]
//! plans anew within a window, and [`protocol::run`] repeats the LFHH paper's experiment.

// As `unwrap_used` and `panic` everywhere; benches and examples may expect. Tests may all of it.
#![deny(clippy::expect_used, clippy::unreachable)]

pub mod control;
pub mod cost;
pub mod differential_evolution;
pub mod error;
pub mod fluid;
pub mod gaussian;
pub mod grid;
pub mod histogram;
pub mod maklink;
pub mod optimum;
pub mod parameters;
pub mod particle_swarm;
pub mod plan;
pub mod population;
pub mod protocol;
pub mod registry;
pub mod replanning;
pub mod sampling;
pub mod search;
pub mod sections;
#[cfg(test)]
mod testing;

pub use control::Control;
pub use cost::{Cost, CostOptions, CostTerms, path_cost};
pub use error::PlanError;
pub use plan::Plan;
pub use registry::{plan, planner_names};
