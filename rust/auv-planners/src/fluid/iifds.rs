//! Planner `iifds`: one line of the flow, and others if that one is not clear.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use auv_world::math::Vec3;
use serde::Deserialize;

use super::field::Coefficients;
use super::held::Held;
use super::judge::Judge;
use super::settings::{Classes, Flow, check_coefficients};
use super::trace::{Ending, trace};
use crate::error::{PlanError, within};
use crate::parameters::Parameters;
use crate::plan::Plan;
use crate::registry::Request;
use crate::sections::check_place;

/// Parameters of `iifds`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// rho0 of all obstacles.
    pub rho: f64,
    /// sigma0 of all obstacles.
    pub sigma: f64,
    /// theta of all obstacles (rad).
    pub theta: f64,
    /// Coefficients of some classes.
    pub classes: Classes,
    /// lambda: 1 leaves the current out.
    pub lambda: f64,
    /// Whether other directions round all obstacles are tried where the first line is not clear.
    pub retry: bool,
    /// How the flow is made and followed.
    pub flow: Flow,
}

impl Default for Settings {
    fn default() -> Self {
        let (classes, flow) = (Classes::default(), Flow::default());
        Self { rho: 1.0, sigma: 1.0, theta: 0.3, classes, lambda: 1.0, retry: true, flow }
    }
}

impl Settings {
    fn coefficients(&self) -> Coefficients {
        Coefficients { rho: self.rho, sigma: self.sigma, theta: self.theta }
    }
}

impl Parameters for Settings {
    fn check(&self) -> Result<(), PlanError> {
        check_coefficients("", self.coefficients())?;
        self.classes.check()?;
        within("lambda", self.lambda, 0.0, 1.0)?;
        self.flow.check()
    }
}

/// Directions that are tried, with rho = sigma = 1 and without the current.
const LADDER: [f64; 5] = [FRAC_PI_2, 0.0, PI, FRAC_PI_4, 3.0 * FRAC_PI_4];

/// Answers a request with the first clear line, or the cheapest of those that are not.
///
/// # Errors
/// As [`crate::registry::plan`].
pub fn plan_iifds(request: &Request<'_>) -> Result<Plan, PlanError> {
    let (common, settings) = request.parse::<Settings>()?;
    check_place(request.world, "start", request.start)?;
    check_place(request.world, "goal", request.goal)?;
    let ends = [request.start, request.goal];
    let mut judge = Judge::new(request.world, common.cost, &common.cost_options)?;
    let all = settings.coefficients();
    let margin = common.cost_options.margin_m;
    let mut field = settings.flow.field(request.world, ends, margin, |class| settings.classes.of(class, all));
    let mut steps = settings.flow.steps(request.world, settings.lambda, request.start, request.goal);
    let tries = if settings.retry { LADDER.len() + 1 } else { 1 };
    let budget = common.max_evaluations.unwrap_or(u64::MAX).min(tries as u64) as usize;
    let (mut held, mut path, mut interrupted) = (Held::default(), Vec::<Vec3>::new(), false);
    let (mut coefficients, mut used) = (all, Vec::new());
    for attempt in 0..budget {
        if attempt > 0 {
            coefficients = Coefficients { rho: 1.0, sigma: 1.0, theta: LADDER[attempt - 1] };
            field.bodies_mut().iter_mut().for_each(|body| body.set(coefficients));
            steps.lambda = 1.0;
        }
        let ending = trace(&mut field, request.world, &steps, ends, &request.control, &mut path);
        let (cost, clear) = (judge.cost(&path), judge.is_clear(&path));
        held.count(1);
        if attempt == 0 || clear || cost.total < held.total() {
            held.hold(&path, cost, clear);
            let Coefficients { rho, sigma, theta } = coefficients;
            used = vec![("rho", rho), ("sigma", sigma), ("theta", theta), ("lambda", steps.lambda)];
        }
        held.note();
        interrupted = ending == Ending::Interrupted || request.control.interrupted();
        if clear || interrupted {
            break;
        }
    }
    // At least one line was drawn.
    let plan = held.finish(request.planner, interrupted);
    plan.map(|plan| Plan { coefficients: used, ..plan })
        .ok_or_else(|| PlanError::parameter("max_evaluations", 0, "at least 1"))
}
