//! What both planners need around them: motions are counted, the best path so far is kept and judged, and
//! the caller is listened to.
//!
//! A path is the better one if it is shorter (faster); the request's cost only judges it. Where a shorter path
//! costs more than one before it, the history leaves out the cheaper ones, so that it never rises.

use auv_world::math::Vec3;

use super::Objective;
use super::space::{Place, Space};
use crate::control::Control;
use crate::cost::{CostTerms, Evaluator};
use crate::error::PlanError;
use crate::parameters::{Common, StopRule};
use crate::plan::Plan;
use crate::registry::Request;
use crate::sections::check_place;

/// Motions tested if nobody says how many.
const DEFAULT_BUDGET: u64 = 20_000;
/// The control is asked once in this many motions.
const ASK_EVERY: u64 = 32;
/// A path is shortened if it is better than the last one that was by this part.
const WORTH_SHORTENING: f64 = 0.99;

/// A search from start to goal.
pub struct Query<'a> {
    space: Space<'a>,
    start: Place,
    goal: Place,
    shortcut: bool,
    control: Control<'a>,
    limit: u64,
    stop: StopRule,
    target: f64,
    evaluator: Evaluator,
    evaluations: u64,
    interrupted: bool,
    /// What the last path that was shortened had cost.
    shortened: f64,
    best: Option<Best>,
    history: Vec<(u64, f64)>,
}

/// The best path so far.
struct Best {
    waypoints: Vec<Vec3>,
    /// In metres or seconds.
    measure: f64,
    terms: CostTerms,
}

impl<'a> Query<'a> {
    /// A search in which nothing is tested yet.
    ///
    /// # Errors
    /// [`PlanError`] if start or goal is no place in the world, or a cost option is not allowed.
    pub fn new(request: &Request<'a>, common: &Common, space: Space<'a>, shortcut: bool) -> Result<Self, PlanError> {
        check_place(request.world, "start", request.start)?;
        check_place(request.world, "goal", request.goal)?;
        Ok(Self {
            start: space.end(request.start),
            goal: space.end(request.goal),
            space,
            shortcut,
            control: request.control,
            limit: common.max_evaluations.unwrap_or(DEFAULT_BUDGET),
            stop: common.stop.unwrap_or(StopRule::Exhaust),
            target: common.target_cost.unwrap_or(f64::NEG_INFINITY),
            evaluator: Evaluator::new(request.world, common.cost, &common.cost_options)?,
            evaluations: 0,
            interrupted: false,
            shortened: f64::INFINITY,
            best: None,
            history: Vec::new(),
        })
    }

    /// Where the motions are.
    pub fn space(&self) -> &Space<'a> {
        &self.space
    }

    /// From where.
    pub fn start(&self) -> Place {
        self.start
    }

    /// To where.
    pub fn goal(&self) -> Place {
        self.goal
    }

    /// Whether the straight motion is free, or `None` if the budget is spent or the caller interrupted: then
    /// stop. The first motion is always tested.
    #[inline]
    pub fn is_free(&mut self, from: &Place, to: &Place) -> Option<bool> {
        if self.evaluations >= self.limit {
            return None;
        }
        if self.evaluations > 0 && self.evaluations.is_multiple_of(ASK_EVERY) && self.control.interrupted() {
            self.interrupted = true;
            return None;
        }
        self.evaluations += 1;
        Some(self.space.is_free(from, to))
    }

    /// Tries the straight line from start to goal first. `None` if nothing can be better.
    pub fn try_straight(&mut self) -> Option<()> {
        let (start, goal) = (self.start, self.goal);
        let measure = self.space.measure(&start, &goal);
        if self.is_free(&start, &goal)? && measure.is_finite() {
            self.offer(vec![start, goal], measure)?;
            return (self.space.objective() == Objective::Time).then_some(());
        }
        Some(())
    }

    /// Takes a free path from start to goal as the answer if it is the best so far. `None` if it suffices.
    pub fn offer(&mut self, mut way: Vec<Place>, mut measure: f64) -> Option<()> {
        if self.shortcut && measure < WORTH_SHORTENING * self.shortened {
            self.shortened = measure;
            self.shorten(&mut way);
            measure = way.windows(2).map(|pair| self.space.measure(&pair[0], &pair[1])).sum();
        }
        if self.best.as_ref().is_some_and(|best| best.measure <= measure) {
            return Some(());
        }
        let waypoints: Vec<Vec3> = way.iter().map(|place| place.point).collect();
        let terms = self.evaluator.terms_of(&waypoints);
        while self.history.last().is_some_and(|last| last.1 < terms.total || last.0 == self.evaluations) {
            self.history.pop();
        }
        self.history.push((self.evaluations, terms.total));
        self.best = Some(Best { waypoints, measure, terms });
        let done = self.stop == StopRule::FirstFeasible || terms.total <= self.target;
        (!done).then_some(())
    }

    /// Leaves out waypoints where the straight motion past them is free and no worse, until there are none.
    fn shorten(&mut self, way: &mut Vec<Place>) {
        let mut at = 1;
        while at + 1 < way.len() {
            let (from, over, to) = (way[at - 1], way[at], way[at + 1]);
            let straight = self.space.measure(&from, &to);
            if straight <= self.space.measure(&from, &over) + self.space.measure(&over, &to) {
                match self.is_free(&from, &to) {
                    None => return,
                    Some(true) => {
                        way.remove(at);
                        // What lies before it has a new neighbour.
                        at = at.saturating_sub(1).max(1);
                        continue;
                    }
                    Some(false) => {}
                }
            }
            at += 1;
        }
    }

    /// The plan: the best path, or if there is none the way that came nearest to the goal and from there
    /// straight on.
    pub fn finish(mut self, planner: &str, approach: impl FnOnce() -> Vec<Place>) -> Plan {
        let feasible = self.best.is_some();
        let (waypoints, cost) = match self.best {
            Some(best) => (best.waypoints, best.terms),
            None => {
                let way = approach().into_iter().chain([self.goal]);
                let waypoints: Vec<Vec3> = way.map(|place| place.point).collect();
                let terms = self.evaluator.terms_of(&waypoints);
                (waypoints, terms)
            }
        };
        if self.history.last().is_none_or(|last| last.0 < self.evaluations) {
            self.history.push((self.evaluations, cost.total));
        }
        Plan {
            planner: planner.to_owned(),
            waypoints,
            feasible,
            cost,
            evaluations: self.evaluations,
            history: self.history,
            coefficients: Vec::new(),
            interrupted: self.interrupted,
            harbor: None,
        }
    }
}
