//! The line that is held as the best, and the count of those that were drawn.

use auv_world::math::Vec3;

use crate::cost::CostTerms;
use crate::plan::Plan;

/// The best line so far.
#[derive(Debug, Clone, Default)]
pub struct Held {
    waypoints: Vec<Vec3>,
    cost: Option<CostTerms>,
    clear: bool,
    evaluations: u64,
    history: Vec<(u64, f64)>,
}

impl Held {
    /// Lines drawn.
    pub fn evaluations(&self) -> u64 {
        self.evaluations
    }

    /// Counts so many lines.
    pub fn count(&mut self, lines: u64) {
        self.evaluations += lines;
    }

    /// Whether a clear line is held.
    pub fn is_clear(&self) -> bool {
        self.clear
    }

    /// Total cost of the line held; infinite if there is none.
    pub fn total(&self) -> f64 {
        self.cost.map_or(f64::INFINITY, |cost| cost.total)
    }

    /// Holds a line from now on.
    pub fn hold(&mut self, path: &[Vec3], cost: CostTerms, clear: bool) {
        self.waypoints.clear();
        self.waypoints.extend_from_slice(path);
        (self.cost, self.clear) = (Some(cost), clear);
        // A line that collides may cost less than the clear one that replaces it: the history is that of
        // totals as low as this.
        while self.history.last().is_some_and(|last| last.1 < cost.total) {
            self.history.pop();
        }
    }

    /// Notes the total of the line held, once for each count.
    pub fn note(&mut self) {
        if let Some(cost) = self.cost
            && self.history.last().is_none_or(|last| last.0 < self.evaluations)
        {
            self.history.push((self.evaluations, cost.total));
        }
    }

    /// The plan; `None` if no line was ever held.
    pub fn finish(mut self, planner: &str, interrupted: bool) -> Option<Plan> {
        if self.history.last().is_some_and(|last| last.0 == self.evaluations && last.1 > self.total()) {
            self.history.pop();
        }
        self.note();
        Some(Plan {
            planner: planner.to_owned(),
            waypoints: self.waypoints,
            feasible: self.clear,
            cost: self.cost?,
            evaluations: self.evaluations,
            history: self.history,
            coefficients: Vec::new(),
            interrupted,
            harbor: None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use crate::{Cost, CostOptions, path_cost};

    #[test]
    fn history_never_rises() {
        let world = testing::paper_world("lfhh-2d-1", 0);
        let path = [world.mission().start_m, world.mission().goal_m];
        let terms = path_cost(&world, &path, Cost::Lfhh, &CostOptions::default()).unwrap();
        let costing = |total: f64| CostTerms { total, ..terms };
        let mut held = Held::default();
        for (total, clear) in [(5.0, false), (3.0, false), (4.0, true), (1.0, true)] {
            held.count(1);
            held.hold(&path, costing(total), clear);
            held.note();
        }
        held.count(1);
        let plan = held.finish("iifds", false).unwrap();
        assert_eq!(plan.history, [(1, 5.0), (3, 4.0), (4, 1.0), (5, 1.0)]);
        assert!(Held::default().finish("iifds", false).is_none());
    }
}
