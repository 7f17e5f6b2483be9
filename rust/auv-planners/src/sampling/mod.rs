//! Planning by random samples of the box: RRT* and PRM* (Karaman and Frazzoli 2011, "Sampling-based algorithms
//! for optimal motion planning"). Both come as near to the shortest (or fastest) free path as one likes, with
//! enough samples. What they spend are motions: straight ways between two places tested for solids.

mod kd_tree;
mod prm_star;
mod query;
mod rrt_star;
mod settings;
mod space;
mod tree;

pub use prm_star::plan_prm_star;
pub use rrt_star::plan_rrt_star;
pub use settings::{Objective, PrmStar, RrtStar};
