//! A*: from the start towards the goal, looking first at the nodes through which the goal may be reached
//! soonest. What is left from a node is estimated as the straight line at the greatest speed over ground that
//! the currents allow anywhere: never too much, so that the way found is as fast as Dijkstra's.

use auv_world::World;
use auv_world::math::{Vec3, distance};

use super::graph::{Direction, Graph};
use super::nodes::Grid;
use super::path::{RINGS, Route};
use super::search::Search;

/// The fastest way over a grid; `None` if interrupted.
pub fn route(
    world: &World,
    grid: &Grid,
    start: Vec3,
    goal: Vec3,
    interrupted: &mut dyn FnMut() -> bool,
) -> Option<Route> {
    let graph = Graph::new(world, grid, goal, interrupted)?;
    let left = |node: usize| distance(grid.place(node), goal) / graph.fastest();
    let at_start = world.clearance(start);
    let mut search = Search::new(grid.len());
    let mut best: Option<(f64, usize)> = None;
    // A wider ring is looked at only if no way leads on from the narrower ones.
    for ring in RINGS {
        for (node, seconds) in grid.entries(world, start, ring) {
            if graph.may_begin(start, at_start, node) {
                search.begin(node, seconds, left(node));
            }
        }
        let settle = |node: usize, seconds: f64| {
            if let Some(total) = graph.exit(node).map(|rest| seconds + rest) {
                best = best.filter(|best| best.0 <= total).or(Some((total, node)));
            }
            best.map_or(f64::INFINITY, |best| best.0)
        };
        if !search.run(&graph, Direction::Forwards, left, settle, interrupted) {
            return None;
        }
        if best.is_some() {
            break;
        }
    }
    let Some((seconds, mut node)) = best else {
        return Some(Route { nodes: Vec::new(), seconds: f64::INFINITY, settled: search.settled });
    };
    let mut nodes = vec![node];
    while search.link[node] as usize != node {
        node = search.link[node] as usize;
        nodes.push(node);
    }
    nodes.reverse();
    Some(Route { nodes, seconds, settled: search.settled })
}
