//! The planners by which a harbour can be crossed.

use super::ants::Colony;
use super::fitness::{Corridor, Objective};
use super::funnel::taut;
use super::harbor::drift;
use super::route::{distance, length};
use super::search::Search;
use super::settings::{Ants, Funnel, Particles, Places, Plain, Unit};
use super::swarm::{Inertia, Swarm};
use super::visibility::shortest;
use crate::error::PlanError;
use crate::plan::Plan;
use crate::registry::Request;

/// Iterations of swarms and colonies, as in the paper.
const ITERATIONS: u64 = 150;

/// The shortest way by the middles of links.
///
/// # Errors
/// As [`crate::registry::plan`].
pub fn plan_maklink_dijkstra(request: &Request<'_>) -> Result<Plan, PlanError> {
    let (common, settings) = request.parse::<Plain>()?;
    let mut search = Search::new(request, &common, &settings.zones, settings.smoothing())?;
    if let Some(routes) = search.routes(1)? {
        let [start, goal] = search.ends();
        let path = routes[0].by_middles(search.chart(), start, goal);
        search.count(1);
        search.hold(&path, routes[0].length, true);
    }
    Ok(search.finish())
}

/// The shortest path through the shortest corridors.
///
/// # Errors
/// As [`crate::registry::plan`].
pub fn plan_funnel(request: &Request<'_>) -> Result<Plan, PlanError> {
    let (common, settings) = request.parse::<Funnel>()?;
    let mut search = Search::new(request, &common, &settings.zones, settings.smoothing())?;
    let [start, goal] = search.ends();
    let mut best = f64::INFINITY;
    for route in search.routes(settings.corridors)?.unwrap_or_default() {
        let path = taut(search.chart(), &route, start, goal);
        search.count(1);
        if length(&path) < best {
            best = length(&path);
            search.hold(&path, best, true);
        }
        if search.end_generation(best) {
            break;
        }
    }
    Ok(search.finish())
}

/// The shortest path of all round the zones.
///
/// # Errors
/// As [`crate::registry::plan`].
pub fn plan_visibility(request: &Request<'_>) -> Result<Plan, PlanError> {
    let (common, settings) = request.parse::<Plain>()?;
    let mut search = Search::new(request, &common, &settings.zones, settings.smoothing())?;
    let [start, goal] = search.ends();
    let control = search.control();
    match shortest(search.chart(), start, goal, &mut || control.interrupted()) {
        Ok(Some(path)) => {
            search.count(1);
            search.hold(&path, length(&path), true);
        }
        Ok(None) => search.interrupt(),
        Err(_) => search.no_way(),
    }
    Ok(search.finish())
}

/// Ordinary particle swarm on the MAKLINK route.
///
/// # Errors
/// As [`crate::registry::plan`].
pub fn plan_maklink_pso(request: &Request<'_>) -> Result<Plan, PlanError> {
    plan_swarm(request, Inertia::Linear)
}

/// Particle swarm whose inertia weights are reinforced (RMPSO).
///
/// # Errors
/// As [`crate::registry::plan`].
pub fn plan_rmpso(request: &Request<'_>) -> Result<Plan, PlanError> {
    plan_swarm(request, Inertia::Reinforced)
}

fn plan_swarm(request: &Request<'_>, inertia: Inertia) -> Result<Plan, PlanError> {
    let (common, settings) = request.parse::<Particles>()?;
    let drift = drift(request.world, settings.objective)?;
    let mut search = Search::new(request, &common, &settings.zones, settings.smoothing())?;
    let (ratio, size) = (settings.unit == Unit::Ratio, settings.population);
    let (chart, ends) = (search.chart().clone(), search.ends());
    let corridor = match settings.places {
        Places::Links => {
            let Some(routes) = search.routes(1)? else { return Ok(search.finish()) };
            Corridor::new(&chart, &routes[0], ends, ratio, settings.objective, drift)
        }
        Places::Line => {
            if search.is_straight() {
                return Ok(search.finish());
            }
            let line = settings.zones.wider(settings.smoothing().cut_m()).line(request.world, settings.penalty)?;
            let third = distance(ends[0], ends[1]) / 3.0;
            let reach = if settings.reach_m > 0.0 { settings.reach_m } else { third };
            Corridor::beside(&chart, line, ends, settings.points, reach, ratio, settings.objective, drift)
        }
    };
    let generations = common.generations_or(ITERATIONS);
    // Without a number of generations the weight falls over the whole budget.
    let iterations = generations.min(common.max_evaluations.map_or(u64::MAX, |budget| budget / size as u64));
    let mut random = request.random();
    let counted = search.left().min(size as u64);
    let mut swarm = Swarm::new(&corridor, settings.rules(inertia, iterations), size, counted as usize, &mut random);
    search.count(counted);
    let mut held = hold(&mut search, &corridor, swarm.best(), swarm.best_cost());
    let mut generation = 0;
    while !search.end_generation(swarm.best_cost()) && generation < generations {
        let counted = search.left().min(size as u64);
        swarm.step(counted as usize, &mut random);
        search.count(counted);
        generation += 1;
        if swarm.best_cost() < held && search.is_worth_holding(swarm.best_cost()) {
            held = hold(&mut search, &corridor, swarm.best(), swarm.best_cost());
        }
    }
    if swarm.best_cost() < held {
        hold(&mut search, &corridor, swarm.best(), swarm.best_cost());
    }
    Ok(search.finish())
}

/// Ant colony on the MAKLINK route.
///
/// # Errors
/// As [`crate::registry::plan`].
pub fn plan_maklink_aco(request: &Request<'_>) -> Result<Plan, PlanError> {
    let (common, settings) = request.parse::<Ants>()?;
    let drift = drift(request.world, Objective::Length)?;
    let mut search = Search::new(request, &common, &settings.zones, settings.smoothing())?;
    let Some(routes) = search.routes(1)? else { return Ok(search.finish()) };
    let chart = search.chart().clone();
    let corridor = Corridor::new(&chart, &routes[0], search.ends(), false, Objective::Length, drift);
    let mut colony = Colony::new(&corridor);
    let mut random = request.random();
    let mut held = f64::INFINITY;
    for _ in 0..common.generations_or(ITERATIONS - 1).saturating_add(1) {
        let ants = search.left().min(settings.population as u64);
        colony.step(ants as usize, &mut random);
        search.count(ants);
        if search.is_worth_holding(colony.best_cost()) {
            held = hold(&mut search, &corridor, colony.best(), colony.best_cost());
        }
        if search.end_generation(colony.best_cost()) {
            break;
        }
    }
    if colony.best_cost() < held {
        hold(&mut search, &corridor, colony.best(), colony.best_cost());
    }
    Ok(search.finish())
}

/// Holds the path of some positions; gives back what it costs the planner.
fn hold(search: &mut Search<'_>, corridor: &Corridor<'_>, positions: &[f64], cost: f64) -> f64 {
    let path = corridor.path(positions.iter().copied());
    // Links lead free paths only.
    let free = !corridor.is_open() || !corridor.is_blocked(&path);
    search.hold(&path, cost, free);
    cost
}
