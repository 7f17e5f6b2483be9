//! Best-first search over the graph, under both planners: Dijkstra's algorithm if nothing is estimated, A*
//! with an estimate of what is left.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::graph::{Direction, Graph};

/// The control is asked once in this many nodes.
const ASK_EVERY: u64 = 1024;

/// A way to or from each node, and how long it takes.
pub struct Search {
    /// Time of the best way found (s); infinite if there is none.
    pub seconds: Vec<f64>,
    /// The next node on that way; the node itself if it is the last.
    pub link: Vec<u32>,
    /// Nodes settled.
    pub settled: u64,
    done: Vec<bool>,
    queue: BinaryHeap<Entry>,
}

/// A node to look at, ordered by time in all, then by index, so that ties are the same everywhere.
#[derive(PartialEq)]
struct Entry {
    total: f64,
    node: u32,
}

impl Eq for Entry {}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> Ordering {
        other.total.total_cmp(&self.total).then(other.node.cmp(&self.node))
    }
}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Search {
    /// A search that knows no way to any of so many nodes.
    pub fn new(nodes: usize) -> Self {
        Self {
            seconds: vec![f64::INFINITY; nodes],
            link: vec![u32::MAX; nodes],
            settled: 0,
            done: vec![false; nodes],
            queue: BinaryHeap::new(),
        }
    }

    /// Lets a way begin at a node after some time (s), with about so much left (s).
    pub fn begin(&mut self, node: usize, seconds: f64, left: f64) {
        if !self.done[node] && seconds < self.seconds[node] {
            self.improve(node, node, seconds, left);
        }
    }

    fn improve(&mut self, node: usize, link: usize, seconds: f64, left: f64) {
        self.seconds[node] = seconds;
        self.link[node] = link as u32;
        self.queue.push(Entry { total: seconds + left, node: node as u32 });
    }

    /// Settles node after node, until none is left or none can be better than what `settle` returned last: the
    /// best total time (s) that is known for sure. `left` never estimates too much (s). `false` if interrupted.
    pub fn run(
        &mut self,
        graph: &Graph<'_>,
        direction: Direction,
        left: impl Fn(usize) -> f64,
        mut settle: impl FnMut(usize, f64) -> f64,
        interrupted: &mut dyn FnMut() -> bool,
    ) -> bool {
        let mut known = f64::INFINITY;
        while let Some(Entry { total, node }) = self.queue.pop() {
            let here = node as usize;
            if self.done[here] {
                continue;
            }
            if total >= known {
                break;
            }
            self.done[here] = true;
            self.settled += 1;
            if self.settled.is_multiple_of(ASK_EVERY) && interrupted() {
                return false;
            }
            let seconds = self.seconds[here];
            known = settle(here, seconds);
            for (other, edge) in graph.neighbours(here, direction) {
                if self.done[other] {
                    continue;
                }
                let (behind, ahead) = if direction == Direction::Forwards { (here, other) } else { (other, here) };
                let arrival = seconds + graph.seconds(edge, behind, ahead);
                if arrival < self.seconds[other] && graph.is_free(behind, ahead) {
                    self.improve(other, here, arrival, left(other));
                }
            }
        }
        true
    }
}
