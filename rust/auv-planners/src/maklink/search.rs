//! What every planner in a harbour needs around it: the chart, start and goal on it, and the path that is held.

use auv_world::math::{Vec2, Vec3};

use super::chart::Chart;
use super::error::MapError;
use super::harbor::ZoneSettings;
use super::route::{Route, Routes, distance};
use crate::control::Control;
use crate::error::PlanError;
use crate::fluid::{Held, Judge};
use crate::parameters::{Common, StopRule};
use crate::plan::Plan;
use crate::registry::Request;
use crate::sections::check_place;

/// A path replaces one in the history if it is shorter by this part.
const WORTH_NOTING: f64 = 1e-3;

/// A search on a chart.
pub struct Search<'a> {
    request: &'a Request<'a>,
    chart: Chart,
    /// Start and goal, or the nearest points outside zones.
    ends: [Vec2; 2],
    level: f64,
    held: Held,
    judge: Judge,
    limit: u64,
    stop: StopRule,
    target: f64,
    noted: f64,
    interrupted: bool,
}

impl<'a> Search<'a> {
    /// A search that has found nothing yet.
    ///
    /// # Errors
    /// [`PlanError`] if the world cannot be charted, or start or goal is no place in it.
    pub fn new(request: &'a Request<'a>, common: &Common, zones: &ZoneSettings) -> Result<Self, PlanError> {
        check_place(request.world, "start", request.start)?;
        check_place(request.world, "goal", request.goal)?;
        let chart = zones.chart(request.world)?;
        let flat = |p: Vec3| [p[0], p[1]];
        let mut ends = [flat(request.start), flat(request.goal)];
        for (name, end) in ["start", "goal"].into_iter().zip(&mut ends) {
            if !zones.snap {
                chart.check(name, *end)?;
            }
            *end = chart.nearest_free(*end).unwrap_or(*end);
        }
        Ok(Self {
            request,
            chart,
            ends,
            level: request.world.scenario().domain.min_m[2],
            held: Held::default(),
            judge: Judge::new(request.world, common.cost, &common.cost_options)?,
            limit: common.max_evaluations.unwrap_or(u64::MAX),
            stop: common.stop.unwrap_or(StopRule::Exhaust),
            target: common.target_cost.unwrap_or(f64::NEG_INFINITY),
            noted: f64::INFINITY,
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

    /// The shortest routes, at most so many. `None` if the answer is already held: the straight line where start
    /// sees goal, or that there is no way.
    ///
    /// # Errors
    /// [`PlanError`] if zones fill the area.
    pub fn routes(&mut self, count: usize) -> Result<Option<Vec<Route>>, PlanError> {
        let [start, goal] = self.ends;
        if self.chart.is_free(start, goal) {
            self.count(1);
            self.hold(&[start, goal], distance(start, goal), true);
            return Ok(None);
        }
        let routes = Routes::new(&self.chart, start, goal).and_then(|routes| routes.shortest_few(count));
        match routes {
            Ok(routes) => Ok(Some(routes)),
            Err(MapError::NoWay | MapError::InZone { .. }) => {
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
        // The last one is held anyway; in between, only progress is worth a verdict.
        let waypoints = self.waypoints(path);
        let clear = free && self.judge.is_clear(&waypoints);
        self.held.hold(&waypoints, self.judge.cost(&waypoints), clear);
        self.noted = measure;
    }

    /// Whether a path of that measure is so much better than the one held that it should be.
    pub fn is_worth_holding(&self, measure: f64) -> bool {
        measure < self.noted * (1.0 - WORTH_NOTING) || self.noted == f64::INFINITY
    }

    /// Notes the total at the end of a generation, and whether the search is done.
    pub fn end_generation(&mut self) -> bool {
        self.held.note();
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

    /// The plan.
    pub fn finish(mut self) -> Plan {
        if self.held.evaluations() == 0 {
            self.no_way();
        }
        let ends = [self.request.start, self.request.goal];
        let cost = self.judge.cost(&ends);
        let interrupted = self.interrupted;
        self.held.finish(self.request.planner, interrupted).unwrap_or_else(|| Plan {
            planner: self.request.planner.to_owned(),
            waypoints: ends.to_vec(),
            feasible: false,
            cost,
            evaluations: 0,
            history: Vec::new(),
            coefficients: Vec::new(),
            interrupted,
        })
    }
}
