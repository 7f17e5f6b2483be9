//! Which segments of a path collide (LFHH eq. 9), in several readings.

use auv_world::World;
use auv_world::math::{Vec2, Vec3};

use super::options::{Collision, Cost, CostOptions};
use super::track::Track;
use crate::sections::{CellMap, Frame, nearest};

/// Points of a segment that are looked up in the cell map, at 1/8, 2/8, ... 8/8 of its way.
const SAMPLES: usize = 8;
/// A walk along a segment takes no shorter steps than this part of its length.
const SHORTEST_STEP: f64 = 1e-3;
/// Start and goal need only this part of the clearance that they have.
const OWN_CLEARANCE: f64 = 0.9;

/// A collision test, prepared for a world as it is now.
#[derive(Debug, Clone)]
pub enum Test {
    /// Exact distance from segments to discs, 2-D.
    Discs(Strips),
    /// A walk along the segments by the world's clearance.
    Walk {
        /// The world.
        world: Box<World>,
        /// Clearance to keep (m).
        margin: f64,
    },
    /// Points looked up in the cell map.
    Cells {
        /// Where the sections lie.
        frame: Frame,
        /// Which cells are blocked.
        map: CellMap,
        /// Only the end point of each segment.
        ends_only: bool,
        /// The waypoints of the path under test.
        places: Places,
    },
}

impl Test {
    /// Prepares the test that the options ask for; of `path` alone, if there is one.
    pub fn new(world: &World, cost: Cost, options: &CostOptions, path: Option<&[Vec3]>) -> Self {
        let collision = options.collision_in(cost, world.scenario());
        if collision != Collision::Segment {
            let frame = Frame::new(world);
            let map = match path {
                Some(path) => CellMap::of_path(world, &frame, path),
                None => CellMap::new(world, &frame),
            };
            let places = Places::new(&frame);
            return Self::Cells { frame, map, ends_only: collision == Collision::Waypoints, places };
        }
        let flat = world.scenario().dimensions == 2 && !world.has_other_solids() && world.spheres().is_empty();
        if flat && matches!(world.floor(), auv_world::seabed::Floor::None) {
            return Self::Discs(Strips::new(world, options.margin_m));
        }
        Self::Walk { world: Box::new(world.clone()), margin: options.margin_m }
    }

    /// The cell map, if this test has one.
    pub fn cells(&self) -> Option<(&Frame, &CellMap)> {
        match self {
            Self::Cells { frame, map, .. } => Some((frame, map)),
            _ => None,
        }
    }

    /// Number of segments that collide.
    #[inline]
    pub fn blocked(&mut self, track: &Track) -> usize {
        match self {
            Self::Discs(strips) => strips.blocked(track),
            Self::Walk { world, margin } => {
                let rooms = ends(track).map(|point| OWN_CLEARANCE * world.clearance(point));
                let blocked = |i: &usize| {
                    let room = room(rooms, *i, track.segments());
                    let step = [track.dx[*i], track.dy[*i], track.dz[*i]];
                    walk(world, track.point(*i), step, track.length[*i], *margin, room)
                };
                (0..track.segments()).filter(blocked).count()
            }
            Self::Cells { frame, map, ends_only, places } => {
                places.locate(track, frame, map);
                if *ends_only {
                    (0..track.segments()).filter(|i| places.end_blocked(map, *i)).count()
                } else {
                    (0..track.segments()).filter(|i| places.samples_blocked(map, *i)).count()
                }
            }
        }
    }
}

impl Test {
    /// What start and goal of a path have of clearance, as far as it is asked of its first and last segment (m).
    pub fn rooms(&self, ends: [Vec3; 2]) -> [f64; 2] {
        match self {
            Self::Discs(strips) => strips.rooms(ends),
            Self::Walk { world, .. } => ends.map(|point| OWN_CLEARANCE * world.clearance(point)),
            Self::Cells { .. } => [f64::INFINITY; 2],
        }
    }

    /// Whether a single segment collides, as [`Test::blocked`] judges it in a path: `room` is the least of
    /// what the path's ends have that are its own, or infinite.
    pub fn blocks(&self, from: Vec3, to: Vec3, room: f64) -> bool {
        let step: Vec3 = std::array::from_fn(|axis| to[axis] - from[axis]);
        match self {
            Self::Discs(strips) => {
                let span = [from, to].map(|point| strips.span_of(point[0], point[1]));
                strips.hit(span, from, step, strips.margin.min(room))
            }
            Self::Walk { world, margin } => {
                let length = (step[0] * step[0] + step[1] * step[1] + step[2] * step[2]).sqrt();
                walk(world, from, step, length, *margin, room)
            }
            Self::Cells { frame, map, ends_only, .. } => {
                let [from, to] = [from, to].map(|[x, y, z]| {
                    [map.scale_section(frame.section(x, y)), map.scale_lateral(frame.lateral(x, y)), map.scale_depth(z)]
                });
                let cells = [from, to].map(|place| map.cell(place));
                if *ends_only { map.is_blocked_cell(cells[1]) } else { samples_blocked(map, [from, to], cells) }
            }
        }
    }
}

fn ends(track: &Track) -> [Vec3; 2] {
    [track.point(0), track.point(track.segments())]
}

/// The clearance beyond which nothing is asked of segment `i`: at the ends of the path no more than they can
/// have; a vehicle that already is too near may leave.
#[inline]
fn room(rooms: [f64; 2], i: usize, segments: usize) -> f64 {
    let at_start = if i == 0 { rooms[0] } else { f64::INFINITY };
    if i + 1 == segments { at_start.min(rooms[1]) } else { at_start }
}

/// Whether a segment comes nearer to a solid than `margin`, or than `room` if that is less, walking by
/// clearances.
fn walk(world: &World, from: Vec3, step: Vec3, length: f64, margin: f64, room: f64) -> bool {
    let shortest = SHORTEST_STEP * length;
    let required = (margin + 0.5 * shortest).min(room);
    let mut walked = 0.0;
    loop {
        let part = if walked < length { walked / length } else { 1.0 };
        let free = world.clearance(std::array::from_fn(|axis| from[axis] + part * step[axis])) - required;
        if free <= 0.0 {
            return true;
        }
        if walked >= length {
            return false;
        }
        walked = (walked + free.max(shortest)).min(length);
    }
}

/// Where the waypoints of the last path lay along the way. Planners on sections move waypoints across it
/// only, so that what follows from this alone holds for the next path.
#[derive(Debug, Clone)]
struct Along {
    /// Whether the way runs along y, so that y alone decides.
    along_y: bool,
    y: Vec<f64>,
}

impl Along {
    fn new(frame: &Frame) -> Self {
        Self { along_y: frame.along() == [0.0, 1.0], y: Vec::new() }
    }

    /// Whether any waypoint lies elsewhere along the way than at the last call.
    #[inline]
    fn moved(&mut self, track: &Track) -> bool {
        let y = &track.y[..track.points()];
        // Bit by bit, without an early end: several lanes at once.
        let differ = || self.y.iter().zip(y).fold(false, |differ, (a, b)| differ | (a.to_bits() != b.to_bits()));
        let moved = !self.along_y || self.y.len() != y.len() || differ();
        if moved {
            self.y.clear();
            self.y.extend_from_slice(y);
        }
        moved
    }
}

/// The waypoints in the cell map.
#[derive(Debug, Clone)]
pub struct Places {
    along: Along,
    /// Scaled as the map scales them: sections, columns, rows.
    scaled: [Vec<f64>; 3],
    /// The same as whole numbers.
    cells: [Vec<u32>; 3],
}

impl Places {
    fn new(frame: &Frame) -> Self {
        Self { along: Along::new(frame), scaled: Default::default(), cells: Default::default() }
    }

    #[inline]
    fn locate(&mut self, track: &Track, frame: &Frame, map: &CellMap) {
        let n = track.points();
        let (x, y, z) = (&track.x[..n], &track.y[..n], &track.z[..n]);
        if self.along.moved(track) {
            self.scaled.iter_mut().for_each(|scaled| scaled.resize(n, 0.0));
            self.cells.iter_mut().for_each(|cells| cells.resize(n, 0));
            for (section, (x, y)) in self.scaled[0].iter_mut().zip(x.iter().zip(y)) {
                *section = map.scale_section(frame.section(*x, *y));
            }
            map.cells(0, &self.scaled[0], &mut self.cells[0]);
        }
        for (across, (x, y)) in self.scaled[1].iter_mut().zip(x.iter().zip(y)) {
            *across = map.scale_lateral(frame.lateral(*x, *y));
        }
        for (down, z) in self.scaled[2].iter_mut().zip(z) {
            *down = map.scale_depth(*z);
        }
        for axis in [1, 2] {
            map.cells(axis, &self.scaled[axis], &mut self.cells[axis]);
        }
    }

    #[inline(always)]
    fn at(&self, i: usize) -> [f64; 3] {
        let [section, across, down] = &self.scaled;
        [section[i], across[i], down[i]]
    }

    #[inline(always)]
    fn cell(&self, i: usize) -> [u32; 3] {
        let [section, across, down] = &self.cells;
        [section[i], across[i], down[i]]
    }

    #[inline]
    fn end_blocked(&self, map: &CellMap, i: usize) -> bool {
        map.is_blocked_cell(self.cell(i + 1))
    }

    #[inline]
    fn samples_blocked(&self, map: &CellMap, i: usize) -> bool {
        samples_blocked(map, [self.at(i), self.at(i + 1)], [self.cell(i), self.cell(i + 1)])
    }
}

/// Whether any sample of a segment lies in a blocked cell, from its scaled ends and their cells.
#[inline(always)]
fn samples_blocked(map: &CellMap, [from, to]: [[f64; 3]; 2], cells: [[u32; 3]; 2]) -> bool {
    // From one section to the next all samples lie in one rectangle of cells, which may be free.
    if map.is_free_between(cells[0], cells[1]) {
        return false;
    }
    let step = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
    let mut samples = [[0.0; 3]; SAMPLES];
    for (k, sample) in samples.iter_mut().enumerate() {
        let part = (k + 1) as f64 / SAMPLES as f64;
        *sample = [from[0] + part * step[0], from[1] + part * step[1], from[2] + part * step[2]];
    }
    map.any_blocked(samples)
}

/// Discs, listed for each strip between two sections that they reach into.
#[derive(Debug, Clone)]
pub struct Strips {
    frame: Frame,
    margin: f64,
    discs: Vec<Disc>,
    first: Vec<u32>,
    /// First and last strip of each waypoint of the path under test.
    span: Vec<[u32; 2]>,
    along: Along,
}

#[derive(Debug, Clone, Copy)]
struct Disc {
    centre: Vec2,
    radius: f64,
}

/// Strips overlap by this much on both sides, in sections, so that rounding loses no disc.
const OVERLAP: f64 = 1e-6;

impl Strips {
    fn new(world: &World, margin: f64) -> Self {
        let frame = Frame::new(world);
        let strips = frame.count() - 1;
        let all = (0..world.discs().len()).map(|i| world.discs().get(i));
        let all: Vec<Disc> = all.map(|(centre, radius)| Disc { centre, radius }).collect();
        let (mut discs, mut first) = (Vec::new(), vec![0]);
        for strip in 0..strips {
            discs.extend(all.iter().filter(|disc| {
                let section = frame.section(disc.centre[0], disc.centre[1]);
                let reach = (disc.radius + margin) / frame.spacing_m() + 2.0 * OVERLAP;
                (strip_of(section - reach, strips)..=strip_of(section + reach, strips)).contains(&strip)
            }));
            first.push(discs.len() as u32);
        }
        Self { along: Along::new(&frame), frame, margin, discs, first, span: Vec::new() }
    }

    fn strips(&self) -> usize {
        self.first.len() - 1
    }

    fn clearance(&self, point: Vec3) -> f64 {
        let distance = |disc: &Disc| {
            let (dx, dy) = (point[0] - disc.centre[0], point[1] - disc.centre[1]);
            (dx * dx + dy * dy).sqrt() - disc.radius
        };
        self.discs.iter().map(distance).fold(f64::INFINITY, f64::min)
    }

    fn rooms(&self, ends: [Vec3; 2]) -> [f64; 2] {
        if self.margin > 0.0 { ends.map(|point| OWN_CLEARANCE * self.clearance(point)) } else { [f64::INFINITY; 2] }
    }

    /// First and last strip of a waypoint.
    #[inline]
    fn span_of(&self, x: f64, y: f64) -> [u32; 2] {
        let section = self.frame.section(x, y);
        [OVERLAP, -OVERLAP].map(|overlap| strip_of(section + overlap, self.strips()) as u32)
    }

    #[inline]
    fn blocked(&mut self, track: &Track) -> usize {
        if self.along.moved(track) {
            self.span.resize(track.points(), [0; 2]);
            for i in 0..track.points() {
                self.span[i] = self.span_of(track.x[i], track.y[i]);
            }
        }
        let segments = track.segments();
        let rooms = self.rooms(ends(track));
        let blocked = |i: &usize| {
            let i = *i;
            let step = [track.dx[i], track.dy[i], 0.0];
            let required = self.margin.min(room(rooms, i, segments));
            self.hit([self.span[i], self.span[i + 1]], track.point(i), step, required)
        };
        (0..segments).filter(blocked).count()
    }

    /// Whether a segment comes nearer to a disc than `required`.
    #[inline(always)]
    fn hit(&self, [from, to]: [[u32; 2]; 2], [x, y, _]: Vec3, [dx, dy, _]: Vec3, required: f64) -> bool {
        let first = from[0].min(to[0]);
        let last = from[1].max(to[1]).max(first);
        let discs = &self.discs[self.first[first as usize] as usize..self.first[last as usize + 1] as usize];
        let square = dx * dx + dy * dy;
        // Without branches or divisions: the disc's centre is near the start, near the end, or beside the
        // segment and near its line.
        discs.iter().fold(false, |hit, disc| {
            let (cx, cy) = (disc.centre[0] - x, disc.centre[1] - y);
            let reach = (disc.radius + required).max(0.0);
            let reach2 = reach * reach;
            let (along, across) = (cx * dx + cy * dy, cx * dy - cy * dx);
            let from_start = cx * cx + cy * cy;
            let from_end = from_start - 2.0 * along + square;
            let beside = (along > 0.0) & (along < square) & (across * across < reach2 * square);
            hit | (from_start < reach2) | (from_end < reach2) | beside
        })
    }
}

/// The strip that holds a place, the nearest one if it lies outside.
#[inline(always)]
fn strip_of(section: f64, strips: usize) -> usize {
    nearest(section, strips)
}
