//! What every population planner needs around it: it counts evaluations, keeps to the budget, remembers
//! the best candidate, and listens for interruption.

use crate::control::Control;
use crate::parameters::{Common, StopRule};
use crate::plan::Plan;
use crate::sections::SectionProblem;

/// The control is asked once in this many evaluations: at most a few milliseconds even where an
/// evaluation walks by clearances.
const ASK_EVERY: u64 = 32;
/// History is kept for this many generations without growing its memory.
const USUAL_GENERATIONS: u64 = 1024;

/// A search for the best candidate of a section problem.
pub struct Search<'a> {
    problem: &'a mut SectionProblem,
    control: Control<'a>,
    limit: u64,
    stop: StopRule,
    target: f64,
    evaluations: u64,
    best: Vec<f64>,
    best_total: f64,
    feasible: bool,
    interrupted: bool,
    history: Vec<(u64, f64)>,
}

impl<'a> Search<'a> {
    /// Starts a search with nothing evaluated, for a planner that stops by `stop` unless it is told otherwise.
    pub fn new(problem: &'a mut SectionProblem, common: &Common, stop: StopRule, control: Control<'a>) -> Self {
        let limit = common.max_evaluations.unwrap_or(u64::MAX);
        let best = vec![0.0; problem.genes()];
        let history = Vec::with_capacity(common.generations_or(USUAL_GENERATIONS).min(USUAL_GENERATIONS) as usize + 1);
        Self {
            problem,
            control,
            limit,
            stop: common.stop.unwrap_or(stop),
            target: common.target_cost.unwrap_or(f64::NEG_INFINITY),
            evaluations: 0,
            best,
            best_total: f64::INFINITY,
            feasible: false,
            interrupted: false,
            history,
        }
    }

    /// The problem.
    pub fn problem(&self) -> &SectionProblem {
        self.problem
    }

    /// The total cost of a candidate, or `None` if the budget is spent or the caller interrupted: then
    /// stop. The first candidate is always evaluated.
    #[inline]
    pub fn evaluate(&mut self, genes: &[f64]) -> Option<f64> {
        if self.evaluations >= self.limit {
            return None;
        }
        if self.evaluations > 0 && self.evaluations.is_multiple_of(ASK_EVERY) && self.control.interrupted() {
            self.interrupted = true;
            return None;
        }
        let terms = self.problem.evaluate(genes);
        self.evaluations += 1;
        if terms.total < self.best_total || self.evaluations == 1 {
            self.best.copy_from_slice(genes);
            self.best_total = terms.total;
            self.feasible = terms.feasible;
        }
        Some(terms.total)
    }

    /// The best candidate so far and whether it is feasible; zeros before the first.
    pub fn best(&self) -> (&[f64], bool) {
        (&self.best, self.feasible)
    }

    /// What it costs; infinite before the first.
    pub fn best_total(&self) -> f64 {
        self.best_total
    }

    /// Number of candidates evaluated.
    pub fn evaluations(&self) -> u64 {
        self.evaluations
    }

    /// Notes that the caller interrupted, for planners that work long between evaluations.
    pub fn interrupt(&mut self) {
        self.interrupted = true;
    }

    /// Whether what was found suffices.
    pub fn is_done(&self) -> bool {
        let feasible = match self.stop {
            StopRule::FirstFeasible => self.feasible,
            StopRule::Exhaust => false,
        };
        feasible || self.best_total <= self.target
    }

    /// Notes the best total at the end of a generation.
    pub fn end_generation(&mut self) {
        self.history.push((self.evaluations, self.best_total));
    }

    /// The best candidate as a plan.
    pub fn finish(mut self, planner: &str) -> Plan {
        // A generation that the budget cut short has its line, too.
        if self.history.last().is_none_or(|last| last.0 < self.evaluations) {
            self.end_generation();
        }
        let cost = self.problem.evaluate(&self.best);
        Plan {
            planner: planner.to_owned(),
            waypoints: self.problem.path(&self.best),
            feasible: cost.feasible,
            cost,
            evaluations: self.evaluations,
            history: self.history,
            coefficients: Vec::new(),
            interrupted: self.interrupted,
            harbor: None,
        }
    }
}
