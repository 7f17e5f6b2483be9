//! What single segments cost: the parts of a path's cost that are sums over its segments, for planners that
//! put paths together piece by piece.

use auv_world::math::Vec3;

use super::evaluator::Evaluator;
use super::options::Cost;

/// Judges single segments of paths between two ends exactly as [`Evaluator`] judges them in a path.
#[derive(Debug, Clone)]
pub(crate) struct Segments {
    evaluator: Evaluator,
    /// What start and goal have of clearance (m).
    rooms: [f64; 2],
    /// Segments of the last fan on which the current beats the vehicle.
    beaten: Vec<usize>,
}

impl Segments {
    /// For paths between `ends`.
    pub fn new(evaluator: &Evaluator, ends: [Vec3; 2]) -> Self {
        let evaluator = evaluator.clone();
        let rooms = evaluator.test.rooms(ends);
        Self { evaluator, rooms, beaten: Vec::new() }
    }

    /// Least cosine that a change of direction may have; minus infinity if turns do not count.
    pub fn turn_limit(&self) -> f64 {
        if self.evaluator.cost == Cost::Afhh { f64::NEG_INFINITY } else { self.evaluator.turn_limit }
    }

    /// Longest segment allowed (m), infinite if length does not count.
    pub fn longest(&self) -> f64 {
        if self.evaluator.cost == Cost::Afhh { self.evaluator.longest_step } else { f64::INFINITY }
    }

    /// For each of several segments from one point its length (m) and its part in the cost: the angle to the
    /// current in units of pi (cost `lfhh`), 0 (`afhh`), or the travel time (s; `time` and `energy`); infinite
    /// if the segment is too long or the current beats the vehicle on it. Collisions are not looked at.
    pub fn weigh(&mut self, from: Vec3, to: &[Vec3]) -> impl Iterator<Item = (f64, f64)> + '_ {
        let Evaluator { cost, flow, track, vehicle, longest_step, .. } = &mut self.evaluator;
        track.fan(from, to);
        match cost {
            Cost::Lfhh => flow.angles(track),
            Cost::Afhh => {
                for (result, length) in track.result.iter_mut().zip(&track.length) {
                    *result = if *length > *longest_step { f64::INFINITY } else { 0.0 };
                }
            }
            Cost::Time | Cost::Energy => {
                self.beaten.clear();
                flow.times(track, vehicle.speed_mps, |segment| self.beaten.push(segment));
                for segment in &self.beaten {
                    track.result[*segment] = f64::INFINITY;
                }
            }
        }
        track.length.iter().copied().zip(track.result.iter().copied()).take(to.len())
    }

    /// Whether a segment collides that touches neither end of the path.
    pub fn blocks(&self, from: Vec3, to: Vec3) -> bool {
        self.evaluator.test.blocks(from, to, f64::INFINITY)
    }

    /// Whether the first segment of a path of more than one collides.
    pub fn blocks_first(&self, from: Vec3, to: Vec3) -> bool {
        self.evaluator.test.blocks(from, to, self.rooms[0])
    }

    /// Whether the last segment of a path of more than one collides.
    pub fn blocks_last(&self, from: Vec3, to: Vec3) -> bool {
        self.evaluator.test.blocks(from, to, self.rooms[1])
    }
}
