//! Estimation of distribution with fixed-height histograms: LFHH, and its plainer kin FHH.

mod lfhh;
mod model;
mod population;
mod sampling;
mod settings;
mod smoothing;

pub use lfhh::{plan_fhh, plan_fhh_lts, plan_lfhh};
pub use model::Histograms;
pub use population::Population;
pub use settings::{Settings, Smoothing, StopRule};
pub use smoothing::smooth;
