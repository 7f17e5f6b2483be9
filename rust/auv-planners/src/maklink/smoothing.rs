//! Round corners (eq. 14-17). The paper lays one cubic Bezier curve on four points of the path, which cuts
//! through zones; a fillet at each corner cuts off no more than it is allowed.

use auv_world::math::Vec2;
use serde::Deserialize;

use super::chart::Chart;
use super::route::{distance, length};

/// Points on a curve.
const POINTS: usize = 16;
/// Fillets deeper than this in the zones that count are not taken (m).
const SHARP: f64 = 1e-7;

/// How a path is smoothed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Curve {
    /// Not at all.
    #[default]
    None,
    /// By a fillet at each corner, on zones that are wider by what it cuts off.
    Fillet,
    /// By one cubic Bezier curve on four points, as in the paper, whatever it cuts through.
    Bezier,
}

/// The curve, and what it may cut off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Smoothing {
    curve: Curve,
    cut_m: f64,
}

impl Smoothing {
    /// Smoothing by a curve; a fillet cuts off at most `cut_m` metres at a corner.
    pub fn new(curve: Curve, cut_m: f64) -> Self {
        Self { curve, cut_m }
    }

    /// By how much wider the zones must be on which the path is planned (m).
    pub fn cut_m(&self) -> f64 {
        if self.curve == Curve::Fillet { self.cut_m } else { 0.0 }
    }

    /// A path smoothed on the chart on which it was planned. Its depth is that in the zones that count: of a path
    /// on wider zones what is left of it.
    pub fn apply(&self, chart: &Chart, path: &[Vec2]) -> Smoothed {
        match self.curve {
            Curve::None => Smoothed { path: path.to_vec(), depth_m: 0.0 },
            Curve::Bezier => one_bezier(chart, path),
            Curve::Fillet => {
                let smooth = fillets(chart, path, self.cut_m);
                let depth_m = (smooth.depth_m - self.cut_m).max(0.0);
                // Rounding apart a fillet never cuts off more; if it did, the corners would stay.
                if depth_m > SHARP {
                    Smoothed { path: path.to_vec(), depth_m: 0.0 }
                } else {
                    Smoothed { depth_m, ..smooth }
                }
            }
        }
    }
}

/// A smoothed path, and what it cost.
#[derive(Debug, Clone, PartialEq)]
pub struct Smoothed {
    /// The curve as a polyline (m).
    pub path: Vec<Vec2>,
    /// How deep it gets into danger zones (m); 0 if it stays outside.
    pub depth_m: f64,
}

impl Smoothed {
    fn of(path: Vec<Vec2>, chart: &Chart) -> Self {
        // Deepest at a point of the polyline, or between two: the curve's points are close.
        let legs =
            path.windows(2).flat_map(|leg| [leg[0], [0.5 * (leg[0][0] + leg[1][0]), 0.5 * (leg[0][1] + leg[1][1])]]);
        let depths = legs.map(|p| chart.zones().iter().map(|zone| zone.depth(p)).fold(0.0, f64::max));
        let depth_m = depths.fold(0.0, f64::max);
        Self { path, depth_m }
    }
}

/// A fillet at each corner that cuts off at most `cut` metres, and at most half of either leg.
///
/// The curve leaves the path `delta` before the corner and comes back as far behind it; it passes the corner at
/// delta sin(turn / 2) / 4. With zones wider than the safety distance by `cut`, the curve keeps that distance.
pub fn fillets(chart: &Chart, path: &[Vec2], cut: f64) -> Smoothed {
    let mut smooth: Vec<Vec2> = path.first().copied().into_iter().collect();
    for corner in path.windows(3) {
        let [before, here, after] = [corner[0], corner[1], corner[2]];
        let (one, two) = (distance(before, here), distance(here, after));
        if one.min(two) == 0.0 {
            continue;
        }
        let along = |to: Vec2, length: f64| -> Vec2 { std::array::from_fn(|k| (to[k] - here[k]) / length) };
        let (back, on) = (along(before, one), along(after, two));
        let cosine = -(back[0] * on[0] + back[1] * on[1]);
        let half_sine = (0.5 * (1.0 - cosine)).max(0.0).sqrt();
        let delta = (4.0 * cut / half_sine.max(1e-12)).min(0.5 * one).min(0.5 * two);
        let end = |direction: Vec2| -> Vec2 { std::array::from_fn(|k| here[k] + delta * direction[k]) };
        smooth.extend((0..=POINTS).map(|i| bezier([end(back), here, here, end(on)], i as f64 / POINTS as f64)));
    }
    smooth.extend(path.last());
    smooth.dedup();
    Smoothed::of(smooth, chart)
}

/// One cubic Bezier curve on four points of the path at equal distances along it (eq. 17).
pub fn one_bezier(chart: &Chart, path: &[Vec2]) -> Smoothed {
    let whole = length(path);
    if whole == 0.0 {
        return Smoothed::of(path.to_vec(), chart);
    }
    let controls = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].map(|part| point_at(path, part * whole));
    let steps = 4 * POINTS;
    Smoothed::of((0..=steps).map(|i| bezier(controls, i as f64 / steps as f64)).collect(), chart)
}

/// A point of a cubic Bezier curve.
fn bezier(controls: [Vec2; 4], t: f64) -> Vec2 {
    let s = 1.0 - t;
    let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
    std::array::from_fn(|k| (0..4).map(|i| weights[i] * controls[i][k]).sum())
}

/// The point so far along a path (m).
fn point_at(path: &[Vec2], along: f64) -> Vec2 {
    let mut left = along;
    for leg in path.windows(2) {
        let size = distance(leg[0], leg[1]);
        if left <= size && size > 0.0 {
            return std::array::from_fn(|k| leg[0][k] + left / size * (leg[1][k] - leg[0][k]));
        }
        left -= size;
    }
    path[path.len() - 1]
}
