//! Planning on a regular grid of nodes: the time that is left to the goal from everywhere.

mod astar;
mod field;
mod path;

pub use astar::plan_astar;
pub use field::{Settings, TimeField};
pub use path::{GridPath, plan};
