//! The flow as a law of motion among threats (section V): fed with measured positions, it says at each
//! tick where to go.

use std::f64::consts::{FRAC_PI_2, PI};

use auv_world::World;
use auv_world::math::{Vec3, add_scaled, distance, dot, norm, sub};
use serde::Deserialize;

use super::barrier::{Ball, turned_away};
use super::kalman::{Kalman, Noise};
use crate::fluid::field::{Body, Coefficients, Field};
use crate::fluid::obstacles::bodies;
use crate::fluid::settings::Flow;
use crate::fluid::shape::Shape;
use crate::fluid::superquadric::Superquadric;
use crate::fluid::trace::{Steps, Walls, put_out, undisturbed};

/// Places nearer to each other than this part of their size are one.
const ROUNDING: f64 = 1e-12;
/// Threats whose radii differ by less than this part may be one and the same.
const ALIKE: f64 = 1e-3;
/// What is so many standard deviations off what was expected is something else.
const SURPRISING: f64 = 5.0;

/// On which side a threat is passed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// Behind it: against its way across (eq. 31-32).
    Reverse,
    /// Before it: what eq. 32 warns of.
    Same,
    /// To the right.
    Fixed,
}

/// Where the flow meets a threat.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Prediction {
    /// Where it will be at the end of the horizon.
    #[default]
    Last,
    /// Where it will be at each fifth of the horizon, at once.
    All,
}

impl Prediction {
    /// Places at which it meets one.
    fn places(self) -> usize {
        match self {
            Self::Last => 1,
            Self::All => 5,
        }
    }
}

/// How threats are avoided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rules {
    /// rho0 and sigma0 of threats.
    pub rho: f64,
    /// rho0 and sigma0 of threats.
    pub sigma: f64,
    /// s: theta is s pi / 2 to the right and pi - s pi / 2 to the left, so that 1 leads over all.
    pub share: f64,
    /// On which side.
    pub side: Side,
    /// The flow takes threats to be this much larger than they are (m).
    pub margin_m: f64,
    /// A threat's side, once chosen, changes only when the angle of eq. 32 is so far beyond a right one (rad).
    pub latch_rad: f64,
    /// The flow takes threats to be where they will be then (s).
    pub horizon_s: f64,
    /// Where until then.
    pub prediction: Prediction,
    /// Whether the flow passes over threats that go away by themselves.
    pub ignore_receding: bool,
    /// alpha: the gap to a threat may shrink by this part of it in a second (1/s); 0: no barrier.
    pub barrier_per_s: f64,
    /// Whether threats turn the flow in their own frame instead.
    pub relative: bool,
    /// What the filter expects.
    pub noise: Noise,
    /// Coefficients of what does not move.
    pub still: Coefficients,
}

impl Default for Rules {
    fn default() -> Self {
        Self {
            rho: 1.0,
            sigma: 1.0,
            share: 0.3,
            side: Side::Reverse,
            margin_m: 300.0,
            latch_rad: 0.0,
            horizon_s: 30.0,
            prediction: Prediction::Last,
            ignore_receding: true,
            barrier_per_s: 0.002,
            relative: false,
            noise: Noise { process: 1e-6, measurement_m: 1.0, velocity_mps: 2.0 },
            still: Coefficients { rho: 1.0, sigma: 1.0, theta: 1.0 },
        }
    }
}

/// Where to go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Course {
    /// Velocity over ground (m/s), as fast as the vehicle.
    pub velocity: Vec3,
    /// Where that leads by the end of the tick (m).
    pub waypoint: Vec3,
}

impl Rules {
    /// The paper's own: threats as large as they are, passed behind and for as long as they are there, no barrier.
    pub fn paper() -> Self {
        Self { margin_m: 0.0, ignore_receding: false, barrier_per_s: 0.0, ..Self::default() }
    }
}

/// Who follows a threat.
#[derive(Debug, Clone, Copy)]
struct Tracker {
    filter: Kalman,
    /// When the threat was seen last (s).
    seen_s: f64,
    /// Whether it was last found to go to the right of the vehicle's way; unknown while it is not known to move.
    rightwards: Option<bool>,
}

/// A vehicle's way to a goal among things that move.
#[derive(Debug, Clone)]
pub struct Navigator {
    world: World,
    field: Field,
    /// Bodies before this one are at rest; the others are the threats, each as often as `prediction` has it.
    still: usize,
    latch: f64,
    trackers: Vec<Option<Tracker>>,
    radii: Vec<f64>,
    balls: Vec<Ball>,
    walls: Walls,
    steps: Steps,
    rules: Rules,
    goal: Vec3,
}

impl Navigator {
    /// A navigator that knows what is at rest in the world, its box and its current, and threats of the
    /// given radii (m), but not where they are. `lambda` is that of eq. 15.
    pub fn new(world: &World, [start, goal]: [Vec3; 2], radii: &[f64], lambda: f64, flow: &Flow, rules: Rules) -> Self {
        let mut all: Vec<Body> = bodies(world, flow.margin_m, |_| rules.still);
        all.retain(|body| body.velocity == [0.0; 3]);
        let still = all.len();
        all.extend(radii.iter().flat_map(|radius| threat(*radius, &rules)));
        let mut modulation = flow.modulation(start, goal);
        modulation.relative = rules.relative;
        // Threats wander: what overlaps now will not stay.
        modulation.union_exponent = 0.0;
        Self {
            world: world.clone(),
            field: Field::new(all, modulation, world.scenario().dimensions == 2),
            still,
            latch: libm::sin(rules.latch_rad),
            trackers: vec![None; radii.len()],
            radii: radii.to_vec(),
            balls: Vec::with_capacity(radii.len()),
            walls: Walls::new(world, [start, goal]),
            steps: flow.steps(world, lambda, start, goal),
            rules,
            goal,
        }
    }

    /// Takes in where a threat was measured to be (m).
    pub fn measure(&mut self, threat: usize, position: Vec3, time_s: f64) {
        match &mut self.trackers[threat] {
            Some(tracker) => {
                tracker.filter.measure(position, time_s);
                tracker.seen_s = time_s;
            }
            nothing => {
                let filter = Kalman::new(self.rules.noise, position, time_s);
                *nothing = Some(Tracker { filter, seen_s: time_s, rightwards: None });
            }
        }
    }

    /// Takes in that something of a radius (m) was measured to be somewhere (m): the threat of that radius that
    /// was expected thereabouts, or a new one.
    pub fn see(&mut self, position: Vec3, radius: f64, time_s: f64) {
        let alike = |known: f64| (known - radius).abs() <= ALIKE * radius;
        let mut best = (SURPRISING, None);
        let mut free = None;
        for (threat, (tracker, known)) in self.trackers.iter().zip(&self.radii).enumerate() {
            match tracker {
                Some(tracker) if alike(*known) => {
                    let surprise = tracker.filter.surprise(position, time_s);
                    if surprise < best.0 {
                        best = (surprise, Some(threat));
                    }
                }
                None if *known == radius => free = Some(threat),
                _ => {}
            }
        }
        let threat = best.1.or(free).unwrap_or_else(|| {
            threat(radius, &self.rules).for_each(|body| self.field.push(body));
            self.trackers.push(None);
            self.radii.push(radius);
            self.radii.len() - 1
        });
        self.measure(threat, position, time_s);
    }

    /// Forgets the threats that were seen last before a time (s).
    pub fn forget(&mut self, before_s: f64) {
        let places = self.rules.prediction.places();
        let threats = self.field.bodies_mut()[self.still..].chunks_exact_mut(places);
        for (tracker, bodies) in self.trackers.iter_mut().zip(threats) {
            if tracker.is_some_and(|tracker| tracker.seen_s < before_s) {
                *tracker = None;
                bodies.iter_mut().for_each(|body| body.active = false);
            }
        }
    }

    /// The threats that are known: centre (m), velocity (m/s), radius (m).
    pub fn threats(&self, time_s: f64) -> Vec<Ball> {
        let known = self.trackers.iter().zip(&self.radii);
        known.filter_map(|(tracker, radius)| Some(tracker.as_ref()?.filter.ball(*radius, time_s))).collect()
    }

    /// Where to go from here (m) in the next `tick_s` seconds. Allocates nothing.
    pub fn course(&mut self, here: Vec3, time_s: f64, tick_s: f64) -> Course {
        let flow = undisturbed(&self.world, &self.steps, here, self.goal);
        self.place_threats(here, time_s, flow);
        let speed = self.steps.speed_mps;
        let left = distance(here, self.goal);
        let far = left.min(speed * tick_s).max(f64::MIN_POSITIVE);
        // The last tick goes straight, whatever flows there.
        let wanted = if left <= speed * tick_s {
            sub(self.goal, here)
        } else {
            self.walls.slide(here, self.field.velocity(here, self.goal, flow))
        };
        let mut direction = unit(wanted).or_else(|| unit(flow)).unwrap_or([0.0; 3]);
        if self.rules.barrier_per_s > 0.0 {
            direction = turned_away(direction, here, speed, self.rules.barrier_per_s, &self.balls);
            direction = unit(self.walls.slide(here, direction)).unwrap_or(direction);
        }
        let mut waypoint = self.walls.clamp(add_scaled(here, far, direction));
        if self.steps.guard {
            self.field.bodies_mut()[self.still..].iter_mut().for_each(|threat| threat.active = false);
            waypoint = put_out(&self.field, &self.walls, waypoint, self.steps.guard_gamma, far);
        }
        let velocity = unit(sub(waypoint, here)).unwrap_or([0.0; 3]).map(|d| speed * d);
        let waypoint = add_scaled(here, far / speed, velocity);
        // Arrived but for rounding is arrived.
        let arrived = distance(waypoint, self.goal) <= ROUNDING * (1.0 + norm(self.goal));
        Course { velocity, waypoint: if arrived { self.goal } else { waypoint } }
    }

    /// Puts the threats where they will be, and chooses the sides on which they are passed.
    fn place_threats(&mut self, here: Vec3, time_s: f64, flow: Vec3) {
        self.balls.clear();
        let heading = unit(flow).unwrap_or([0.0; 3]);
        let [ahead, aside, _] = sub(self.goal, here);
        let places = self.rules.prediction.places();
        let threats = self.field.bodies_mut()[self.still..].chunks_exact_mut(places);
        for ((bodies, tracker), radius) in threats.zip(&mut self.trackers).zip(&self.radii) {
            let Some(Tracker { filter, rightwards: known, .. }) = tracker else { continue };
            let ball = filter.ball(*radius, time_s);
            let Ball { centre, velocity, .. } = ball;
            self.balls.push(ball);
            let closing = sub(heading.map(|h| self.steps.speed_mps * h), velocity);
            let recedes = dot(sub(here, centre), closing) > 0.0;
            // v of eq. 31 points to the right of the goal's direction; this is u.v times that one's length.
            let across = velocity[0] * aside - velocity[1] * ahead;
            let rightwards = match *known {
                Some(before) if self.latch > 0.0 => {
                    let most = norm([velocity[0], velocity[1], 0.0]) * norm([ahead, aside, 0.0]);
                    if across.abs() > self.latch * most { across > 0.0 } else { before }
                }
                _ => across > 0.0,
            };
            if across != 0.0 {
                *known = Some(rightwards);
            }
            let left = match self.rules.side {
                Side::Reverse => rightwards,
                Side::Same => !rightwards,
                Side::Fixed => false,
            };
            let theta = self.rules.share * FRAC_PI_2;
            let theta = if left { PI - theta } else { theta };
            for (place, body) in bodies.iter_mut().enumerate() {
                body.active = !(self.rules.ignore_receding && recedes);
                body.velocity = velocity;
                body.set(Coefficients { rho: self.rules.rho, sigma: self.rules.sigma, theta });
                if let Shape::Superquadric(sphere) = &mut body.shape {
                    let ahead_s = self.rules.horizon_s * (place + 1) as f64 / places as f64;
                    sphere.place(filter.position(time_s + ahead_s));
                }
            }
        }
    }
}

/// A threat of a radius (m), wherever it is, as often as the flow meets it.
fn threat(radius: f64, rules: &Rules) -> impl Iterator<Item = Body> {
    let sphere = Superquadric::new([0.0; 3], [radius + rules.margin_m; 3], [2.0; 3]);
    let mut threat = Body::new(Shape::Superquadric(sphere), rules.still);
    threat.active = false;
    std::iter::repeat_n(threat, rules.prediction.places())
}

fn unit(vector: Vec3) -> Option<Vec3> {
    let length = norm(vector);
    (length > 1e-12).then(|| vector.map(|v| v / length))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    fn navigator(rules: Rules) -> Navigator {
        let world = testing::paper_world("iifds-threat1", 0);
        let (start, goal) = ([0.0, 5e3, 2e3], [10e3, 5e3, 2e3]);
        Navigator::new(&world, [start, goal], &[1e3], 1.0, &Flow::default(), rules)
    }

    /// The course with a threat 2 km ahead that crosses to the left (y grows) or right.
    fn crossing(rules: Rules, across: f64) -> Vec3 {
        let mut navigator = navigator(rules);
        for time in [0.0, 6.0, 12.0] {
            navigator.measure(0, [2e3, 5e3 + across * time, 2e3], time);
        }
        navigator.course([0.0, 5e3, 2e3], 12.0, 6.0).velocity
    }

    #[test]
    fn threats_are_passed_behind() {
        let rules = Rules { barrier_per_s: 0.0, share: 0.2, ..Rules::default() };
        // To the left (y grows) goes the threat, to the right the vehicle, and the other way round.
        assert!(crossing(rules, 0.9)[1] < 0.0);
        assert!(crossing(rules, -0.9)[1] > 0.0);
        assert!(crossing(Rules { side: Side::Same, ..rules }, 0.9)[1] > 0.0);
        assert!(crossing(Rules { share: 1.0, ..rules }, 0.9)[2] < 0.0);
        assert!((norm(crossing(rules, 0.9)) - 2.0).abs() < 1e-9);
    }

    #[test]
    fn what_is_seen_again_is_known_again() {
        let mut navigator =
            navigator(Rules { noise: Noise { measurement_m: 20.0, ..Rules::default().noise }, ..Rules::default() });
        for time in [0.0, 15.0, 30.0, 45.0] {
            navigator.see([3e3 - time, 5e3, 2e3], 700.0, time);
            navigator.see([5e3 + time, 5e3, 2e3], 700.0, time);
        }
        let mut known = navigator.threats(60.0);
        assert_eq!(known.len(), 2);
        known.sort_by(|a, b| a.centre[0].total_cmp(&b.centre[0]));
        assert!(known.iter().zip([2940.0, 5060.0]).all(|(ball, x)| (ball.centre[0] - x).abs() < 5.0));
        // One of another size, and one that turned back long ago.
        navigator.see([3e3, 5e3, 2e3], 800.0, 45.0);
        navigator.see([3300.0, 5e3, 2e3], 700.0, 60.0);
        assert_eq!(navigator.threats(60.0).len(), 4);
        navigator.forget(50.0);
        assert_eq!(navigator.threats(60.0).len(), 1);
        navigator.see([8e3, 5e3, 2e3], 700.0, 60.0);
        assert_eq!(navigator.radii, [1e3, 700.0, 700.0, 800.0, 700.0]);
        navigator.forget(70.0);
        assert_eq!(navigator.course([0.0, 5e3, 2e3], 70.0, 6.0).velocity, [2.0, 0.0, 0.0]);
    }

    #[test]
    fn what_goes_away_is_passed_over() {
        let mut navigator = navigator(Rules::default());
        let straight = navigator.course([0.0, 5e3, 2e3], 0.0, 6.0);
        assert_eq!(straight.velocity, [2.0, 0.0, 0.0]);
        assert_eq!(straight.waypoint, [12.0, 5e3, 2e3]);
        // Ahead, and faster than the vehicle on the same way.
        for time in [0.0, 6.0, 12.0] {
            navigator.measure(0, [3e3 + 3.0 * time, 5e3, 2e3], time);
        }
        assert_eq!(navigator.course([0.0, 5e3, 2e3], 12.0, 6.0).velocity, [2.0, 0.0, 0.0]);
    }

    #[test]
    fn the_last_step_ends_at_the_goal() {
        let course = navigator(Rules::default()).course([9_995.0, 5e3, 2e3], 0.0, 6.0);
        assert_eq!(course.waypoint, [10e3, 5e3, 2e3]);
        let there = navigator(Rules::default()).course([10e3, 5e3, 2e3], 0.0, 6.0);
        assert_eq!(there.velocity, [0.0; 3]);
    }
}
