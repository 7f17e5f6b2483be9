//! The time to the goal from every node of a grid, through the present map and currents: Dijkstra's
//! algorithm from the goal outwards.

use auv_world::World;
use auv_world::kinematics::travel_time;
use auv_world::math::{Vec3, distance};

use super::Settings;
use super::graph::{Direction, Graph};
use super::nodes::Grid;
use super::path::{RINGS, Route};
use super::search::Search;

/// A field of times to the goal.
#[derive(Debug, Clone)]
pub struct TimeField {
    grid: Grid,
    goal: Vec3,
    seconds: Vec<f64>,
    /// The node that comes next on the way to the goal; the node itself if that is the goal.
    next: Vec<u32>,
    settled: u64,
}

impl TimeField {
    /// The field of a world as it is now, for its goal or another. `interrupted` is asked now and then;
    /// when it says yes, there is no field.
    pub fn new(world: &World, goal: Vec3, settings: Settings, interrupted: &mut dyn FnMut() -> bool) -> Option<Self> {
        let grid = Grid::new(world, settings);
        let graph = Graph::new(world, &grid, goal, interrupted)?;
        let mut search = Search::new(grid.len());
        for (node, seconds) in graph.exits() {
            search.begin(*node, *seconds, 0.0);
        }
        let whole = |_: usize, _: f64| f64::INFINITY;
        let done = search.run(&graph, Direction::Backwards, |_| 0.0, whole, interrupted);
        let Search { seconds, link: next, settled, .. } = search;
        done.then_some(Self { grid, goal, seconds, next, settled })
    }

    /// Where to steer from `position`: the node within `reach_m`, or the goal, that is reached freely and
    /// from which least time is left in all. Nodes nearer than a third of the reach count only if no
    /// farther one is free: along a good path all are nearly equal, and short legs waste replanning.
    /// `None` if nothing is in free reach.
    pub fn best_waypoint(&self, world: &World, position: Vec3, reach_m: f64) -> Option<Vec3> {
        let speed = self.grid.speed();
        let at_position = world.clearance(position);
        let mut candidates: Vec<(bool, f64, Vec3)> = self
            .grid
            .nodes_within(position, reach_m)
            .into_iter()
            .filter(|&node| self.seconds[node].is_finite())
            .map(|node| {
                let place = self.grid.place(node);
                let near = 3.0 * distance(place, position) < reach_m;
                (near, self.seconds[node] + travel_time(world, position, place, speed, 2), place)
            })
            .filter(|(_, seconds, place)| seconds.is_finite() && *place != position)
            .collect();
        if distance(position, self.goal) <= reach_m {
            candidates.push((false, travel_time(world, position, self.goal, speed, 4), self.goal));
        }
        candidates.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        candidates
            .into_iter()
            .map(|(_, _, place)| place)
            .find(|place| self.grid.free(world, position, at_position, *place, world.clearance(*place)))
    }

    /// The fastest way from `start` along the nodes.
    pub(super) fn route(&self, world: &World, start: Vec3) -> Route {
        let at_start = world.clearance(start);
        let free = |place: Vec3| self.grid.free(world, start, at_start, place, world.clearance(place));
        let entry = RINGS.into_iter().find_map(|ring| {
            let entries = self.grid.entries(world, start, ring).filter(|(node, _)| self.seconds[*node].is_finite());
            let mut entries: Vec<_> = entries.map(|(node, seconds)| (seconds + self.seconds[node], node)).collect();
            entries.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            entries.into_iter().find(|(_, node)| free(self.grid.place(*node)))
        });
        let Some((seconds, mut node)) = entry else {
            return Route { nodes: Vec::new(), seconds: f64::INFINITY, settled: self.settled };
        };
        let mut nodes = vec![node];
        while self.next[node] as usize != node {
            node = self.next[node] as usize;
            nodes.push(node);
        }
        Route { nodes, seconds, settled: self.settled }
    }

    /// The grid alone.
    pub(super) fn into_grid(self) -> Grid {
        self.grid
    }

    /// Where a node lies (m).
    pub fn place(&self, node: usize) -> Vec3 {
        self.grid.place(node)
    }

    /// Nodes settled: what the field cost.
    pub fn settled(&self) -> u64 {
        self.settled
    }

    /// Time to the goal (s) of every node, x fastest, and how many nodes along x, y, z.
    pub fn seconds(&self) -> (&[f64], [usize; 3]) {
        (&self.seconds, self.grid.counts())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use auv_world::families::{Parameters, generate};
    use auv_world::math::{add_scaled, sub};

    fn still(family: &str) -> World {
        let parameters = Parameters { vortices: Some(0), obstacles: Some(0), ..Parameters::default() };
        World::new(generate(family, 3, &parameters).unwrap(), 3, 0).unwrap()
    }

    #[test]
    fn still_water_times_are_distances() {
        let world = still("lfhh-2d");
        let goal = world.mission().goal_m;
        let field = TimeField::new(&world, goal, Settings::default(), &mut || false).unwrap();
        let (seconds, counts) = field.seconds();
        assert_eq!(counts, [41, 81, 1]);
        for (node, time) in seconds.iter().enumerate() {
            let straight = distance(field.place(node), goal) / 2.0;
            assert!(*time >= straight * (1.0 - 1e-12) && *time <= 1.014 * straight + 300.0, "{time} {straight}");
        }
    }

    #[test]
    fn never_steers_into_solids() {
        for family in ["lfhh-2d", "lfhh-3d"] {
            let world = World::new(generate(family, 5, &Parameters::default()).unwrap(), 5, 0).unwrap();
            let goal = world.mission().goal_m;
            let field = TimeField::new(&world, goal, Settings::default(), &mut || false).unwrap();
            let mut position = world.mission().start_m;
            for _ in 0..200 {
                let next = field.best_waypoint(&world, position, 2000.0).unwrap();
                for i in 0..=20 {
                    let point = add_scaled(position, 0.05 * f64::from(i), sub(next, position));
                    assert!(world.clearance(point) > 0.0);
                }
                position = next;
                if position == goal {
                    break;
                }
            }
            assert_eq!(position, goal);
        }
    }

    #[test]
    fn an_interrupted_field_is_none() {
        let world = still("lfhh-2d");
        assert!(TimeField::new(&world, world.mission().goal_m, Settings::default(), &mut || true).is_none());
    }
}
