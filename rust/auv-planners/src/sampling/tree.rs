//! A tree of places with the cost from its root to each of them; a subtree may move to a better parent.

use super::space::Place;

const NONE: u32 = u32::MAX;

/// Nodes by number; 0 is the root.
pub struct Tree {
    places: Vec<Place>,
    parent: Vec<u32>,
    /// What the motion from the parent costs.
    edge: Vec<f64>,
    cost: Vec<f64>,
    first_child: Vec<u32>,
    next_sibling: Vec<u32>,
    stack: Vec<u32>,
}

impl Tree {
    /// A tree of a root alone.
    pub fn new(root: Place) -> Self {
        Self {
            places: vec![root],
            parent: vec![NONE],
            edge: vec![0.0],
            cost: vec![0.0],
            first_child: vec![NONE],
            next_sibling: vec![NONE],
            stack: Vec::new(),
        }
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Where all nodes are.
    pub fn places(&self) -> &[Place] {
        &self.places
    }

    /// What the way from the root to a node costs.
    pub fn cost(&self, node: usize) -> f64 {
        self.cost[node]
    }

    /// Adds a node under a parent.
    pub fn add(&mut self, place: Place, parent: usize, edge: f64) -> usize {
        let node = self.places.len();
        self.places.push(place);
        self.parent.push(parent as u32);
        self.edge.push(edge);
        self.cost.push(self.cost[parent] + edge);
        self.first_child.push(NONE);
        self.next_sibling.push(self.first_child[parent]);
        self.first_child[parent] = node as u32;
        node
    }

    /// Moves a node with all below it under another parent, which must not be one of them.
    pub fn move_to(&mut self, node: usize, parent: usize, edge: f64) {
        self.detach(node);
        self.parent[node] = parent as u32;
        self.edge[node] = edge;
        self.next_sibling[node] = self.first_child[parent];
        self.first_child[parent] = node as u32;
        self.stack.push(node as u32);
        while let Some(moved) = self.stack.pop() {
            let moved = moved as usize;
            self.cost[moved] = self.cost[self.parent[moved] as usize] + self.edge[moved];
            let mut child = self.first_child[moved];
            while child != NONE {
                self.stack.push(child);
                child = self.next_sibling[child as usize];
            }
        }
    }

    fn detach(&mut self, node: usize) {
        let (parent, next) = (self.parent[node] as usize, self.next_sibling[node]);
        let mut sibling = self.first_child[parent] as usize;
        if sibling == node {
            self.first_child[parent] = next;
            return;
        }
        while self.next_sibling[sibling] as usize != node {
            sibling = self.next_sibling[sibling] as usize;
        }
        self.next_sibling[sibling] = next;
    }

    /// The way from the root to a node.
    pub fn way_to(&self, node: usize) -> Vec<Place> {
        let parent = |node: &u32| Some(self.parent[*node as usize]).filter(|parent| *parent != NONE);
        let up = std::iter::successors(Some(node as u32), parent);
        let mut way: Vec<Place> = up.map(|node| self.places[node as usize]).collect();
        way.reverse();
        way
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_subtree_moves_with_its_costs() {
        let place = |x: f64| Place { point: [x, 0.0, 0.0], clearance: 1.0, required: 0.0 };
        let mut tree = Tree::new(place(0.0));
        let a = tree.add(place(1.0), 0, 5.0);
        let b = tree.add(place(2.0), a, 5.0);
        let c = tree.add(place(3.0), b, 5.0);
        let d = tree.add(place(4.0), a, 1.0);
        tree.move_to(b, d, 1.0);
        assert_eq!([a, b, c, d].map(|node| tree.cost(node)), [5.0, 7.0, 12.0, 6.0]);
        assert_eq!(tree.way_to(c), [0.0, 1.0, 4.0, 2.0, 3.0].map(place));
        tree.move_to(d, 0, 2.0);
        assert_eq!([a, b, c, d].map(|node| tree.cost(node)), [5.0, 3.0, 8.0, 2.0]);
        tree.move_to(c, a, 1.0);
        assert_eq!(tree.cost(c), 6.0);
        assert_eq!(tree.way_to(b), [0.0, 4.0, 2.0].map(place));
    }
}
