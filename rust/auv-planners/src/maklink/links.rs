//! Free links (Habib and Asama 1991): lines between corners of different zones, or from a corner straight to
//! a wall, that cut the free water into convex cells.
//!
//! Shortest first over the whole map: a line becomes a link if it splits a gap of more than half a turn at
//! one of its corners, enters no zone, and crosses no link. Then the longest that are not needed go.

use std::f64::consts::{PI, TAU};

use auv_world::math::Vec2;
use robust::{Coord, orient2d};

use super::area::Area;
use super::error::MapError;
use super::zone::Zone;

/// Gaps up to this beyond half a turn are straight (rad).
const STRAIGHT: f64 = 1e-7;
/// A link keeps this from the lines that bound the gap it splits (rad).
const INSIDE: f64 = 1e-6;
/// Shorter links are none (m).
const SHORTEST: f64 = 1e-9;

/// A free link.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Link {
    /// From where to where (m).
    pub ends: [Vec2; 2],
    /// Its length (m).
    pub length: f64,
}

impl Link {
    /// The point so many metres from the first end, which may lie beyond the link.
    #[inline]
    pub fn at(&self, along: f64) -> Vec2 {
        let part = along / self.length;
        let [a, b] = self.ends;
        [a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])]
    }

    /// The point in the middle (m).
    pub fn middle(&self) -> Vec2 {
        let [a, b] = self.ends;
        [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
    }
}

/// A corner of a zone and the free water round it.
struct Corner {
    point: Vec2,
    zone: usize,
    /// Direction of the edge to the corner before (rad); the free water runs counter-clockwise from it ...
    first: f64,
    /// ... so far (rad).
    fan: f64,
    /// Where links leave (rad from `first`), ascending.
    links: Vec<f64>,
    /// The gap of more than half a turn, if there is one: there is never more than one.
    reflex: Option<[f64; 2]>,
}

impl Corner {
    fn new(zone: usize, [before, point, after]: [Vec2; 3], area: &Area) -> Self {
        let first = direction(point, before);
        let fan = (direction(point, after) - first).rem_euclid(TAU);
        let mut corner = Self { point, zone, first, fan, links: Vec::new(), reflex: None };
        // At a wall the wall itself splits the gap.
        corner.reflex = (!area.on_wall(point)).then_some([0.0, fan]).filter(is_reflex);
        corner
    }

    fn angle_to(&self, point: Vec2) -> f64 {
        (direction(self.point, point) - self.first).rem_euclid(TAU)
    }

    /// Whether a line to that point would split the reflex gap.
    fn gains(&self, point: Vec2) -> bool {
        self.reflex.is_some_and(|[from, to]| {
            let angle = self.angle_to(point);
            from + INSIDE < angle && angle < to - INSIDE
        })
    }

    fn add(&mut self, point: Vec2) {
        let angle = self.angle_to(point);
        let place = self.links.partition_point(|other| *other < angle);
        self.links.insert(place, angle);
        if let Some([from, to]) = self.reflex
            && from < angle
            && angle < to
        {
            self.reflex = [[from, angle], [angle, to]].into_iter().find(is_reflex);
        }
    }

    /// Whether no reflex gap opens without that link.
    fn may_remove(&self, point: Vec2, area: &Area) -> bool {
        if area.on_wall(self.point) {
            return true;
        }
        let angle = self.angle_to(point);
        let place = self.links.partition_point(|other| *other < angle);
        let before = if place > 0 { self.links[place - 1] } else { 0.0 };
        let after = self.links.get(place + 1).copied().unwrap_or(self.fan);
        !is_reflex(&[before, after])
    }

    fn remove(&mut self, point: Vec2) {
        let angle = self.angle_to(point);
        let place = self.links.partition_point(|other| *other < angle);
        self.links.remove(place);
    }
}

fn is_reflex(gap: &[f64; 2]) -> bool {
    gap[1] - gap[0] > PI + STRAIGHT
}

/// A line that may become a link: from a corner to another or, without one, to a wall.
struct Candidate {
    square: f64,
    from: u32,
    to: u32,
}

/// The free links of zones in an area, shortest first.
///
/// # Errors
/// [`MapError::Degenerate`] if a corner keeps a reflex gap.
pub fn links(area: &Area, zones: &[Zone]) -> Result<Vec<Link>, MapError> {
    let mut corners = corners(area, zones);
    let mut accepted: Vec<(Candidate, Link)> = Vec::new();
    let mut open = corners.iter().filter(|corner| corner.reflex.is_some()).count();
    // Rings of growing length, so that only what is short gets sorted.
    let diagonal = area.diagonal();
    let (mut low, mut high) = (SHORTEST, diagonal / (corners.len().max(1) as f64).sqrt());
    while open > 0 && low < diagonal {
        for candidate in candidates(area, &corners, low, high) {
            let (from, to) = (candidate.from as usize, candidate.to as usize);
            let ends = [corners[from].point, end(area, &corners, from, to)];
            let other = (to < corners.len()).then_some(to);
            let gains = corners[from].gains(ends[1]) || other.is_some_and(|to| corners[to].gains(ends[0]));
            if !gains
                || zones.iter().any(|zone| zone.meets(ends[0], ends[1]))
                || accepted.iter().any(|(_, link)| cross(link.ends, ends))
            {
                continue;
            }
            for (corner, seen) in [(Some(from), ends[1]), (other, ends[0])] {
                let Some(corner) = corner.map(|i| &mut corners[i]) else { continue };
                let was_open = corner.reflex.is_some();
                corner.add(seen);
                open -= usize::from(was_open && corner.reflex.is_none());
            }
            let length = candidate.square.sqrt();
            accepted.push((candidate, Link { ends, length }));
            if open == 0 {
                break;
            }
        }
        (low, high) = (high, 2.0 * high);
    }
    if let Some(corner) = corners.iter().find(|corner| corner.reflex.is_some()) {
        return Err(MapError::Degenerate { point: corner.point, reason: "a corner keeps more than half a turn" });
    }
    Ok(prune(area, &mut corners, accepted))
}

fn corners(area: &Area, zones: &[Zone]) -> Vec<Corner> {
    let all = zones.iter().enumerate().flat_map(|(zone, shape)| {
        let ring = shape.corners();
        let n = ring.len();
        (0..n).map(move |i| Corner::new(zone, [ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]], area))
    });
    all.collect()
}

/// Where a candidate ends: numbers from that of corners on are walls.
fn end(area: &Area, corners: &[Corner], from: usize, to: usize) -> Vec2 {
    match corners.get(to) {
        Some(corner) => corner.point,
        None => area.feet(corners[from].point)[to - corners.len()],
    }
}

/// Lines that could still gain something, of a length between `low` and `high` (m), shortest first; in the
/// order of the corners where they are equally long.
fn candidates(area: &Area, corners: &[Corner], low: f64, high: f64) -> Vec<Candidate> {
    let (low, high) = (low * low, high * high);
    let mut found = Vec::new();
    for (from, corner) in corners.iter().enumerate() {
        let open = corner.reflex.is_some();
        let others = (from + 1..corners.len())
            .filter(|&to| corners[to].zone != corner.zone && (open || corners[to].reflex.is_some()));
        let walls = if open { corners.len()..corners.len() + 4 } else { 0..0 };
        for to in others.chain(walls) {
            let point = end(area, corners, from, to);
            let [dx, dy] = [point[0] - corner.point[0], point[1] - corner.point[1]];
            let square = dx * dx + dy * dy;
            if (low..high).contains(&square) {
                found.push(Candidate { square, from: from as u32, to: to as u32 });
            }
        }
    }
    found.sort_unstable_by(|a, b| a.square.total_cmp(&b.square).then((a.from, a.to).cmp(&(b.from, b.to))));
    found
}

/// Leaves out links, longest first, where no reflex gap opens.
fn prune(area: &Area, corners: &mut [Corner], accepted: Vec<(Candidate, Link)>) -> Vec<Link> {
    let mut kept = Vec::with_capacity(accepted.len());
    for (candidate, link) in accepted.into_iter().rev() {
        let (from, to) = (candidate.from as usize, candidate.to as usize);
        let needed = !corners[from].may_remove(link.ends[1], area)
            || corners.get(to).is_some_and(|corner| !corner.may_remove(link.ends[0], area));
        if needed {
            kept.push(link);
            continue;
        }
        corners[from].remove(link.ends[1]);
        if let Some(corner) = corners.get_mut(to) {
            corner.remove(link.ends[0]);
        }
    }
    kept.reverse();
    kept
}

fn direction(from: Vec2, to: Vec2) -> f64 {
    libm::atan2(to[1] - from[1], to[0] - from[0])
}

/// Twice the area of a triangle, positive if it turns left, with the right sign always.
#[inline]
pub fn turn(a: Vec2, b: Vec2, c: Vec2) -> f64 {
    let [a, b, c] = [a, b, c].map(|p| Coord { x: p[0], y: p[1] });
    orient2d(a, b, c)
}

/// Whether two segments share more than an end of both.
fn cross([a, b]: [Vec2; 2], [c, d]: [Vec2; 2]) -> bool {
    if (0..2).any(|k| a[k].max(b[k]) < c[k].min(d[k]) || c[k].max(d[k]) < a[k].min(b[k])) {
        return false;
    }
    let (t1, t2, t3, t4) = (turn(a, b, c), turn(a, b, d), turn(c, d, a), turn(c, d, b));
    if t1 == 0.0 && t2 == 0.0 {
        // On one line: they overlap unless they only meet end to end.
        let axis = usize::from((b[1] - a[1]).abs() > (b[0] - a[0]).abs());
        let from = a[axis].min(b[axis]).max(c[axis].min(d[axis]));
        let to = a[axis].max(b[axis]).min(c[axis].max(d[axis]));
        return from < to;
    }
    if [c, d].contains(&a) || [c, d].contains(&b) {
        return false;
    }
    t1 * t2 <= 0.0 && t3 * t4 <= 0.0
}
