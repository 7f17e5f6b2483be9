//! A world as a chart: what of a 2-D world MAKLINK can plan on.

use std::f64::consts::{PI, TAU};

use auv_world::World;
use auv_world::math::Vec2;
use auv_world::obstacles::polygon::centre;
use auv_world::scenario::{Current, Obstacle};
use serde::Deserialize;

use super::area::Area;
use super::chart::Chart;
use super::drift::Drift;
use super::fitness::Objective;
use super::line::{Line, Penalty};
use super::zone::each;
use crate::error::{PlanError, within};

/// How danger zones are made.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ZoneSettings {
    /// Least distance from the obstacles' hulls (m; d_min).
    pub distance_m: f64,
    /// Corners of zones lie at most this many times that away.
    pub mitre_limit: f64,
    /// Discs and cylinders become polygons of so many sides round them.
    pub sides: usize,
    /// Whether start and goal inside a zone are joined to the nearest point outside; if not, they are an error.
    pub snap: bool,
}

impl Default for ZoneSettings {
    fn default() -> Self {
        Self { distance_m: 1.875, mitre_limit: 10.0, sides: 16, snap: true }
    }
}

impl ZoneSettings {
    /// Checks every value.
    ///
    /// # Errors
    /// [`PlanError::Parameter`] naming field, value and what is allowed.
    pub fn check(&self) -> Result<(), PlanError> {
        within("zones.distance_m", self.distance_m, 0.0, 1e9)?;
        within("zones.mitre_limit", self.mitre_limit, 1.0, 1e9)?;
        within("zones.sides", self.sides, 3, 1000)
    }

    /// The same, wider by so much (m).
    #[must_use]
    pub fn wider(&self, by_m: f64) -> Self {
        Self { distance_m: self.distance_m + by_m, ..*self }
    }

    /// Start and goal where a path on the chart may begin and end: themselves, or the nearest points outside zones.
    ///
    /// # Errors
    /// [`PlanError`] if one lies outside the area or in a zone, and is not to be joined to the nearest point outside.
    pub fn ends(&self, chart: &Chart, mut ends: [Vec2; 2]) -> Result<[Vec2; 2], PlanError> {
        for (name, end) in ["start", "goal"].into_iter().zip(&mut ends) {
            if !self.snap {
                chart.check(name, *end)?;
            }
            *end = chart.nearest_free(*end).unwrap_or(*end);
        }
        Ok(ends)
    }

    /// The chart of a world as it is now.
    ///
    /// # Errors
    /// [`PlanError`] for what a chart cannot show: a third dimension, a sea floor, shapes that have no outline.
    pub fn chart(&self, world: &World) -> Result<Chart, PlanError> {
        Ok(Chart::new(area(world)?, &self.polygons(world)?, self.distance_m, self.mitre_limit)?)
    }

    /// What blocks legs beside the straight line in a world as it is now.
    ///
    /// # Errors
    /// As [`ZoneSettings::chart`].
    pub fn line(&self, world: &World, penalty: Penalty) -> Result<Line, PlanError> {
        let area = area(world)?;
        let obstacles = each(&area, &self.polygons(world)?, self.distance_m, self.mitre_limit)?;
        Ok(Line { area, obstacles, penalty })
    }

    /// Outlines of everything solid.
    fn polygons(&self, world: &World) -> Result<Vec<Vec<Vec2>>, PlanError> {
        let scenario = world.scenario();
        let refuse =
            |what: &str| Err(PlanError::parameter("world", &scenario.name, format!("MAKLINK planners know no {what}")));
        if scenario.dimensions != 2 {
            return refuse("third dimension, only 2-D worlds");
        }
        if scenario.seabed.is_some() {
            return refuse("sea floor, only polygons, discs and cylinders");
        }
        let level = scenario.domain.min_m[2];
        let mut polygons = Vec::with_capacity(scenario.obstacles.len());
        for (i, obstacle) in scenario.obstacles.iter().enumerate() {
            let [x, y, _] = world.obstacle_position(i);
            match obstacle {
                Obstacle::Disc(disc) => polygons.push(round([x, y], disc.radius_m, self.sides)),
                Obstacle::Cylinder(shape) if (shape.top_m..=shape.bottom_m).contains(&level) => {
                    polygons.push(round([x, y], shape.radius_m, self.sides));
                }
                Obstacle::Polygon(shape) if (shape.top_m..=shape.bottom_m).contains(&level) => {
                    let was = centre(&shape.vertices_m);
                    let moved = [x - was[0], y - was[1]];
                    polygons.push(shape.vertices_m.iter().map(|p| [p[0] + moved[0], p[1] + moved[1]]).collect());
                }
                Obstacle::Cylinder(_) | Obstacle::Polygon(_) => {}
                Obstacle::Sphere(_) => return refuse("spheres, only polygons, discs and cylinders"),
                Obstacle::Superquadric(_) => return refuse("superquadrics, only polygons, discs and cylinders"),
            }
        }
        Ok(polygons)
    }
}

/// The rectangle of a world.
fn area(world: &World) -> Result<Area, PlanError> {
    let domain = &world.scenario().domain;
    let flat = |corner: [f64; 3]| [corner[0], corner[1]];
    Ok(Area::new(flat(domain.min_m), flat(domain.max_m))?)
}

/// A regular polygon round a circle.
fn round(centre: Vec2, radius: f64, sides: usize) -> Vec<Vec2> {
    let reach = radius / libm::cos(PI / sides as f64);
    let corner = |i: usize| {
        let angle = TAU * i as f64 / sides as f64;
        [centre[0] + reach * libm::cos(angle), centre[1] + reach * libm::sin(angle)]
    };
    (0..sides).map(corner).collect()
}

/// The vehicle of a world in its current.
///
/// # Errors
/// [`PlanError`] if the objective counts the current and that is not the same everywhere.
pub fn drift(world: &World, objective: Objective) -> Result<Drift, PlanError> {
    let scenario = world.scenario();
    let uniform = scenario.currents.iter().all(|current| matches!(current, Current::Uniform(_)));
    if objective != Objective::Length && !uniform {
        let rule = "only \"length\" where the current is not the same everywhere";
        return Err(PlanError::parameter("objective", format!("{objective:?}"), rule));
    }
    Ok(Drift { speed: scenario.vehicle.speed_mps, current: world.current(world.mission().start_m) })
}
