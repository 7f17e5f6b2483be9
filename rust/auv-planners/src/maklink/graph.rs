//! The MAKLINK graph: middles of links, start and goal, and the straight ways between them inside cells.

use std::collections::BTreeSet;

use auv_world::math::Vec2;

use super::chart::Chart;
use super::route::Routes;

/// The graph from a start to a goal on a chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Graph {
    /// The middle of each link in the chart's order, then start and goal (m).
    pub nodes: Vec<Vec2>,
    /// Pairs of nodes that share a cell, each once and ascending.
    pub edges: Vec<[usize; 2]>,
    /// Nodes of the shortest way, from start to goal; empty if there is none.
    pub route: Vec<usize>,
}

impl Graph {
    /// The graph of a chart.
    pub fn new(chart: &Chart, start: Vec2, goal: Vec2) -> Self {
        let links = chart.links().len();
        let mut nodes: Vec<Vec2> = chart.links().iter().map(|link| link.middle()).collect();
        nodes.extend([start, goal]);
        let ends = [chart.cells_at(start), chart.cells_at(goal)];
        let mut edges = BTreeSet::new();
        for (number, cell) in chart.cells().iter().enumerate() {
            let middles = cell.sides.iter().map(|side| side / 2);
            let inside = (0..2).filter(|&end| ends[end].contains(&number)).map(|end| links + end);
            let here: Vec<usize> = middles.chain(inside).collect();
            for (place, &one) in here.iter().enumerate() {
                edges.extend(
                    here[place + 1..]
                        .iter()
                        .filter(|&&other| other != one)
                        .map(|&other| if one < other { [one, other] } else { [other, one] }),
                );
            }
        }
        let route = Routes::new(chart, start, goal).and_then(|routes| routes.shortest());
        let route = match route {
            Ok(route) => {
                let inner = route.crossings.iter().map(|crossing| crossing / 2);
                std::iter::once(links).chain(inner).chain([links + 1]).collect()
            }
            // No way, or no place to begin or end.
            Err(_) => Vec::new(),
        };
        Self { nodes, edges: edges.into_iter().collect(), route }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maklink::Area;
    use crate::maklink::route::distance;

    #[test]
    fn one_square_in_the_middle() {
        let area = Area::new([0.0; 2], [10.0; 2]).unwrap();
        let square = vec![[4.0, 4.0], [6.0, 4.0], [6.0, 6.0], [4.0, 6.0]];
        let chart = Chart::new(area, &[square], 0.0, 10.0).unwrap();
        let graph = Graph::new(&chart, [1.0, 5.0], [9.0, 5.0]);
        assert_eq!(graph.nodes.len(), chart.links().len() + 2);
        let [start, goal] = [chart.links().len(), chart.links().len() + 1];
        assert_eq!((graph.route[0], graph.route[graph.route.len() - 1]), (start, goal));
        // Every leg of the route is an edge, and no way over edges is shorter (Floyd and Warshall).
        let n = graph.nodes.len();
        let mut least = vec![f64::INFINITY; n * n];
        for &[a, b] in &graph.edges {
            assert!(a < b);
            let length = distance(graph.nodes[a], graph.nodes[b]);
            (least[a * n + b], least[b * n + a]) = (length, length);
        }
        let legs: f64 = graph.route.windows(2).map(|leg| least[leg[0] * n + leg[1]]).sum();
        for k in 0..n {
            for i in 0..n {
                for j in 0..n {
                    least[i * n + j] = least[i * n + j].min(least[i * n + k] + least[k * n + j]);
                }
            }
        }
        assert!((legs - least[start * n + goal]).abs() < 1e-12, "{legs}");
        let walled = vec![[4.0, -1.0], [6.0, -1.0], [6.0, 11.0], [4.0, 11.0]];
        let chart = Chart::new(area, &[walled], 0.0, 10.0).unwrap();
        assert!(Graph::new(&chart, [1.0, 5.0], [9.0, 5.0]).route.is_empty());
    }
}
