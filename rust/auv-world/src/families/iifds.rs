//! `iifds`: threats that cross the vehicle's way, after Yao & Zhao (2018): a box of 10 x 10 x 4 km, a way
//! from corner to corner, spheres on courses that meet it, and a meandering jet.

use super::{Difficulty, Manoeuvres, Parameters, few, not_negative};
use crate::error::WorldError;
use crate::math::{Vec3, add_scaled, distance, sub};
use crate::rng::{Purpose, Stream};
use crate::scenario::{
    Current, Domain, Episode, Jet, Limits, Manoeuvre, Mission, Obstacle, SCHEMA, Scenario, Sphere, Vehicle,
};

const KM: f64 = 1000.0;
const SIDE: f64 = 10.0 * KM;
const DEPTH: f64 = 4.0 * KM;
/// Start and goal lie so deep (m).
const LEVEL: f64 = 3.0 * KM;
/// Threats begin this clear of start and goal (m).
const MARGIN: f64 = 0.9 * KM;
/// Threats aim at a point no farther beside the way than this (m).
const BESIDE: f64 = 0.7 * KM;
/// Noise of seen threats (m): that of the set whose success rates are known with noise.
const NOISE: f64 = 20.0;
/// Looks along a threat's course at whether it keeps to the box.
const LOOKS: u32 = 32;
/// Tries before the box counts as full.
const TRIES: usize = 1000;

/// Threats, the greatest speed of one (m/s), the jet's over the vehicle's, and the time factor: such that at
/// normal the straight line seldom arrives, the sonar rule in less than 80 %, and the flow's law of motion among
/// threats nearly always.
fn calibration(difficulty: Difficulty) -> (usize, f64, f64, f64) {
    match difficulty {
        Difficulty::Easy => (3, 1.0, 0.2, 1.5),
        Difficulty::Normal => (6, 3.5, 0.5, 1.75),
        Difficulty::Hard => (10, 4.0, 0.7, 2.0),
    }
}

/// Draws a scenario.
///
/// # Errors
/// [`WorldError`] for a parameter that is not allowed, by name.
pub(super) fn draw(seed: u64, parameters: &Parameters) -> Result<Scenario, WorldError> {
    few("obstacles", parameters.obstacles)?;
    for (name, given) in [
        ("vortices", parameters.vortices.is_some()),
        ("peaks", parameters.peaks.is_some()),
        ("ring_ratio", parameters.ring_ratio.is_some()),
        ("change_every_m", parameters.change_every_m.is_some()),
        ("vortex_drift_mps", parameters.vortex_drift_mps.is_some()),
        ("vessels", parameters.vessels.is_some()),
    ] {
        if given {
            return Err(WorldError::parameter(name, "given", "iifds has threats and a jet, which never change"));
        }
    }
    let (threats, fastest, ratio, time_factor) = calibration(parameters.difficulty);
    let fastest = not_negative("obstacle_speed_mps", parameters.obstacle_speed_mps, fastest)?;
    let ratio = not_negative("current_ratio", parameters.current_ratio, ratio)?;
    let speed = not_negative("vehicle_speed_mps", parameters.vehicle_speed_mps, 2.0)?;
    let time_factor = not_negative("time_factor", parameters.time_factor, time_factor)?;
    let mission = Mission { start_m: [0.0, 0.0, LEVEL], goal_m: [SIDE, SIDE, LEVEL] };
    let mut stream = Stream::new(seed, Purpose::Family, 4);
    // In a stream of their own, so that they shift no other draw.
    let mut turns = Stream::new(seed, Purpose::Family, 6);
    let manoeuvres = parameters.manoeuvres.unwrap_or_default();
    let count = parameters.obstacles.unwrap_or(threats);
    let threats =
        (0..count).map(|_| threat(&mut stream, &mission, speed, fastest, || manoeuvre(&mut turns, manoeuvres)));
    let obstacles = threats.collect::<Option<Vec<_>>>();
    let obstacles = obstacles.ok_or_else(|| {
        WorldError::parameter("obstacle_speed_mps", fastest, "leaves no room for courses that begin in the box")
    })?;
    let jet = jet(&mut stream, ratio * speed);
    Ok(Scenario {
        schema: SCHEMA,
        name: format!("iifds-seed-{seed}"),
        description: String::new(),
        family: "iifds".into(),
        dimensions: 3,
        notes: Vec::new(),
        domain: Domain { min_m: [0.0; 3], max_m: [SIDE, SIDE, DEPTH], margin_m: 500.0 },
        limits: Limits { time_factor, ..Limits::default() },
        vehicle: Vehicle { speed_mps: speed, ..Vehicle::default() },
        episode: legs(not_negative("sensor_noise_m", parameters.sensor_noise_m, NOISE)?),
        sections: None,
        projection: None,
        seabed: None,
        change: None,
        missions: vec![mission],
        currents: if ratio > 0.0 { vec![Current::Jet(jet)] } else { Vec::new() },
        obstacles,
    })
}

/// Legs as short as a tick for who wants to decide at each, and never so long that a threat goes more than a
/// part of its radius meanwhile.
fn legs(sensor_noise_m: f64) -> Episode {
    Episode {
        tick_s: 3.0,
        reach_m: 600.0,
        capture_radius_m: 100.0,
        minimum_leg_s: 3.0,
        maximum_leg_s: 60.0,
        station_radius_m: 30.0,
        waypoint_margin_m: 100.0,
        sonar_range_m: 3.0 * KM,
        sensor_noise_m,
    }
}

/// A sphere whose course meets a vehicle that goes straight, or nearly so; `None` if there is no room.
fn threat(
    stream: &mut Stream,
    mission: &Mission,
    speed: f64,
    fastest: f64,
    mut manoeuvre: impl FnMut() -> Option<Manoeuvre>,
) -> Option<Obstacle> {
    let (start, goal) = (mission.start_m, mission.goal_m);
    let length = distance(start, goal);
    let along: Vec3 = std::array::from_fn(|axis| (goal[axis] - start[axis]) / length);
    (0..TRIES).find_map(|_| {
        let way = stream.uniform(0.25, 0.8) * length;
        let beside = stream.uniform(-BESIDE, BESIDE);
        let below = stream.uniform(-0.5, 0.5) * BESIDE;
        let heading = stream.uniform(0.0, std::f64::consts::TAU);
        let pace = stream.uniform(0.2, 1.0) * fastest;
        let radius_m = stream.uniform(0.5 * KM, KM);
        let meeting = add_scaled(add_scaled(start, way, along), beside, [along[1], -along[0], 0.0]);
        let meeting = [meeting[0], meeting[1], meeting[2] + below];
        let velocity_mps = [pace * libm::cos(heading), pace * libm::sin(heading), 0.0];
        let time = if speed > 0.0 { way / speed } else { 0.0 };
        let manoeuvre = manoeuvre();
        let (position_m, inside) = match &manoeuvre {
            None => {
                let begin = add_scaled(meeting, -time, velocity_mps);
                (begin, is_inside(begin))
            }
            // It must not meet a wall before the vehicle.
            Some(manoeuvre) => {
                let begin = sub(meeting, manoeuvre.travel(velocity_mps, time));
                let place = |part: f64| add_scaled(begin, 1.0, manoeuvre.travel(velocity_mps, part * time));
                (begin, (0..=LOOKS).all(|look| is_inside(place(f64::from(look) / f64::from(LOOKS)))))
            }
        };
        let clear = |end: Vec3| distance(end, position_m) >= radius_m + MARGIN;
        let fits = inside && clear(start) && clear(goal);
        fits.then_some(Obstacle::Sphere(Sphere { position_m, radius_m, velocity_mps, manoeuvre }))
    })
}

fn is_inside(place: Vec3) -> bool {
    (0..2).all(|axis| (0.0..=SIDE).contains(&place[axis]))
}

/// A circle of half an hour to three hours, or a zigzag of 20 to 60 degrees with a turn every 5 to 15 minutes.
fn manoeuvre(stream: &mut Stream, manoeuvres: Manoeuvres) -> Option<Manoeuvre> {
    let turns = match manoeuvres {
        Manoeuvres::None => return None,
        Manoeuvres::Turn => true,
        Manoeuvres::Zigzag => false,
        Manoeuvres::Mixed => stream.below(2) == 0,
    };
    let side = if stream.below(2) == 0 { -1.0 } else { 1.0 };
    Some(if turns {
        Manoeuvre::Turn { rate_radps: side * std::f64::consts::TAU / stream.uniform(1800.0, 10_800.0) }
    } else {
        let angle_rad = side * stream.uniform(20.0, 60.0_f64).to_radians();
        Manoeuvre::Zigzag { angle_rad, period_s: stream.uniform(600.0, 1800.0) }
    })
}

/// The paper's meander at any phase and of either sense.
fn jet(stream: &mut Stream, peak_speed_mps: f64) -> Jet {
    Jet {
        t: stream.uniform(0.0, 10.0),
        c: 1.2,
        k: stream.uniform(0.8, 1.0),
        e: 0.1,
        b0: stream.uniform(1.5, 2.2),
        omega: 0.4,
        chi: std::f64::consts::FRAC_PI_2,
        peak_speed_mps,
        length_scale_m: KM,
        time_scale_s: None,
        origin_m: [stream.uniform(0.0, SIDE), stream.uniform(0.0, SIDE)],
        heading_rad: stream.uniform(0.0, std::f64::consts::TAU),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::World;
    use crate::families::generate;

    #[test]
    fn threats_meet_the_straight_way() {
        for (seed, manoeuvres) in (0..50).flat_map(|seed| [Manoeuvres::None, Manoeuvres::Mixed].map(|m| (seed, m))) {
            let parameters = Parameters { obstacles: Some(1), manoeuvres: Some(manoeuvres), ..Parameters::default() };
            let mut world = World::new(generate("iifds", seed, &parameters).unwrap(), seed, 0).unwrap();
            let (start, goal) = (world.mission().start_m, world.mission().goal_m);
            let length = distance(start, goal);
            let nearest = (0..200).map(|i| {
                let part = f64::from(i) / 200.0;
                world.set_time(part * length / 2.0);
                world.clearance(std::array::from_fn(|axis| start[axis] + part * (goal[axis] - start[axis])))
            });
            // Aimed 700 m beside and 350 m above at most, and 500 m in radius at least.
            assert!(nearest.fold(f64::INFINITY, f64::min) < 300.0, "{seed}");
        }
    }

    #[test]
    fn manoeuvres_shift_no_other_draw_and_keep_to_box_and_speed() {
        let given = |manoeuvres| Parameters { manoeuvres: Some(manoeuvres), ..Parameters::default() };
        assert_eq!(
            generate("iifds", 4, &given(Manoeuvres::None)).unwrap(),
            generate("iifds", 4, &Parameters::default()).unwrap()
        );
        let kinds = [Manoeuvres::Turn, Manoeuvres::Zigzag, Manoeuvres::Mixed];
        let mut seen = [0; 2];
        for (seed, kind) in (0..20).zip(kinds.into_iter().cycle()) {
            let scenario = generate("iifds", seed, &given(kind)).unwrap();
            scenario.check().unwrap();
            for obstacle in &scenario.obstacles {
                seen[usize::from(matches!(obstacle.manoeuvre(), Some(Manoeuvre::Turn { .. })))] += 1;
            }
            let mut world = World::new(scenario, seed, 0).unwrap();
            let before: Vec<Vec3> = (0..3).map(|i| world.obstacle_position(i)).collect();
            let mut last = before.clone();
            for tick in 1..3000 {
                world.set_time(6.0 * f64::from(tick));
                for (i, last) in last.iter_mut().enumerate() {
                    let place = world.obstacle_position(i);
                    assert!(is_inside(place) && distance(place, *last) <= 6.0 * 3.5 + 1e-9);
                    *last = place;
                }
            }
            world.set_time(0.0);
            assert!((0..3).all(|i| world.obstacle_position(i) == before[i]));
        }
        assert!(seen[0] > 10 && seen[1] > 10);
        let peaks = generate("lfhh-3d", 1, &given(Manoeuvres::Turn)).unwrap_err().to_string();
        assert!(peaks.starts_with("manoeuvres"));
    }

    #[test]
    fn what_does_not_apply_is_refused() {
        let peaks = Parameters { peaks: Some(3), ..Parameters::default() };
        assert!(generate("iifds", 1, &peaks).unwrap_err().to_string().starts_with("peaks"));
        let still = Parameters { obstacle_speed_mps: Some(0.0), current_ratio: Some(0.0), ..Parameters::default() };
        let scenario = generate("iifds", 1, &still).unwrap();
        assert!(scenario.currents.is_empty() && scenario.obstacles.iter().all(|o| o.velocity_mps() == [0.0; 3]));
        let fast = Parameters { obstacle_speed_mps: Some(1e9), ..Parameters::default() };
        assert!(generate("iifds", 1, &fast).unwrap_err().to_string().starts_with("obstacle_speed_mps"));
    }
}
