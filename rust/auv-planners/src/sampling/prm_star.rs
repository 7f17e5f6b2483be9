//! PRM* (Karaman and Frazzoli 2011, Algorithm 5): a roadmap of random samples, each joined to all others
//! within a radius that shrinks with their number, and Dijkstra's algorithm over it.
//!
//! The number of samples need not be known: as long as motions are left to test, the roadmap gets twice as
//! many. Pairs that the larger roadmap's radius joins and the smaller one had were tested already.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use auv_world::math::distance;
use auv_world::rng::Stream;

use super::kd_tree::KdTree;
use super::query::Query;
use super::settings::PrmStar;
use super::space::{Place, Space};
use crate::error::PlanError;
use crate::plan::Plan;
use crate::registry::Request;

/// The search ends with a roadmap of this many nodes.
pub const MOST_NODES: usize = 1 << 15;

const NONE: u32 = u32::MAX;
const START: usize = 0;
const GOAL: usize = 1;

/// PRM*.
///
/// # Errors
/// As [`crate::registry::plan`].
pub fn plan_prm_star(request: &Request<'_>) -> Result<Plan, PlanError> {
    let (common, settings) = request.parse::<PrmStar>()?;
    let space = Space::new(request.world, settings.objective, settings.margin_m);
    let mut query = Query::new(request, &common, space, settings.shortcut)?;
    let mut roadmap = Roadmap::new(&query);
    // A spent budget, an interruption or a path that suffices unwinds through `None`.
    let _ended = roadmap.run(&mut query, &settings, &mut request.random());
    Ok(query.finish(request.planner, || roadmap.approach()))
}

/// A motion from one node to another.
struct Edge {
    to: u32,
    /// The next edge from the same node.
    next: u32,
    measure: f64,
}

struct Roadmap {
    /// Start, goal, samples.
    places: Vec<Place>,
    index: KdTree,
    /// The first edge from each node.
    first: Vec<u32>,
    edges: Vec<Edge>,
    /// The least cost from the start to each node, and the node before it on that way.
    cost: Vec<f64>,
    before: Vec<u32>,
}

impl Roadmap {
    fn new(query: &Query<'_>) -> Self {
        let mut roadmap = Self {
            places: Vec::new(),
            index: KdTree::new(query.space().dimensions()),
            first: Vec::new(),
            edges: Vec::new(),
            cost: Vec::new(),
            before: Vec::new(),
        };
        roadmap.add(query.start());
        roadmap.add(query.goal());
        roadmap.settle();
        roadmap
    }

    fn add(&mut self, place: Place) {
        self.index.insert(place.point);
        self.places.push(place);
        self.first.push(NONE);
    }

    fn run(&mut self, query: &mut Query<'_>, settings: &PrmStar, stream: &mut Stream) -> Option<()> {
        query.try_straight()?;
        let mut samples = settings.samples;
        while samples <= MOST_NODES {
            let first = self.places.len();
            while self.places.len() < samples + 2 {
                self.add(query.space().draw(stream));
            }
            let radius = settings.radius_factor * connection_radius(query.space(), samples);
            let joined = self.join(query, first, radius);
            self.settle();
            if self.cost[GOAL].is_finite() {
                query.offer(self.way_to(GOAL), self.cost[GOAL])?;
            }
            joined?;
            samples *= 2;
        }
        Some(())
    }

    /// Joins the nodes from `first` on to all before them within the radius.
    fn join(&mut self, query: &mut Query<'_>, first: usize, radius: f64) -> Option<()> {
        let mut near = Vec::new();
        for node in first..self.places.len() {
            let place = self.places[node];
            self.index.within(place.point, radius, &mut near);
            for other in near.iter().map(|other| *other as usize).filter(|other| *other < node) {
                let neighbour = self.places[other];
                if query.is_free(&place, &neighbour)? {
                    self.link(node, other, query.space().measure(&place, &neighbour));
                    self.link(other, node, query.space().measure(&neighbour, &place));
                }
            }
        }
        Some(())
    }

    fn link(&mut self, from: usize, to: usize, measure: f64) {
        // Where the current wins there is no way.
        if measure.is_finite() {
            self.edges.push(Edge { to: to as u32, next: self.first[from], measure });
            self.first[from] = self.edges.len() as u32 - 1;
        }
    }

    /// Dijkstra's algorithm from the start.
    fn settle(&mut self) {
        self.cost.clear();
        self.cost.resize(self.places.len(), f64::INFINITY);
        self.before.clear();
        self.before.resize(self.places.len(), NONE);
        self.cost[START] = 0.0;
        // Costs are not negative, so that their bits are in the order of their values.
        let mut queue = BinaryHeap::from([Reverse((0.0_f64.to_bits(), START as u32))]);
        while let Some(Reverse((bits, node))) = queue.pop() {
            let cost = f64::from_bits(bits);
            if cost > self.cost[node as usize] {
                continue;
            }
            let mut at = self.first[node as usize];
            while at != NONE {
                let Edge { to, next, measure } = self.edges[at as usize];
                let arrival = cost + measure;
                if arrival < self.cost[to as usize] {
                    self.cost[to as usize] = arrival;
                    self.before[to as usize] = node;
                    queue.push(Reverse((arrival.to_bits(), to)));
                }
                at = next;
            }
        }
    }

    fn way_to(&self, node: usize) -> Vec<Place> {
        let before = |node: &u32| Some(self.before[*node as usize]).filter(|before| *before != NONE);
        let back = std::iter::successors(Some(node as u32), before);
        let mut way: Vec<Place> = back.map(|node| self.places[node as usize]).collect();
        way.reverse();
        way
    }

    /// The way to the node nearest to the goal of those that are reached.
    fn approach(&self) -> Vec<Place> {
        let goal = self.places[GOAL].point;
        let reached = (0..self.cost.len()).filter(|node| self.cost[*node].is_finite());
        let gap = |node: &usize| distance(self.places[*node].point, goal);
        self.way_to(reached.min_by(|a, b| gap(a).total_cmp(&gap(b))).unwrap_or(START))
    }
}

/// The least radius (m) with which PRM* of so many samples converges: 2 (1 + 1/d)^(1/d) (volume / unit ball
/// log n / n)^(1/d).
fn connection_radius(space: &Space<'_>, samples: usize) -> f64 {
    let (n, d) = (samples as f64 + 1.0, space.dimensions() as f64);
    2.0 * space.radius_of((1.0 + 1.0 / d) * libm::log(n) / n)
}
