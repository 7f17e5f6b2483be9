//! A path through a time field: node after node to the goal, then straightened where a straight leg is
//! free and no slower.

use auv_world::World;
use auv_world::math::Vec3;

use super::field::{Settings, TimeField};

/// A path over the grid.
#[derive(Debug, Clone, PartialEq)]
pub struct GridPath {
    /// Start, waypoints, goal (m); only start and goal if there is no way.
    pub waypoints: Vec<Vec3>,
    /// Whether there is a way.
    pub feasible: bool,
    /// Nodes settled.
    pub evaluations: u64,
}

/// Plans from `start` to `goal` through the world as it is now, by default on a grid twice as fine as a
/// field's; `None` if interrupted.
pub fn plan(
    world: &World,
    start: Vec3,
    goal: Vec3,
    settings: Settings,
    interrupted: &mut dyn FnMut() -> bool,
) -> Option<GridPath> {
    let settings = Settings { spacing_m: settings.spacing_or(world, 0.5), ..settings };
    let field = TimeField::new(world, goal, settings, interrupted)?;
    let evaluations = field.settled();
    let Some(mut node) = field.entry(world, start) else {
        return Some(GridPath { waypoints: vec![start, goal], feasible: false, evaluations });
    };
    let mut path = vec![start, field.place(node)];
    loop {
        let (_, next) = field.follow(node);
        if next == node {
            break;
        }
        node = next;
        path.push(field.place(node));
    }
    path.push(goal);
    Some(GridPath { waypoints: straighten(world, &field, &path), feasible: true, evaluations })
}

/// From each waypoint on, the farthest of the next ones that a straight leg reaches freely and no later.
fn straighten(world: &World, field: &TimeField, path: &[Vec3]) -> Vec<Vec3> {
    const AHEAD: usize = 12;
    let legs: Vec<f64> =
        path.windows(2).map(|pair| field.leg(world, pair[0], pair[1]).unwrap_or(f64::INFINITY)).collect();
    let mut straight = vec![path[0]];
    let mut here = 0;
    while here + 1 < path.len() {
        let last = (here + AHEAD).min(path.len() - 1);
        let farthest = (here + 2..=last).rev().find(|&there| {
            let along: f64 = legs[here..there].iter().sum();
            field.leg(world, path[here], path[there]).is_some_and(|seconds| seconds <= along)
        });
        here = farthest.unwrap_or(here + 1);
        straight.push(path[here]);
    }
    straight
}

#[cfg(test)]
mod tests {
    use super::*;
    use auv_world::families::{Parameters, generate};
    use auv_world::scenario::{Obstacle, Polygon};

    #[test]
    fn a_wall_without_a_gap_has_no_path() {
        let parameters = Parameters { obstacles: Some(0), ..Parameters::default() };
        let mut scenario = generate("lfhh-2d", 1, &parameters).unwrap();
        let vertices_m = vec![[-1e3, 15e3], [21e3, 15e3], [21e3, 16e3], [-1e3, 16e3]];
        scenario.obstacles.push(Obstacle::Polygon(Polygon {
            vertices_m,
            top_m: -1.0,
            bottom_m: 1.0,
            velocity_mps: [0.0; 2],
        }));
        let world = World::new(scenario, 0, 0).unwrap();
        let mission = world.mission().clone();
        let path = plan(&world, mission.start_m, mission.goal_m, Settings::default(), &mut || false).unwrap();
        assert!(!path.feasible && path.waypoints == [mission.start_m, mission.goal_m]);
    }
}
