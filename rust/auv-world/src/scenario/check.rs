//! What a scenario may say. Every refusal names the key, the value and what is allowed.

use super::manoeuvre::{check_manoeuvre, check_on_the_map};
use super::{Change, Current, GriddedCurrent, GriddedSeabed, Hold, Obstacle, SCHEMA, Scenario, Seabed, SectionFrame};
use crate::error::WorldError;
use crate::math::{Vec2, Vec3};
use crate::obstacles::polygon;
use crate::world::World;

pub(super) type Checked = Result<(), WorldError>;

/// More obstacles, vortices, peaks, sections or phases than this are refused.
pub(super) const MOST: usize = 100_000;
/// More sections than this are refused.
const MOST_SECTIONS: usize = 10_000;
/// Larger numbers than this are refused, so that no square overflows.
const LARGEST: f64 = 1e12;

pub(super) fn finite(key: &str, value: f64) -> Checked {
    if value.is_finite() && value.abs() <= LARGEST {
        return Ok(());
    }
    Err(WorldError::key(key, value, format!("must be a finite number of at most {LARGEST:e}")))
}

pub(super) fn all_finite(key: &str, values: &[f64]) -> Checked {
    values.iter().try_for_each(|&value| finite(key, value))
}

pub(super) fn positive(key: &str, value: f64) -> Checked {
    finite(key, value)?;
    if value > 0.0 { Ok(()) } else { Err(WorldError::key(key, value, "must be greater than 0")) }
}

fn not_negative(key: &str, value: f64) -> Checked {
    finite(key, value)?;
    if value >= 0.0 { Ok(()) } else { Err(WorldError::key(key, value, "must not be negative")) }
}

pub(super) fn at_most(key: &str, count: usize, most: usize) -> Checked {
    if count <= most { Ok(()) } else { Err(WorldError::key(key, count, format!("at most {most} are allowed"))) }
}

fn between(key: &str, top: f64, bottom: f64) -> Checked {
    all_finite(key, &[top, bottom])?;
    if top < bottom {
        return Ok(());
    }
    Err(WorldError::key(format!("{key}.top_m"), top, format!("must be less deep than bottom_m = {bottom}")))
}

fn ascending(key: &str, values: &[f64], fewest: usize) -> Checked {
    if values.len() < fewest {
        return Err(WorldError::key(key, format!("{} values", values.len()), format!("needs at least {fewest}")));
    }
    all_finite(key, values)?;
    match values.windows(2).find(|pair| pair[1] <= pair[0]) {
        Some(pair) => Err(WorldError::key(key, format!("{}, {}", pair[0], pair[1]), "must ascend")),
        None => Ok(()),
    }
}

impl Scenario {
    /// Checks every value.
    ///
    /// # Errors
    /// [`WorldError::Scenario`] naming the first key that is wrong.
    pub fn check(&self) -> Checked {
        World::new(self.clone(), 0, 0).map(drop)
    }

    /// Checks everything that can be checked without making the world.
    pub(crate) fn check_numbers(&self) -> Checked {
        if self.schema != SCHEMA {
            return Err(WorldError::key("schema", self.schema, format!("this version reads schema {SCHEMA}")));
        }
        if self.name.is_empty() {
            return Err(WorldError::key("name", "\"\"", "must not be empty"));
        }
        if !matches!(self.dimensions, 2 | 3) {
            return Err(WorldError::key("dimensions", self.dimensions, "must be 2 or 3"));
        }
        self.check_domain()?;
        self.check_vehicle()?;
        self.check_sections()?;
        self.check_seabed()?;
        at_most("currents", self.currents.len(), MOST)?;
        for (i, current) in self.currents.iter().enumerate() {
            self.check_current(&format!("currents[{i}]"), current)?;
        }
        at_most("obstacles", self.obstacles.len(), MOST)?;
        for (i, obstacle) in self.obstacles.iter().enumerate() {
            check_obstacle(&format!("obstacles[{i}]"), obstacle)?;
        }
        self.check_change()?;
        self.check_missions()
    }

    /// Start and goal lie clear of everything solid in the world made of this scenario.
    pub(crate) fn check_clear(&self, world: &World) -> Checked {
        for (i, mission) in self.missions.iter().enumerate() {
            for (name, point) in [("start_m", mission.start_m), ("goal_m", mission.goal_m)] {
                let clearance = world.clearance(point);
                if clearance <= 0.0 {
                    let rule = format!("lies inside rock or an obstacle (clearance {clearance:.1} m)");
                    return Err(WorldError::key(format!("missions[{i}].{name}"), format!("{point:?}"), rule));
                }
            }
        }
        Ok(())
    }

    fn check_domain(&self) -> Checked {
        let (low, high) = (self.domain.min_m, self.domain.max_m);
        all_finite("domain.min_m", &low)?;
        all_finite("domain.max_m", &high)?;
        not_negative("domain.margin_m", self.domain.margin_m)?;
        for axis in 0..3 {
            let flat = axis == 2 && self.dimensions == 2;
            let fits = if flat { high[2] == low[2] } else { high[axis] > low[axis] };
            if !fits {
                let rule = if flat { "in 2-D both depths must be equal" } else { "must exceed domain.min_m" };
                return Err(WorldError::key(format!("domain.max_m[{axis}]"), high[axis], rule));
            }
        }
        if low[2] < 0.0 {
            return Err(WorldError::key("domain.min_m[2]", low[2], "must not be above the surface (0)"));
        }
        if let Some(projection) = &self.projection {
            finite("projection.longitude_deg", projection.longitude_deg)?;
            if !(-90.0..=90.0).contains(&projection.latitude_deg) {
                let value = projection.latitude_deg;
                return Err(WorldError::key("projection.latitude_deg", value, "must lie in -90 .. 90"));
            }
        }
        Ok(())
    }

    fn check_vehicle(&self) -> Checked {
        let (vehicle, limits, episode) = (&self.vehicle, &self.limits, &self.episode);
        positive("limits.goal_radius_m", limits.goal_radius_m)?;
        for (key, value) in [("limits.time_factor", limits.time_factor), ("limits.energy_factor", limits.energy_factor)]
        {
            finite(key, value)?;
            if value < 1.0 {
                return Err(WorldError::key(key, value, "must be at least 1, the still-water straight run"));
            }
        }
        positive("vehicle.speed_mps", vehicle.speed_mps)?;
        positive("vehicle.yaw_rate_radps", vehicle.yaw_rate_radps)?;
        positive("vehicle.pitch_limit_rad", vehicle.pitch_limit_rad)?;
        not_negative("vehicle.hotel_power_w", vehicle.hotel_power_w)?;
        not_negative("vehicle.propulsion_w_per_mps3", vehicle.propulsion_w_per_mps3)?;
        positive("vehicle.hotel_power_w + propulsion_w_per_mps3", vehicle.power_w(vehicle.speed_mps))?;
        positive("episode.tick_s", episode.tick_s)?;
        positive("episode.reach_m", episode.reach_m)?;
        positive("episode.capture_radius_m", episode.capture_radius_m)?;
        positive("episode.minimum_leg_s", episode.minimum_leg_s)?;
        positive("episode.sonar_range_m", episode.sonar_range_m)?;
        not_negative("episode.station_radius_m", episode.station_radius_m)?;
        not_negative("episode.waypoint_margin_m", episode.waypoint_margin_m)?;
        not_negative("episode.sensor_noise_m", episode.sensor_noise_m)?;
        finite("episode.maximum_leg_s", episode.maximum_leg_s)?;
        if episode.maximum_leg_s < episode.minimum_leg_s {
            let rule = format!("must be at least minimum_leg_s = {}", episode.minimum_leg_s);
            return Err(WorldError::key("episode.maximum_leg_s", episode.maximum_leg_s, rule));
        }
        if episode.maximum_leg_s / episode.tick_s > 1e6 {
            return Err(WorldError::key("episode.tick_s", episode.tick_s, "a leg may have at most a million ticks"));
        }
        Ok(())
    }

    fn check_sections(&self) -> Checked {
        let Some(sections) = &self.sections else { return Ok(()) };
        if !(2..=MOST_SECTIONS).contains(&sections.count) {
            let rule = format!("must lie in 2 .. {MOST_SECTIONS}");
            return Err(WorldError::key("sections.count", sections.count, rule));
        }
        positive("sections.cell_m", sections.cell_m)?;
        let spans = |spacing: f64| spacing * (sections.count - 1) as f64;
        match (sections.frame, sections.spacing_m, sections.half_width_m) {
            (SectionFrame::Domain, Some(spacing), None) => {
                positive("sections.spacing_m", spacing)?;
                let length = self.domain.max_m[1] - self.domain.min_m[1];
                if spans(spacing) > length {
                    let rule = format!("{} sections must fit into the domain's {length} m", sections.count);
                    return Err(WorldError::key("sections.spacing_m", spacing, rule));
                }
                Ok(())
            }
            (SectionFrame::Mission, None, Some(width)) => positive("sections.half_width_m", width),
            (SectionFrame::Domain, ..) => {
                Err(WorldError::key("sections.frame", "\"domain\"", "needs spacing_m and no half_width_m"))
            }
            (SectionFrame::Mission, ..) => {
                Err(WorldError::key("sections.frame", "\"mission\"", "needs half_width_m and no spacing_m"))
            }
        }
    }

    fn check_seabed(&self) -> Checked {
        match &self.seabed {
            None => Ok(()),
            Some(Seabed::Flat(flat)) => positive("seabed.depth_m", flat.depth_m),
            Some(Seabed::Peaks(peaks)) => {
                positive("seabed.floor_depth_m", peaks.floor_depth_m)?;
                at_most("seabed.peaks", peaks.peaks.len(), MOST)?;
                for (i, peak) in peaks.peaks.iter().enumerate() {
                    let key = |name: &str| format!("seabed.peaks[{i}].{name}");
                    finite(&key("x_m"), peak.x_m)?;
                    finite(&key("y_m"), peak.y_m)?;
                    positive(&key("height_m"), peak.height_m)?;
                    positive(&key("a"), peak.a)?;
                    positive(&key("b"), peak.b)?;
                    positive(&key("sigma_m"), peak.sigma_m)?;
                }
                Ok(())
            }
            Some(Seabed::Gridded(grid)) => self.check_gridded_seabed(grid),
        }
    }

    fn check_gridded_seabed(&self, grid: &GriddedSeabed) -> Checked {
        let (columns, rows) =
            self.check_axes("seabed", [&grid.x_m, &grid.y_m, &grid.longitude_deg, &grid.latitude_deg])?;
        let depths = check_data("seabed.depth_m", &grid.depth_m, rows * columns)?;
        if depths.iter().any(|depth| !depth.is_finite()) {
            return Err(WorldError::key("seabed.depth_m", "NaN", "every depth must be a finite number"));
        }
        Ok(())
    }

    /// Checks horizontal axes, gives their lengths (columns, rows).
    fn check_axes(&self, key: &str, axes: [&Option<Vec<f64>>; 4]) -> Result<(usize, usize), WorldError> {
        match axes {
            [Some(x), Some(y), None, None] => {
                ascending(&format!("{key}.x_m"), x, 2)?;
                ascending(&format!("{key}.y_m"), y, 2)?;
                Ok((x.len(), y.len()))
            }
            [None, None, Some(longitude), Some(latitude)] => {
                ascending(&format!("{key}.longitude_deg"), longitude, 2)?;
                ascending(&format!("{key}.latitude_deg"), latitude, 2)?;
                if self.projection.is_none() {
                    return Err(WorldError::key(key, "longitude_deg", "a grid in degrees needs a [projection]"));
                }
                if latitude[0] < -90.0 || latitude[latitude.len() - 1] > 90.0 {
                    return Err(WorldError::key(format!("{key}.latitude_deg"), latitude[0], "must lie in -90 .. 90"));
                }
                Ok((longitude.len(), latitude.len()))
            }
            _ => Err(WorldError::key(key, "axes", "needs either x_m and y_m or longitude_deg and latitude_deg")),
        }
    }

    fn check_current(&self, key: &str, current: &Current) -> Checked {
        match current {
            Current::Uniform(uniform) => all_finite(&format!("{key}.velocity_mps"), &uniform.velocity_mps),
            Current::Vortices(vortices) => {
                positive(&format!("{key}.core_radius_m"), vortices.core_radius_m)?;
                at_most(&format!("{key}.vortices"), vortices.vortices.len(), MOST)?;
                for (i, vortex) in vortices.vortices.iter().enumerate() {
                    let values = [vortex.x_m, vortex.y_m, vortex.circulation_m2ps];
                    all_finite(&format!("{key}.vortices[{i}]"), &values)?;
                    all_finite(&format!("{key}.vortices[{i}].drift_mps"), &vortex.drift_mps)?;
                }
                Ok(())
            }
            Current::Jet(jet) => {
                let values = [jet.t, jet.c, jet.k, jet.e, jet.b0, jet.omega, jet.chi, jet.heading_rad];
                all_finite(key, &values)?;
                all_finite(&format!("{key}.origin_m"), &jet.origin_m)?;
                not_negative(&format!("{key}.peak_speed_mps"), jet.peak_speed_mps)?;
                positive(&format!("{key}.length_scale_m"), jet.length_scale_m)?;
                jet.time_scale_s.map_or(Ok(()), |scale| positive(&format!("{key}.time_scale_s"), scale))
            }
            Current::Gridded(grid) => self.check_gridded_current(key, grid),
        }
    }

    fn check_gridded_current(&self, key: &str, grid: &GriddedCurrent) -> Checked {
        let (columns, rows) = self.check_axes(key, [&grid.x_m, &grid.y_m, &grid.longitude_deg, &grid.latitude_deg])?;
        let mut count = columns * rows;
        for (name, axis) in [("depth_m", &grid.depth_m), ("time_s", &grid.time_s)] {
            if let Some(values) = axis {
                ascending(&format!("{key}.{name}"), values, 1)?;
                count *= values.len();
            }
        }
        let u = check_data(&format!("{key}.u_mps"), &grid.u_mps, count)?;
        let v = check_data(&format!("{key}.v_mps"), &grid.v_mps, count)?;
        if u.iter().zip(&v).all(|(u, v)| u.is_nan() || v.is_nan()) {
            return Err(WorldError::key(format!("{key}.u_mps"), "NaN everywhere", "some current must be known"));
        }
        Ok(())
    }

    fn check_change(&self) -> Checked {
        let (every, hold) = match &self.change {
            None => return Ok(()),
            Some(Change::Table(table)) => (table.every_m, table.hold_margin_m),
            Some(Change::Redraw(redraw)) => (redraw.every_m, redraw.hold_margin_m),
        };
        positive("change.every_m", every)?;
        not_negative("change.hold_margin_m", hold)?;
        match &self.change {
            Some(Change::Table(table)) => {
                at_most("change.phases", table.phases.len(), MOST)?;
                let vortices: usize = self.currents.iter().map(Current::vortex_count).sum();
                for (i, phase) in table.phases.iter().enumerate() {
                    let key = format!("change.phases[{i}]");
                    same_length(&format!("{key}.obstacles_m"), phase.obstacles_m.len(), self.obstacles.len())?;
                    same_length(&format!("{key}.vortices_m"), phase.vortices_m.len(), vortices)?;
                    phase.obstacles_m.iter().try_for_each(|p: &Vec3| all_finite(&key, p))?;
                    phase.vortices_m.iter().try_for_each(|p: &Vec2| all_finite(&key, p))?;
                }
                Ok(())
            }
            Some(Change::Redraw(redraw)) => {
                not_negative("change.obstacle_step_m", redraw.obstacle_step_m)?;
                let Some(vortices) = &redraw.vortices else { return Ok(()) };
                for normal in [&vortices.x_normal_m, &vortices.y_normal_m].into_iter().flatten() {
                    finite("change.vortices mean", normal[0])?;
                    not_negative("change.vortices standard deviation", normal[1])?;
                }
                vortices.peak_speed_mps.map_or(Ok(()), |peak| not_negative("change.vortices.peak_speed_mps", peak))
            }
            None => Ok(()),
        }
    }

    /// Start and goal lie inside the box, apart.
    fn check_missions(&self) -> Checked {
        if self.missions.is_empty() {
            return Err(WorldError::key("missions", "[]", "at least one [[missions]] with start_m and goal_m"));
        }
        at_most("missions", self.missions.len(), MOST)?;
        for (i, mission) in self.missions.iter().enumerate() {
            for (name, point) in [("start_m", mission.start_m), ("goal_m", mission.goal_m)] {
                let key = format!("missions[{i}].{name}");
                all_finite(&key, &point)?;
                for axis in 0..3 {
                    let (low, high) = (self.domain.min_m[axis], self.domain.max_m[axis]);
                    if !(low..=high).contains(&point[axis]) {
                        let axis_key = format!("{key}[{axis}]");
                        return Err(WorldError::key(axis_key, point[axis], format!("must lie in {low} .. {high}")));
                    }
                }
            }
            let length = crate::math::distance(mission.start_m, mission.goal_m);
            if length <= self.limits.goal_radius_m {
                let rule =
                    format!("must be farther from the start than the goal radius, {}", self.limits.goal_radius_m);
                return Err(WorldError::key(format!("missions[{i}].goal_m"), format!("{length} m away"), rule));
            }
        }
        Ok(())
    }
}

fn same_length(key: &str, found: usize, wanted: usize) -> Checked {
    if found == wanted {
        return Ok(());
    }
    Err(WorldError::key(key, format!("{found} positions"), format!("needs {wanted}, one for each")))
}

fn check_data(key: &str, data: &super::Data, count: usize) -> Result<Vec<f32>, WorldError> {
    let values = data.values().map_err(|rule| WorldError::key(key, "data", rule))?;
    if values.len() != count {
        let rule = format!("needs {count}, the product of the axes' lengths");
        return Err(WorldError::key(key, format!("{} values", values.len()), rule));
    }
    match values.iter().find(|value| value.is_infinite() || f64::from(value.abs()) > LARGEST) {
        Some(value) => Err(WorldError::key(key, value, "must be finite or NaN (missing)")),
        None => Ok(values),
    }
}

fn check_obstacle(key: &str, obstacle: &Obstacle) -> Checked {
    let name = |name: &str| format!("{key}.{name}");
    match obstacle {
        Obstacle::Sphere(sphere) => {
            all_finite(&name("position_m"), &sphere.position_m)?;
            all_finite(&name("velocity_mps"), &sphere.velocity_mps)?;
            check_manoeuvre(&name("manoeuvre"), sphere.manoeuvre.as_ref(), sphere.velocity_mps)?;
            positive(&name("radius_m"), sphere.radius_m)
        }
        Obstacle::Disc(disc) => {
            all_finite(&name("position_m"), &disc.position_m)?;
            all_finite(&name("velocity_mps"), &disc.velocity_mps)?;
            let [u, v] = disc.velocity_mps;
            check_manoeuvre(&name("manoeuvre"), disc.manoeuvre.as_ref(), [u, v, 0.0])?;
            check_on_the_map(&name("manoeuvre.legs"), disc.manoeuvre.as_ref())?;
            positive(&name("radius_m"), disc.radius_m)
        }
        Obstacle::Cylinder(cylinder) => {
            all_finite(&name("position_m"), &cylinder.position_m)?;
            all_finite(&name("velocity_mps"), &cylinder.velocity_mps)?;
            positive(&name("radius_m"), cylinder.radius_m)?;
            between(key, cylinder.top_m, cylinder.bottom_m)
        }
        Obstacle::Superquadric(shape) => {
            all_finite(&name("position_m"), &shape.position_m)?;
            all_finite(&name("velocity_mps"), &shape.velocity_mps)?;
            for axis in 0..3 {
                positive(&name("semi_axes_m"), shape.semi_axes_m[axis])?;
                if !(1.0..=100.0).contains(&shape.exponents[axis]) {
                    return Err(WorldError::key(name("exponents"), shape.exponents[axis], "must lie in 1 .. 100"));
                }
            }
            Ok(())
        }
        Obstacle::Polygon(shape) => {
            for vertex in &shape.vertices_m {
                all_finite(&name("vertices_m"), vertex)?;
            }
            all_finite(&name("velocity_mps"), &shape.velocity_mps)?;
            between(key, shape.top_m, shape.bottom_m)?;
            polygon::check_simple(&shape.vertices_m).map_err(|rule| {
                WorldError::key(name("vertices_m"), format!("{} corners", shape.vertices_m.len()), rule)
            })
        }
    }
}

impl Current {
    /// Number of vortices in it.
    pub fn vortex_count(&self) -> usize {
        match self {
            Self::Vortices(vortices) => vortices.vortices.len(),
            _ => 0,
        }
    }
}

impl Change {
    /// Path length between changes (m).
    pub fn every_m(&self) -> f64 {
        match self {
            Self::Table(table) => table.every_m,
            Self::Redraw(redraw) => redraw.every_m,
        }
    }

    /// The margin that holds an obstacle in place, and whom it protects.
    pub fn hold(&self) -> (f64, Hold) {
        match self {
            Self::Table(table) => (table.hold_margin_m, table.hold),
            Self::Redraw(redraw) => (redraw.hold_margin_m, Hold::All),
        }
    }
}
