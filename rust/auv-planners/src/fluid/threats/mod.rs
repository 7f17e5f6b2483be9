//! Threats that move (section V).

mod barrier;
mod kalman;
mod navigator;
mod settings;

pub use barrier::{Ball, turned_away};
pub use kalman::{Kalman, Noise};
pub use navigator::{Course, Navigator, Prediction, Rules, Side};
pub use settings::{RuleSet, Settings};
