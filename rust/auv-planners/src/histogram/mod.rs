//! Estimation of distribution with fixed-height histograms: LFHH, its plainer kin FHH, and AFHH.

mod afhh;
mod lfhh;
mod model;
mod sampling;
mod settings;
mod smoothing;
mod sorted;

pub use afhh::plan_afhh;
pub use lfhh::{plan_fhh, plan_fhh_lts, plan_lfhh};
pub use model::Histograms;
pub use settings::{Settings, Smoothing};
pub use smoothing::smooth;
pub use sorted::SortedGenes;
