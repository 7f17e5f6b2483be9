//! Planners by name. To add one: a module with a function of [`Run`]'s type, and a line in [`PLANNERS`].

use auv_world::World;
use auv_world::math::Vec3;
use auv_world::rng::{Purpose, Stream};

use crate::control::Control;
use crate::error::PlanError;
use crate::parameters::{Common, Parameters, parse, parse_common};
use crate::plan::Plan;
use crate::sections::SectionProblem;
use crate::{differential_evolution, fluid, gaussian, grid, histogram, maklink, optimum, particle_swarm, sampling};

/// A question to a planner.
#[derive(Clone, Copy)]
pub struct Request<'a> {
    /// The name under which the planner was called.
    pub planner: &'a str,
    /// The world, as it is now.
    pub world: &'a World,
    /// From where (m).
    pub start: Vec3,
    /// To where (m).
    pub goal: Vec3,
    /// The seed of the planner's draws ...
    pub seed: u64,
    /// ... and the number of the stream under it: re-plans and attempts of one run differ in it.
    pub stream: u32,
    /// A JSON object; empty for defaults.
    pub parameters: &'a str,
    /// How the caller may interrupt.
    pub control: Control<'a>,
    /// Evaluations left of a budget shared by several requests.
    pub evaluations_left: Option<u64>,
}

impl Request<'_> {
    /// The common parameters, the budget cut to what is left, and the planner's own.
    ///
    /// # Errors
    /// [`PlanError`] naming the parameter that is not allowed.
    pub fn parse<P: Parameters>(&self) -> Result<(Common, P), PlanError> {
        let (mut common, own) = parse(self.planner, self.parameters)?;
        common.max_evaluations = common.max_evaluations.into_iter().chain(self.evaluations_left).min();
        Ok((common, own))
    }

    /// The common parameters alone.
    ///
    /// # Errors
    /// [`PlanError`] naming the parameter that is not allowed.
    pub fn common(&self) -> Result<Common, PlanError> {
        parse_common(self.planner, self.parameters)
    }

    /// The section problem of the request.
    ///
    /// # Errors
    /// [`PlanError`] if start or goal is no place in the world.
    pub fn problem(&self, common: &Common) -> Result<SectionProblem, PlanError> {
        SectionProblem::new(self.world, self.start, self.goal, common.cost, &common.cost_options)
    }

    /// The planner's random numbers.
    pub fn random(&self) -> Stream {
        Stream::new(self.seed, Purpose::Planner, self.stream)
    }
}

/// What answers a request.
pub type Run = fn(&Request<'_>) -> Result<Plan, PlanError>;

/// A planner.
struct Entry {
    name: &'static str,
    run: Run,
}

/// All planners.
const PLANNERS: &[Entry] = &[
    Entry { name: "lfhh", run: histogram::plan_lfhh },
    Entry { name: "fhh", run: histogram::plan_fhh },
    Entry { name: "fhh-lts", run: histogram::plan_fhh_lts },
    Entry { name: "afhh", run: histogram::plan_afhh },
    Entry { name: "eda-g", run: gaussian::plan_eda_g },
    Entry { name: "ade", run: differential_evolution::plan_ade },
    Entry { name: "rwde", run: differential_evolution::plan_rwde },
    Entry { name: "pso", run: particle_swarm::plan_pso },
    Entry { name: "rrt-star", run: sampling::plan_rrt_star },
    Entry { name: "prm-star", run: sampling::plan_prm_star },
    Entry { name: "astar", run: grid::plan_astar },
    Entry { name: "dijkstra", run: grid::plan_dijkstra },
    Entry { name: "iifds", run: fluid::plan_iifds },
    Entry { name: "iifds-ga", run: fluid::tuning::plan_iifds_ga },
    Entry { name: "iifds-iga", run: fluid::tuning::plan_iifds_iga },
    Entry { name: "iifds-de", run: fluid::tuning::plan_iifds_de },
    Entry { name: "maklink-dijkstra", run: maklink::plan_maklink_dijkstra },
    Entry { name: "maklink-aco", run: maklink::plan_maklink_aco },
    Entry { name: "maklink-pso", run: maklink::plan_maklink_pso },
    Entry { name: "rmpso", run: maklink::plan_rmpso },
    Entry { name: "funnel", run: maklink::plan_funnel },
    Entry { name: "visibility", run: maklink::plan_visibility },
    Entry { name: "section-optimum", run: optimum::plan_section_optimum },
];

/// The names of all planners.
pub fn planner_names() -> Vec<&'static str> {
    PLANNERS.iter().map(|entry| entry.name).collect()
}

/// Plans with the planner of that name, through the world as it is now.
///
/// # Errors
/// [`PlanError`] if the name is unknown (it lists the known ones), a parameter is not allowed, or start
/// or goal is no place in the world. That no feasible path was found is no error.
#[allow(clippy::too_many_arguments)]
pub fn plan(
    name: &str,
    world: &World,
    start: Vec3,
    goal: Vec3,
    seed: u64,
    parameters_json: &str,
    control: &Control<'_>,
) -> Result<Plan, PlanError> {
    answer(&Request {
        planner: name,
        world,
        start,
        goal,
        seed,
        stream: 0,
        parameters: parameters_json,
        control: *control,
        evaluations_left: None,
    })
}

/// Answers a request.
///
/// # Errors
/// As [`plan`].
pub fn answer(request: &Request<'_>) -> Result<Plan, PlanError> {
    let entry = PLANNERS.iter().find(|entry| entry.name == request.planner);
    let entry = entry.ok_or_else(|| PlanError::unknown("planner", request.planner, &planner_names()))?;
    (entry.run)(request)
}
