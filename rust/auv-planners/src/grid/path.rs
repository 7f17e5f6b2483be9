//! Planners `dijkstra` and `astar`: node after node to the goal, then straightened where a straight leg is
//! free and no slower.

use auv_world::World;
use auv_world::math::Vec3;

use super::nodes::Grid;
use super::{Settings, TimeField, astar};
use crate::cost::path_cost;
use crate::error::PlanError;
use crate::plan::Plan;
use crate::registry::Request;
use crate::sections::check_place;

/// Rings of nodes round the start by which a way may begin, tried one after the other.
pub const RINGS: [u32; 4] = [1, 2, 3, 4];

/// The fastest way over a grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Route {
    /// The nodes between start and goal; none if there is no way.
    pub nodes: Vec<usize>,
    /// How long it takes (s).
    pub seconds: f64,
    /// Nodes settled.
    pub settled: u64,
}

/// Who looks for the way: it gives the grid and the route, `None` if interrupted.
type Method = fn(&World, Vec3, Vec3, Settings, &mut dyn FnMut() -> bool) -> Option<(Grid, Route)>;

/// `dijkstra`: the path of least travel time, from the time field of the whole grid. `feasible` says that a
/// way was found that keeps clear of everything solid and on which the vehicle beats the current; `cost` judges
/// the path by the request's cost like any other. `max_evaluations` does not apply: the search is exact and
/// ends by itself.
///
/// # Errors
/// [`PlanError`] naming the parameter, start or goal that is not allowed.
pub fn plan_dijkstra(request: &Request<'_>) -> Result<Plan, PlanError> {
    plan(request, by_dijkstra)
}

/// `astar`: the same path (where several are as fast, one of them) by A* from start to goal, which settles
/// fewer nodes.
///
/// # Errors
/// As [`plan_dijkstra`].
pub fn plan_astar(request: &Request<'_>) -> Result<Plan, PlanError> {
    plan(request, by_astar)
}

fn by_dijkstra(
    world: &World,
    start: Vec3,
    goal: Vec3,
    settings: Settings,
    interrupted: &mut dyn FnMut() -> bool,
) -> Option<(Grid, Route)> {
    let field = TimeField::new(world, goal, settings, interrupted)?;
    let route = field.route(world, start);
    Some((field.into_grid(), route))
}

fn by_astar(
    world: &World,
    start: Vec3,
    goal: Vec3,
    settings: Settings,
    interrupted: &mut dyn FnMut() -> bool,
) -> Option<(Grid, Route)> {
    let grid = Grid::new(world, settings);
    let route = astar::route(world, &grid, start, goal, interrupted)?;
    Some((grid, route))
}

/// Answers a request, by default on a grid twice as fine as a field's.
fn plan(request: &Request<'_>, method: Method) -> Result<Plan, PlanError> {
    let (common, settings) = request.parse::<Settings>()?;
    let Request { world, start, goal, control, .. } = *request;
    check_place(world, "start", start)?;
    check_place(world, "goal", goal)?;
    let settings = Settings { spacing_m: settings.spacing_or(world, 0.5), ..settings };
    let found = method(world, start, goal, settings, &mut || control.interrupted());
    let way = found.as_ref().filter(|(_, route)| !route.nodes.is_empty());
    let waypoints = way.map_or_else(
        || vec![start, goal],
        |(grid, route)| {
            let nodes = route.nodes.iter().map(|node| grid.place(*node));
            let path: Vec<Vec3> = std::iter::once(start).chain(nodes).chain(std::iter::once(goal)).collect();
            straighten(world, grid, &path)
        },
    );
    let evaluations = found.as_ref().map_or(0, |(_, route)| route.settled);
    let cost = path_cost(world, &waypoints, common.cost, &common.cost_options)?;
    Ok(Plan {
        planner: request.planner.to_owned(),
        waypoints,
        feasible: way.is_some(),
        cost,
        evaluations,
        history: vec![(evaluations, cost.total)],
        coefficients: Vec::new(),
        interrupted: found.is_none(),
        harbor: None,
    })
}

/// From each waypoint on, the farthest of the next ones that a straight leg reaches freely and no later.
fn straighten(world: &World, grid: &Grid, path: &[Vec3]) -> Vec<Vec3> {
    const AHEAD: usize = 12;
    let legs: Vec<f64> =
        path.windows(2).map(|pair| grid.leg(world, pair[0], pair[1]).unwrap_or(f64::INFINITY)).collect();
    let mut straight = vec![path[0]];
    let mut here = 0;
    while here + 1 < path.len() {
        let last = (here + AHEAD).min(path.len() - 1);
        let farthest = (here + 2..=last).rev().find(|&there| {
            let along: f64 = legs[here..there].iter().sum();
            grid.leg(world, path[here], path[there]).is_some_and(|seconds| seconds <= along)
        });
        here = farthest.unwrap_or(here + 1);
        straight.push(path[here]);
    }
    straight
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry;
    use crate::{Control, testing};
    use auv_world::families::{Parameters, generate};

    /// Both ways through a world, from its start to its goal.
    fn both(world: &World, settings: Settings) -> [Route; 2] {
        let mission = world.mission();
        [by_dijkstra, by_astar]
            .map(|method: Method| method(world, mission.start_m, mission.goal_m, settings, &mut || false).unwrap().1)
    }

    #[test]
    fn astar_is_as_fast_as_dijkstra_and_settles_fewer_nodes() {
        for family in ["lfhh-2d", "lfhh-3d"] {
            for seed in 0..8 {
                let world = World::new(generate(family, seed, &Parameters::default()).unwrap(), seed, 0).unwrap();
                for inflation_m in [Some(0.0), None] {
                    let [exact, fast] = both(&world, Settings { inflation_m, ..Settings::default() });
                    assert!((fast.seconds - exact.seconds).abs() <= 1e-9 * exact.seconds, "{family} {seed}");
                    assert!(fast.settled < exact.settled, "{family} {seed}: {} {}", fast.settled, exact.settled);
                }
            }
        }
    }

    #[test]
    fn a_slow_vehicle_finds_the_same_way_or_none() {
        let mut scenario = generate("lfhh-2d", 2, &Parameters::default()).unwrap();
        let speed = scenario.vehicle.speed_mps;
        for part in [0.1, 0.15, 0.2, 0.5] {
            scenario.vehicle.speed_mps = part * speed;
            let [exact, fast] = both(&World::new(scenario.clone(), 0, 0).unwrap(), Settings::default());
            assert_eq!(exact.seconds.is_finite(), part > 0.1);
            assert_eq!(fast.seconds.is_finite(), part > 0.1);
            assert!(part == 0.1 || (fast.seconds - exact.seconds).abs() <= 1e-9 * exact.seconds, "{part}");
        }
    }

    #[test]
    fn a_wall_without_a_gap_has_no_path() {
        let world = testing::walled_world();
        let mission = world.mission();
        for planner in ["dijkstra", "astar"] {
            let (start, goal) = (mission.start_m, mission.goal_m);
            let plan = registry::plan(planner, &world, start, goal, 0, "", &Control::none()).unwrap();
            assert!(!plan.feasible && !plan.interrupted && plan.waypoints == [start, goal]);
        }
    }

    #[test]
    fn an_interrupted_search_says_so() {
        let world = testing::paper_world("lfhh-2d-1", 0);
        let mission = world.mission();
        let stop = || true;
        for planner in ["dijkstra", "astar"] {
            let (start, goal) = (mission.start_m, mission.goal_m);
            let plan = registry::plan(planner, &world, start, goal, 0, "", &Control::ask(&stop)).unwrap();
            assert!(!plan.feasible && plan.interrupted && plan.waypoints == [start, goal]);
        }
    }
}
