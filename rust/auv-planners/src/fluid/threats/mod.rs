//! Threats that move (section V).

mod barrier;
mod kalman;
mod navigator;

pub use barrier::{Ball, turned_away};
pub use kalman::{Kalman, Noise};
pub use navigator::{Course, Navigator, Rules, Side};
