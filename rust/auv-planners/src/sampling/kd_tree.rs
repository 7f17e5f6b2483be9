//! Nearest neighbours: a k-d tree to which points are added one by one. It is not balanced: points drawn at
//! random keep it shallow.

use auv_world::math::Vec3;

const NONE: u32 = u32::MAX;

struct Node {
    point: Vec3,
    /// The axis that parts the children: less than the point's, and the others.
    axis: u8,
    children: [u32; 2],
}

/// Points by number, in the order in which they were added.
pub struct KdTree {
    dimensions: u8,
    nodes: Vec<Node>,
    /// Nodes still to be looked at, and the square of the distance (m) that is at least between.
    stack: Vec<(u32, f64)>,
}

impl KdTree {
    /// An empty tree of points that differ in so many coordinates.
    pub fn new(dimensions: usize) -> Self {
        Self { dimensions: dimensions as u8, nodes: Vec::new(), stack: Vec::new() }
    }

    /// Adds a point.
    pub fn insert(&mut self, point: Vec3) {
        let new = self.nodes.len() as u32;
        let mut axis = 0;
        if new > 0 {
            let mut at = 0;
            loop {
                let node = &mut self.nodes[at];
                let side = node.side(point[usize::from(node.axis)]);
                if node.children[side] == NONE {
                    node.children[side] = new;
                    axis = (node.axis + 1) % self.dimensions;
                    break;
                }
                at = node.children[side] as usize;
            }
        }
        self.nodes.push(Node { point, axis, children: [NONE; 2] });
    }

    /// The point nearest to another; 0 if there is none.
    pub fn nearest(&mut self, to: Vec3) -> usize {
        let (mut nearest, mut least) = (0, f64::INFINITY);
        self.walk(to, |node, square| {
            if square < least {
                (nearest, least) = (node, square);
            }
            least
        });
        nearest
    }

    /// Finds the points no farther than `radius` (m) from another, in an order of its own.
    pub fn within(&mut self, of: Vec3, radius: f64, found: &mut Vec<u32>) {
        found.clear();
        let reach = radius * radius;
        self.walk(of, |node, square| {
            if square <= reach {
                found.push(node as u32);
            }
            reach
        });
    }

    /// Calls `see` with points and the squares of their distances; what is farther than the square it returns
    /// need not be seen.
    #[inline]
    fn walk(&mut self, point: Vec3, mut see: impl FnMut(usize, f64) -> f64) {
        self.stack.clear();
        if !self.nodes.is_empty() {
            self.stack.push((0, 0.0));
        }
        let mut reach = f64::INFINITY;
        while let Some((at, gap)) = self.stack.pop() {
            if gap > reach {
                continue;
            }
            let node = &self.nodes[at as usize];
            let [dx, dy, dz] = [0, 1, 2].map(|axis| point[axis] - node.point[axis]);
            reach = see(at as usize, dx * dx + dy * dy + dz * dz);
            let across = [dx, dy, dz][usize::from(node.axis)];
            let side = node.side(point[usize::from(node.axis)]);
            // The near side is on top and so looked at first.
            for (child, gap) in [(node.children[1 - side], across * across), (node.children[side], gap)] {
                if child != NONE && gap <= reach {
                    self.stack.push((child, gap));
                }
            }
        }
    }
}

impl Node {
    fn side(&self, coordinate: f64) -> usize {
        usize::from(coordinate >= self.point[usize::from(self.axis)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use auv_world::math::distance;
    use auv_world::rng::{Purpose, Stream};

    #[test]
    fn finds_what_a_look_at_all_points_finds() {
        let mut stream = Stream::new(1, Purpose::Planner, 0);
        for dimensions in [2, 3] {
            let depth = if dimensions == 2 { 0.0 } else { 10.0 };
            // Whole numbers, so that many coordinates are equal.
            let mut draw = || [20.0, 40.0, depth].map(|high: f64| stream.uniform(0.0, high).floor());
            let mut tree = KdTree::new(dimensions);
            let mut points = Vec::new();
            let mut found = Vec::new();
            for _ in 0..600 {
                points.push(draw());
                tree.insert(points[points.len() - 1]);
                let (query, radius) = (draw(), 3.0);
                let least = points.iter().map(|p| distance(*p, query)).fold(f64::INFINITY, f64::min);
                assert_eq!(distance(points[tree.nearest(query)], query), least);
                tree.within(query, radius, &mut found);
                found.sort_unstable();
                let all: Vec<u32> =
                    (0..points.len() as u32).filter(|i| distance(points[*i as usize], query) <= radius).collect();
                assert_eq!(found, all);
            }
        }
    }
}
