//! What a line is worth: the request's cost, and whether it is truly clear.

use auv_world::World;
use auv_world::math::Vec3;

use crate::cost::{Collision, Cost, CostOptions, CostTerms, Evaluator};
use crate::error::PlanError;

/// The judge of all lines of one request.
pub struct Judge {
    cost: Evaluator,
    clear: Evaluator,
}

impl Judge {
    /// A judge.
    ///
    /// # Errors
    /// [`PlanError`] if a cost option is not allowed.
    pub fn new(world: &World, cost: Cost, options: &CostOptions) -> Result<Self, PlanError> {
        let exact = CostOptions { collision: Collision::Segment, ..*options };
        // Only the time tells where the current beats the vehicle.
        let timed = if cost == Cost::Energy { Cost::Time } else { cost };
        Ok(Self { cost: Evaluator::new(world, cost, options)?, clear: Evaluator::new(world, timed, &exact)? })
    }

    /// The cost of a path.
    pub fn cost(&mut self, path: &[Vec3]) -> CostTerms {
        self.cost.terms_of(path)
    }

    /// Whether no segment meets anything solid and, where time counts, the vehicle beats the current.
    pub fn is_clear(&mut self, path: &[Vec3]) -> bool {
        let terms = self.clear.terms_of(path);
        terms.block == 0.0 && (terms.time_s.is_none() || terms.current == 0.0)
    }
}
