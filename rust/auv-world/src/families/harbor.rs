//! `harbor`: basins of 200 x 200 m with polygons that need not be convex and may overlap or reach the walls, in
//! a uniform current, as Huang & Jin (2021) have them. A way from start to goal always exists, and is never
//! straight. Vessels, if asked for, cross the basin at constant velocity.

use std::f64::consts::TAU;

use super::{Difficulty, Parameters, few, not_negative};
use crate::error::WorldError;
use crate::math::{Vec2, Vec3, distance};
use crate::obstacles::polygon::Prism;
use crate::obstacles::{Solid, Solids};
use crate::rng::{Purpose, Stream};
use crate::scenario::{
    Current, Disc, Domain, Episode, Limits, Mission, Obstacle, Polygon, SCHEMA, Scenario, SectionFrame, Sections,
    Uniform, Vehicle,
};

/// The box (m).
const SIDE: f64 = 200.0;
/// A metre here is so many of LFHH's.
const SCALE: f64 = 0.01;
/// Start and goal keep this clear of polygons (m).
const MARGIN: f64 = 12.0;
/// The way that must exist keeps this clear of polygons (m), looked at on a grid this fine.
const PASSAGE: f64 = 4.0;
const CELL: f64 = 2.0;
/// That this much is clear (m) is worth finding out: some cells ahead are then known to be.
const AHEAD: f64 = 16.0;
/// Radius of vessels (m), and the fastest one's speed over the vehicle's unless told; the slowest has half of it.
const VESSEL: [f64; 2] = [4.0, 8.0];
const VESSEL_RATIO: f64 = 0.6;
/// Vessels begin this clear of start and goal (m).
const VESSEL_MARGIN: f64 = 25.0;
/// Maps drawn before there counts as being no way.
const TRIES: usize = 200;

/// Number of polygons, current over the vehicle's speed, and the time factor.
fn calibration(difficulty: Difficulty) -> (usize, f64, f64) {
    match difficulty {
        Difficulty::Easy => (8, 0.1, 2.0),
        Difficulty::Normal => (14, 0.2, 2.0),
        Difficulty::Hard => (20, 0.5, 2.5),
    }
}

/// Draws a scenario.
///
/// # Errors
/// [`WorldError`] for a parameter that is not allowed, by name.
pub(super) fn draw(seed: u64, parameters: &Parameters) -> Result<Scenario, WorldError> {
    few("obstacles", parameters.obstacles)?;
    few("vessels", parameters.vessels)?;
    for (name, given) in [
        ("vortices", parameters.vortices.is_some()),
        ("peaks", parameters.peaks.is_some()),
        ("ring_ratio", parameters.ring_ratio.is_some()),
        ("change_every_m", parameters.change_every_m.is_some()),
        ("vortex_drift_mps", parameters.vortex_drift_mps.is_some()),
    ] {
        if given {
            return Err(WorldError::parameter(
                name,
                "given",
                "harbor has polygons at rest, vessels and a uniform current, and never changes",
            ));
        }
    }
    let (count, ratio, time_factor) = calibration(parameters.difficulty);
    let count = parameters.obstacles.unwrap_or(count);
    let ratio = not_negative("current_ratio", parameters.current_ratio, ratio)?;
    let speed = not_negative("vehicle_speed_mps", parameters.vehicle_speed_mps, 1.5)?;
    let time_factor = not_negative("time_factor", parameters.time_factor, time_factor)?;
    let noise = not_negative("sensor_noise_m", parameters.sensor_noise_m, 0.0)?;
    let fastest = not_negative("obstacle_speed_mps", parameters.obstacle_speed_mps, VESSEL_RATIO * speed)?;
    let vessels = parameters.vessels.unwrap_or(0);
    let mut stream = Stream::new(seed, Purpose::Family, 5);
    let mut sketches = Vec::with_capacity(count);
    'maps: for _ in 0..TRIES {
        let mission = mission(&mut stream);
        let heading = stream.uniform(0.0, TAU);
        let velocity_mps = [ratio * speed * libm::cos(heading), ratio * speed * libm::sin(heading)];
        // Most maps fail here, before many of their corners have been worked out.
        let ends = [mission.start_m, mission.goal_m];
        sketches.clear();
        for drawn in 1..=count {
            let sketch = Sketch::draw(&mut stream);
            if ends.iter().any(|end| sketch.is_near(*end)) {
                (drawn..count).for_each(|_| Sketch::pass_over(&mut stream));
                continue 'maps;
            }
            sketches.push(sketch);
        }
        let polygons: Vec<Polygon> = sketches.iter().map(Sketch::polygon).collect();
        let solids = solids(&polygons);
        if !((count == 0 || is_barred(&solids, &mission)) && has_way(&solids, &mission)) {
            continue;
        }
        let mut scenario = Scenario {
            schema: SCHEMA,
            name: format!("harbor-seed-{seed}"),
            description: String::new(),
            family: "harbor".into(),
            dimensions: 2,
            notes: Vec::new(),
            domain: Domain { min_m: [0.0; 3], max_m: [SIDE, SIDE, 0.0], margin_m: 500.0 * SCALE },
            limits: Limits { goal_radius_m: 300.0 * SCALE, time_factor, energy_factor: time_factor },
            vehicle: Vehicle { speed_mps: speed, yaw_rate_radps: 60.0_f64.to_radians(), ..Vehicle::default() },
            episode: episode(noise),
            sections: Some(Sections {
                count: 20,
                frame: SectionFrame::Mission,
                spacing_m: None,
                half_width_m: Some(0.5 * SIDE),
                cell_m: SIDE / 40.0,
            }),
            projection: None,
            seabed: None,
            change: None,
            missions: vec![mission.clone()],
            currents: if ratio > 0.0 { vec![Current::Uniform(Uniform { velocity_mps })] } else { Vec::new() },
            obstacles: polygons.into_iter().map(Obstacle::Polygon).collect(),
        };
        // Of a stream of their own: the same basin with and without them.
        let mut stream = Stream::new(seed, Purpose::Family, 6);
        scenario.obstacles.extend((0..vessels).map(|_| vessel(&mut stream, &mission, fastest)));
        return Ok(scenario);
    }
    Err(WorldError::parameter("obstacles", count, "leave no way from start to goal"))
}

/// LFHH's legs, in proportion to box and speed.
fn episode(sensor_noise_m: f64) -> Episode {
    let (time, legs) = (SCALE * 2.0 / 1.5, Episode::default());
    Episode {
        tick_s: legs.tick_s * time,
        reach_m: legs.reach_m * SCALE,
        capture_radius_m: legs.capture_radius_m * SCALE,
        minimum_leg_s: legs.minimum_leg_s * time,
        maximum_leg_s: legs.maximum_leg_s * time,
        station_radius_m: legs.station_radius_m * SCALE,
        waypoint_margin_m: 1.0,
        sonar_range_m: legs.sonar_range_m * SCALE,
        sensor_noise_m,
    }
}

/// Start and goal at least half the box apart.
fn mission(stream: &mut Stream) -> Mission {
    loop {
        let mut place = || [stream.uniform(0.05 * SIDE, 0.95 * SIDE), stream.uniform(0.05 * SIDE, 0.95 * SIDE), 0.0];
        let (start_m, goal_m) = (place(), place());
        if distance(start_m, goal_m) >= 0.5 * SIDE {
            return Mission { start_m, goal_m };
        }
    }
}

/// Three to seven corners round a centre, in order and each at a distance of its own.
struct Sketch {
    centre: Vec2,
    corners: usize,
    /// No corner is farther from the centre (m).
    size: f64,
    first: f64,
    /// Of each corner: how far it is turned, in parts of the angle between two, and its distance in parts of the size.
    draws: [Vec2; 7],
}

impl Sketch {
    fn draw(stream: &mut Stream) -> Self {
        let centre = [stream.uniform(0.0, SIDE), stream.uniform(0.0, SIDE)];
        let corners = 3 + stream.below(5);
        let (size, first) = (stream.uniform(12.0, 32.0), stream.uniform(0.0, TAU));
        let mut draws = [[0.0; 2]; 7];
        draws[..corners].fill_with(|| [stream.uniform(-0.3, 0.3), stream.uniform(0.5, 1.0)]);
        Self { centre, corners, size, first, draws }
    }

    /// Draws one that nobody looks at.
    fn pass_over(stream: &mut Stream) {
        stream.skip(2);
        let corners = 3 + stream.below(5);
        stream.skip(2 + 2 * corners);
    }

    fn polygon(&self) -> Polygon {
        let corner = |(i, [turned, part]): (usize, &Vec2)| -> Vec2 {
            let angle = self.first + TAU * (i as f64 + turned) / self.corners as f64;
            let reach = self.size * part;
            [self.centre[0] + reach * libm::cos(angle), self.centre[1] + reach * libm::sin(angle)]
        };
        let vertices_m = self.draws[..self.corners].iter().enumerate().map(corner).collect();
        Polygon { vertices_m, top_m: -1.0, bottom_m: 1.0, velocity_mps: [0.0; 2] }
    }

    /// Whether start or goal cannot be there.
    fn is_near(&self, end: Vec3) -> bool {
        // A metre more than what rounds.
        distance([self.centre[0], self.centre[1], end[2]], end) < self.size + MARGIN + 1.0
            && Prism::new(&self.polygon()).clearance(end) < MARGIN
    }
}

fn solids(polygons: &[Polygon]) -> Solids {
    let mut solids = Solids::default();
    polygons.iter().for_each(|polygon| solids.push(Solid::Polygon(Prism::new(polygon))));
    solids
}

/// A disc on a straight course: over anything at rest, and back at the walls.
fn vessel(stream: &mut Stream, mission: &Mission, fastest: f64) -> Obstacle {
    let radius_m = stream.uniform(VESSEL[0], VESSEL[1]);
    let heading = stream.uniform(0.0, TAU);
    let pace = stream.uniform(0.5, 1.0) * fastest;
    // Start and goal are far enough apart that there is always room.
    let position_m = loop {
        let place = [stream.uniform(0.0, SIDE), stream.uniform(0.0, SIDE)];
        let clear = |end: Vec3| distance(end, [place[0], place[1], end[2]]) >= radius_m + VESSEL_MARGIN;
        if clear(mission.start_m) && clear(mission.goal_m) {
            break place;
        }
    };
    Obstacle::Disc(Disc {
        position_m,
        radius_m,
        velocity_mps: [pace * libm::cos(heading), pace * libm::sin(heading)],
        manoeuvre: None,
    })
}

/// Whether something lies on the straight line from start to goal.
fn is_barred(solids: &Solids, mission: &Mission) -> bool {
    let (start, goal) = (mission.start_m, mission.goal_m);
    let length = distance(start, goal);
    let pieces = (length / CELL) as usize;
    let mut piece = 1;
    while piece < pieces {
        let part = piece as f64 / pieces as f64;
        let place = std::array::from_fn(|axis| start[axis] + part * (goal[axis] - start[axis]));
        let near = solids.nearest(place, 0.0);
        if near.clearance < 0.0 {
            return true;
        }
        // What is clear ahead need not be looked at; by more than what rounds.
        let clear = near.clearance.min(near.rivals) - 1e-6;
        piece = piece.saturating_add(1).saturating_add((clear * pieces as f64 / length) as usize);
    }
    false
}

/// Whether start and goal are joined by cells of a grid that are clear.
fn has_way(solids: &Solids, mission: &Mission) -> bool {
    const CELLS: usize = (SIDE / CELL) as usize;
    let place =
        |cell: usize| -> Vec3 { [((cell % CELLS) as f64 + 0.5) * CELL, ((cell / CELLS) as f64 + 0.5) * CELL, 0.0] };
    let cell = |point: Vec3| (point[1] / CELL) as usize * CELLS + (point[0] / CELL) as usize;
    let (start, goal) = (cell(mission.start_m), cell(mission.goal_m));
    let mut seen = [0_u64; (CELLS * CELLS).div_ceil(64)];
    let mut is_new = |cell: usize| {
        let (word, bit) = (&mut seen[cell / 64], 1 << (cell % 64));
        let new = *word & bit == 0;
        *word |= bit;
        new
    };
    // Cells, and how clear they are at least, as far as that follows from a neighbour.
    let mut open = vec![(start, PASSAGE)];
    is_new(start);
    while let Some((here, known)) = open.pop() {
        let clear = if known >= PASSAGE { known } else { solids.clearance(place(here), AHEAD) };
        if clear < PASSAGE {
            continue;
        }
        if here == goal {
            return true;
        }
        // A cell's width less, and more than what rounds.
        let beside_clear = clear - CELL - 1e-6;
        let (column, row) = (here % CELLS, here / CELLS);
        // Neighbours, and whether they are nearer to the goal.
        let beside = [
            (column > 0, here.wrapping_sub(1), goal % CELLS < column),
            (column + 1 < CELLS, here + 1, column < goal % CELLS),
            (row > 0, here.wrapping_sub(CELLS), goal / CELLS < row),
            (row + 1 < CELLS, here + CELLS, row < goal / CELLS),
        ];
        // Those are looked at first: most ways show before most of the basin has been looked at.
        for nearer in [false, true] {
            for (inside, there, towards) in beside {
                if inside && towards == nearer && is_new(there) {
                    open.push((there, beside_clear));
                }
            }
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::families::generate;

    #[test]
    fn a_wall_is_no_way_and_a_gap_is() {
        let wall = |low: f64, high: f64| {
            let vertices_m = vec![[95.0, low], [105.0, low], [105.0, high], [95.0, high]];
            Polygon { vertices_m, top_m: -1.0, bottom_m: 1.0, velocity_mps: [0.0; 2] }
        };
        let mission = Mission { start_m: [20.0, 20.0, 0.0], goal_m: [180.0, 20.0, 0.0] };
        for (top, way) in [(201.0, false), (197.0, false), (185.0, true)] {
            assert_eq!(has_way(&solids(&[wall(-1.0, top)]), &mission), way, "{top}");
        }
    }

    #[test]
    fn passing_over_a_sketch_leaves_the_stream_where_drawing_it_does() {
        let [mut drawn, mut passed] = [(); 2].map(|()| Stream::new(1, Purpose::Family, 5));
        for _ in 0..50 {
            Sketch::draw(&mut drawn);
            Sketch::pass_over(&mut passed);
            assert_eq!(drawn.clone().next_u64(), passed.clone().next_u64());
        }
    }

    #[test]
    fn what_does_not_apply_is_refused() {
        let vortices = Parameters { vortices: Some(3), ..Parameters::default() };
        assert!(generate("harbor", 1, &vortices).unwrap_err().to_string().starts_with("vortices"));
        let full = Parameters { obstacles: Some(400), ..Parameters::default() };
        assert!(generate("harbor", 1, &full).unwrap_err().to_string().contains("leave no way"));
        let empty = Parameters { obstacles: Some(0), current_ratio: Some(0.0), ..Parameters::default() };
        let scenario = generate("harbor", 1, &empty).unwrap();
        assert!(scenario.currents.is_empty() && scenario.obstacles.is_empty());
    }

    #[test]
    fn vessels_leave_the_basin_as_it_was() {
        let bare = generate("harbor", 3, &Parameters::default()).unwrap();
        let busy = Parameters { vessels: Some(20), obstacle_speed_mps: Some(1.0), ..Parameters::default() };
        let busy = generate("harbor", 3, &busy).unwrap();
        busy.check().unwrap();
        assert_eq!(busy.missions, bare.missions);
        assert_eq!(busy.currents, bare.currents);
        assert_eq!(busy.obstacles[..bare.obstacles.len()], bare.obstacles);
        let vessels = &busy.obstacles[bare.obstacles.len()..];
        assert_eq!(vessels.len(), 20);
        for vessel in vessels {
            let [u, v, _] = vessel.velocity_mps();
            assert!((0.5..=1.0).contains(&(u * u + v * v).sqrt()));
            for end in [busy.missions[0].start_m, busy.missions[0].goal_m] {
                assert!(distance(vessel.position_m(), end) >= VESSEL_MARGIN + VESSEL[0]);
            }
        }
    }

    #[test]
    fn the_straight_line_is_barred() {
        for seed in 0..30 {
            let parameters = Parameters { obstacles: Some(1 + seed as usize % 9), ..Parameters::default() };
            let scenario = generate("harbor", seed, &parameters).unwrap();
            let polygons = scenario.obstacles.iter().map(|obstacle| match obstacle {
                Obstacle::Polygon(polygon) => polygon.clone(),
                other => panic!("{other:?}"),
            });
            let (solids, mission) = (solids(&polygons.collect::<Vec<_>>()), &scenario.missions[0]);
            assert!(is_barred(&solids, mission), "{seed}");
            for end in [mission.start_m, mission.goal_m] {
                assert!(solids.clearance(end, f64::INFINITY) >= MARGIN, "{seed}");
            }
        }
    }
}
