//! The grid map of the sections (LFHH section III-B): cells that are free or blocked.

use std::ops::RangeInclusive;

use auv_world::World;
use auv_world::math::Vec3;

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
        Self::of_sections(world, frame, 0..=frame.count() - 1)
    }

    /// The sections that a path passes, the nearest ones where it leaves them: all that judging it asks for.
    pub fn of_path(world: &World, frame: &Frame, path: &[Vec3]) -> Self {
        let (first, last) = path.iter().fold((frame.count() - 1, 0), |(first, last), [x, y, _]| {
            let section = nearest(frame.section(*x, *y) + 0.5, frame.count());
            (first.min(section), last.max(section))
        });
        Self::of_sections(world, frame, first..=last)
    }

    /// Maps these sections; all others stay free.
    fn of_sections(world: &World, frame: &Frame, mapped: RangeInclusive<usize>) -> Self {
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
        for section in mapped.clone() {
            map.mark_floor(world, frame, section);
            map.mark_round(world, frame, section);
            if world.has_other_solids() {
                map.mark_others(world, frame, section);
            }
        }
        map.sum_pairs(mapped);
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

    fn mark_others(&mut self, world: &World, frame: &Frame, section: usize) {
        for down in 0..self.down {
            for across in 0..self.across {
                let cell = self.index(section, across, down);
                let [lateral, depth] = self.centre(across, down);
                self.blocked[cell] = self.blocked[cell] || world.clearance(frame.point(section, lateral, depth)) <= 0.0;
            }
        }
    }

    fn sum_pairs(&mut self, mapped: RangeInclusive<usize>) {
        let (width, height) = (self.across + 1, self.down + 1);
        self.pairs = vec![0; self.sections.saturating_sub(1) * width * height];
        let tables = self.pairs.chunks_exact_mut(width * height).enumerate();
        for (pair, table) in tables.take(*mapped.end()).skip(*mapped.start()) {
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

    /// Whether any cell is free in a rectangle, columns and rows inclusive.
    #[inline]
    pub fn has_free(&self, section: usize, columns: [usize; 2], rows: [usize; 2]) -> bool {
        (rows[0]..=rows[1]).any(|row| {
            let first = self.index(section, 0, row);
            self.blocked[first + columns[0]..=first + columns[1]].contains(&false)
        })
    }

    /// The column of a lateral place (m), the nearest one if it lies outside.
    #[inline]
    pub fn across_of(&self, lateral: f64) -> usize {
        nearest(self.scale_lateral(lateral), self.across)
    }

    /// The row of a depth (m), the nearest one if it lies outside.
    #[inline]
    pub fn down_of(&self, depth: f64) -> usize {
        nearest(self.scale_depth(depth), self.down)
    }

    /// A place along the way, in sections, shifted so that its whole part numbers sections.
    #[inline(always)]
    pub fn scale_section(&self, section: f64) -> f64 {
        section + 0.5
    }

    /// A lateral place (m), shifted and scaled so that its whole part numbers columns.
    #[inline(always)]
    pub fn scale_lateral(&self, lateral: f64) -> f64 {
        (lateral - self.low[0]) * self.density[0]
    }

    /// A depth (m), shifted and scaled so that its whole part numbers rows.
    #[inline(always)]
    pub fn scale_depth(&self, depth: f64) -> f64 {
        (depth - self.low[1]) * self.density[1]
    }

    /// Sections (axis 0), columns (1) or rows (2) of scaled places, the nearest ones if they lie outside.
    #[inline]
    pub fn cells(&self, axis: usize, scaled: &[f64], cells: &mut [u32]) {
        let count = [self.sections, self.across, self.down][axis];
        for (cell, place) in cells.iter_mut().zip(scaled) {
            *cell = nearest(*place, count) as u32;
        }
    }

    /// Section, column and row of a scaled place, the nearest ones if it lies outside.
    #[inline]
    pub fn cell(&self, scaled: [f64; 3]) -> [u32; 3] {
        let count = [self.sections, self.across, self.down];
        std::array::from_fn(|axis| nearest(scaled[axis], count[axis]) as u32)
    }

    /// Whether a cell is blocked.
    #[inline]
    pub fn is_blocked_cell(&self, cell: [u32; 3]) -> bool {
        let [section, across, down] = cell.map(|i| i as usize);
        self.is_blocked(section, across, down)
    }

    /// Whether any of several scaled places lies in a blocked cell.
    #[inline]
    pub fn any_blocked<const N: usize>(&self, places: [[f64; 3]; N]) -> bool {
        // Numbered in floating point, where all places are worked on at once.
        let (across, down) = (self.across as f64, self.down as f64);
        let mut index = [0; N];
        for (index, place) in index.iter_mut().zip(&places) {
            let row = floor(place[0], self.sections) * down + floor(place[2], self.down);
            *index = whole(row * across + floor(place[1], self.across));
        }
        index.iter().any(|index| self.blocked[*index])
    }

    /// Whether the rectangle between two cells on neighbouring sections is free on both; `false` for cells
    /// that are not on neighbouring sections.
    #[inline]
    pub fn is_free_between(&self, from: [u32; 3], to: [u32; 3]) -> bool {
        let pair = from[0].min(to[0]);
        if from[0].max(to[0]) != pair + 1 {
            return false;
        }
        let width = self.across + 1;
        let table = &self.pairs[pair as usize * width * (self.down + 1)..][..width * (self.down + 1)];
        let (left, right) = (from[1].min(to[1]) as usize, from[1].max(to[1]) as usize + 1);
        let (top, bottom) = (from[2].min(to[2]) as usize * width, (from[2].max(to[2]) as usize + 1) * width);
        table[bottom + right] + table[top + left] == table[top + right] + table[bottom + left]
    }
}

/// The whole part of `place`, the nearest of 0 .. count - 1 if it lies outside.
#[inline(always)]
fn floor(place: f64, count: usize) -> f64 {
    let last = (count - 1) as f64;
    let place = if place > 0.0 { place } else { 0.0 };
    let place = if place < last { place } else { last };
    place.floor()
}

/// A whole number below 2^32 as an integer: adding 2^52 leaves it in the low bits, without the checks that
/// a cast makes.
#[inline(always)]
fn whole(number: f64) -> usize {
    (number + 4_503_599_627_370_496.0).to_bits() as u32 as usize
}

/// The whole part of `place` as an index, the nearest of 0 .. count - 1 if it lies outside.
#[inline(always)]
pub(crate) fn nearest(place: f64, count: usize) -> usize {
    whole(floor(place, count))
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
    fn the_sections_of_a_path_are_mapped_as_all_are() {
        for world in [testing::paper_world("lfhh-3d-1", 0), testing::other_solids_world()] {
            let frame = Frame::new(&world);
            let all = CellMap::new(&world, &frame);
            let path = [frame.point(7, 0.0, 0.0), frame.point(9, 0.0, 0.0)];
            let some = CellMap::of_path(&world, &frame, &path);
            let [across, down] = all.shape();
            let cells = (0..down).flat_map(|k| (0..across).map(move |i| [i, k]));
            for [i, k] in cells {
                for section in 0..frame.count() {
                    let expected = (7..=9).contains(&section) && all.is_blocked(section, i, k);
                    assert_eq!(some.is_blocked(section, i, k), expected);
                }
                for section in [7, 8] {
                    let (from, to) = ([section, 0, 0], [section + 1, i as u32, k as u32]);
                    assert_eq!(some.is_free_between(from, to), all.is_free_between(from, to));
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
                let (from, to) =
                    ([section as u32, i as u32 + 2, k as u32], [section as u32 + 1, i as u32, k as u32 + 1]);
                assert_eq!(map.is_free_between(from, to), free);
                assert_eq!(map.is_free_between(to, from), free);
            }
        }
    }
}
