//! One episode: the vehicle flies leg by leg until it arrives or fails.

use auv_world::math::{Vec3, add_scaled, distance, sub};
use auv_world::scenario::Change;
use auv_world::world::{ChangeEvent, Scratch};
use auv_world::{Scenario, World};
use serde::{Deserialize, Serialize};

use crate::error::EnvError;
use crate::frame::Frame;
use crate::vehicle::Helm;
use crate::{observation, reward, sonar};

/// An action of 0 along "forward" already goes this part of the reach forward, so that an untrained
/// policy moves; -1 still backs out by half the reach.
pub const FORWARD_BIAS: f64 = 0.25;

/// How an episode stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Outcome {
    /// Not over.
    Running,
    /// Within the goal radius.
    Goal,
    /// Inside something solid.
    Collision,
    /// Beyond the margin round the box.
    OutOfBounds,
    /// No energy left.
    Energy,
    /// No time left.
    Timeout,
}

impl Outcome {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Running => "running",
            Self::Goal => "goal",
            Self::Collision => "collision",
            Self::OutOfBounds => "out_of_bounds",
            Self::Energy => "energy",
            Self::Timeout => "timeout",
        }
    }
}

/// Whether an episode keeps where the vehicle was and what was ordered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Record {
    /// Every tick and action, for pictures and replays.
    Everything,
    /// Nothing but the present: a few tens of kilobytes less.
    Nothing,
}

/// What is measured of an episode, SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measures {
    /// Time since the start (s).
    pub time_s: f64,
    /// Energy spent (J).
    pub energy_j: f64,
    /// Length of the path over ground (m).
    pub path_length_m: f64,
    /// Least clearance so far (m).
    pub min_clearance_m: f64,
    /// Distance to the goal (m).
    pub distance_to_goal_m: f64,
    /// Planner evaluations charged.
    pub evaluations: u64,
    /// Plans after the first.
    pub replans: u64,
    /// Map changes so far.
    pub map_changes: usize,
    /// Whether the last leg ended with one.
    pub map_changed: bool,
    /// How the episode stands.
    pub outcome: Outcome,
}

impl Default for Measures {
    fn default() -> Self {
        Self {
            time_s: 0.0,
            energy_j: 0.0,
            path_length_m: 0.0,
            min_clearance_m: 0.0,
            distance_to_goal_m: 0.0,
            evaluations: 0,
            replans: 0,
            map_changes: 0,
            map_changed: false,
            outcome: Outcome::Running,
        }
    }
}

/// What an episode may spend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Straight line from start to goal (m).
    pub distance_m: f64,
    /// Time limit (s).
    pub time_s: f64,
    /// Energy budget (J).
    pub energy_j: f64,
}

/// Everything that changes while an episode runs, but for its world.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Where the vehicle is (m).
    pub position: Vec3,
    /// Unit vector of its motion through water.
    pub heading: Vec3,
    /// The last waypoint (m).
    pub waypoint: Option<Vec3>,
    /// Ticks flown.
    pub ticks: u64,
    /// Time since the start (s).
    pub time_s: f64,
    /// Energy spent (J).
    pub energy_j: f64,
    /// Length of the path over ground (m).
    pub path_length_m: f64,
    /// Path length since the last map change (m).
    pub since_change_m: f64,
    /// Least clearance so far (m).
    pub min_clearance_m: f64,
    /// A lower bound of the present clearance (m).
    clearance_left_m: f64,
    /// Planner evaluations charged to this episode.
    pub evaluations: u64,
    /// Plans made in this episode after the first.
    pub replans: u64,
    /// Whether the last leg ended with a map change.
    pub map_changed: bool,
    /// How it stands.
    pub outcome: Outcome,
    /// Where the vehicle was after each tick, the start first (m).
    pub trail: Vec<Vec3>,
    /// All actions so far, one after another.
    pub actions: Vec<f32>,
}

/// One episode.
#[derive(Debug, Clone)]
pub struct Episode {
    world: World,
    limits: Limits,
    helm: Helm,
    state: State,
    record: Record,
    beams: Vec<Vec3>,
    turned: Vec<Vec3>,
    ranges: Vec<f64>,
    scratch: Scratch,
}

/// A saved episode.
#[derive(Serialize, Deserialize)]
struct Saved {
    scenario: String,
    seed: u64,
    mission: usize,
    changes: Vec<ChangeEvent>,
    state: State,
}

impl Episode {
    /// A vehicle at the start of a world's mission, heading for the goal.
    pub fn new(mut world: World) -> Self {
        world.set_time(0.0);
        let clearance = world.clearance(world.mission().start_m);
        let mission = world.mission();
        let forward = Frame::towards(mission.start_m, mission.goal_m).forward;
        let state = State {
            position: mission.start_m,
            heading: [forward[0], forward[1], 0.0],
            waypoint: None,
            ticks: 0,
            time_s: 0.0,
            energy_j: 0.0,
            path_length_m: 0.0,
            since_change_m: 0.0,
            min_clearance_m: clearance,
            clearance_left_m: clearance,
            evaluations: 0,
            replans: 0,
            map_changed: false,
            outcome: Outcome::Running,
            trail: vec![mission.start_m],
            actions: Vec::new(),
        };
        Self::assemble(world, state)
    }

    /// The same, keeping what `record` says.
    pub fn recording(world: World, record: Record) -> Self {
        Self { record, ..Self::new(world) }
    }

    /// Keeps what `record` says from now on.
    pub fn record(&mut self, record: Record) {
        self.record = record;
    }

    fn assemble(world: World, state: State) -> Self {
        let scenario = world.scenario();
        let (vehicle, mission) = (&scenario.vehicle, world.mission());
        let distance_m = distance(mission.start_m, mission.goal_m);
        let straight_s = distance_m / vehicle.speed_mps;
        let limits = Limits {
            distance_m,
            time_s: scenario.limits.time_factor * straight_s,
            energy_j: scenario.limits.energy_factor * vehicle.power_w(vehicle.speed_mps) * straight_s,
        };
        let flat = scenario.dimensions == 2;
        let helm = Helm::new(vehicle, scenario.episode.tick_s, scenario.episode.station_radius_m, flat);
        let beams = sonar::beams(scenario.dimensions);
        let count = beams.len();
        Self {
            world,
            limits,
            helm,
            state,
            record: Record::Everything,
            turned: beams.clone(),
            beams,
            ranges: vec![0.0; count],
            scratch: Scratch::default(),
        }
    }

    /// The world at the present time.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// What may be spent.
    pub fn limits(&self) -> Limits {
        self.limits
    }

    /// How the episode stands.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// What is measured now.
    pub fn measures(&self) -> Measures {
        let state = &self.state;
        Measures {
            time_s: state.time_s,
            energy_j: state.energy_j,
            path_length_m: state.path_length_m,
            min_clearance_m: state.min_clearance_m,
            distance_to_goal_m: self.distance_to_goal_m(),
            evaluations: state.evaluations,
            replans: state.replans,
            map_changes: self.world.changes().len(),
            map_changed: state.map_changed,
            outcome: state.outcome,
        }
    }

    /// The goal-aligned frame at the vehicle.
    pub fn frame(&self) -> Frame {
        Frame::towards(self.state.position, self.world.mission().goal_m)
    }

    /// Distance to the goal (m).
    pub fn distance_to_goal_m(&self) -> f64 {
        distance(self.state.position, self.world.mission().goal_m)
    }

    /// Entries of an action.
    pub fn action_len(&self) -> usize {
        usize::from(self.world.scenario().dimensions)
    }

    /// Charges planning to the episode.
    pub fn charge(&mut self, evaluations: u64, replans: u64) {
        self.state.evaluations += evaluations;
        self.state.replans += replans;
    }

    /// Where an action of offsets in [-1, 1] (forward, left[, up]) puts the waypoint (m): forward
    /// 0.25 + 0.75 a, the others a, times the reach, clipped to the box.
    pub fn waypoint_of(&self, action: &[f32]) -> Vec3 {
        let reach = self.world.scenario().episode.reach_m;
        let mut offset = [0.0; 3];
        for (entry, value) in offset.iter_mut().zip(action) {
            *entry = f64::from(*value);
        }
        offset[0] = FORWARD_BIAS + (1.0 - FORWARD_BIAS) * offset[0];
        self.clip(add_scaled(self.state.position, reach, self.frame().to_world(offset)))
    }

    /// The action whose waypoint is `waypoint`, or lies on the way to it if that is out of reach.
    pub fn action_for(&self, waypoint: Vec3) -> [f32; 3] {
        let reach = self.world.scenario().episode.reach_m;
        let offset = self.frame().from_world(sub(waypoint, self.state.position)).map(|v| v / reach);
        let back = 2.0 * FORWARD_BIAS - 1.0;
        let mut scale = 1.0_f64;
        for (entry, (low, high)) in offset.iter().zip([(back, 1.0), (-1.0, 1.0), (-1.0, 1.0)]) {
            if *entry > high {
                scale = scale.min(high / entry);
            } else if *entry < low {
                scale = scale.min(low / entry);
            }
        }
        let action = offset.map(|v| v * scale);
        let forward = (action[0] - FORWARD_BIAS) / (1.0 - FORWARD_BIAS);
        [forward, action[1], action[2]].map(|v| v.clamp(-1.0, 1.0) as f32)
    }

    /// A point moved into the box, `waypoint_margin_m` away from its side walls, surface and bottom.
    fn clip(&self, mut point: Vec3) -> Vec3 {
        let (domain, margin) = (&self.world.scenario().domain, self.world.scenario().episode.waypoint_margin_m);
        for axis in 0..3 {
            let (low, high) = (domain.min_m[axis], domain.max_m[axis]);
            let margin = if axis == 1 { 0.0 } else { margin.min(0.5 * (high - low)) };
            point[axis] = point[axis].clamp(low + margin, high - margin);
        }
        point
    }

    /// Flies one leg towards the action's waypoint; gives its reward.
    ///
    /// # Errors
    /// [`EnvError`] for a wrong action or an episode that has ended; nothing has changed then.
    pub fn step(&mut self, action: &[f32]) -> Result<f64, EnvError> {
        self.check(action)?;
        let waypoint = self.waypoint_of(action);
        if self.record == Record::Everything {
            self.state.actions.extend_from_slice(action);
        }
        self.state.waypoint = Some(waypoint);
        let (before, start_s) = (self.distance_to_goal_m(), self.state.time_s);
        self.fly(waypoint);
        let elapsed = self.state.time_s - start_s;
        let after = self.distance_to_goal_m();
        Ok(reward::leg(before, after, self.limits.distance_m, elapsed, self.limits.time_s, self.state.outcome))
    }

    /// Whether an action may be flown.
    ///
    /// # Errors
    /// As [`Episode::step`].
    pub fn check(&self, action: &[f32]) -> Result<(), EnvError> {
        if self.state.outcome != Outcome::Running {
            return Err(EnvError::Ended(self.state.outcome.name()));
        }
        let wrong = |index: String, value: String, allowed: String| Err(EnvError::Action { index, value, allowed });
        let entries = self.action_len();
        if action.len() != entries {
            let given = format!("{} entries", action.len());
            return wrong(
                String::new(),
                given,
                format!("must have {entries} (forward, left{})", ["", ", up"][entries - 2]),
            );
        }
        match action.iter().position(|value| !(-1.0..=1.0).contains(value)) {
            Some(i) => wrong(format!("[{i}]"), action[i].to_string(), "must lie in -1 .. 1".into()),
            None => Ok(()),
        }
    }

    /// Flies until the waypoint is captured, the leg has lasted its time, the map changes, or the end.
    fn fly(&mut self, waypoint: Vec3) {
        let flight = self.world.scenario().episode.clone();
        let first = self.state.ticks;
        self.state.map_changed = false;
        loop {
            self.tick(waypoint, flight.tick_s);
            self.state.outcome = self.judge();
            if self.state.outcome != Outcome::Running {
                return;
            }
            if self.change_due() && self.world.apply_change(self.state.position) {
                self.state.since_change_m = 0.0;
                self.state.map_changed = true;
                self.measure_clearance();
                return;
            }
            let elapsed = (self.state.ticks - first) as f64 * flight.tick_s;
            if elapsed >= flight.maximum_leg_s {
                return;
            }
            if elapsed >= flight.minimum_leg_s && distance(self.state.position, waypoint) <= flight.capture_radius_m {
                return;
            }
        }
    }

    fn tick(&mut self, waypoint: Vec3, tick_s: f64) {
        let state = &mut self.state;
        let current = self.world.current(state.position);
        let order = self.helm.steer(state.position, state.heading, waypoint, current);
        let through_water = order.speed * tick_s;
        let mut position = add_scaled(state.position, through_water, order.heading);
        position[0] += current[0] * tick_s;
        position[1] += current[1] * tick_s;
        // The surface is no obstacle: a vehicle just cannot rise above it.
        position[2] = position[2].max(self.world.scenario().domain.min_m[2].min(state.position[2]));
        let travelled = distance(state.position, position);
        state.position = position;
        state.heading = order.heading;
        state.ticks += 1;
        state.time_s = state.ticks as f64 * tick_s;
        state.energy_j += self.world.scenario().vehicle.power_w(order.speed) * tick_s;
        state.path_length_m += travelled;
        state.since_change_m += travelled;
        if self.record == Record::Everything {
            state.trail.push(position);
        }
        self.world.set_time(self.state.time_s);
        // No clearance shrinks faster than vehicle and obstacles approach each other: as long as it cannot
        // have become the least so far, it need not be measured.
        self.state.clearance_left_m -= travelled + self.world.fastest_obstacle_mps() * tick_s;
        if self.state.clearance_left_m <= self.state.min_clearance_m {
            self.measure_clearance();
        }
    }

    fn measure_clearance(&mut self) {
        let clearance = self.world.clearance(self.state.position);
        self.state.clearance_left_m = clearance;
        self.state.min_clearance_m = self.state.min_clearance_m.min(clearance);
    }

    fn judge(&self) -> Outcome {
        let (state, scenario) = (&self.state, self.world.scenario());
        let domain = &scenario.domain;
        let outside = (0..3).any(|axis| {
            state.position[axis] < domain.min_m[axis] - domain.margin_m
                || state.position[axis] > domain.max_m[axis] + domain.margin_m
        });
        if state.min_clearance_m <= 0.0 {
            Outcome::Collision
        } else if outside {
            Outcome::OutOfBounds
        } else if self.distance_to_goal_m() <= scenario.limits.goal_radius_m {
            Outcome::Goal
        } else if state.energy_j >= self.limits.energy_j {
            Outcome::Energy
        } else if state.time_s >= self.limits.time_s {
            Outcome::Timeout
        } else {
            Outcome::Running
        }
    }

    fn change_due(&self) -> bool {
        let every = self.world.scenario().change.as_ref().map(Change::every_m);
        every.is_some_and(|every| self.state.since_change_m >= every)
    }

    /// Writes what the vehicle sees now; `values` as long as [`observation::length`] says.
    pub fn observe(&mut self, values: &mut [f32]) {
        let frame = self.frame();
        for (turned, beam) in self.turned.iter_mut().zip(&self.beams) {
            *turned = frame.to_world(*beam);
        }
        let range = self.world.scenario().episode.sonar_range_m;
        let origin = self.state.position;
        self.world.sonar(origin, &self.turned, range, &mut self.scratch, &mut self.ranges);
        observation::observe(self, &self.ranges, values);
    }

    /// The episode as bytes; [`Episode::load`] makes it again and it goes on identically.
    ///
    /// # Errors
    /// [`EnvError`] if the scenario has no text.
    pub fn save(&self) -> Result<Vec<u8>, EnvError> {
        let saved = Saved {
            scenario: self.world.scenario().to_toml()?,
            seed: self.world.seed(),
            mission: self.world.mission_index(),
            changes: self.world.changes().to_vec(),
            state: self.state.clone(),
        };
        postcard::to_allocvec(&saved).map_err(|error| EnvError::Saved(error.to_string()))
    }

    /// An episode from bytes.
    ///
    /// # Errors
    /// [`EnvError`] if they are not those of an episode.
    pub fn load(bytes: &[u8]) -> Result<Self, EnvError> {
        let saved: Saved = postcard::from_bytes(bytes).map_err(|error| EnvError::Saved(error.to_string()))?;
        let scenario = Scenario::from_toml(&saved.scenario)?;
        let world = World::restore(scenario, saved.seed, saved.mission, &saved.changes, saved.state.time_s)?;
        Ok(Self::assemble(world, saved.state))
    }
}

#[cfg(test)]
mod tests;
