//! The chart of a harbour: zones, free links and convex cells, and which links bound which cells.

use auv_world::math::Vec2;

use super::area::Area;
use super::cells::{Cell, cells};
use super::error::MapError;
use super::links::{Link, links};
use super::zone::{Zone, hulls, zones};

/// A map of polygons made ready for planning.
///
/// A *crossing* is a link with the direction in which it is crossed: twice the link's number if from the cell on
/// its left, seen from its first end, to that on its right, and one more if back.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    area: Area,
    hulls: Vec<Zone>,
    zones: Vec<Zone>,
    links: Vec<Link>,
    cells: Vec<Cell>,
    /// The cell that each crossing leaves.
    leaves: Vec<usize>,
}

impl Chart {
    /// Makes danger zones of the polygons, `distance` (m) wide with mitres of at most `mitre_limit` times that,
    /// draws the free links and cuts out the cells.
    ///
    /// # Errors
    /// [`MapError`] naming the polygon or the number that cannot be.
    pub fn new(area: Area, polygons: &[Vec<Vec2>], distance: f64, mitre_limit: f64) -> Result<Self, MapError> {
        if !(distance.is_finite() && distance >= 0.0) {
            let allowed = "must be a finite number, not negative";
            return Err(MapError::Number { name: "distance", value: distance, allowed });
        }
        if mitre_limit.is_nan() || mitre_limit < 1.0 {
            return Err(MapError::Number { name: "mitre_limit", value: mitre_limit, allowed: "must be at least 1" });
        }
        let zones = zones(&area, polygons, distance, mitre_limit)?;
        let links = links(&area, &zones)?;
        let cells = cells(&area, &zones, &links)?;
        let mut leaves = vec![usize::MAX; 2 * links.len()];
        for (number, cell) in cells.iter().enumerate() {
            for &side in &cell.sides {
                leaves[side] = number;
            }
        }
        if let Some(lost) = leaves.iter().position(|cell| *cell == usize::MAX) {
            let point = links[lost / 2].middle();
            return Err(MapError::Degenerate { point, reason: "a link bounds no cell" });
        }
        Ok(Self { area, hulls: hulls(&area, polygons), zones, links, cells, leaves })
    }

    /// The area.
    pub fn area(&self) -> &Area {
        &self.area
    }

    /// The danger zones.
    pub fn zones(&self) -> &[Zone] {
        &self.zones
    }

    /// The free links.
    pub fn links(&self) -> &[Link] {
        &self.links
    }

    /// The cells.
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// The cell that a crossing leaves.
    #[inline]
    pub fn leaves(&self, crossing: usize) -> usize {
        self.leaves[crossing]
    }

    /// The cell that a crossing enters.
    #[inline]
    pub fn enters(&self, crossing: usize) -> usize {
        self.leaves[crossing ^ 1]
    }

    /// The ends of the link on the left and on the right hand of who crosses it.
    pub fn hands(&self, crossing: usize) -> [Vec2; 2] {
        let [first, second] = self.links[crossing / 2].ends;
        if crossing.is_multiple_of(2) { [second, first] } else { [first, second] }
    }

    /// The cells that hold a point: several if it is on a link.
    pub fn cells_at(&self, point: Vec2) -> Vec<usize> {
        (0..self.cells.len()).filter(|&cell| self.cells[cell].contains(point)).collect()
    }

    /// The polygons of the zones between the water that can be reached from a point and what cannot: those that
    /// part a goal from a start to which there is no way.
    pub fn barriers(&self, start: Vec2) -> Vec<usize> {
        let mut reached = vec![false; self.cells.len()];
        let mut open = self.cells_at(start);
        while let Some(cell) = open.pop() {
            if !std::mem::replace(&mut reached[cell], true) {
                open.extend(self.cells[cell].sides.iter().map(|&side| self.enters(side)));
            }
        }
        let touches = |zone: &Zone, wanted: bool| {
            let cells = self.cells.iter().zip(&reached).filter(|(_, reached)| **reached == wanted);
            cells.flat_map(|(cell, _)| &cell.ring).any(|corner| zone.corners().contains(corner))
        };
        let between = self.zones.iter().filter(|zone| touches(zone, true) && touches(zone, false));
        let mut polygons: Vec<usize> = between.flat_map(|zone| zone.polygons()).copied().collect();
        polygons.sort_unstable();
        polygons
    }

    /// Whether a segment between points of the area enters no zone.
    #[inline]
    pub fn is_free(&self, from: Vec2, to: Vec2) -> bool {
        let wall = self.area.shared_wall(from, to);
        !self.zones.iter().any(|zone| zone.meets(from, to) || wall.is_some_and(|along| zone.bars_wall(from, to, along)))
    }

    /// Fails unless a point is in the area and in no zone.
    ///
    /// # Errors
    /// [`MapError::Outside`] or [`MapError::InZone`], which names the zone's polygons.
    pub fn check(&self, name: &'static str, point: Vec2) -> Result<(), MapError> {
        if !self.area.contains(point) {
            return Err(MapError::Outside { name, point });
        }
        match self.zones.iter().find(|zone| zone.contains(point)) {
            Some(zone) => Err(MapError::InZone { name, point, polygons: zone.polygons().to_vec() }),
            None => Ok(()),
        }
    }

    /// The nearest point that is in the area and in no zone, to which nothing solid bars the way if there is
    /// such a point; `None` if zones fill the area.
    pub fn nearest_free(&self, point: Vec2) -> Option<Vec2> {
        let inside = self.area.nearest(point);
        let Some(zone) = self.zones.iter().find(|zone| zone.contains(inside)) else { return Some(inside) };
        let exits = zone.ways_out(inside, &self.area);
        let open = |exit: &&Vec2| !self.hulls.iter().any(|hull| hull.meets(inside, **exit));
        exits.iter().find(open).or(exits.first()).copied()
    }
}
