//! Harbours: planning among polygons on MAKLINK graphs, after Huang and Jin (2021).
//!
//! Obstacles become convex danger zones ([`zone`]), free links between them cut the water into convex cells
//! ([`links`], [`cells`]), and a route is a sequence of links ([`route`]). Where on its link each waypoint lies
//! is then a convex problem, of which [`funnel`] knows the exact answer.

pub mod ants;
pub mod area;
pub mod cells;
pub mod chart;
pub mod drift;
pub mod error;
pub mod fitness;
pub mod funnel;
pub mod graph;
pub mod harbor;
pub mod line;
pub mod links;
mod planners;
pub mod report;
pub mod route;
mod search;
pub mod settings;
pub mod smoothing;
pub mod swarm;
pub mod visibility;
pub mod zone;

pub use area::Area;
pub use chart::Chart;
pub use error::MapError;
pub use planners::{
    plan_funnel, plan_maklink_aco, plan_maklink_dijkstra, plan_maklink_pso, plan_rmpso, plan_visibility,
};
pub use report::HarborReport;
