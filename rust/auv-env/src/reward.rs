//! The reward: progress, time, and how the episode ends.
//!
//! Sum over an episode: (progress <= 1) - (time <= 0.75) + (1 on arrival, -1 on any failure). With d0 the
//! distance at the start and r < d0 the goal radius, an episode that arrives has at least
//! 1 - r/d0 + 1 - 0.75 = 1.25 - r/d0 > 0, one that fails less than 1 - 1 = 0: whatever the scenario,
//! nothing that fails out-scores anything that arrives, and of two arrivals the faster scores more.

use crate::measures::Outcome;

/// What a whole time limit costs.
pub const TIME_WEIGHT: f64 = 0.75;

/// Reward of one leg: distances to the goal before and after and at the start of the episode (m), the
/// leg's time and the time limit (s), and the outcome after it.
pub fn leg(before: f64, after: f64, at_start: f64, elapsed: f64, time_limit: f64, outcome: Outcome) -> f64 {
    let end = match outcome {
        Outcome::Running => 0.0,
        Outcome::Goal => 1.0,
        Outcome::Collision | Outcome::OutOfBounds | Outcome::Energy | Outcome::Timeout => -1.0,
    };
    (before - after) / at_start - TIME_WEIGHT * elapsed / time_limit + end
}
