//! The LFHH paper's experiment (section IV-F and V): plan, travel until the map changes, re-plan in a
//! window, and so on through the scenario's change table. F is the mean over the re-plans.

use auv_world::World;
use auv_world::math::{Vec3, distance};
use auv_world::scenario::Change;

use crate::control::Control;
use crate::cost::CostTerms;
use crate::error::PlanError;
use crate::registry::{Request, answer};
use crate::replanning::{Window, replan_request};
use crate::sections::Frame;

/// Re-plans of one run draw from streams this far apart, more than there are attempts.
const STREAMS_PER_PHASE: u32 = 1 << 16;

/// When the map changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Trigger {
    /// When the path since the last change becomes longer than the distance: at the last waypoint reached
    /// by then, but at least one farther than at the last change.
    #[default]
    PathLength,
    /// At the first waypoint that many distances farther along than the start.
    Progress,
}

/// How the experiment is run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Settings {
    /// The planning window.
    pub window: Window,
    /// When the map changes.
    pub trigger: Trigger,
}

/// One phase: a plan, and what it cost.
#[derive(Debug, Clone, PartialEq)]
pub struct Phase {
    /// Where the vehicle was (m).
    pub vehicle_m: Vec3,
    /// The cost of the planned path; in a re-plan that of the window.
    pub cost: CostTerms,
    /// Whether the planned path breaks no constraint of the cost.
    pub feasible: bool,
    /// Evaluations of all attempts.
    pub evaluations: u64,
    /// Sections of the last window; all, in the first phase.
    pub window_sections: usize,
    /// Number of attempts.
    pub attempts: u32,
    /// The path from the vehicle to the goal (m).
    pub waypoints: Vec<Vec3>,
}

/// A run of the experiment.
#[derive(Debug, Clone, PartialEq)]
pub struct Protocol {
    /// The first plan, and a re-plan for each change.
    pub phases: Vec<Phase>,
    /// Mean total cost of the re-plans; the paper's result.
    pub mean_cost: f64,
    /// Whether every re-plan is feasible.
    pub feasible: bool,
    /// Evaluations of all phases.
    pub evaluations: u64,
    /// Whether the caller interrupted it.
    pub interrupted: bool,
}

/// Runs the experiment on a world's mission, from its time 0 on.
///
/// # Errors
/// [`PlanError`] as [`crate::plan`], or if the world's scenario has no change.
pub fn run(
    world: &World,
    planner: &str,
    seed: u64,
    parameters_json: &str,
    settings: Settings,
    control: &Control<'_>,
) -> Result<Protocol, PlanError> {
    let mut world = world.fresh(world.seed());
    let (every_m, changes) = match &world.scenario().change {
        Some(Change::Table(table)) => (table.every_m, table.phases.len()),
        Some(Change::Redraw(redraw)) => (redraw.every_m, DRAWN_CHANGES),
        None => return Err(PlanError::parameter("scenario.change", "none", "the experiment needs map changes")),
    };
    let frame = Frame::new(&world);
    let (start, goal) = (world.mission().start_m, world.mission().goal_m);
    let asker = Asker { planner, seed, parameters: parameters_json, control: *control, goal };
    let plan = answer(&asker.request(&world, start, 0))?;
    let mut interrupted = plan.interrupted;
    let mut path = plan.waypoints;
    let mut phases = vec![Phase {
        vehicle_m: start,
        cost: plan.cost,
        feasible: plan.cost.feasible,
        evaluations: plan.evaluations,
        window_sections: frame.count() - 1,
        attempts: 1,
        waypoints: path.clone(),
    }];
    for phase in 1..=changes {
        let reached = match settings.trigger {
            Trigger::PathLength => travel(&path, every_m),
            Trigger::Progress => advance(&frame, &path, start, every_m * phase as f64),
        };
        // A vehicle that arrives meets no further change.
        if interrupted || reached + 1 >= path.len() {
            break;
        }
        let vehicle = path[reached];
        world.apply_change(vehicle);
        let replan = replan_request(asker.request(&world, vehicle, phase as u32), &path[reached..], settings.window)?;
        interrupted = replan.plan.interrupted;
        path = replan.plan.waypoints;
        phases.push(Phase {
            vehicle_m: vehicle,
            cost: replan.window.cost,
            feasible: replan.window.cost.feasible,
            evaluations: replan.plan.evaluations,
            window_sections: replan.sections,
            attempts: replan.attempts,
            waypoints: path.clone(),
        });
    }
    let replans = &phases[1..];
    Ok(Protocol {
        mean_cost: replans.iter().map(|phase| phase.cost.total).sum::<f64>() / replans.len() as f64,
        feasible: replans.iter().all(|phase| phase.feasible),
        evaluations: phases.iter().map(|phase| phase.evaluations).sum(),
        interrupted,
        phases,
    })
}

/// What all requests of a run have in common.
struct Asker<'a> {
    planner: &'a str,
    seed: u64,
    parameters: &'a str,
    control: Control<'a>,
    goal: Vec3,
}

impl Asker<'_> {
    fn request<'a>(&'a self, world: &'a World, start: Vec3, phase: u32) -> Request<'a> {
        Request {
            planner: self.planner,
            world,
            start,
            goal: self.goal,
            seed: self.seed,
            stream: phase * STREAMS_PER_PHASE,
            parameters: self.parameters,
            control: self.control,
            evaluations_left: None,
        }
    }
}

/// Changes of a run where they are drawn without end: as many as in the paper.
const DRAWN_CHANGES: usize = 5;

/// The last waypoint within `distance_m` of path, but at least the second.
fn travel(path: &[Vec3], distance_m: f64) -> usize {
    let mut travelled = 0.0;
    for (i, leg) in path.windows(2).enumerate() {
        travelled += distance(leg[0], leg[1]);
        if travelled > distance_m {
            return i.max(1);
        }
    }
    path.len() - 1
}

/// The first waypoint at least `distance_m` farther along the sections than the start, or the last one.
fn advance(frame: &Frame, path: &[Vec3], start: Vec3, distance_m: f64) -> usize {
    let along = |point: &Vec3| (frame.section(point[0], point[1]) - frame.section(start[0], start[1])).abs();
    let far = |point: &Vec3| along(point) * frame.spacing_m() >= distance_m - 1e-6;
    path.iter().position(far).unwrap_or(path.len() - 1)
}
