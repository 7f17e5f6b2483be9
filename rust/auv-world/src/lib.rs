//! Dynamic ocean worlds: seabed, obstacles that move, currents that turn.
//!
//! A [`scenario::Scenario`] is plain numbers; a [`world::World`] is one scenario at one time, after the
//! map changes so far, and answers the questions that planners, vehicles and pictures ask: the current
//! here, the clearance here, how far a sonar beam runs. Units are SI; z is depth, positive down.

// As `unwrap_used` and `panic` everywhere; benches and examples may expect. Tests may all of it.
#![deny(clippy::expect_used, clippy::unreachable)]

pub mod currents;
pub mod error;
pub mod families;
pub mod grid;
pub mod kinematics;
pub mod lanes;
pub mod math;
pub mod motion;
pub mod obstacles;
pub mod projection;
pub mod rng;
pub mod scenario;
pub mod seabed;
pub mod settings;
pub mod world;

pub use error::WorldError;
pub use scenario::Scenario;
pub use world::World;
