//! Re-planning within a window (LFHH section IV-E): from the vehicle to a waypoint of the old path a
//! number of sections ahead; if that fails, to the next one, and so on to the end.

use auv_world::World;
use auv_world::math::Vec3;

use crate::control::Control;
use crate::cost::path_cost;
use crate::error::PlanError;
use crate::parameters::Common;
use crate::plan::Plan;
use crate::registry::{Request, answer};
use crate::sections::Frame;

/// A vehicle this near to a section, in sections, has reached it.
const REACHED: f64 = 1e-6;

/// The planning window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// Sections from the vehicle's to the target's. More than there are reach to the end of the path.
    pub sections: usize,
    /// Whether a failure tries the next larger window.
    pub grow: bool,
}

impl Default for Window {
    /// The paper's: 20 sections, growing.
    fn default() -> Self {
        Self { sections: 20, grow: true }
    }
}

impl Window {
    /// The whole rest of the path.
    pub fn whole() -> Self {
        Self { sections: usize::MAX, grow: false }
    }
}

/// The outcome of re-planning.
#[derive(Debug, Clone, PartialEq)]
pub struct Replan {
    /// The vehicle's place, the new path in the window, and the rest of the old path. Cost and feasibility
    /// are those of all this; evaluations count every attempt. Its history is that of the last attempt if the
    /// window reaches to the end, and otherwise the outcome alone: window and whole path cost differently.
    pub plan: Plan,
    /// The new path in the window alone, as planned at the last attempt: its cost is the paper's F.
    pub window: Plan,
    /// Sections of the last window.
    pub sections: usize,
    /// Number of attempts.
    pub attempts: u32,
}

/// Re-plans from the vehicle's place within a window of the global path, through the world as it is now,
/// with any planner.
///
/// # Errors
/// [`PlanError`] as [`crate::plan`], or if the path has fewer than two waypoints.
#[allow(clippy::too_many_arguments)]
pub fn replan(
    world: &World,
    global_path: &[Vec3],
    vehicle: Vec3,
    planner: &str,
    seed: u64,
    parameters_json: &str,
    window: Window,
    control: &Control<'_>,
) -> Result<Replan, PlanError> {
    let request = Request {
        planner,
        world,
        start: vehicle,
        goal: vehicle,
        seed,
        stream: 0,
        parameters: parameters_json,
        control: *control,
        evaluations_left: None,
    };
    replan_request(request, global_path, window)
}

/// Re-plans for a request whose start is the vehicle's place and whose goal does not matter; attempts use
/// its stream and the following ones.
///
/// # Errors
/// As [`replan`].
pub fn replan_request(request: Request<'_>, global_path: &[Vec3], window: Window) -> Result<Replan, PlanError> {
    if global_path.len() < 2 {
        let found = format!("{} points", global_path.len());
        return Err(PlanError::parameter("global_path", found, "a path needs at least 2"));
    }
    if window.sections == 0 {
        return Err(PlanError::parameter("window", 0, "must be at least 1 section"));
    }
    let progress = Progress::new(&Frame::new(request.world), global_path, request.start);
    let common = request.common()?;
    let mut left = common.max_evaluations;
    let mut sections = window.sections.min(progress.sections_left());
    let (mut attempts, mut evaluations) = (0, 0);
    loop {
        let target = progress.target(sections);
        let attempt =
            Request { goal: global_path[target], stream: request.stream + attempts, evaluations_left: left, ..request };
        let plan = answer(&attempt)?;
        attempts += 1;
        evaluations += plan.evaluations;
        left = left.map(|left| left.saturating_sub(plan.evaluations));
        let last = target + 1 == global_path.len();
        if plan.feasible || plan.interrupted || !window.grow || last || left == Some(0) {
            let joined = join(&request, &common, &plan, &global_path[target + 1..], evaluations)?;
            return Ok(Replan { plan: joined, window: plan, sections, attempts });
        }
        sections += 1;
    }
}

/// The path through the window and on along the old path.
fn join(
    request: &Request<'_>,
    common: &Common,
    window: &Plan,
    rest: &[Vec3],
    evaluations: u64,
) -> Result<Plan, PlanError> {
    if rest.is_empty() {
        let before = evaluations - window.evaluations;
        let history = window.history.iter().map(|(spent, total)| (before + spent, *total)).collect();
        return Ok(Plan { evaluations, history, ..window.clone() });
    }
    let waypoints = [window.waypoints.as_slice(), rest].concat();
    let cost = path_cost(request.world, &waypoints, common.cost, &common.cost_options)?;
    let history = vec![(evaluations, cost.total)];
    // A harbour's report is one of the window alone.
    Ok(Plan { waypoints, feasible: cost.feasible, cost, evaluations, history, harbor: None, ..window.clone() })
}

/// Where along its path a vehicle is.
struct Progress {
    /// How far ahead of the vehicle's section each waypoint lies, in sections.
    ahead: Vec<f64>,
    /// The first waypoint that may be a target.
    first: usize,
}

impl Progress {
    fn new(frame: &Frame, path: &[Vec3], vehicle: Vec3) -> Self {
        let section = |point: &Vec3| frame.section(point[0], point[1]);
        // A path from the last section to the first is measured backwards.
        let sense = if section(&path[path.len() - 1]) >= section(&path[0]) { 1.0 } else { -1.0 };
        let reached = (sense * section(&vehicle) + REACHED).floor();
        let ahead: Vec<f64> = path.iter().map(|point| sense * section(point) - reached).collect();
        let passed = ahead.iter().rposition(|ahead| *ahead <= REACHED);
        let first = passed.map_or(0, |passed| passed + 1).min(path.len() - 1);
        Self { ahead, first }
    }

    /// The window that reaches to the end of the path.
    fn sections_left(&self) -> usize {
        let farthest = self.ahead[self.first..].iter().fold(1.0, |most: f64, ahead| most.max(*ahead));
        farthest.ceil() as usize
    }

    /// The first waypoint at least so many sections ahead, or the last one.
    fn target(&self, sections: usize) -> usize {
        let far = |ahead: &f64| *ahead >= sections as f64 - REACHED;
        self.ahead[self.first..].iter().position(far).map_or(self.ahead.len() - 1, |index| self.first + index)
    }
}
