//! `lfhh-2d` and `lfhh-3d`: worlds like those of the LFHH paper, a sea surface with discs or a box with
//! spheres over peaks; vortices; a map that changes every 6 km travelled. The `debiased` variant, the
//! default, draws everything evenly over the box and the vortices' senses at random; the `paper` variant
//! keeps the papers' distributions, whose equal-signed vortices round x = 13.5 km make the east side
//! flow to the goal.

use super::{Difficulty, Parameters, Variant, few, not_negative};
use crate::currents::{RING_SPEED, VortexField, scale_to_peak};
use crate::error::WorldError;
use crate::math::{Vec2, Vec3, distance};
use crate::rng::{Purpose, Stream};
use crate::scenario::{
    Change, Current, Disc, Domain, Limits, Mission, Obstacle, Peak, Peaks, Redraw, SCHEMA, Scenario, Seabed,
    SectionFrame, Sections, Sphere, Vehicle, Vortex, VortexDraw, Vortices,
};
use crate::seabed::PeakFloor;

const KM: f64 = 1000.0;
const WIDTH: f64 = 20.0 * KM;
const LENGTH: f64 = 40.0 * KM;
const DEPTH: f64 = 20.0 * KM;
/// Start and goal keep this above the sea floor, and obstacles keep it from start, goal and vehicle (m).
const MARGIN: f64 = 0.9 * KM;
const CORE_RADIUS: f64 = 1.2 * KM;

/// What a difficulty stands for: current ratio (paper variant: ring ratio) and time factor, calibrated so
/// that at `normal` the straight line succeeds in less than 20 %, the sonar rule in less than 80 % and the
/// snapshot re-planner in more than 90 % of the debiased worlds.
fn calibration(dimensions: u8, variant: Variant, difficulty: Difficulty) -> (f64, f64) {
    use Difficulty::{Easy, Hard, Normal};
    match (variant, difficulty, dimensions) {
        (Variant::Paper, Easy, _) => (0.1, 1.5),
        (Variant::Paper, Normal, _) => (0.4, 1.5),
        (Variant::Paper, Hard, _) => (0.7, 1.5),
        (Variant::Debiased, Easy, _) => (0.2, 1.5),
        (Variant::Debiased, Normal, 2) => (0.8, 1.25),
        (Variant::Debiased, Normal, _) => (0.8, 1.3),
        (Variant::Debiased, Hard, 2) => (1.2, 1.3),
        (Variant::Debiased, Hard, _) => (1.2, 1.4),
    }
}

/// Draws a scenario of 2 or 3 dimensions.
///
/// # Errors
/// [`WorldError`] for a parameter that is not allowed, by name.
pub(super) fn draw(family: &str, dimensions: u8, seed: u64, parameters: &Parameters) -> Result<Scenario, WorldError> {
    Draw::new(dimensions, seed, parameters)?.scenario(family, seed)
}

/// One scenario being drawn.
struct Draw<'a> {
    dimensions: u8,
    parameters: &'a Parameters,
    stream: Stream,
    speed: f64,
    ratio: f64,
    ring: bool,
    time_factor: f64,
}

impl<'a> Draw<'a> {
    fn new(dimensions: u8, seed: u64, parameters: &'a Parameters) -> Result<Self, WorldError> {
        let (ratio, time_factor) = calibration(dimensions, parameters.variant, parameters.difficulty);
        few("obstacles", parameters.obstacles)?;
        few("vortices", parameters.vortices)?;
        few("peaks", parameters.peaks)?;
        if dimensions == 2 && parameters.peaks.is_some() {
            return Err(WorldError::parameter("peaks", "given", "only lfhh-3d has a seabed with peaks"));
        }
        if parameters.current_ratio.is_some() && parameters.ring_ratio.is_some() {
            return Err(WorldError::parameter("ring_ratio", "given", "give current_ratio or ring_ratio, not both"));
        }
        for (name, value) in [
            ("change_every_m", parameters.change_every_m),
            ("obstacle_speed_mps", parameters.obstacle_speed_mps),
            ("vortex_drift_mps", parameters.vortex_drift_mps),
        ] {
            not_negative(name, value, 0.0)?;
        }
        let ring = parameters.ring_ratio.is_some()
            || (parameters.variant == Variant::Paper && parameters.current_ratio.is_none());
        Ok(Self {
            dimensions,
            parameters,
            stream: Stream::new(seed, Purpose::Family, u32::from(dimensions)),
            speed: not_negative("vehicle_speed_mps", parameters.vehicle_speed_mps, 2.0)?,
            ratio: not_negative("current_ratio", parameters.current_ratio.or(parameters.ring_ratio), ratio)?,
            ring,
            time_factor: not_negative("time_factor", parameters.time_factor, time_factor)?,
        })
    }

    fn scenario(mut self, family: &str, seed: u64) -> Result<Scenario, WorldError> {
        let seabed = (self.dimensions == 3).then(|| self.seabed());
        let mission = self.mission(seabed.as_ref())?;
        let obstacles = self.obstacles(&mission)?;
        let vortex_draw = self.vortex_draw();
        let vortices = self.vortices(&vortex_draw);
        let every = self.parameters.change_every_m.unwrap_or(6.0 * KM);
        let redraw = Redraw {
            every_m: every,
            hold_margin_m: MARGIN,
            obstacle_step_m: if self.dimensions == 2 { 700.0 } else { 500.0 },
            vortices: Some(vortex_draw),
        };
        let change = (every > 0.0).then_some(Change::Redraw(redraw));
        let depth = if self.dimensions == 2 { 0.0 } else { DEPTH };
        let scenario = Scenario {
            schema: SCHEMA,
            name: format!("{family}-seed-{seed}"),
            description: String::new(),
            family: family.into(),
            dimensions: self.dimensions,
            notes: Vec::new(),
            domain: Domain { min_m: [0.0; 3], max_m: [WIDTH, LENGTH, depth], margin_m: 500.0 },
            limits: Limits { time_factor: self.time_factor, ..Limits::default() },
            vehicle: Vehicle { speed_mps: self.speed, ..Vehicle::default() },
            episode: crate::scenario::Episode::default(),
            sections: Some(Sections {
                count: 40,
                frame: SectionFrame::Domain,
                spacing_m: Some(KM),
                half_width_m: None,
                cell_m: KM,
            }),
            projection: None,
            seabed: seabed.map(Seabed::Peaks),
            change,
            missions: vec![mission],
            currents: vec![Current::Vortices(vortices)],
            obstacles,
        };
        Ok(scenario)
    }

    fn seabed(&mut self) -> Peaks {
        let stream = &mut self.stream;
        let peak = |_| Peak {
            x_m: stream.uniform(0.0, WIDTH),
            y_m: stream.uniform(0.0, LENGTH),
            height_m: stream.uniform(6.0 * KM, 15.0 * KM),
            a: stream.uniform(0.6, 1.2),
            b: stream.uniform(0.6, 1.2),
            sigma_m: stream.uniform(1.5 * KM, 2.8 * KM),
        };
        Peaks { floor_depth_m: DEPTH, peaks: (0..self.parameters.peaks.unwrap_or(12)).map(peak).collect() }
    }

    /// Start on the near side, goal 39 km away on the far one, both clear of the sea floor.
    fn mission(&mut self, seabed: Option<&Peaks>) -> Result<Mission, WorldError> {
        let floor = seabed.map(PeakFloor::new);
        let mut place = |y: f64| {
            for _ in 0..1000 {
                let x = self.stream.uniform(3.0 * KM, 17.0 * KM);
                let Some(floor) = &floor else { return Ok([x, y, 0.0]) };
                // The papers' heights 4 .. 18 km above the deepest floor.
                let z = DEPTH - self.stream.uniform(4.0 * KM, 18.0 * KM);
                if floor.depth(x, y) - z > MARGIN {
                    return Ok([x, y, z]);
                }
            }
            Err(WorldError::parameter("peaks", "so many", "leave no room for start and goal"))
        };
        Ok(Mission { start_m: place(0.0)?, goal_m: place(39.0 * KM)? })
    }

    fn obstacles(&mut self, mission: &Mission) -> Result<Vec<Obstacle>, WorldError> {
        let flat = self.dimensions == 2;
        let count = self.parameters.obstacles.unwrap_or(if flat { 22 } else { 70 });
        let speed = self.parameters.obstacle_speed_mps.unwrap_or(0.0);
        let mut obstacles = Vec::with_capacity(count);
        let mut tries = 0;
        while obstacles.len() < count {
            tries += 1;
            if tries > 1000 * (count + 1) {
                return Err(WorldError::parameter("obstacles", count, "leave no room for start and goal"));
            }
            let (centre, radius) = self.obstacle();
            let clear = |point: Vec3| distance(centre, point) >= radius + MARGIN;
            if !(clear(mission.start_m) && clear(mission.goal_m)) {
                continue;
            }
            let velocity = self.velocity(speed);
            obstacles.push(if flat {
                let [x, y, _] = centre;
                Obstacle::Disc(Disc { position_m: [x, y], radius_m: radius, velocity_mps: [velocity[0], velocity[1]] })
            } else {
                Obstacle::Sphere(Sphere { position_m: centre, radius_m: radius, velocity_mps: velocity })
            });
        }
        Ok(obstacles)
    }

    fn obstacle(&mut self) -> (Vec3, f64) {
        let stream = &mut self.stream;
        match (self.dimensions, self.parameters.variant) {
            (2, Variant::Paper) => {
                let x = stream.normal(10.0 * KM, 4.0 * KM).clamp(0.0, WIDTH);
                let y = stream.normal(20.0 * KM, 9.0 * KM).clamp(0.0, LENGTH);
                ([x, y, 0.0], stream.uniform(0.8 * KM, 1.6 * KM))
            }
            (2, Variant::Debiased) => {
                let x = stream.uniform(0.0, WIDTH);
                let y = stream.normal(20.0 * KM, 9.0 * KM).clamp(0.0, LENGTH);
                ([x, y, 0.0], stream.uniform(0.8 * KM, 1.6 * KM))
            }
            _ => {
                let centre = [stream.uniform(0.0, WIDTH), stream.uniform(0.0, LENGTH), stream.uniform(0.0, DEPTH)];
                (centre, stream.uniform(1.5 * KM, 3.0 * KM))
            }
        }
    }

    /// A velocity of the given speed in a random direction.
    fn velocity(&mut self, speed: f64) -> Vec3 {
        if speed == 0.0 {
            return [0.0; 3];
        }
        let heading = self.stream.uniform(0.0, std::f64::consts::TAU);
        let climb = if self.dimensions == 3 { self.stream.uniform(-1.0, 1.0) } else { 0.0 };
        let level = speed * (1.0 - climb * climb).sqrt();
        [level * libm::cos(heading), level * libm::sin(heading), speed * climb]
    }

    fn vortex_draw(&self) -> VortexDraw {
        let paper = self.parameters.variant == Variant::Paper;
        VortexDraw {
            x_normal_m: paper.then_some([13.5 * KM, 5.0 * KM]),
            y_normal_m: Some([20.0 * KM, 10.0 * KM]),
            random_sign: !paper,
            peak_speed_mps: (!self.ring).then_some(self.ratio * self.speed),
        }
    }

    fn vortices(&mut self, draw: &VortexDraw) -> Vortices {
        let drift = self.parameters.vortex_drift_mps.unwrap_or(0.0);
        let ring = self.ratio * self.speed * std::f64::consts::TAU * CORE_RADIUS / RING_SPEED;
        let mut field = VortexField::default();
        let mut drifts: Vec<Vec2> = Vec::new();
        for _ in 0..self.parameters.vortices.unwrap_or(6) {
            let (centre, sign) = draw.sample(&mut self.stream, [0.0, 0.0], [WIDTH, LENGTH]);
            field.push(centre, sign * if self.ring { ring } else { 1.0 }, CORE_RADIUS);
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
        Vortices { core_radius_m: CORE_RADIUS, vortices }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::World;
    use crate::families::generate;

    #[test]
    fn the_fastest_current_is_the_ratio() {
        let parameters = Parameters { current_ratio: Some(0.5), ..Parameters::default() };
        let mut world = World::new(generate("lfhh-2d", 5, &parameters).unwrap(), 5, 0).unwrap();
        for _ in 0..3 {
            let mut fastest = 0.0_f64;
            for i in 0..200 {
                for j in 0..400 {
                    let [u, v] = world.current([f64::from(i) * 100.0, f64::from(j) * 100.0, 0.0]);
                    fastest = fastest.max((u * u + v * v).sqrt());
                }
            }
            // Sampled at eight points a ring: a little more in between.
            assert!((0.99..1.15).contains(&fastest), "{fastest}");
            assert!(world.apply_change([10_000.0, 20_000.0, 0.0]));
        }
    }

    #[test]
    fn a_change_keeps_away_from_the_vehicle() {
        let mut world = World::new(generate("lfhh-3d", 8, &Parameters::default()).unwrap(), 8, 0).unwrap();
        let vehicle = world.mission().start_m;
        let before = world.spheres().clearance(vehicle);
        assert!(before >= MARGIN);
        for _ in 0..50 {
            world.apply_change(vehicle);
            assert!(world.spheres().clearance(vehicle) >= MARGIN - 1e-9);
            assert!(world.spheres().clearance(world.mission().goal_m) >= MARGIN - 1e-9);
        }
    }
}
