//! Currents, horizontal, one file for each kind; they superpose.

mod draw;
mod gridded;
mod jet;
mod vortices;

pub use draw::scale_to_peak;
pub use gridded::GriddedField;
pub use jet::velocity as jet_velocity;
pub use vortices::{RING_RADIUS, RING_SPEED, VortexField, VortexLanes};
