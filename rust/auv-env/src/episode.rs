//! One episode: the vehicle flies leg by leg until it arrives or fails.

use std::sync::Arc;

use auv_planners::Control;
use auv_world::World;
use auv_world::math::{Vec3, add_scaled, distance};
use auv_world::scenario::Change;
use auv_world::world::Scratch;
use serde::{Deserialize, Serialize};

use crate::error::EnvError;
use crate::frame::Frame;
use crate::measures::{Limits, Measures, Outcome, Record};
use crate::observation::{Mode, Writer};
use crate::replan::{Pilot, Settings, Window};
use crate::vehicle::Helm;
use crate::{observation, replan, reward, sonar};

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
    /// Time spent keeping station while a plan was made (s).
    pub planning_s: f64,
    /// Plans after the first that found no way and were not taken.
    pub failed_plans: u64,
    /// Whether the last leg ended with a map change.
    pub map_changed: bool,
    /// How it stands.
    pub outcome: Outcome,
    /// Where the vehicle was after each tick, the start first (m).
    pub trail: Vec<Vec3>,
    /// All actions so far, one after another.
    pub actions: Vec<f32>,
}

/// For so many ticks at full speed nothing comes nearer than what was found in the way.
const LOOKOUT_TICKS: f64 = 16.0;

/// One episode.
#[derive(Debug, Clone)]
pub struct Episode {
    world: World,
    limits: Limits,
    /// The box and its margin (m).
    bounds: [Vec3; 2],
    /// How much farther than the least clearance so far what is near is looked at (m).
    lookout_m: f64,
    helm: Helm,
    state: State,
    record: Record,
    /// Who flies a plan, in re-plan mode.
    pilot: Option<Box<Pilot>>,
    beams: &'static [Vec3],
    turned: Vec<Vec3>,
    ranges: Vec<f64>,
    scratch: Scratch,
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
            planning_s: 0.0,
            failed_plans: 0,
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
        let domain = &scenario.domain;
        let bounds = [domain.min_m.map(|low| low - domain.margin_m), domain.max_m.map(|high| high + domain.margin_m)];
        // What is measured less often is measured farther. A lower bound must be measured when it always was.
        let near = world.has_other_solids() && world.has_exact_clearance();
        let lookout_m = if near { LOOKOUT_TICKS * vehicle.speed_mps * scenario.episode.tick_s } else { f64::INFINITY };
        Self {
            world,
            limits,
            bounds,
            lookout_m,
            helm,
            state,
            record: Record::Everything,
            pilot: None,
            turned: beams.to_vec(),
            ranges: vec![0.0; beams.len()],
            beams,
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
            planning_s: state.planning_s,
            failed_plans: state.failed_plans,
            plan_feasible: self.pilot.as_ref().is_some_and(|pilot| pilot.course.feasible),
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

    /// What actions decide.
    pub fn mode(&self) -> Mode {
        if self.pilot.is_some() { Mode::Replan } else { Mode::Waypoint }
    }

    /// Who flies a plan, in re-plan mode.
    pub fn pilot(&self) -> Option<&Pilot> {
        self.pilot.as_deref()
    }

    /// Entries of an action.
    pub fn action_len(&self) -> usize {
        self.mode().action_len(self.world.scenario().dimensions)
    }

    /// Plans the whole way, before departure: from now on actions say when to plan anew.
    ///
    /// # Errors
    /// [`EnvError`] for a planner or parameter that is not allowed or does not fit the world, or if interrupted.
    pub fn plan(&mut self, settings: Arc<Settings>, control: &Control<'_>) -> Result<(), EnvError> {
        let (pilot, evaluations) = Pilot::new(settings, &self.world, control)?;
        self.pilot = Some(Box::new(pilot));
        self.charge(evaluations, 0);
        Ok(())
    }

    /// Charges planning to the episode.
    pub fn charge(&mut self, evaluations: u64, replans: u64) {
        self.state.evaluations += evaluations;
        self.state.replans += replans;
    }

    /// Takes an action in either mode; gives its reward. Only planning listens to `control`.
    ///
    /// # Errors
    /// [`EnvError`] for a wrong action, an episode that has ended, or planning that was interrupted; nothing has
    /// changed then.
    pub fn act(&mut self, action: &[f32], control: &Control<'_>) -> Result<f64, EnvError> {
        match self.pilot.take() {
            None => self.steer(action),
            Some(mut pilot) => {
                let done = self.decide(&mut pilot, action, control);
                self.pilot = Some(pilot);
                done
            }
        }
    }

    /// The same; nothing interrupts it.
    ///
    /// # Errors
    /// As [`Episode::act`].
    pub fn step(&mut self, action: &[f32]) -> Result<f64, EnvError> {
        self.act(action, &Control::none())
    }

    /// Flies one leg towards the action's waypoint.
    fn steer(&mut self, action: &[f32]) -> Result<f64, EnvError> {
        self.check(action)?;
        let waypoint = self.waypoint_of(action);
        Ok(self.rewarded(action, |episode| episode.fly(waypoint)))
    }

    /// Plans anew if the action says so, which takes its time, and flies one leg of the plan. A map change while
    /// planning ends the step: it calls for another decision.
    fn decide(&mut self, pilot: &mut Pilot, action: &[f32], control: &Control<'_>) -> Result<f64, EnvError> {
        self.check_decision(action)?;
        let (position, flown_m) = (self.state.position, self.state.path_length_m);
        let window = Window::asked(action[0])?;
        let draft = window.map(|window| pilot.draft(&self.world, position, flown_m, window, control)).transpose()?;
        Ok(self.rewarded(action, |episode| {
            if let Some(draft) = draft {
                episode.charge(draft.evaluations, 1);
                let before = episode.state.time_s;
                episode.hold(draft.seconds);
                episode.state.planning_s += episode.state.time_s - before;
                episode.state.failed_plans += u64::from(!pilot.take(draft));
            }
            if episode.state.outcome == Outcome::Running && !episode.state.map_changed {
                let flight = &episode.world.scenario().episode;
                pilot.course.advance(episode.state.position, flight.capture_radius_m);
                let aim = pilot.course.aim(episode.state.position, flight);
                episode.fly(aim);
            }
        }))
    }

    /// Does what an action asks for; gives its reward.
    fn rewarded(&mut self, action: &[f32], work: impl FnOnce(&mut Self)) -> f64 {
        if self.record == Record::Everything {
            self.state.actions.extend_from_slice(action);
        }
        self.state.map_changed = false;
        let (before, start_s) = (self.distance_to_goal_m(), self.state.time_s);
        work(self);
        let elapsed = self.state.time_s - start_s;
        let after = self.distance_to_goal_m();
        reward::leg(before, after, self.limits.distance_m, elapsed, self.limits.time_s, self.state.outcome)
    }

    /// Whether an action may be taken.
    ///
    /// # Errors
    /// As [`Episode::act`].
    pub fn check(&self, action: &[f32]) -> Result<(), EnvError> {
        if self.pilot.is_some() {
            return self.check_decision(action);
        }
        self.check_running()?;
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

    fn check_decision(&self, action: &[f32]) -> Result<(), EnvError> {
        self.check_running()?;
        match action {
            [choice] => Window::asked(*choice).map(|_| ()),
            _ => {
                let (index, value) = (String::new(), format!("{} entries", action.len()));
                Err(EnvError::Action { index, value, allowed: "must be one".into() })
            }
        }
    }

    fn check_running(&self) -> Result<(), EnvError> {
        match self.state.outcome {
            Outcome::Running => Ok(()),
            ended => Err(EnvError::Ended(ended.name())),
        }
    }

    /// Flies until the waypoint is captured, the leg has lasted its time, the map changes, or the end.
    fn fly(&mut self, waypoint: Vec3) {
        self.state.waypoint = Some(waypoint);
        let flight = self.world.scenario().episode.clone();
        let first = self.state.ticks;
        loop {
            self.tick(waypoint, flight.tick_s);
            if self.judged() {
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

    /// Keeps station for `seconds`, in whole ticks, or until the end. The map may change meanwhile.
    fn hold(&mut self, seconds: f64) {
        let (here, tick_s) = (self.state.position, self.world.scenario().episode.tick_s);
        self.state.waypoint = Some(here);
        let last = self.state.ticks.saturating_add((seconds / tick_s).ceil() as u64);
        while self.state.ticks < last && self.state.outcome == Outcome::Running {
            self.tick(here, tick_s);
            self.judged();
        }
    }

    /// Judges the tick that was flown, and changes the map if that is due: whether a leg ends with it.
    fn judged(&mut self) -> bool {
        self.state.outcome = self.judge();
        if self.state.outcome != Outcome::Running {
            return true;
        }
        if self.change_due() && self.world.apply_change(self.state.position) {
            self.state.since_change_m = 0.0;
            self.state.map_changed = true;
            self.measure_clearance();
            return true;
        }
        false
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
        let farthest = self.state.min_clearance_m + self.lookout_m;
        let clearance = self.world.clearance_within(self.state.position, farthest);
        self.state.clearance_left_m = clearance;
        self.state.min_clearance_m = self.state.min_clearance_m.min(clearance);
    }

    fn judge(&self) -> Outcome {
        let (state, [low, high]) = (&self.state, self.bounds);
        let outside = (0..3).any(|axis| state.position[axis] < low[axis] || state.position[axis] > high[axis]);
        if state.min_clearance_m <= 0.0 {
            Outcome::Collision
        } else if outside {
            Outcome::OutOfBounds
        } else if self.distance_to_goal_m() <= self.world.scenario().limits.goal_radius_m {
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

    /// The obstacles, in no order, that may be within sonar range of where the vehicle last looked.
    pub(crate) fn within_sonar(&self) -> impl Iterator<Item = usize> {
        self.world.within_sonar(&self.scratch)
    }

    /// Writes what the vehicle sees now; `values` as long as [`observation::length`] says.
    pub fn observe(&mut self, values: &mut [f32]) {
        let frame = self.frame();
        for (turned, beam) in self.turned.iter_mut().zip(self.beams) {
            *turned = frame.to_world(*beam);
        }
        let range = self.world.scenario().episode.sonar_range_m;
        let origin = self.state.position;
        self.world.sonar(origin, &self.turned, range, &mut self.scratch, &mut self.ranges);
        let mut out = Writer::new(values);
        observation::observe(self, &self.ranges, &mut out);
        if let Some(mut pilot) = self.pilot.take() {
            replan::observe(self, &mut pilot, &mut out);
            self.pilot = Some(pilot);
        }
    }
}

mod saved;
mod waypoints;

#[cfg(test)]
mod tests;
