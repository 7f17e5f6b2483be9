//! Draws one scenario of a family.

use super::{Layout, Parameters, Variant, few, not_negative};
use crate::currents::{RING_SPEED, VortexField, scale_to_peak};
use crate::error::WorldError;
use crate::math::{Vec2, Vec3, distance};
use crate::rng::{Purpose, Stream};
use crate::scenario::{
    Change, Current, Disc, Domain, Episode, Limits, Mission, Obstacle, Peak, Peaks, Redraw, SCHEMA, Scenario, Seabed,
    SectionFrame, Sections, Sphere, Vehicle, Vortex, VortexDraw, Vortices,
};
use crate::seabed::PeakFloor;

/// The box, in units of the family.
const WIDTH: f64 = 20.0;
const LENGTH: f64 = 40.0;
const DEPTH: f64 = 20.0;
/// Start and goal keep this above the sea floor, and obstacles keep it from start, goal and vehicle.
pub const MARGIN: f64 = 0.9;
const CORE_RADIUS: f64 = 1.2;

/// One scenario being drawn.
pub struct Draw<'a> {
    layout: &'a Layout,
    parameters: &'a Parameters,
    stream: Stream,
    speed: f64,
    ratio: f64,
    ring: bool,
    time_factor: f64,
}

impl<'a> Draw<'a> {
    /// Checks the parameters.
    ///
    /// # Errors
    /// [`WorldError`] naming the one that is not allowed.
    pub fn new(layout: &'a Layout, seed: u64, parameters: &'a Parameters) -> Result<Self, WorldError> {
        let calibration = (layout.calibration)(parameters.variant, parameters.difficulty);
        few("obstacles", parameters.obstacles)?;
        few("vortices", parameters.vortices)?;
        few("peaks", parameters.peaks)?;
        if layout.dimensions == 2 && parameters.peaks.is_some() {
            return Err(WorldError::parameter("peaks", "given", "only families in 3-D have a seabed with peaks"));
        }
        if parameters.vessels.is_some() {
            return Err(WorldError::parameter("vessels", "given", "only harbor has vessels"));
        }
        if parameters.current_ratio.is_some() && parameters.ring_ratio.is_some() {
            return Err(WorldError::parameter("ring_ratio", "given", "give current_ratio or ring_ratio, not both"));
        }
        for (name, value) in [
            ("change_every_m", parameters.change_every_m),
            ("obstacle_speed_mps", parameters.obstacle_speed_mps),
            ("vortex_drift_mps", parameters.vortex_drift_mps),
            ("sensor_noise_m", parameters.sensor_noise_m),
        ] {
            not_negative(name, value, 0.0)?;
        }
        let ring = parameters.ring_ratio.is_some()
            || (parameters.variant == Variant::Paper && parameters.current_ratio.is_none());
        Ok(Self {
            layout,
            parameters,
            stream: Stream::new(seed, Purpose::Family, u32::from(layout.dimensions)),
            speed: not_negative("vehicle_speed_mps", parameters.vehicle_speed_mps, layout.speed_mps)?,
            ratio: not_negative(
                "current_ratio",
                parameters.current_ratio.or(parameters.ring_ratio),
                calibration.current_ratio,
            )?,
            ring,
            time_factor: not_negative("time_factor", parameters.time_factor, calibration.time_factor)?,
        })
    }

    /// The scenario.
    ///
    /// # Errors
    /// [`WorldError`] if there is no room for start, goal or obstacles.
    pub fn scenario(mut self, seed: u64) -> Result<Scenario, WorldError> {
        let Layout { name: family, dimensions, unit_m: unit, .. } = *self.layout;
        let seabed = (dimensions == 3).then(|| self.seabed());
        let mission = self.mission(seabed.as_ref())?;
        let obstacles = self.obstacles(&mission)?;
        let vortex_draw = self.vortex_draw();
        let vortices = self.vortices(&vortex_draw);
        let every = self.parameters.change_every_m.unwrap_or(self.layout.change_every * unit);
        let redraw = Redraw {
            every_m: every,
            hold_margin_m: MARGIN * unit,
            obstacle_step_m: self.layout.obstacle_step * unit,
            vortices: Some(vortex_draw),
        };
        let change = (every > 0.0).then_some(Change::Redraw(redraw));
        let depth = if dimensions == 2 { 0.0 } else { DEPTH };
        let scenario = Scenario {
            schema: SCHEMA,
            name: format!("{family}-seed-{seed}"),
            description: String::new(),
            family: family.into(),
            dimensions,
            notes: Vec::new(),
            domain: Domain {
                min_m: [0.0; 3],
                max_m: [WIDTH * unit, LENGTH * unit, depth * unit],
                margin_m: 0.5 * unit,
            },
            limits: Limits { goal_radius_m: 0.3 * unit, time_factor: self.time_factor, ..Limits::default() },
            vehicle: self.vehicle(),
            episode: self.episode(),
            sections: Some(Sections {
                count: 40,
                frame: SectionFrame::Domain,
                spacing_m: Some(unit),
                half_width_m: None,
                cell_m: unit,
            }),
            projection: None,
            seabed: seabed.map(Seabed::Peaks),
            change,
            missions: vec![mission],
            currents: if vortices.vortices.is_empty() { Vec::new() } else { vec![Current::Vortices(vortices)] },
            obstacles,
        };
        Ok(scenario)
    }

    /// How long a unit takes against LFHH's vehicle in a box of kilometres.
    fn pace(&self) -> f64 {
        (self.layout.unit_m / 1000.0) * (2.0 / self.layout.speed_mps)
    }

    fn vehicle(&self) -> Vehicle {
        let yaw_rate_radps = self.layout.yaw_rate_deg.to_radians();
        Vehicle { speed_mps: self.speed, yaw_rate_radps, ..Vehicle::default() }
    }

    /// LFHH's legs, in proportion to the box.
    fn episode(&self) -> Episode {
        let (length, time, legs) = (self.layout.unit_m / 1000.0, self.pace(), Episode::default());
        Episode {
            tick_s: legs.tick_s * time,
            reach_m: legs.reach_m * length,
            capture_radius_m: legs.capture_radius_m * length,
            minimum_leg_s: legs.minimum_leg_s * time,
            maximum_leg_s: legs.maximum_leg_s * time,
            station_radius_m: legs.station_radius_m * length,
            waypoint_margin_m: legs.waypoint_margin_m * length,
            sonar_range_m: legs.sonar_range_m * length,
            sensor_noise_m: self.parameters.sensor_noise_m.unwrap_or(0.0),
        }
    }

    fn seabed(&mut self) -> Peaks {
        let (stream, unit, [lowest, highest]) = (&mut self.stream, self.layout.unit_m, self.layout.peak_height);
        let peak = |_| Peak {
            x_m: stream.uniform(0.0, WIDTH * unit),
            y_m: stream.uniform(0.0, LENGTH * unit),
            height_m: stream.uniform(lowest * unit, highest * unit),
            a: stream.uniform(0.6, 1.2),
            b: stream.uniform(0.6, 1.2),
            sigma_m: stream.uniform(1.5 * unit, 2.8 * unit),
        };
        let count = self.parameters.peaks.unwrap_or(self.layout.peaks);
        Peaks { floor_depth_m: DEPTH * unit, peaks: (0..count).map(peak).collect() }
    }

    /// Start on the near side, goal 39 units away on the far one, both clear of the sea floor.
    fn mission(&mut self, seabed: Option<&Peaks>) -> Result<Mission, WorldError> {
        let (floor, unit) = (seabed.map(PeakFloor::new), self.layout.unit_m);
        let mut place = |y: f64| {
            for _ in 0..1000 {
                let x = self.stream.uniform(3.0 * unit, 17.0 * unit);
                let Some(floor) = &floor else { return Ok([x, y, 0.0]) };
                // The papers' heights 4 .. 18 above the deepest floor.
                let z = DEPTH * unit - self.stream.uniform(4.0 * unit, 18.0 * unit);
                if floor.depth(x, y) - z > MARGIN * unit {
                    return Ok([x, y, z]);
                }
            }
            Err(WorldError::parameter("peaks", "so many", "leave no room for start and goal"))
        };
        Ok(Mission { start_m: place(0.0)?, goal_m: place(39.0 * unit)? })
    }

    fn obstacles(&mut self, mission: &Mission) -> Result<Vec<Obstacle>, WorldError> {
        let flat = self.layout.dimensions == 2;
        let count = self.parameters.obstacles.unwrap_or(self.layout.obstacles[self.parameters.difficulty as usize]);
        let speed = self.parameters.obstacle_speed_mps.unwrap_or(0.0);
        let mut obstacles = Vec::with_capacity(count);
        let mut tries = 0;
        while obstacles.len() < count {
            tries += 1;
            if tries > 1000 * (count + 1) {
                return Err(WorldError::parameter("obstacles", count, "leave no room for start and goal"));
            }
            let (centre, radius) = self.obstacle();
            let clear = |point: Vec3| distance(centre, point) >= radius + MARGIN * self.layout.unit_m;
            if !(clear(mission.start_m) && clear(mission.goal_m)) {
                continue;
            }
            let velocity = self.velocity(speed);
            obstacles.push(if flat {
                let [x, y, _] = centre;
                Obstacle::Disc(Disc {
                    position_m: [x, y],
                    radius_m: radius,
                    velocity_mps: [velocity[0], velocity[1]],
                    manoeuvre: None,
                })
            } else {
                Obstacle::Sphere(Sphere {
                    position_m: centre,
                    radius_m: radius,
                    velocity_mps: velocity,
                    manoeuvre: None,
                })
            });
        }
        Ok(obstacles)
    }

    fn obstacle(&mut self) -> (Vec3, f64) {
        let (stream, unit, [least, most]) = (&mut self.stream, self.layout.unit_m, self.layout.radius);
        let centre = match (self.layout.dimensions, self.parameters.variant) {
            (2, Variant::Paper) => {
                let x = stream.normal(10.0 * unit, 4.0 * unit).clamp(0.0, WIDTH * unit);
                let y = stream.normal(20.0 * unit, 9.0 * unit).clamp(0.0, LENGTH * unit);
                [x, y, 0.0]
            }
            (2, Variant::Debiased) => {
                let x = stream.uniform(0.0, WIDTH * unit);
                let y = stream.normal(20.0 * unit, 9.0 * unit).clamp(0.0, LENGTH * unit);
                [x, y, 0.0]
            }
            _ => [WIDTH, LENGTH, DEPTH].map(|edge| stream.uniform(0.0, edge * unit)),
        };
        (centre, stream.uniform(least * unit, most * unit))
    }

    /// A velocity of the given speed in a random direction.
    fn velocity(&mut self, speed: f64) -> Vec3 {
        if speed == 0.0 {
            return [0.0; 3];
        }
        let heading = self.stream.uniform(0.0, std::f64::consts::TAU);
        let climb = if self.layout.dimensions == 3 { self.stream.uniform(-1.0, 1.0) } else { 0.0 };
        let level = speed * (1.0 - climb * climb).sqrt();
        [level * libm::cos(heading), level * libm::sin(heading), speed * climb]
    }

    fn vortex_draw(&self) -> VortexDraw {
        let (paper, unit) = (self.parameters.variant == Variant::Paper, self.layout.unit_m);
        VortexDraw {
            x_normal_m: paper.then_some([13.5 * unit, 5.0 * unit]),
            y_normal_m: Some([20.0 * unit, 10.0 * unit]),
            random_sign: !paper,
            peak_speed_mps: (!self.ring).then_some(self.ratio * self.speed),
        }
    }

    fn vortices(&mut self, draw: &VortexDraw) -> Vortices {
        let drift = self.parameters.vortex_drift_mps.unwrap_or(0.0);
        let unit = self.layout.unit_m;
        let core_radius_m = CORE_RADIUS * unit;
        let ring = self.ratio * self.speed * std::f64::consts::TAU * core_radius_m / RING_SPEED;
        let mut field = VortexField::default();
        let mut drifts: Vec<Vec2> = Vec::new();
        for _ in 0..self.parameters.vortices.unwrap_or(self.layout.vortices) {
            let (centre, sign) = draw.sample(&mut self.stream, [0.0, 0.0], [WIDTH * unit, LENGTH * unit]);
            field.push(centre, sign * if self.ring { ring } else { 1.0 }, core_radius_m);
            let heading = self.stream.uniform(0.0, std::f64::consts::TAU);
            drifts.push([drift * libm::cos(heading), drift * libm::sin(heading)]);
        }
        if let Some(peak) = draw.peak_speed_mps {
            scale_to_peak(&mut field, peak);
        }
        let vortices = drifts
            .into_iter()
            .enumerate()
            .map(|(i, drift_mps)| {
                let [x_m, y_m] = field.centre(i);
                Vortex { x_m, y_m, circulation_m2ps: field.circulation(i), drift_mps }
            })
            .collect();
        Vortices { core_radius_m, vortices }
    }
}
