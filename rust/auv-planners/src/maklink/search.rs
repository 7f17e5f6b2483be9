//! What every planner in a harbour needs around it: the chart, start and goal on it, and the path that is held.

use auv_world::math::{Vec2, Vec3};

use super::chart::Chart;
use super::error::MapError;
use super::harbor::ZoneSettings;
use super::report::HarborReport;
use super::route::{Route, Routes, distance, length};
use super::smoothing::Smoothing;
use super::visibility::shortest;
use crate::control::Control;
use crate::error::PlanError;
use crate::fluid::{Held, Judge};
use crate::parameters::{Common, StopRule};
use crate::plan::Plan;
use crate::registry::Request;
use crate::sections::check_place;

/// A path replaces one in the history if it is shorter by this part.
const WORTH_NOTING: f64 = 1e-3;
/// A path no deeper than this in a zone keeps out of it (m).
const OUTSIDE: f64 = 1e-6;

/// A search on a chart.
pub struct Search<'a> {
    request: &'a Request<'a>,
    zones: ZoneSettings,
    smoothing: Smoothing,
    chart: Chart,
    /// Start and goal, or the nearest points outside zones.
    ends: [Vec2; 2],
    level: f64,
    held: Held,
    /// The path held, on the chart: as planned, and as smoothed.
    corners: Vec<Vec2>,
    smooth: Vec<Vec2>,
    depth: f64,
    judge: Judge,
    limit: u64,
    stop: StopRule,
    target: f64,
    noted: f64,
    trace: Vec<(u64, f64)>,
    interrupted: bool,
}

impl<'a> Search<'a> {
    /// A search that has found nothing yet.
    ///
    /// # Errors
    /// [`PlanError`] if the world cannot be charted, or start or goal is no place in it.
    pub fn new(
        request: &'a Request<'a>,
        common: &Common,
        zones: &ZoneSettings,
        smoothing: Smoothing,
    ) -> Result<Self, PlanError> {
        check_place(request.world, "start", request.start)?;
        check_place(request.world, "goal", request.goal)?;
        let chart = zones.wider(smoothing.cut_m()).chart(request.world)?;
        let flat = |p: Vec3| [p[0], p[1]];
        let ends = zones.ends(&chart, [flat(request.start), flat(request.goal)])?;
        Ok(Self {
            request,
            zones: *zones,
            smoothing,
            chart,
            ends,
            level: request.world.scenario().domain.min_m[2],
            held: Held::default(),
            corners: Vec::new(),
            smooth: Vec::new(),
            depth: 0.0,
            judge: Judge::new(request.world, common.cost, &common.cost_options)?,
            limit: common.max_evaluations.unwrap_or(u64::MAX),
            stop: common.stop.unwrap_or(StopRule::Exhaust),
            target: common.target_cost.unwrap_or(f64::NEG_INFINITY),
            noted: f64::INFINITY,
            trace: Vec::new(),
            interrupted: false,
        })
    }

    /// The chart.
    pub fn chart(&self) -> &Chart {
        &self.chart
    }

    /// Start and goal, or the nearest points outside zones (m).
    pub fn ends(&self) -> [Vec2; 2] {
        self.ends
    }

    /// How the caller may interrupt.
    pub fn control(&self) -> Control<'a> {
        self.request.control
    }

    /// Evaluations left.
    pub fn left(&self) -> u64 {
        self.limit - self.held.evaluations()
    }

    /// Whether start sees goal. Then the straight line, the answer, is held.
    pub fn is_straight(&mut self) -> bool {
        let [start, goal] = self.ends;
        let free = self.chart.is_free(start, goal);
        if free {
            self.count(1);
            self.hold(&[start, goal], distance(start, goal), true);
        }
        free
    }

    /// The shortest routes, at most so many. `None` if the answer is already held: the straight line where start
    /// sees goal, or that there is no way.
    ///
    /// # Errors
    /// [`PlanError`] if zones fill the area.
    pub fn routes(&mut self, count: usize) -> Result<Option<Vec<Route>>, PlanError> {
        if self.is_straight() {
            return Ok(None);
        }
        let [start, goal] = self.ends;
        let routes = Routes::new(&self.chart, start, goal).and_then(|routes| routes.shortest_few(count));
        match routes {
            Ok(routes) => Ok(Some(routes)),
            Err(MapError::NoWay { .. } | MapError::InZone { .. }) => {
                self.no_way();
                Ok(None)
            }
            Err(error) => Err(error.into()),
        }
    }

    /// Holds the straight line, which leads through a zone.
    pub fn no_way(&mut self) {
        self.count(1);
        self.hold(&self.ends.clone(), f64::INFINITY, false);
    }

    /// Counts evaluations.
    pub fn count(&mut self, paths: u64) {
        self.held.count(paths);
    }

    /// Holds a better path from now on. `measure` is what is minimised.
    pub fn hold(&mut self, path: &[Vec2], measure: f64, free: bool) {
        self.corners = path.to_vec();
        let smooth = self.smoothing.apply(&self.chart, path);
        (self.smooth, self.depth) = if free { (smooth.path, smooth.depth_m) } else { (path.to_vec(), 0.0) };
        // The last one is held anyway; in between, only progress is worth a verdict.
        let waypoints = self.waypoints(&self.smooth);
        let clear = free && self.depth <= OUTSIDE && self.judge.is_clear(&waypoints);
        self.held.hold(&waypoints, self.judge.cost(&waypoints), clear);
        self.noted = measure;
    }

    /// Whether a path of that measure is so much better than the one held that it should be.
    pub fn is_worth_holding(&self, measure: f64) -> bool {
        measure < self.noted * (1.0 - WORTH_NOTING) || self.noted == f64::INFINITY
    }

    /// Notes the total at the end of a generation and the best `measure` so far, and whether the search is done.
    pub fn end_generation(&mut self, measure: f64) -> bool {
        self.held.note();
        self.note(measure);
        self.interrupted = self.interrupted || self.control().interrupted();
        let enough = match self.stop {
            StopRule::FirstFeasible => self.held.is_clear(),
            StopRule::Exhaust => false,
        };
        enough || self.interrupted || self.held.total() <= self.target || self.left() == 0
    }

    /// Notes that the caller interrupted.
    pub fn interrupt(&mut self) {
        self.interrupted = true;
    }

    fn note(&mut self, measure: f64) {
        let spent = self.held.evaluations();
        if measure.is_finite() && self.trace.last().is_none_or(|last| last.0 < spent) {
            self.trace.push((spent, measure));
        }
    }

    /// From start to goal by way of a path on the chart.
    fn waypoints(&self, path: &[Vec2]) -> Vec<Vec3> {
        let inner = path.iter().map(|p| [p[0], p[1], self.level]);
        let mut waypoints: Vec<Vec3> = std::iter::once(self.request.start).chain(inner).collect();
        waypoints.push(self.request.goal);
        waypoints.dedup();
        if waypoints.len() < 2 {
            waypoints.push(self.request.goal);
        }
        waypoints
    }

    /// What the path held is longer than the shortest of all round the zones.
    fn gap(&self) -> Option<f64> {
        if self.interrupted || !self.noted.is_finite() {
            return None;
        }
        let control = self.control();
        let best = |chart: &Chart| shortest(chart, self.ends[0], self.ends[1], &mut || control.interrupted());
        let best = if self.smoothing.cut_m() > 0.0 {
            // Planned on zones that are wider than those that count.
            best(&self.zones.chart(self.request.world).ok()?)
        } else {
            best(&self.chart)
        };
        Some(length(&self.smooth) - length(&best.ok()??))
    }

    /// The plan.
    pub fn finish(mut self) -> Plan {
        if self.held.evaluations() == 0 {
            self.no_way();
        }
        self.note(self.noted);
        let report = HarborReport {
            gap_m: self.gap(),
            depth_m: self.depth,
            corners: self.waypoints(&self.corners),
            trace: std::mem::take(&mut self.trace),
            barriers: if self.noted.is_finite() || self.interrupted {
                Vec::new()
            } else {
                self.chart.barriers(self.ends[0])
            },
        };
        let ends = [self.request.start, self.request.goal];
        let cost = self.judge.cost(&ends);
        let interrupted = self.interrupted;
        let plan = self.held.finish(self.request.planner, interrupted).unwrap_or_else(|| Plan {
            planner: self.request.planner.to_owned(),
            waypoints: ends.to_vec(),
            feasible: false,
            cost,
            evaluations: 0,
            history: Vec::new(),
            coefficients: Vec::new(),
            interrupted,
            harbor: None,
        });
        Plan { harbor: Some(Box::new(report)), ..plan }
    }
}
