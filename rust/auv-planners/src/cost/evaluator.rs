//! Evaluates paths one after the other, without allocating: what planners do hundreds of thousands of
//! times, and `path_cost` once.

use auv_world::World;
use auv_world::math::Vec3;
use auv_world::scenario::Vehicle;

use super::collision::Test;
use super::current::Flow;
use super::options::{AlphaRange, Angle, Cost, CostOptions};
use super::track::Track;
use super::{CostTerms, PENALTY};
use crate::error::PlanError;
use crate::sections::{CellMap, Frame};

/// A cost, prepared for a world as it is now.
#[derive(Debug, Clone)]
pub struct Evaluator {
    pub(super) cost: Cost,
    pub(super) flow: Flow,
    pub(super) test: Test,
    pub(super) vehicle: Vehicle,
    /// A change of direction is too sharp if its cosine is less.
    pub(super) turn_limit: f64,
    alpha: AlphaRange,
    /// A step of cost `afhh` is too long if it is longer (m).
    pub(super) longest_step: f64,
    /// Depth of the box (m).
    depth: f64,
    pub(super) track: Track,
}

impl Evaluator {
    /// Prepares a cost.
    ///
    /// # Errors
    /// [`PlanError`] if an option is not allowed.
    pub fn new(world: &World, cost: Cost, options: &CostOptions) -> Result<Self, PlanError> {
        Self::prepare(world, cost, options, None)
    }

    /// The same for this one path, which is cheaper to prepare.
    pub(super) fn for_path(world: &World, cost: Cost, options: &CostOptions, path: &[Vec3]) -> Result<Self, PlanError> {
        Self::prepare(world, cost, options, Some(path))
    }

    fn prepare(world: &World, cost: Cost, options: &CostOptions, path: Option<&[Vec3]>) -> Result<Self, PlanError> {
        options.check()?;
        let limit = match options.angle {
            Angle::Turning => options.turn_limit_rad,
            Angle::Interior => std::f64::consts::PI - options.turn_limit_rad,
        };
        Ok(Self {
            cost,
            flow: Flow::new(world),
            test: Test::new(world, cost, options, path),
            vehicle: world.scenario().vehicle.clone(),
            turn_limit: libm::cos(limit),
            alpha: options.alpha,
            longest_step: options.step_limit * Frame::new(world).spacing_m(),
            depth: world.scenario().domain.max_m[2] - world.scenario().domain.min_m[2],
            track: Track::default(),
        })
    }

    /// The cell map of the sections, if collisions are tested on it.
    pub fn cells(&self) -> Option<(&Frame, &CellMap)> {
        self.test.cells()
    }

    /// The path to be evaluated next: first make room, then set every waypoint.
    pub fn track(&mut self) -> &mut Track {
        &mut self.track
    }

    /// The cost of the path in the track.
    #[inline]
    pub fn terms(&mut self) -> CostTerms {
        let track = &mut self.track;
        track.measure();
        let segments = track.segments() as f64;
        let penalty = |offending: usize| if offending > 0 { offending as f64 / segments + PENALTY } else { 0.0 };
        let (direct, path_length_m) = (track.direct_length(), track.path_length());
        let length = if path_length_m > 0.0 { 1.0 - direct / path_length_m } else { 0.0 };
        let mut terms = CostTerms {
            total: 0.0,
            feasible: true,
            length,
            curvature: 0.0,
            block: 0.0,
            current: 0.0,
            path_length_m,
            depth: None,
            smooth: None,
            excess: None,
            time_s: None,
            energy_j: None,
        };
        let blocked = self.test.blocked(track);
        if self.cost == Cost::Afhh {
            // Its eq. 5 counts waypoints, of which there is one more.
            terms.block = if blocked > 0 { blocked as f64 / (segments + 1.0) + PENALTY } else { 0.0 };
        } else {
            terms.block = penalty(blocked);
            terms.curvature = penalty(track.sharp_turns(self.turn_limit));
        }
        terms.feasible = terms.curvature + terms.block == 0.0;
        let first = match self.cost {
            Cost::Afhh => {
                let depth = if self.depth > 0.0 { track.depth_range() / self.depth } else { 0.0 };
                let smooth = penalty(track.longer_than(self.longest_step));
                terms.feasible &= smooth == 0.0;
                (terms.depth, terms.smooth) = (Some(depth), Some(smooth));
                length + depth + smooth
            }
            Cost::Lfhh => {
                self.flow.angles(track);
                terms.current = mean_angle(track, self.alpha);
                length
            }
            Cost::Time | Cost::Energy => {
                let speed = self.vehicle.speed_mps;
                let mut beaten = 0;
                self.flow.times(track, speed, |_| beaten += 1);
                terms.current = penalty(beaten);
                terms.feasible &= terms.current == 0.0;
                let time_s = track.sum_results();
                // Power is constant, so energy ranks paths as time does; only the unit differs.
                let excess = if time_s > 0.0 { 1.0 - direct / speed / time_s } else { 0.0 };
                terms.excess = Some(excess);
                terms.time_s = Some(time_s);
                terms.energy_j = Some(time_s * self.vehicle.power_w(speed));
                excess
            }
        };
        terms.total = first + terms.curvature + terms.block + terms.current;
        terms
    }

    /// The cost of any polyline of at least two points.
    pub fn terms_of(&mut self, waypoints: &[Vec3]) -> CostTerms {
        self.track.resize(waypoints.len());
        for (i, point) in waypoints.iter().enumerate() {
            self.track.set(i, *point);
        }
        self.terms()
    }
}

/// LFHH eq. 10 from the angles in the track's results.
#[inline]
fn mean_angle(track: &mut Track, range: AlphaRange) -> f64 {
    let n = track.segments();
    if range == AlphaRange::PerPath {
        let angles = &mut track.result[..n];
        let (low, high) = angles.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), a| (low.min(*a), high.max(*a)));
        let width = high - low;
        for angle in angles {
            *angle = if width > 0.0 { (*angle - low) / width } else { 0.0 };
        }
    }
    track.sum_results() / n as f64
}
