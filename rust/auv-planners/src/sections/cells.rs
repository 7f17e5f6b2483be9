//! The grid map of the sections (LFHH section III-B): cells that are free or blocked.

use auv_world::World;

use super::Frame;

/// At least this many cells across each edge of a section, so that a shallow sea has layers, too.
const FEWEST: usize = 20;

/// Free and blocked cells on every section. A cell is blocked if its centre lies below the sea floor or
/// inside a solid.
#[derive(Debug, Clone)]
pub struct CellMap {
    sections: usize,
    across: usize,
    down: usize,
    low: [f64; 2],
    edge: [f64; 2],
    /// Cells to a metre.
    density: [f64; 2],
    blocked: Vec<bool>,
    /// For each pair of neighbouring sections the number of blocked cells in both with smaller indices
    /// (a summed-area table), to clear a whole rectangle at once.
    pairs: Vec<u32>,
}

impl CellMap {
    /// Maps the world as it is now.
    pub fn new(world: &World, frame: &Frame) -> Self {
        let scenario = world.scenario();
        let sections = frame.count();
        let edge = scenario.sections.as_ref().map_or(frame.spacing_m(), |sections| sections.cell_m);
        let bounds = (0..sections).map(|section| frame.lateral_bounds(section));
        let (low, high) =
            bounds.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), [a, b]| (low.min(a), high.max(b)));
        let [top, bottom] = frame.depth_bounds();
        let cells = |width: f64| ((width / edge).ceil() as usize).clamp(FEWEST, 1 << 10);
        let across = cells(high - low);
        let down = if scenario.dimensions == 2 { 1 } else { cells(bottom - top) };
        let edge = [(high - low) / across as f64, (bottom - top) / down as f64];
        let density = edge.map(|edge| if edge > 0.0 { 1.0 / edge } else { 0.0 });
        let blocked = vec![false; sections * across * down];
        let mut map = Self { sections, across, down, low: [low, top], edge, density, blocked, pairs: Vec::new() };
        for section in 0..sections {
            map.mark_floor(world, frame, section);
            map.mark_round(world, frame, section);
        }
        if world.has_other_solids() {
            map.mark_others(world, frame);
        }
        map.sum_pairs();
        map
    }

    fn index(&self, section: usize, across: usize, down: usize) -> usize {
        (section * self.down + down) * self.across + across
    }

    /// Lateral place and depth of a cell's centre (m). Where there is no depth, the depth itself.
    fn centre(&self, across: usize, down: usize) -> [f64; 2] {
        let [lateral, depth] = self.low;
        [lateral + (across as f64 + 0.5) * self.edge[0], depth + (down as f64 + 0.5) * self.edge[1]]
    }

    fn mark_floor(&mut self, world: &World, frame: &Frame, section: usize) {
        for across in 0..self.across {
            let [x, y, _] = frame.point(section, self.centre(across, 0)[0], 0.0);
            let floor = world.floor_depth(x, y);
            for down in 0..self.down {
                let cell = self.index(section, across, down);
                self.blocked[cell] |= self.centre(across, down)[1] > floor;
            }
        }
    }

    /// Marks the circles in which spheres and discs cut a section.
    fn mark_round(&mut self, world: &World, frame: &Frame, section: usize) {
        let (spheres, discs) = (world.spheres(), world.discs());
        let balls = (0..spheres.len()).map(|i| spheres.get(i)).map(|(c, r)| ([c[0], c[1]], Some(c[2]), r));
        let columns = (0..discs.len()).map(|i| discs.get(i)).map(|(c, r)| (c, None, r));
        for ([x, y], depth, radius) in balls.chain(columns) {
            let away = (frame.section(x, y) - section as f64) * frame.spacing_m();
            let circle2 = radius * radius - away * away;
            if circle2 <= 0.0 {
                continue;
            }
            let lateral = frame.lateral(x, y);
            let reach = circle2.sqrt();
            let first = self.across_of(lateral - reach);
            let last = self.across_of(lateral + reach);
            for down in 0..self.down {
                for across in first..=last {
                    let centre = self.centre(across, down);
                    let (side, height) = (centre[0] - lateral, depth.map_or(0.0, |depth| centre[1] - depth));
                    let cell = self.index(section, across, down);
                    self.blocked[cell] |= side * side + height * height < circle2;
                }
            }
        }
    }

    fn mark_others(&mut self, world: &World, frame: &Frame) {
        for section in 0..self.sections {
            for down in 0..self.down {
                for across in 0..self.across {
                    let cell = self.index(section, across, down);
                    let [lateral, depth] = self.centre(across, down);
                    self.blocked[cell] =
                        self.blocked[cell] || world.clearance(frame.point(section, lateral, depth)) <= 0.0;
                }
            }
        }
    }

    fn sum_pairs(&mut self) {
        let (width, height) = (self.across + 1, self.down + 1);
        self.pairs = vec![0; self.sections.saturating_sub(1) * width * height];
        for (pair, table) in self.pairs.chunks_exact_mut(width * height).enumerate() {
            for down in 0..self.down {
                let mut row = 0;
                for across in 0..self.across {
                    for section in [pair, pair + 1] {
                        row += u32::from(self.blocked[(section * self.down + down) * self.across + across]);
                    }
                    table[(down + 1) * width + across + 1] = table[down * width + across + 1] + row;
                }
            }
        }
    }

    /// Number of cells across and down each section.
    pub fn shape(&self) -> [usize; 2] {
        [self.across, self.down]
    }

    /// Whether a cell is blocked.
    #[inline]
    pub fn is_blocked(&self, section: usize, across: usize, down: usize) -> bool {
        self.blocked[self.index(section, across, down)]
    }

    /// Part of the cells that are blocked.
    pub fn blocked_fraction(&self) -> f64 {
        self.blocked.iter().filter(|blocked| **blocked).count() as f64 / self.blocked.len() as f64
    }

    /// The column of a lateral place (m), the nearest one if it lies outside.
    #[inline]
    pub fn across_of(&self, lateral: f64) -> usize {
        clamp((lateral - self.low[0]) * self.density[0], self.across)
    }

    /// The row of a depth (m), the nearest one if it lies outside.
    #[inline]
    pub fn down_of(&self, depth: f64) -> usize {
        clamp((depth - self.low[1]) * self.density[1], self.down)
    }

    /// A place in units of cells.
    #[inline]
    pub fn scale(&self, lateral: f64, depth: f64) -> [f64; 2] {
        [(lateral - self.low[0]) * self.density[0], (depth - self.low[1]) * self.density[1]]
    }

    /// Whether a place given in sections and cells lies in a blocked cell of the nearest section.
    #[inline]
    pub fn is_blocked_at(&self, section: f64, across: f64, down: f64) -> bool {
        let section = clamp(section + 0.5, self.sections);
        self.is_blocked(section, clamp(across, self.across), clamp(down, self.down))
    }

    /// Whether any cell is free in a rectangle, columns and rows inclusive.
    #[inline]
    pub fn has_free(&self, section: usize, columns: [usize; 2], rows: [usize; 2]) -> bool {
        (rows[0]..=rows[1]).any(|row| {
            let first = self.index(section, 0, row);
            self.blocked[first + columns[0]..=first + columns[1]].contains(&false)
        })
    }

    /// The first of two neighbouring sections to which all places from `low` to `high` are nearest, if
    /// there are two such.
    #[inline]
    pub fn pair(&self, low: f64, high: f64) -> Option<usize> {
        let (first, last) = (clamp(low + 0.5, self.sections), clamp(high + 0.5, self.sections));
        (last == first + 1).then_some(first)
    }

    /// Whether a rectangle of cells, corners given in units of cells, is free on two neighbouring
    /// sections, the first being `section`.
    #[inline]
    pub fn is_free_pair(&self, section: usize, from: [f64; 2], to: [f64; 2]) -> bool {
        let width = self.across + 1;
        let table = &self.pairs[section * width * (self.down + 1)..][..width * (self.down + 1)];
        let (a, b) = (clamp(from[0], self.across), clamp(to[0], self.across));
        let (left, right) = (a.min(b), a.max(b) + 1);
        let (a, b) = (clamp(from[1], self.down), clamp(to[1], self.down));
        let (top, bottom) = (a.min(b) * width, (a.max(b) + 1) * width);
        table[bottom + right] + table[top + left] == table[top + right] + table[bottom + left]
    }
}

/// The cell that holds `place`, the nearest one if it lies outside (or is not a number).
#[inline(always)]
fn clamp(place: f64, count: usize) -> usize {
    // Through i32, which one machine instruction makes.
    (place as i32).clamp(0, count as i32 - 1) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn cells_agree_with_the_clearance_of_their_centres() {
        for world in [
            testing::paper_world("lfhh-3d-1", 0),
            testing::paper_world("lfhh-2d-1", 0),
            testing::mission_frame_world(),
            testing::other_solids_world(),
        ] {
            let frame = Frame::new(&world);
            let map = CellMap::new(&world, &frame);
            let [across, down] = map.shape();
            for section in 0..frame.count() {
                for (i, k) in (0..across).flat_map(|i| (0..down).map(move |k| (i, k))) {
                    let [lateral, depth] = map.centre(i, k);
                    let clearance = world.clearance(frame.point(section, lateral, depth));
                    if clearance.abs() > 1e-6 {
                        assert_eq!(map.is_blocked(section, i, k), clearance < 0.0, "{section} {i} {k}");
                    }
                }
            }
        }
    }

    #[test]
    fn shipped_maps_are_as_dense_as_the_readings_say() {
        let map = |name| {
            let world = testing::paper_world(name, 0);
            CellMap::new(&world, &Frame::new(&world))
        };
        for name in ["lfhh-3d-1", "lfhh-3d-2", "lfhh-3d-3"] {
            let fraction = map(name).blocked_fraction();
            assert!((0.25..0.37).contains(&fraction), "{name}: {fraction}");
        }
    }

    #[test]
    fn free_rectangles_are_free() {
        let world = testing::paper_world("lfhh-3d-1", 0);
        let map = CellMap::new(&world, &Frame::new(&world));
        for section in 0..39 {
            for (i, k) in (0..18).flat_map(|i| (0..18).map(move |k| (i, k))) {
                let cells = (i..i + 3).flat_map(|a| (k..k + 2).map(move |b| (a, b)));
                let free = cells
                    .into_iter()
                    .all(|(a, b)| !map.is_blocked(section, a, b) && !map.is_blocked(section + 1, a, b));
                let (from, to) = ([i as f64 + 2.3, k as f64 + 0.2], [i as f64 + 0.9, k as f64 + 1.6]);
                assert_eq!(map.is_free_pair(section, from, to), free);
            }
        }
    }
}
