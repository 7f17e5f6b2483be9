//! Danger zones: the hulls of obstacles, made larger by the safety distance, cut off at the walls, and put
//! together where they overlap.

use auv_world::math::Vec2;
use geo::{ConvexHull, MultiPoint, Point};

use super::area::Area;
use super::error::MapError;

/// A line may enter a zone by this much (m): zones' own corners and edges do not block.
pub const SKIN: f64 = 1e-7;
/// Zones nearer to each other than this count as touching (m).
const TOUCH: f64 = 1e-6;
/// Corners nearer than this to their neighbours, or to the line between them, are left out (m).
const SAME: f64 = 1e-9;

/// The plane n . p <= h with |n| = 1.
#[derive(Debug, Clone, Copy, PartialEq)]
struct HalfPlane {
    normal: Vec2,
    height: f64,
}

impl HalfPlane {
    /// How far beyond the edge a point is (m).
    #[inline]
    fn beyond(&self, p: Vec2) -> f64 {
        self.normal[0] * p[0] + self.normal[1] * p[1] - self.height
    }
}

/// A convex danger zone.
#[derive(Debug, Clone, PartialEq)]
pub struct Zone {
    corners: Vec<Vec2>,
    edges: Vec<HalfPlane>,
    low: Vec2,
    high: Vec2,
    polygons: Vec<usize>,
}

impl Zone {
    /// The hull of points; `None` if it has no area.
    fn around(points: &[Vec2], polygons: Vec<usize>) -> Option<Self> {
        let corners = hull(points);
        if corners.len() < 3 {
            return None;
        }
        let edges = (0..corners.len()).map(|i| half_plane(corners[i], corners[(i + 1) % corners.len()])).collect();
        let bound = |pick: fn(f64, f64) -> f64| {
            corners.iter().skip(1).fold(corners[0], |best, p| [pick(best[0], p[0]), pick(best[1], p[1])])
        };
        let (low, high) = (bound(f64::min), bound(f64::max));
        Some(Self { corners, edges, low, high, polygons })
    }

    /// Corners, counter-clockwise from the one of least x (m).
    pub fn corners(&self) -> &[Vec2] {
        &self.corners
    }

    /// The polygons that it holds, by their places in the list.
    pub fn polygons(&self) -> &[usize] {
        &self.polygons
    }

    /// How deep inside a point is (m); negative outside.
    pub fn depth(&self, point: Vec2) -> f64 {
        -self.edges.iter().map(|edge| edge.beyond(point)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Whether a point is inside, its skin excepted.
    pub fn contains(&self, point: Vec2) -> bool {
        self.depth(point) > SKIN
    }

    /// Whether the segment enters it deeper than its skin.
    #[inline]
    pub fn meets(&self, a: Vec2, b: Vec2) -> bool {
        if (0..2).any(|k| a[k].max(b[k]) <= self.low[k] || a[k].min(b[k]) >= self.high[k]) {
            return false;
        }
        // The part of the segment within all half planes (Cyrus and Beck).
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for edge in &self.edges {
            let (at_a, at_b) = (edge.beyond(a) + SKIN, edge.beyond(b) + SKIN);
            if at_a >= 0.0 && at_b >= 0.0 {
                return false;
            }
            if at_a > 0.0 {
                from = from.max(at_a / (at_a - at_b));
            } else if at_b > 0.0 {
                to = to.min(at_a / (at_a - at_b));
            }
        }
        from < to
    }

    /// Whether its edge on a wall lies between two points of that wall, which runs along an axis. The edge is where the
    /// zone was cut off, and no way past it.
    pub fn bars_wall(&self, a: Vec2, b: Vec2, along: usize) -> bool {
        let on_wall = self.corners.iter().filter(|corner| corner[1 - along] == a[1 - along]);
        let reach = on_wall.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], corner| {
            [low.min(corner[along]), high.max(corner[along])]
        });
        let from = reach[0].max(a[along].min(b[along]));
        let to = reach[1].min(a[along].max(b[along]));
        to - from > SKIN
    }

    /// The nearest points of its edges to a point inside, nearest first; those at the walls lead nowhere.
    pub fn ways_out(&self, point: Vec2, area: &Area) -> Vec<Vec2> {
        let n = self.corners.len();
        let edges = (0..n).map(|i| (self.corners[i], self.corners[(i + 1) % n]));
        let inner = edges.filter(|(a, b)| !area.on_wall([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]));
        let mut exits: Vec<Vec2> = inner.map(|(a, b)| nearest_on(a, b, point)).collect();
        exits.sort_by(|p, q| square(*p, point).total_cmp(&square(*q, point)));
        exits
    }

    /// Whether two zones overlap or touch: no edge of either parts them.
    fn touches(&self, other: &Self) -> bool {
        let parts = |one: &Self, two: &Self| {
            let gap = |edge: &HalfPlane| two.corners.iter().map(|p| edge.beyond(*p)).fold(f64::INFINITY, f64::min);
            one.edges.iter().any(|edge| gap(edge) > TOUCH)
        };
        let apart = (0..2).any(|k| self.low[k] > other.high[k] + TOUCH || other.low[k] > self.high[k] + TOUCH);
        !(apart || parts(self, other) || parts(other, self))
    }
}

/// The danger zones of polygons in an area, in an order that does not depend on the list's.
///
/// `distance` (m) is the least distance that their edges keep from the hulls. Corners lie `distance / cos(turn / 2)`
/// away, but no farther than `mitre_limit` times `distance`: there they are cut off flat.
///
/// # Errors
/// [`MapError`] for a polygon that has no area or a corner that is not finite.
pub fn zones(area: &Area, polygons: &[Vec<Vec2>], distance: f64, mitre_limit: f64) -> Result<Vec<Zone>, MapError> {
    let mut zones = each(area, polygons, distance, mitre_limit)?;
    merge(&mut zones);
    zones.sort_by(|a, b| a.corners[0][0].total_cmp(&b.corners[0][0]).then(a.corners[0][1].total_cmp(&b.corners[0][1])));
    Ok(zones)
}

/// The same, each polygon by itself: zones in the order of the list, which may overlap.
///
/// # Errors
/// As [`zones`].
pub fn each(area: &Area, polygons: &[Vec<Vec2>], distance: f64, mitre_limit: f64) -> Result<Vec<Zone>, MapError> {
    let mut zones = Vec::with_capacity(polygons.len());
    for (index, polygon) in polygons.iter().enumerate() {
        if polygon.iter().any(|p| !(p[0].is_finite() && p[1].is_finite())) {
            return Err(MapError::Polygon { index, reason: "a corner is not a finite number" });
        }
        let corners = hull(polygon);
        if corners.len() < 3 {
            return Err(MapError::Polygon { index, reason: "needs three corners that are not on one line" });
        }
        let ring = area.clip(offset(&corners, distance, mitre_limit));
        // What lies outside the area is nobody's danger.
        zones.extend(Zone::around(&ring, vec![index]));
    }
    Ok(zones)
}

/// The hulls of the polygons themselves, in the area.
pub fn hulls(area: &Area, polygons: &[Vec<Vec2>]) -> Vec<Zone> {
    let hulls = polygons.iter().enumerate();
    hulls.filter_map(|(index, polygon)| Zone::around(&area.clip(hull(polygon)), vec![index])).collect()
}

/// Puts zones that overlap or touch into the hull of both, until none do.
fn merge(zones: &mut Vec<Zone>) {
    let mut i = 0;
    while i < zones.len() {
        match (0..zones.len()).find(|&j| j != i && zones[i].touches(&zones[j])) {
            Some(j) => {
                let other = zones.swap_remove(i.max(j));
                let one = &zones[i.min(j)];
                let mut polygons = [one.polygons.as_slice(), &other.polygons].concat();
                polygons.sort_unstable();
                let points = [one.corners.as_slice(), &other.corners].concat();
                if let Some(both) = Zone::around(&points, polygons) {
                    zones[i.min(j)] = both;
                }
                i = 0;
            }
            None => i += 1,
        }
    }
}

/// Corners of the convex hull, counter-clockwise from the one of least x, without those that change nothing.
fn hull(points: &[Vec2]) -> Vec<Vec2> {
    let points: MultiPoint = points.iter().map(|p| Point::new(p[0] + 0.0, p[1] + 0.0)).collect();
    let ring = points.convex_hull();
    let mut corners: Vec<Vec2> = ring.exterior().coords().map(|c| [c.x, c.y]).collect();
    corners.pop();
    // Each corner against its neighbours, until all of one round are kept.
    let (mut at, mut kept) = (0, 0);
    while corners.len() >= 3 && kept < corners.len() {
        let n = corners.len();
        at %= n;
        let (before, here, after) = (corners[(at + n - 1) % n], corners[at], corners[(at + 1) % n]);
        if square(before, here) <= SAME * SAME || half_plane(before, after).beyond(here) <= SAME {
            corners.remove(at);
            kept = 0;
        } else {
            (at, kept) = (at + 1, kept + 1);
        }
    }
    let first = (0..corners.len())
        .min_by(|&a, &b| corners[a][0].total_cmp(&corners[b][0]).then(corners[a][1].total_cmp(&corners[b][1])));
    corners.rotate_left(first.unwrap_or(0));
    corners
}

/// A convex ring moved outwards: mitres, cut off flat where they stick out farther than `limit` times `distance`.
fn offset(corners: &[Vec2], distance: f64, limit: f64) -> Vec<Vec2> {
    let n = corners.len();
    let mut ring = Vec::with_capacity(n);
    for i in 0..n {
        let (before, here, after) = (corners[(i + n - 1) % n], corners[i], corners[(i + 1) % n]);
        let (one, two) = (half_plane(before, here).normal, half_plane(here, after).normal);
        let cosine = one[0] * two[0] + one[1] * two[1];
        if 2.0 <= limit * limit * (1.0 + cosine) {
            let reach = distance / (1.0 + cosine);
            ring.push([here[0] + reach * (one[0] + two[0]), here[1] + reach * (one[1] + two[1])]);
            continue;
        }
        // Along the edges, which run a quarter turn left of their normals.
        let (into, away) = ([-one[1], one[0]], [-two[1], two[0]]);
        let middle = [into[0] - away[0], into[1] - away[1]];
        let size = (middle[0] * middle[0] + middle[1] * middle[1]).sqrt();
        let middle = middle.map(|value| value / size);
        let (outward, forward) = (middle[0] * one[0] + middle[1] * one[1], middle[0] * into[0] + middle[1] * into[1]);
        let along = distance * (limit - outward) / forward;
        ring.push(std::array::from_fn(|k| here[k] + distance * one[k] + along * into[k]));
        ring.push(std::array::from_fn(|k| here[k] + distance * two[k] - along * away[k]));
    }
    ring
}

/// What lies left of the line from a to b.
fn half_plane(a: Vec2, b: Vec2) -> HalfPlane {
    let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    let length = (dx * dx + dy * dy).sqrt();
    let normal = [dy / length, -dx / length];
    HalfPlane { normal, height: normal[0] * a[0] + normal[1] * a[1] }
}

fn nearest_on(a: Vec2, b: Vec2, p: Vec2) -> Vec2 {
    let edge = [b[0] - a[0], b[1] - a[1]];
    let along = ((p[0] - a[0]) * edge[0] + (p[1] - a[1]) * edge[1]) / square(a, b);
    std::array::from_fn(|k| a[k] + along.clamp(0.0, 1.0) * edge[k])
}

fn square(a: Vec2, b: Vec2) -> f64 {
    let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    dx * dx + dy * dy
}
