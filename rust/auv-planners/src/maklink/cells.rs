//! Convex cells: what walls, zones and links leave of the free water.

use std::cmp::Ordering;
use std::collections::BTreeSet;

use auv_world::math::Vec2;

use super::area::Area;
use super::error::MapError;
use super::links::{Link, turn};
use super::zone::Zone;

/// A point this far outside an edge still counts as in the cell (m).
const EDGE: f64 = 1e-6;
/// A corner may bend inwards by this (sine of the angle).
const BENT: f64 = 2e-6;

/// A convex cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// Corners, counter-clockwise (m).
    pub ring: Vec<Vec2>,
    /// Its links, each as twice its number, plus one if the cell lies left of it from its second end to its first.
    pub sides: Vec<usize>,
}

impl Cell {
    /// Whether a point is inside or on the edge.
    pub fn contains(&self, point: Vec2) -> bool {
        self.edges().all(|[a, b]| {
            let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
            let left = dx * (point[1] - a[1]) - dy * (point[0] - a[0]);
            left >= -EDGE * (dx * dx + dy * dy).sqrt()
        })
    }

    /// Its area (m^2).
    pub fn area_m2(&self) -> f64 {
        area_of(&self.ring)
    }

    fn edges(&self) -> impl Iterator<Item = [Vec2; 2]> + '_ {
        (0..self.ring.len()).map(|i| [self.ring[i], self.ring[(i + 1) % self.ring.len()]])
    }

    /// A corner that bends inwards.
    fn bent(&self) -> Option<Vec2> {
        let n = self.ring.len();
        (0..n).map(|i| [self.ring[i], self.ring[(i + 1) % n], self.ring[(i + 2) % n]]).find_map(|[a, b, c]| {
            let ([ux, uy], [vx, vy]) = ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]);
            let lengths = ((ux * ux + uy * uy) * (vx * vx + vy * vy)).sqrt();
            let straight_on = ux * vx + uy * vy > 0.0;
            let convex = ux * vy - uy * vx >= -BENT * lengths && (straight_on || turn(a, b, c) > 0.0);
            (!convex).then_some(b)
        })
    }
}

/// Half of an edge: from one node to another, with a face on its left.
struct Half {
    from: usize,
    to: usize,
    /// Side of a link, as in [`Cell::sides`].
    side: Option<usize>,
    /// Whether a zone lies on the left.
    solid: bool,
}

/// The cells of an area.
///
/// # Errors
/// [`MapError::Degenerate`] if one is not convex.
pub fn cells(area: &Area, zones: &[Zone], links: &[Link]) -> Result<Vec<Cell>, MapError> {
    let nodes = nodes(area, zones, links);
    let halves = halves(area, zones, links, &nodes);
    let next = next(&nodes, &halves);
    let mut seen = vec![false; halves.len()];
    let mut cells = Vec::new();
    for first in 0..halves.len() {
        if seen[first] {
            continue;
        }
        let mut cell = Cell { ring: Vec::new(), sides: Vec::new() };
        let mut solid = false;
        let mut half = first;
        while !seen[half] {
            seen[half] = true;
            cell.ring.push(nodes[halves[half].from]);
            cell.sides.extend(halves[half].side);
            solid |= halves[half].solid;
            half = next[half];
        }
        // The outside runs clockwise.
        if solid || (area_of(&cell.ring) <= 0.0 && cell.ring.iter().all(|p| area.on_wall(*p))) {
            continue;
        }
        if let Some(point) = cell.bent() {
            return Err(MapError::Degenerate { point, reason: "a cell is not convex" });
        }
        cells.push(cell);
    }
    Ok(cells)
}

/// All ends of edges, each once, in the order of x and y.
fn nodes(area: &Area, zones: &[Zone], links: &[Link]) -> Vec<Vec2> {
    let mut nodes = area.corners().to_vec();
    nodes.extend(zones.iter().flat_map(|zone| zone.corners()));
    nodes.extend(links.iter().flat_map(|link| link.ends));
    nodes.sort_unstable_by(order);
    nodes.dedup();
    nodes
}

fn order(a: &Vec2, b: &Vec2) -> Ordering {
    a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
}

/// Both halves of every edge, one after the other.
fn halves(area: &Area, zones: &[Zone], links: &[Link], nodes: &[Vec2]) -> Vec<Half> {
    let node = |point: Vec2| nodes.binary_search_by(|other| order(other, &point)).unwrap_or_else(|place| place);
    let mut halves = Vec::new();
    let mut zone_edges = BTreeSet::new();
    for zone in zones {
        let ring = zone.corners();
        for i in 0..ring.len() {
            let (from, to) = (node(ring[i]), node(ring[(i + 1) % ring.len()]));
            zone_edges.insert((from.min(to), from.max(to)));
            halves.push(Half { from, to, side: None, solid: true });
            halves.push(Half { from: to, to: from, side: None, solid: false });
        }
    }
    for (i, link) in links.iter().enumerate() {
        let [from, to] = link.ends.map(node);
        halves.push(Half { from, to, side: Some(2 * i), solid: false });
        halves.push(Half { from: to, to: from, side: Some(2 * i + 1), solid: false });
    }
    let corners = area.corners();
    for wall in 0..4 {
        let (a, b) = (corners[wall], corners[(wall + 1) % 4]);
        let (across, along) = if wall % 2 == 0 { (1, 0) } else { (0, 1) };
        let mut on: Vec<usize> = (0..nodes.len()).filter(|&i| nodes[i][across] == a[across]).collect();
        on.sort_by(|&i, &j| nodes[i][along].total_cmp(&nodes[j][along]));
        if a[along] > b[along] {
            on.reverse();
        }
        for pair in on.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            if !zone_edges.contains(&(from.min(to), from.max(to))) {
                halves.push(Half { from, to, side: None, solid: false });
                halves.push(Half { from: to, to: from, side: None, solid: false });
            }
        }
    }
    halves
}

/// What follows each half on the way round the face on its left: at its end, the next to the right of its twin.
fn next(nodes: &[Vec2], halves: &[Half]) -> Vec<usize> {
    let mut leaving: Vec<Vec<usize>> = vec![Vec::new(); nodes.len()];
    for (i, half) in halves.iter().enumerate() {
        leaving[half.from].push(i);
    }
    let mut next = vec![0; halves.len()];
    for (node, leaving) in leaving.iter_mut().enumerate() {
        let centre = nodes[node];
        leaving.sort_by(|&i, &j| round(centre, nodes[halves[i].to], nodes[halves[j].to]));
        for (place, &half) in leaving.iter().enumerate() {
            let right = leaving[(place + leaving.len() - 1) % leaving.len()];
            next[half ^ 1] = right;
        }
    }
    next
}

/// The order of points by direction from a centre, counter-clockwise.
fn round(centre: Vec2, a: Vec2, b: Vec2) -> Ordering {
    let below = |p: Vec2| p[1] < centre[1] || (p[1] == centre[1] && p[0] < centre[0]);
    below(a).cmp(&below(b)).then_with(|| 0.0_f64.total_cmp(&turn(centre, a, b)))
}

fn area_of(ring: &[Vec2]) -> f64 {
    let edges = (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()]));
    0.5 * edges.map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>()
}
