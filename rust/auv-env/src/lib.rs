//! Episodes in dynamic ocean worlds: a vehicle is steered from waypoint to waypoint, sees what its
//! sensors see, and is rewarded for arriving.
//!
//! An [`episode::Episode`] is a pure function of its world and the actions so far. In re-plan mode ([`replan`]) a
//! planner's path is flown, and actions say when to plan anew.

// As `unwrap_used` and `panic` everywhere; benches and examples may expect. Tests may all of it.
#![deny(clippy::expect_used, clippy::unreachable)]

pub mod batch;
pub mod episode;
pub mod error;
pub mod frame;
pub mod measures;
pub mod observation;
pub mod replan;
pub mod replay;
pub mod reward;
pub mod sonar;
pub mod source;
pub mod vehicle;

pub use batch::{Autoreset, Batch};
pub use episode::Episode;
pub use error::EnvError;
pub use measures::Outcome;
pub use replay::Replay;
pub use source::Source;
