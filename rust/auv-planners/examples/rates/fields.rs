//! Dense fields of superquadrics, and whether a line meets one.

use std::path::Path;

use auv_planners::{Control, Plan, plan};
use auv_world::math::{Vec3, add_scaled, distance, sub};
use auv_world::rng::{Purpose, Stream};
use auv_world::scenario::{Obstacle, Superquadric};
use auv_world::{Scenario, World};

use super::Failure;

/// What came of one field.
pub struct Line {
    /// Whether it met a surface.
    pub met: bool,
    /// Whether it arrived.
    pub arrived: bool,
    /// Lines drawn until then.
    pub lines: u64,
}

/// Worlds of twelve superquadrics.
pub fn fields(count: u64) -> Result<Vec<World>, Failure> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../auvgym/scenarios/iifds-static-dense.toml");
    let frame = Scenario::load(&path)?;
    (0..count).map(|seed| field(&frame, seed)).collect()
}

/// One line through a field at steps of so many seconds at 2 m/s, with random coefficients; `flow` in JSON.
pub fn line(world: &World, seconds: f64, flow: &str, retry: bool) -> Result<Line, Failure> {
    let mut stream = Stream::new(world.seed(), Purpose::Planner, 100);
    let [rho, sigma] = [(); 2].map(|()| stream.uniform(1.0, 3.0));
    let theta = stream.uniform(0.0, std::f64::consts::PI);
    let comma = if flow.is_empty() { "" } else { "," };
    let parameters = format!(
        r#"{{"rho": {rho}, "sigma": {sigma}, "theta": {theta}, "retry": {retry}, "cost": "time",
            "cost_options": {{"collision": "segment"}},
            "flow": {{"step_m": {}, "unit_m": 1000 {comma} {flow}}}}}"#,
        2.0 * seconds
    );
    let mission = world.mission();
    let found = plan("iifds", world, mission.start_m, mission.goal_m, 0, &parameters, &Control::none())?;
    let last = found.waypoints[found.waypoints.len() - 2];
    let arrived = distance(last, mission.goal_m) <= 2.0 * seconds;
    Ok(Line { met: touches(world, &found), arrived, lines: found.evaluations })
}

/// Twelve superquadrics of four kinds on the sea floor of 10 x 11 km, not over start or goal.
fn field(frame: &Scenario, seed: u64) -> Result<World, Failure> {
    let mut stream = Stream::new(seed, Purpose::Family, 100);
    let (mission, depth) = (&frame.missions[0], frame.domain.max_m[2]);
    let mut obstacles = Vec::new();
    while obstacles.len() < 12 {
        let position_m = [stream.uniform(0.5e3, 9.5e3), stream.uniform(0.5e3, 10.5e3), depth];
        let width = stream.uniform(0.8e3, 1.5e3);
        let semi_axes_m = [width, width * stream.uniform(0.8, 1.0), stream.uniform(1.3e3, 2.4e3)];
        let exponents = [[2.0; 3], [2.0, 2.0, 8.0], [8.0; 3], [2.0, 2.0, 1.0]][stream.below(4)];
        let away = |p: Vec3| distance([p[0], p[1], depth], position_m) > 1.5 * width;
        if away(mission.start_m) && away(mission.goal_m) {
            let velocity_mps = [0.0; 3];
            obstacles.push(Obstacle::Superquadric(Superquadric { position_m, semi_axes_m, exponents, velocity_mps }));
        }
    }
    Ok(World::new(Scenario { obstacles, currents: Vec::new(), ..frame.clone() }, seed, 0)?)
}

/// Whether any of many points of the line lies in an obstacle; the leg to the goal aside, which a line
/// that did not arrive ends with.
fn touches(world: &World, plan: &Plan) -> bool {
    let line = &plan.waypoints[..plan.waypoints.len() - 1];
    line.windows(2)
        .any(|leg| (0..8).any(|k| is_solid(world, add_scaled(leg[0], 0.125 * f64::from(k), sub(leg[1], leg[0])))))
}

fn is_solid(world: &World, point: Vec3) -> bool {
    world.scenario().obstacles.iter().any(|obstacle| {
        let Obstacle::Superquadric(shape) = obstacle else { return false };
        let offset = sub(point, shape.position_m);
        let scaled: Vec3 = std::array::from_fn(|axis| (offset[axis] / shape.semi_axes_m[axis]).abs());
        scaled.iter().all(|q| *q <= 1.0)
            && (0..3).map(|axis| scaled[axis].powf(shape.exponents[axis])).sum::<f64>() < 1.0
    })
}
