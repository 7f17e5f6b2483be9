//! A plan that is being flown: what lies ahead on it, and what its map promised.

use auv_world::World;
use auv_world::kinematics::travel_time;
use auv_world::math::{Vec3, add_scaled, distance, norm, sub};
use auv_world::scenario::Episode as Flight;

/// The piece of a plan ahead of the vehicle: its place, then waypoints, and how far along each lies (m).
#[derive(Debug, Clone, Default)]
pub struct Way {
    points: Vec<Vec3>,
    along: Vec<f64>,
}

impl Way {
    fn clear(&mut self, from: Vec3) {
        self.points.clear();
        self.along.clear();
        self.points.push(from);
        self.along.push(0.0);
    }

    fn push(&mut self, point: Vec3) {
        let (last, far) = (self.points[self.points.len() - 1], self.length());
        self.along.push(far + distance(last, point));
        self.points.push(point);
    }

    /// How long it is (m).
    pub fn length(&self) -> f64 {
        self.along[self.along.len() - 1]
    }

    /// The point so far along it (m), or its end, and the unit vector along it there.
    pub fn at(&self, far: f64) -> (Vec3, Vec3) {
        let last = self.points.len() - 1;
        if last == 0 {
            return (self.points[0], [0.0; 3]);
        }
        let end = self.along.iter().position(|along| *along >= far).unwrap_or(last).max(1);
        let (from, to) = (self.points[end - 1], self.points[end]);
        let length = self.along[end] - self.along[end - 1];
        let direction = sub(to, from).map(|entry| entry / length.max(1e-9));
        (add_scaled(from, (far - self.along[end - 1]).min(length), direction), direction)
    }

    /// How long it takes to fly it in a world's present currents (s).
    pub fn seconds(&self, world: &World, piece_m: f64) -> f64 {
        self.points.windows(2).map(|pair| seconds(world, pair[0], pair[1], piece_m)).sum()
    }
}

/// Time for a straight line (s), its currents asked about every `piece_m`.
fn seconds(world: &World, from: Vec3, to: Vec3, piece_m: f64) -> f64 {
    let pieces = (distance(from, to) / piece_m).ceil().max(1.0);
    travel_time(world, from, to, world.scenario().vehicle.speed_mps, pieces as usize)
}

/// A plan in flight.
#[derive(Debug, Clone)]
pub struct Course {
    /// From where it was made to the goal (m).
    pub waypoints: Vec<Vec3>,
    /// The waypoint that is steered to.
    pub next: usize,
    /// The world as it was when the plan was made.
    pub map: World,
    /// Whether the planner found it feasible.
    pub feasible: bool,
    /// Length of the path flown when it was made (m).
    pub made_m: f64,
    /// What the map promises from each waypoint to the goal: length (m) and time (s).
    promised: Vec<[f64; 2]>,
}

impl Course {
    /// A plan of at least two waypoints that was made in the world `map`.
    pub fn new(waypoints: Vec<Vec3>, map: World, feasible: bool, made_m: f64) -> Self {
        let piece_m = piece_m(&map.scenario().episode);
        let mut promised = vec![[0.0; 2]; waypoints.len()];
        for (i, pair) in waypoints.windows(2).enumerate().rev() {
            let [length, time] = promised[i + 1];
            promised[i] = [length + distance(pair[0], pair[1]), time + seconds(&map, pair[0], pair[1], piece_m)];
        }
        Self { waypoints, next: 1, map, feasible, made_m, promised }
    }

    /// Goes on to the first waypoint that is neither reached nor passed: one is passed once the vehicle has crossed
    /// the plane through it that stands across the segment leading to it. The last is never given up.
    pub fn advance(&mut self, position: Vec3, capture_m: f64) {
        while self.next + 1 < self.waypoints.len() {
            let (before, waypoint) = (self.waypoints[self.next - 1], self.waypoints[self.next]);
            let (leading, offset) = (sub(waypoint, before), sub(position, waypoint));
            let passed = (0..3).map(|i| leading[i] * offset[i]).sum::<f64>() >= 0.0;
            if !passed && norm(offset) > capture_m {
                break;
            }
            self.next += 1;
        }
    }

    /// Where to steer (m): a capture radius beyond the next waypoint, so that the leg ends on the path and does not
    /// cut the corner, and no farther than the reach.
    pub fn aim(&self, position: Vec3, flight: &Flight) -> Vec3 {
        let mut aim = self.waypoints[self.next];
        if self.next + 1 < self.waypoints.len() {
            let leading = sub(aim, self.waypoints[self.next - 1]);
            aim = add_scaled(aim, flight.capture_radius_m / norm(leading).max(1e-9), leading);
        }
        let offset = sub(aim, position);
        add_scaled(position, (flight.reach_m / norm(offset).max(1e-9)).min(1.0), offset)
    }

    /// What lies ahead within `range_m` along the plan.
    pub fn ahead(&self, position: Vec3, range_m: f64, way: &mut Way) {
        way.clear(position);
        for waypoint in &self.waypoints[self.next..] {
            way.push(*waypoint);
            if way.length() >= range_m {
                break;
            }
        }
        let far = way.length();
        if far > range_m {
            let (end, _) = way.at(range_m);
            let last = way.points.len() - 1;
            (way.points[last], way.along[last]) = (end, range_m);
        }
    }

    /// Length (m) of what is left of the plan, and the time (s) that its map promises for it.
    pub fn left(&self, position: Vec3) -> [f64; 2] {
        let (waypoint, [length, time]) = (self.waypoints[self.next], self.promised[self.next]);
        let here = seconds(&self.map, position, waypoint, piece_m(&self.map.scenario().episode));
        [length + distance(position, waypoint), time + here]
    }

    /// Whether water and obstacles may be elsewhere by now than the plan's map says.
    pub fn outdated(&self, world: &World) -> bool {
        !world.is_steady() || world.changes().len() != self.map.changes().len()
    }

    /// To where a window of `window_m` along the plan reaches, and the first waypoint beyond; the place is the
    /// first one clear of everything solid by the margin of waypoints. Nothing if that leaves no part of the plan.
    pub fn window(&self, position: Vec3, window_m: f64, world: &World, way: &mut Way) -> Option<(Vec3, usize)> {
        let flight = &world.scenario().episode;
        self.ahead(position, f64::INFINITY, way);
        let mut far = window_m;
        while far < way.length() {
            let (place, _) = way.at(far);
            if world.clearance(place) >= flight.waypoint_margin_m {
                let beyond = way.along.iter().position(|along| *along > far)?;
                return Some((place, self.next + beyond - 1));
            }
            far += 0.25 * flight.reach_m;
        }
        None
    }
}

/// Currents are asked about so often along a plan (m).
pub fn piece_m(flight: &Flight) -> f64 {
    0.25 * flight.reach_m
}
