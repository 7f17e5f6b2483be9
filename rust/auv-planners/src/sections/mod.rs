//! Sections: the planes across the way from start to goal on which section planners put one waypoint
//! each (LFHH section III), and the map of free and blocked cells on them.

mod cells;
mod frame;
mod problem;

pub use cells::CellMap;
pub(crate) use cells::nearest;
pub use frame::Frame;
pub use problem::SectionProblem;
pub(crate) use problem::check_place;
