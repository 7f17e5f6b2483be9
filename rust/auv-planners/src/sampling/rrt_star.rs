//! RRT* (Karaman and Frazzoli 2011, Algorithm 6): a tree from the start grows towards random samples; a new
//! node takes the best parent near by, and becomes the parent of those near by whose way it betters.

use auv_world::math::distance;
use auv_world::rng::Stream;

use super::kd_tree::KdTree;
use super::query::Query;
use super::settings::RrtStar;
use super::space::{Place, Space};
use super::tree::Tree;
use crate::error::PlanError;
use crate::plan::Plan;
use crate::registry::Request;

/// The longest motion is this part of the longest edge of the box.
const STEP: f64 = 0.2;
/// The search ends with a tree of this many nodes.
const MOST_NODES: usize = 4_000_000;

/// RRT*.
///
/// # Errors
/// As [`crate::registry::plan`].
pub fn plan_rrt_star(request: &Request<'_>) -> Result<Plan, PlanError> {
    let (common, settings) = request.parse::<RrtStar>()?;
    let space = Space::new(request.world, settings.objective, settings.margin_m);
    let mut query = Query::new(request, &common, space, settings.shortcut)?;
    let mut growth = Growth::new(&query, &settings);
    // A spent budget, an interruption or a path that suffices unwinds through `None`.
    let _ended = growth.run(&mut query, &mut request.random());
    Ok(query.finish(request.planner, || growth.approach()))
}

struct Growth {
    tree: Tree,
    /// The nodes of the tree by place.
    index: KdTree,
    goal: Place,
    /// The last node before the goal, and the cost of the motion from there.
    last: Option<(usize, f64)>,
    step: f64,
    radius_factor: f64,
    goal_bias: f64,
    near: Vec<u32>,
    candidates: Vec<Candidate>,
}

/// A node near the new one.
#[derive(Clone, Copy)]
struct Candidate {
    node: usize,
    /// What the way through it to the new node costs.
    cost: f64,
    /// Whether the motion between them is free, if that was tested.
    free: Option<bool>,
}

impl Growth {
    fn new(query: &Query<'_>, settings: &RrtStar) -> Self {
        let mut index = KdTree::new(query.space().dimensions());
        index.insert(query.start().point);
        let step = if settings.step_m > 0.0 { settings.step_m } else { STEP * query.space().longest_edge() };
        Self {
            tree: Tree::new(query.start()),
            index,
            goal: query.goal(),
            last: None,
            step,
            radius_factor: settings.radius_factor,
            goal_bias: settings.goal_bias,
            near: Vec::new(),
            candidates: Vec::new(),
        }
    }

    fn run(&mut self, query: &mut Query<'_>, stream: &mut Stream) -> Option<()> {
        query.try_straight()?;
        while self.tree.len() < MOST_NODES {
            let before = self.cost();
            self.grow(query, stream)?;
            if let Some((last, _)) = self.last
                && self.cost() < before
            {
                let mut way = self.tree.way_to(last);
                way.push(self.goal);
                query.offer(way, self.cost())?;
            }
        }
        Some(())
    }

    /// The cost of the best way to the goal.
    fn cost(&self) -> f64 {
        self.last.map_or(f64::INFINITY, |(node, edge)| self.tree.cost(node) + edge)
    }

    /// One sample; at least one motion is tested.
    fn grow(&mut self, query: &mut Query<'_>, stream: &mut Stream) -> Option<()> {
        let at_goal = self.last.is_none() && stream.unit() < self.goal_bias;
        let sample = if at_goal { self.goal } else { query.space().draw(stream) };
        let nearest = self.index.nearest(sample.point);
        let from = self.tree.places()[nearest];
        let new = query.space().steer(&from, &sample, self.step);
        if !query.is_free(&from, &new)? {
            return Some(());
        }
        if new == self.goal {
            let edge = query.space().measure(&from, &new);
            if self.tree.cost(nearest) + edge < self.cost() {
                self.last = Some((nearest, edge));
            }
            return Some(());
        }
        self.look_round(query.space(), &new, nearest);
        let Some(node) = self.choose_parent(query, &new)? else { return Some(()) };
        self.rewire(query, node)?;
        self.try_goal(query, node)
    }

    /// The nodes near a new place, those through which the way to it is the best first.
    fn look_round(&mut self, space: &Space<'_>, new: &Place, nearest: usize) {
        let (n, d) = (self.tree.len() as f64 + 1.0, space.dimensions() as f64);
        let radius = self.radius_factor * space.radius_of(2.0 * (1.0 + 1.0 / d) * libm::log(n) / n);
        self.index.within(new.point, radius.min(self.step), &mut self.near);
        self.candidates.clear();
        let others = self.near.iter().map(|node| *node as usize).filter(|node| *node != nearest);
        for node in std::iter::once(nearest).chain(others) {
            let cost = self.tree.cost(node) + space.measure(&self.tree.places()[node], new);
            self.candidates.push(Candidate { node, cost, free: (node == nearest).then_some(true) });
        }
        self.candidates.sort_unstable_by(|a, b| a.cost.total_cmp(&b.cost).then(a.node.cmp(&b.node)));
    }

    /// Adds the new place under the best of the candidates from which it is reached freely.
    fn choose_parent(&mut self, query: &mut Query<'_>, new: &Place) -> Option<Option<usize>> {
        for candidate in &mut self.candidates {
            // Where the current wins the cost is infinite, and no later one is better.
            if candidate.cost == f64::INFINITY {
                break;
            }
            let parent = self.tree.places()[candidate.node];
            let free = match candidate.free {
                Some(free) => free,
                None => query.is_free(&parent, new)?,
            };
            candidate.free = Some(free);
            if free {
                let edge = candidate.cost - self.tree.cost(candidate.node);
                self.index.insert(new.point);
                return Some(Some(self.tree.add(*new, candidate.node, edge)));
            }
        }
        Some(None)
    }

    /// Leads the ways to the nodes near by through a new node where that is better.
    fn rewire(&mut self, query: &mut Query<'_>, new: usize) -> Option<()> {
        let place = self.tree.places()[new];
        for candidate in &self.candidates {
            let other = self.tree.places()[candidate.node];
            let edge = query.space().measure(&place, &other);
            if self.tree.cost(new) + edge >= self.tree.cost(candidate.node) {
                continue;
            }
            let free = match candidate.free {
                Some(free) => free,
                None => query.is_free(&place, &other)?,
            };
            if free {
                self.tree.move_to(candidate.node, new, edge);
            }
        }
        Some(())
    }

    /// Goes from a new node to the goal if that is near and so is better.
    fn try_goal(&mut self, query: &mut Query<'_>, new: usize) -> Option<()> {
        let place = self.tree.places()[new];
        let edge = query.space().measure(&place, &self.goal);
        let near = distance(place.point, self.goal.point) <= self.step;
        if near && self.tree.cost(new) + edge < self.cost() && query.is_free(&place, &self.goal)? {
            self.last = Some((new, edge));
        }
        Some(())
    }

    /// The way to the node nearest to the goal.
    fn approach(&mut self) -> Vec<Place> {
        self.tree.way_to(self.index.nearest(self.goal.point))
    }
}
