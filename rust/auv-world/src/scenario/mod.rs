//! A scenario: everything a world is made of, as plain numbers. The types here are the file format,
//! schema 1; `check` says what is allowed, `file` reads and writes.

mod check;
mod data;
mod file;
mod manoeuvre;
mod obstacle;

pub use data::Data;
pub use obstacle::{Cylinder, Disc, Leg, Manoeuvre, Obstacle, Polygon, Sphere, Superquadric};
use serde::{Deserialize, Serialize};

use crate::math::{Vec2, Vec3};

/// The schema that this version reads and writes.
pub const SCHEMA: u32 = 1;

/// Everything a world is made of. SI units; positions (x, y, z) with z the depth, positive down.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// The version of the file format: 1.
    pub schema: u32,
    /// A short name.
    pub name: String,
    /// What it is, in a sentence.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// The family that it belongs to.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub family: String,
    /// 2 (a plane at one depth) or 3.
    pub dimensions: u8,
    /// What a loader decided, in sentences.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// The box of the world.
    pub domain: Domain,
    /// How success and failure are judged.
    #[serde(default)]
    pub limits: Limits,
    /// The vehicle.
    #[serde(default)]
    pub vehicle: Vehicle,
    /// How one environment step is flown.
    #[serde(default)]
    pub episode: Episode,
    /// The sections that section planners put their waypoints on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sections: Option<Sections>,
    /// Where local metres lie on the Earth.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub projection: Option<Projection>,
    /// The sea floor; without it the box ends below in rock (3-D) or in nothing (2-D).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seabed: Option<Seabed>,
    /// What happens when the vehicle has travelled a given distance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub change: Option<Change>,
    /// Start and goal, at least one pair.
    pub missions: Vec<Mission>,
    /// Currents; they superpose.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub currents: Vec<Current>,
    /// Solid obstacles.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub obstacles: Vec<Obstacle>,
}

/// The box of the world.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Domain {
    /// The lowest x, y, z (m).
    pub min_m: Vec3,
    /// The highest x, y, z (m).
    pub max_m: Vec3,
    /// Out of bounds is beyond this outside the box (m).
    #[serde(default = "default_margin")]
    pub margin_m: f64,
}

fn default_margin() -> f64 {
    500.0
}

/// A start and a goal.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mission {
    /// Where the vehicle starts (m).
    pub start_m: Vec3,
    /// Where it shall go (m).
    pub goal_m: Vec3,
}

/// How success and failure are judged.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Limits {
    /// Arrived within this of the goal (m).
    pub goal_radius_m: f64,
    /// Time limit as a multiple of the still-water straight-line time.
    pub time_factor: f64,
    /// Energy budget as a multiple of the energy of that straight run.
    pub energy_factor: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { goal_radius_m: 300.0, time_factor: 1.5, energy_factor: 2.0 }
    }
}

/// A kinematic vehicle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Vehicle {
    /// Speed through water (m/s).
    pub speed_mps: f64,
    /// Fastest turn (rad/s).
    pub yaw_rate_radps: f64,
    /// Steepest climb or dive (rad).
    pub pitch_limit_rad: f64,
    /// Power drawn at rest (W).
    pub hotel_power_w: f64,
    /// Propulsion power over the cube of the speed (W s^3 / m^3).
    pub propulsion_w_per_mps3: f64,
}

impl Default for Vehicle {
    fn default() -> Self {
        Self {
            speed_mps: 2.0,
            yaw_rate_radps: 3.0_f64.to_radians(),
            pitch_limit_rad: std::f64::consts::FRAC_PI_2,
            hotel_power_w: 20.0,
            propulsion_w_per_mps3: 10.0,
        }
    }
}

impl Vehicle {
    /// Power (W) at a speed through water (m/s): hotel + propulsion * speed^3.
    pub fn power_w(&self, speed_mps: f64) -> f64 {
        self.hotel_power_w + self.propulsion_w_per_mps3 * speed_mps * speed_mps * speed_mps
    }
}

/// How one environment step (a leg to a waypoint) is flown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Episode {
    /// Physics step (s).
    pub tick_s: f64,
    /// An action of 1 puts the waypoint this far away (m).
    pub reach_m: f64,
    /// A waypoint is captured within this (m).
    pub capture_radius_m: f64,
    /// A leg lasts at least this (s), captured or not.
    pub minimum_leg_s: f64,
    /// A leg lasts at most this (s).
    pub maximum_leg_s: f64,
    /// Within this of the waypoint the vehicle keeps station (m).
    pub station_radius_m: f64,
    /// Waypoints are clipped this far inside the box in x and z (m).
    pub waypoint_margin_m: f64,
    /// The sonar sees this far (m).
    pub sonar_range_m: f64,
    /// Obstacles are seen where they are but for normal noise of this standard deviation along each axis (m).
    /// Without noise it is left out of the file.
    #[serde(skip_serializing_if = "is_zero")]
    pub sensor_noise_m: f64,
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

impl Default for Episode {
    fn default() -> Self {
        Self {
            tick_s: 15.0,
            reach_m: 2000.0,
            capture_radius_m: 200.0,
            minimum_leg_s: 60.0,
            maximum_leg_s: 1500.0,
            station_radius_m: 100.0,
            waypoint_margin_m: 300.0,
            sonar_range_m: 5000.0,
            sensor_noise_m: 0.0,
        }
    }
}

/// The sections that section planners put their waypoints on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sections {
    /// Number of sections; the first holds the start, the last the goal.
    pub count: usize,
    /// How the sections lie.
    #[serde(default)]
    pub frame: SectionFrame,
    /// Distance between sections (m); with `frame = "mission"` it follows from start and goal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spacing_m: Option<f64>,
    /// Lateral half width (m), `frame = "mission"` only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub half_width_m: Option<f64>,
    /// Edge of the cells of the section map (m).
    #[serde(default = "default_cell")]
    pub cell_m: f64,
}

fn default_cell() -> f64 {
    1000.0
}

/// How sections lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SectionFrame {
    /// Planes y = min_y + j * spacing.
    #[default]
    Domain,
    /// Planes perpendicular to the line from start to goal.
    Mission,
}

/// Spherical azimuthal equidistant projection (R = 6 371 008.8 m): local x east, y north of the centre.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Projection {
    /// Longitude of the centre (degrees east).
    pub longitude_deg: f64,
    /// Latitude of the centre (degrees north).
    pub latitude_deg: f64,
}

/// The sea floor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Seabed {
    /// One depth everywhere.
    Flat(Flat),
    /// Gaussian peaks on a flat floor (LFHH eq. 11).
    Peaks(Peaks),
    /// A grid of depths.
    Gridded(GriddedSeabed),
}

/// A flat floor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Flat {
    /// Its depth (m).
    pub depth_m: f64,
}

/// Gaussian peaks on a flat floor; the sea floor is the highest of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Peaks {
    /// Depth of the flat floor (m).
    pub floor_depth_m: f64,
    /// The peaks.
    pub peaks: Vec<Peak>,
}

/// A peak: height * exp(-((y - y0)^2 a^2 + (x - x0)^2 b^2) / (2 sigma^2)) above the floor (LFHH eq. 11).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Peak {
    /// x of the summit (m).
    pub x_m: f64,
    /// y of the summit (m).
    pub y_m: f64,
    /// Height above the floor (m).
    pub height_m: f64,
    /// Shape along y.
    pub a: f64,
    /// Shape along x.
    pub b: f64,
    /// Width (m).
    pub sigma_m: f64,
}

/// Horizontal axes of a grid: either metres or degrees.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GriddedSeabed {
    /// x of the columns (m), ascending.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x_m: Option<Vec<f64>>,
    /// y of the rows (m), ascending.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub y_m: Option<Vec<f64>>,
    /// Longitude of the columns (degrees east), ascending; needs a projection.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub longitude_deg: Option<Vec<f64>>,
    /// Latitude of the rows (degrees north), ascending.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub latitude_deg: Option<Vec<f64>>,
    /// Depth of the floor (m), positive down, land <= 0; C order (y, x).
    pub depth_m: Data,
}

/// A current.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Current {
    /// The same everywhere.
    Uniform(Uniform),
    /// Lamb-Oseen vortices (LFHH eq. 3-5).
    Vortices(Vortices),
    /// A meandering jet (IIFDS eq. 16-18).
    Jet(Jet),
    /// A grid in space and time.
    Gridded(GriddedCurrent),
}

/// A uniform current.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Uniform {
    /// Velocity (m/s).
    pub velocity_mps: Vec2,
}

/// Lamb-Oseen vortices with one core radius.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Vortices {
    /// Core radius zeta (m).
    pub core_radius_m: f64,
    /// The vortices.
    pub vortices: Vec<Vortex>,
}

/// A Lamb-Oseen vortex.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Vortex {
    /// x of the centre (m).
    pub x_m: f64,
    /// y of the centre (m).
    pub y_m: f64,
    /// Circulation eta (m^2/s), positive from x towards y.
    pub circulation_m2ps: f64,
    /// Velocity of the centre (m/s), reflecting at the walls.
    #[serde(default)]
    pub drift_mps: Vec2,
}

/// A meandering jet: stream function F = 1 - tanh((y - b cos(k (x - c t))) / sqrt(1 + k^2 b^2 sin^2(k (x - c t))))
/// with b = b0 + e cos(omega t + chi); lengths in units of `length_scale_m`, times of `time_scale_s`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Jet {
    /// Time at the start of the episode, in units.
    pub t: f64,
    /// Phase speed, in units.
    pub c: f64,
    /// Wave number, in units.
    pub k: f64,
    /// Amplitude of the meander's breathing, in units.
    pub e: f64,
    /// Mean meander amplitude, in units.
    pub b0: f64,
    /// Frequency of the breathing, in units.
    pub omega: f64,
    /// Phase of the breathing (rad).
    pub chi: f64,
    /// Speed on the centre line (m/s).
    pub peak_speed_mps: f64,
    /// Metres to one unit of length.
    pub length_scale_m: f64,
    /// Seconds to one unit of time; without it the jet is frozen at `t`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_scale_s: Option<f64>,
    /// Where the jet's own origin lies (m).
    #[serde(default)]
    pub origin_m: Vec2,
    /// Direction of the jet's own x axis, from x towards y (rad).
    #[serde(default)]
    pub heading_rad: f64,
}

/// A current on a grid, linear in between, NaN where it is missing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GriddedCurrent {
    /// x of the columns (m), ascending.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x_m: Option<Vec<f64>>,
    /// y of the rows (m), ascending.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub y_m: Option<Vec<f64>>,
    /// Longitude of the columns (degrees east), ascending; needs a projection.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub longitude_deg: Option<Vec<f64>>,
    /// Latitude of the rows (degrees north), ascending.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub latitude_deg: Option<Vec<f64>>,
    /// Depths of the levels (m), ascending; without it the same at all depths.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth_m: Option<Vec<f64>>,
    /// Times of the slices (s from the start of the episode), ascending; without it steady.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_s: Option<Vec<f64>>,
    /// Velocity along x, or eastward with degrees (m/s); C order (time, depth, y, x).
    pub u_mps: Data,
    /// Velocity along y, or northward with degrees (m/s); C order (time, depth, y, x).
    pub v_mps: Data,
}

/// The papers' map change: positions are drawn anew when the vehicle has travelled a given distance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Change {
    /// Positions from a table; after its last phase nothing changes any more.
    Table(ChangeTable),
    /// Obstacles take a normal step, vortices are drawn anew.
    Redraw(Redraw),
}

/// A table of positions, a phase for each change.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChangeTable {
    /// Path length between changes (m).
    pub every_m: f64,
    /// An obstacle stays where it is if its new place is nearer than its extent + this to the vehicle,
    /// the start or the goal (m).
    pub hold_margin_m: f64,
    /// Whom the hold margin protects.
    #[serde(default)]
    pub hold: Hold,
    /// Positions after the first, second, ... change.
    pub phases: Vec<Phase>,
}

/// Whom the hold margin protects.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Hold {
    /// Vehicle, start and goal.
    #[default]
    All,
    /// The vehicle only, as in the papers' maps.
    Vehicle,
}

/// Positions after a change.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Phase {
    /// Position of each obstacle (m), in order.
    pub obstacles_m: Vec<Vec3>,
    /// Centre of each vortex (m), in order over all currents of that kind.
    pub vortices_m: Vec<Vec2>,
}

/// Positions drawn anew.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Redraw {
    /// Path length between changes (m).
    pub every_m: f64,
    /// As in a table (m).
    pub hold_margin_m: f64,
    /// Standard deviation of an obstacle's step along each axis (m).
    pub obstacle_step_m: f64,
    /// How vortex centres are drawn; without it they stay.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub vortices: Option<VortexDraw>,
}

/// How vortices are drawn.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VortexDraw {
    /// Along x: uniform over the box if absent, else normal (mean, standard deviation) and clipped (m).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x_normal_m: Option<Vec2>,
    /// Along y, likewise (m).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub y_normal_m: Option<Vec2>,
    /// Whether the sense of rotation is drawn, too.
    #[serde(default)]
    pub random_sign: bool,
    /// If given, circulations are scaled so that the fastest summed current, sampled on the vortices'
    /// rings of greatest speed, is this (m/s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub peak_speed_mps: Option<f64>,
}
