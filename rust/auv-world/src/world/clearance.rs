//! How far the nearest solid of a world is.

use super::{Slot, World};
use crate::math::{Vec3, distance};
use crate::seabed::Floor;

/// The solid that was nearest where clearance was measured last.
#[derive(Debug, Clone, Copy)]
pub struct Neighbour {
    slot: Slot,
    /// No other solid was nearer than this (m), ...
    rivals_m: f64,
    /// ... at this place (m) ...
    at: Vec3,
    /// ... and time (s).
    time_s: f64,
}

/// More than what rounds in distances (m).
const ROUNDING_M: f64 = 1e-6;

impl World {
    /// Signed distance (m) from a point to the nearest solid at the present time: the least over
    /// obstacles and sea floor, exact for spheres and discs, never too large for the others.
    #[inline]
    pub fn clearance(&self, point: Vec3) -> f64 {
        self.clearance_within(point, f64::INFINITY)
    }

    /// The lesser of `nearest` and [`World::clearance`] (m): what is farther away need not be measured.
    #[inline]
    pub fn clearance_within(&self, point: Vec3, nearest: f64) -> f64 {
        let round = self.spheres.clearance(point).min(self.discs.clearance(point));
        self.fixed.floor.clearance(point, self.solids.clearance(point, round.min(nearest)))
    }

    /// [`World::clearance_within`] at places that follow one another: the solid that was nearest at the last one is
    /// the nearest at this one, too, unless enough has moved for another to have overtaken it.
    pub fn clearance_along(&self, point: Vec3, nearest: f64, neighbour: &mut Option<Neighbour>) -> f64 {
        if !self.fixed.exact_solids {
            return self.clearance_within(point, nearest);
        }
        let still = neighbour.as_ref().and_then(|neighbour| {
            let clearance = match neighbour.slot {
                Slot::Sphere(i) => self.spheres.clearance_of(i, point),
                Slot::Disc(i) => self.discs.clearance_of(i, point),
                Slot::Solid(i) => self.solids.shapes()[i].clearance(point),
            };
            let approach = self.fixed.fastest_obstacle * (self.time_s - neighbour.time_s).abs();
            let rivals = neighbour.rivals_m - distance(point, neighbour.at) - approach;
            (clearance < rivals - ROUNDING_M).then_some(clearance)
        });
        let clearance = still.unwrap_or_else(|| {
            let round = self.spheres.nearest(point).named(Slot::Sphere);
            let round = round.and(self.discs.nearest(point).named(Slot::Disc));
            let solids = self.solids.nearest(point, round.clearance.min(nearest)).named(Slot::Solid);
            let found = round.and(solids);
            let (rivals_m, at, time_s) = (found.rivals, point, self.time_s);
            *neighbour = found.index.map(|slot| Neighbour { slot, rivals_m, at, time_s });
            found.clearance
        });
        self.fixed.floor.clearance(point, clearance.min(nearest))
    }

    /// Whether clearance is the distance itself, which changes by no more than one moves; a lower bound may.
    pub fn has_exact_clearance(&self) -> bool {
        matches!(self.fixed.floor, Floor::None | Floor::Flat(_)) && self.fixed.exact_solids
    }
}
