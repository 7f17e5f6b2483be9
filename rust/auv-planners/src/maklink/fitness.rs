//! What a path costs a swarm (eq. 5-8, 10-11), for all particles at once.

use auv_world::math::Vec2;
use serde::Deserialize;

use super::chart::Chart;
use super::drift::Drift;
use super::line::Line;
use super::route::Route;

/// Weights of eq. 8, 10 and 11: of the length, of a blocked path, of the current's term, of its angle and length.
const LENGTH: f64 = 0.5;
/// The cost of a blocked path.
pub const BLOCKED: f64 = 100.0;
const CURRENT: f64 = 0.216;
const CRAB: f64 = 0.3;
const WAY: f64 = 0.1;

/// What is minimised.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Objective {
    /// Half the length (eq. 8).
    #[default]
    Length,
    /// With the current's term, crab angles in degrees (eq. 11).
    Current,
    /// The same with crab angles in radians.
    CurrentRadians,
    /// Half the length that the vehicle would make in still water in the path's travel time.
    Time,
}

/// A link as the particles see it: where it begins, and what a unit of position is.
#[derive(Debug, Clone, Copy)]
struct Axis {
    origin: Vec2,
    step: Vec2,
    high: f64,
}

impl Axis {
    /// The place of a position (m).
    fn at(&self, x: f64) -> Vec2 {
        std::array::from_fn(|k| self.origin[k] + x * self.step[k])
    }
}

/// A route whose waypoints are to be placed, one on each link.
pub struct Corridor<'a> {
    chart: &'a Chart,
    axes: Vec<Axis>,
    start: Vec2,
    goal: Vec2,
    objective: Objective,
    drift: Drift,
    /// Only beside the straight line: there no link sees to it that legs are free.
    line: Option<Line>,
}

impl<'a> Corridor<'a> {
    /// The links of a route. Positions run from 0 to the link's length or, if `ratio`, to 1.
    pub fn new(
        chart: &'a Chart,
        route: &Route,
        ends: [Vec2; 2],
        ratio: bool,
        objective: Objective,
        drift: Drift,
    ) -> Self {
        let axis = |&crossing: &usize| {
            let link = chart.links()[crossing / 2];
            let [a, b] = link.ends;
            let high = if ratio { 1.0 } else { link.length };
            Axis { origin: a, step: [(b[0] - a[0]) / high, (b[1] - a[1]) / high], high }
        };
        let axes = route.crossings.iter().map(axis).collect();
        Self { chart, axes, start: ends[0], goal: ends[1], objective, drift, line: None }
    }

    /// So many places at equal distances along the straight line, each up to `reach` metres beside it. Positions
    /// run from 0 on the right hand to twice the reach or, if `ratio`, to 1.
    #[allow(clippy::too_many_arguments)]
    pub fn beside(
        chart: &'a Chart,
        line: Line,
        ends: [Vec2; 2],
        points: usize,
        reach: f64,
        ratio: bool,
        objective: Objective,
        drift: Drift,
    ) -> Self {
        let [start, goal] = ends;
        let way = [goal[0] - start[0], goal[1] - start[1]];
        let length = (way[0] * way[0] + way[1] * way[1]).sqrt().max(f64::MIN_POSITIVE);
        let left = [-way[1] / length, way[0] / length];
        let (high, unit) = if ratio { (1.0, 2.0 * reach) } else { (2.0 * reach, 1.0) };
        let axis = |point: usize| {
            let part = (point + 1) as f64 / (points + 1) as f64;
            let origin = std::array::from_fn(|k| start[k] + part * way[k] - reach * left[k]);
            Axis { origin, step: left.map(|one| unit * one), high }
        };
        let axes = (0..points).map(axis).collect();
        Self { chart, axes, start, goal, objective, drift, line: Some(line) }
    }

    /// Whether every path must be looked at: where no links lead it.
    pub fn is_open(&self) -> bool {
        self.line.is_some()
    }

    /// What the blocked legs of a path beside the straight line cost; `place` gives its positions.
    pub fn penalty(&self, place: impl Fn(usize) -> f64) -> f64 {
        let Some(line) = &self.line else { return 0.0 };
        let inner = self.axes.iter().enumerate().map(|(point, axis)| axis.at(place(point)));
        let (mut blocked, mut last) = (0, self.start);
        for next in inner.chain([self.goal]) {
            blocked += u32::from(line.blocks(last, next));
            last = next;
        }
        line.cost(blocked)
    }

    /// Number of links.
    pub fn links(&self) -> usize {
        self.axes.len()
    }

    /// The greatest position on a link.
    pub fn high(&self, link: usize) -> f64 {
        self.axes[link].high
    }

    /// The path of some positions.
    pub fn path(&self, positions: impl Iterator<Item = f64>) -> Vec<Vec2> {
        let inner = self.axes.iter().zip(positions);
        let inner = inner.map(|(axis, x)| axis.at(x));
        let mut path: Vec<Vec2> = std::iter::once(self.start).chain(inner).chain([self.goal]).collect();
        path.dedup();
        path
    }

    /// Whether a path leaves the area or enters a zone (eq. 7).
    pub fn is_blocked(&self, path: &[Vec2]) -> bool {
        if let Some(line) = &self.line {
            return path.windows(2).any(|leg| line.blocks(leg[0], leg[1]));
        }
        let area = self.chart.area();
        !(path.iter().all(|p| area.contains(*p)) && path.windows(2).all(|leg| self.chart.is_free(leg[0], leg[1])))
    }

    /// Costs of free paths. `positions` has those of all paths on the first link, then on the second, and so on,
    /// `stride` each; as many are costed as `costs` has room for. `last` is scratch.
    pub fn costs(&self, positions: &[f64], stride: usize, last: &mut [Vec<f64>; 2], costs: &mut [f64]) {
        let n = costs.len();
        let [last_x, last_y] = last;
        last_x.clear();
        last_x.resize(n, self.start[0]);
        last_y.clear();
        last_y.resize(n, self.start[1]);
        costs.fill(0.0);
        for (link, axis) in self.axes.iter().enumerate() {
            let positions = &positions[link * stride..][..n];
            let ([ox, oy], [sx, sy]) = (axis.origin, axis.step);
            let place = |x: f64| [ox + x * sx, oy + x * sy];
            self.legs(positions.iter().map(|&x| place(x)), last_x, last_y, costs);
        }
        self.legs(std::iter::repeat_n(self.goal, n), last_x, last_y, costs);
    }

    /// Adds what the legs to the next points cost.
    #[inline]
    fn legs(&self, next: impl Iterator<Item = Vec2>, last_x: &mut [f64], last_y: &mut [f64], costs: &mut [f64]) {
        let all = next.zip(last_x).zip(last_y).zip(costs);
        // One loop each, so that the usual one has no branch.
        match self.objective {
            Objective::Length => all.for_each(|(((to, x), y), cost)| {
                let [dx, dy] = [to[0] - *x, to[1] - *y];
                (*x, *y) = (to[0], to[1]);
                *cost += LENGTH * (dx * dx + dy * dy).sqrt();
            }),
            objective => all.for_each(|(((to, x), y), cost)| {
                let leg = [to[0] - *x, to[1] - *y];
                (*x, *y) = (to[0], to[1]);
                *cost += self.leg(objective, leg);
            }),
        }
    }

    fn leg(&self, objective: Objective, leg: Vec2) -> f64 {
        let length = (leg[0] * leg[0] + leg[1] * leg[1]).sqrt();
        if objective == Objective::Time {
            return LENGTH * self.drift.speed * self.drift.time(leg, length);
        }
        // A course that cannot be held counts as the worst that can.
        let crab = libm::asin(self.drift.crab_sine(leg, length).abs().min(1.0));
        let crab = if objective == Objective::Current { crab.to_degrees() } else { crab };
        LENGTH * length + CURRENT * (CRAB * crab + WAY * length)
    }

    /// The cost of one path, free or not.
    pub fn cost(&self, path: &[Vec2]) -> f64 {
        let legs = path.windows(2).map(|pair| [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]]);
        let way: f64 = match self.objective {
            Objective::Length => legs.map(|[dx, dy]| LENGTH * (dx * dx + dy * dy).sqrt()).sum(),
            objective => legs.map(|leg| self.leg(objective, leg)).sum(),
        };
        way + if self.is_blocked(path) { BLOCKED } else { 0.0 }
    }
}
