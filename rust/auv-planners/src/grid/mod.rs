//! Planning on a regular grid of nodes: the least travel time through the present map and currents, by
//! Dijkstra's algorithm from the goal over the whole field, or by A* from the start.

mod astar;
mod field;
mod graph;
mod nodes;
mod path;
mod search;
mod settings;

pub use field::TimeField;
pub use path::{plan_astar, plan_dijkstra};
pub use settings::Settings;
