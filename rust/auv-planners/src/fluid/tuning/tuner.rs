//! Draws a line for four coefficients and says what it is worth, within the budget.

use auv_world::World;
use auv_world::math::{Vec3, add_scaled, sub};

use super::objective::Objective;
use crate::control::Control;
use crate::error::PlanError;
use crate::fluid::field::{Coefficients, Field};
use crate::fluid::held::Held;
use crate::fluid::judge::Judge;
use crate::fluid::settings::Flow;
use crate::fluid::trace::{Ending, Steps, trace};
use crate::parameters::{Common, StopRule};
use crate::plan::Plan;
use crate::registry::Request;
use crate::sections::check_place;

/// rho, theta, sigma, lambda: a chromosome.
pub type Genes = [f64; 4];

const GENES: [&str; 4] = ["rho", "theta", "sigma", "lambda"];

/// Least and greatest value of each gene (eq. 19).
pub type Bounds = [[f64; 2]; 4];

/// The bounds of eq. 19.
pub fn bounds(rho_max: f64, sigma_max: f64) -> Bounds {
    [[1.0, rho_max], [0.0, std::f64::consts::PI], [1.0, sigma_max], [0.0, 1.0]]
}

/// When the search has come to rest.
#[derive(Debug, Clone, Copy)]
pub struct Rest {
    /// So many generations without progress end it; 0: none do.
    pub stall: u64,
    /// Less than this is no progress.
    pub tolerance: f64,
}

/// Evaluates chromosomes for one request.
pub struct Tuner<'a> {
    world: &'a World,
    ends: [Vec3; 2],
    control: Control<'a>,
    field: Field,
    steps: Steps,
    objective: Objective,
    judge: Judge,
    limit: u64,
    stop: StopRule,
    target: f64,
    rest: Rest,
    path: Vec<Vec3>,
    /// The best line, while it is not judged yet.
    better: Vec<Vec3>,
    held: Held,
    best: f64,
    genes: Genes,
    interrupted: bool,
    /// The best value after the last generation, generations without progress, and without evaluations.
    last: f64,
    stalled: u64,
    idle: u64,
    counted: u64,
}

/// So many generations without anything new end any search.
const IDLE: u64 = 100;

impl<'a> Tuner<'a> {
    /// A tuner with nothing evaluated.
    ///
    /// # Errors
    /// [`PlanError`] if start or goal is no place in the world or a cost option is not allowed.
    pub fn new(
        request: &Request<'a>,
        common: &Common,
        flow: &Flow,
        objective: Objective,
        rest: Rest,
    ) -> Result<Self, PlanError> {
        check_place(request.world, "start", request.start)?;
        check_place(request.world, "goal", request.goal)?;
        let ends = [request.start, request.goal];
        let any = Coefficients { rho: 1.0, sigma: 1.0, theta: 0.0 };
        Ok(Self {
            world: request.world,
            ends,
            control: request.control,
            field: flow.field(request.world, ends, common.cost_options.margin_m, |_| any),
            steps: flow.steps(request.world, 1.0, request.start, request.goal),
            objective,
            judge: Judge::new(request.world, common.cost, &common.cost_options)?,
            limit: common.max_evaluations.unwrap_or(u64::MAX),
            stop: common.stop.unwrap_or(StopRule::Exhaust),
            target: common.target_cost.unwrap_or(f64::NEG_INFINITY),
            rest,
            path: Vec::new(),
            better: Vec::new(),
            held: Held::default(),
            best: f64::INFINITY,
            genes: [0.0; 4],
            interrupted: false,
            last: f64::INFINITY,
            stalled: 0,
            idle: 0,
            counted: 0,
        })
    }

    /// The value of a chromosome, infinite if its line does not arrive or meets anything; `None` if the
    /// budget is spent or the caller interrupted. The first is always evaluated.
    pub fn evaluate(&mut self, genes: &Genes) -> Option<f64> {
        let evaluations = self.held.evaluations();
        if evaluations >= self.limit {
            return None;
        }
        if self.interrupted || (evaluations > 0 && self.control.interrupted()) {
            self.interrupted = true;
            return None;
        }
        let [rho, theta, sigma, lambda] = *genes;
        let coefficients = Coefficients { rho, sigma, theta };
        self.field.bodies_mut().iter_mut().for_each(|body| body.set(coefficients));
        self.steps.lambda = lambda;
        let ending = trace(&mut self.field, self.world, &self.steps, self.ends, &self.control, &mut self.path);
        self.interrupted = ending == Ending::Interrupted;
        let arrives = ending == Ending::Reached && self.is_outside();
        let value = if arrives { self.objective.value(self.world, &self.path) } else { f64::INFINITY };
        self.held.count(1);
        if value < self.best {
            // Judged when the generation ends: it may not be the best until then, and judging takes longer than drawing.
            (self.best, self.genes) = (value, *genes);
            std::mem::swap(&mut self.path, &mut self.better);
        } else if self.best == f64::INFINITY {
            // Among lines that are worth nothing the cheapest is held.
            let (cost, clear) = (self.judge.cost(&self.path), self.judge.is_clear(&self.path));
            let better = if clear == self.held.is_clear() { cost.total < self.held.total() } else { clear };
            if better || evaluations == 0 {
                self.genes = *genes;
                self.held.hold(&self.path, cost, clear);
            }
        }
        Some(value)
    }

    /// Judges the best line and holds it, unless it is held already.
    fn hold_best(&mut self) {
        if !self.better.is_empty() {
            let (cost, clear) = (self.judge.cost(&self.better), self.judge.is_clear(&self.better));
            self.held.hold(&self.better, cost, clear);
            self.better.clear();
        }
    }

    /// Whether all points of the line and the middles between them lie outside (eq. 24).
    fn is_outside(&self) -> bool {
        let middle = |pair: &[Vec3]| add_scaled(pair[0], 0.5, sub(pair[1], pair[0]));
        self.path.iter().all(|point| self.field.is_outside(*point))
            && self.path.windows(2).all(|pair| self.field.is_outside(middle(pair)))
    }

    /// Ends a generation; says whether the search is done.
    pub fn end_generation(&mut self) -> bool {
        self.hold_best();
        self.held.note();
        let evaluations = self.held.evaluations();
        self.idle = if evaluations > self.counted { 0 } else { self.idle + 1 };
        self.counted = evaluations;
        let progress = if self.last.is_finite() { self.last - self.best } else { f64::INFINITY };
        self.stalled = if progress < self.rest.tolerance { self.stalled + 1 } else { 0 };
        self.last = self.best;
        let found = self.stop == StopRule::FirstFeasible && self.held.is_clear();
        let at_rest = self.rest.stall > 0 && self.stalled >= self.rest.stall;
        found || at_rest || self.idle >= IDLE || self.held.total() <= self.target
    }

    /// The best chromosome, its value, and the line it draws as a plan.
    ///
    /// # Errors
    /// [`PlanError`] if nothing was evaluated.
    pub fn finish(mut self, planner: &str) -> Result<Tuned, PlanError> {
        self.hold_best();
        let nothing = || PlanError::parameter("max_evaluations", self.limit, "at least 1");
        let mut plan = self.held.finish(planner, self.interrupted).ok_or_else(nothing)?;
        plan.coefficients = GENES.into_iter().zip(self.genes).collect();
        Ok(Tuned { plan, genes: self.genes, value: self.best })
    }
}

/// What a search found.
#[derive(Debug, Clone, PartialEq)]
pub struct Tuned {
    /// The line of the best chromosome.
    pub plan: Plan,
    /// rho, theta, sigma, lambda.
    pub genes: Genes,
    /// Its value; infinite if no line arrived.
    pub value: f64,
}
