//! One episode: the vehicle flies leg by leg until it arrives or fails.

use std::sync::Arc;

use auv_planners::Control;
use auv_world::World;
use auv_world::math::{Vec3, distance};
use auv_world::scenario::Change;
use auv_world::world::{Neighbour, Scratch};
use serde::{Deserialize, Serialize};

use crate::error::EnvError;
use crate::frame::Frame;
use crate::measures::{Limits, Measures, Outcome, Record};
use crate::observation::{Mode, Writer};
use crate::replan::{Pilot, Settings, Window};
use crate::vehicle::Helm;
use crate::{observation, replan, reward, sonar};
use flight::Leg;

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
    /// What was nearest when clearance was measured last.
    neighbour: Option<Neighbour>,
}

/// An action before its leg is flown.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Departure {
    /// Where the leg leads, if there is one (m).
    waypoint: Option<Vec3>,
    /// Distance to the goal (m) and time (s) when the action was taken.
    distance_m: f64,
    start_s: f64,
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
            neighbour: None,
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
        let departure = self.depart(action, control)?;
        if let Some(leg) = self.leg(&departure) {
            flight::fly(&mut [leg]);
        }
        Ok(self.arrive(&departure))
    }

    /// The same; nothing interrupts it.
    ///
    /// # Errors
    /// As [`Episode::act`].
    pub fn step(&mut self, action: &[f32]) -> Result<f64, EnvError> {
        self.act(action, &Control::none())
    }

    /// Does what an action asks for, up to the leg that it ends with.
    ///
    /// # Errors
    /// As [`Episode::act`].
    pub(crate) fn depart(&mut self, action: &[f32], control: &Control<'_>) -> Result<Departure, EnvError> {
        match self.pilot.take() {
            None => {
                self.check(action)?;
                let departure = self.departure(action);
                Ok(Departure { waypoint: Some(self.waypoint_of(action)), ..departure })
            }
            Some(mut pilot) => {
                let done = self.decide(&mut pilot, action, control);
                self.pilot = Some(pilot);
                done
            }
        }
    }

    /// Plans anew if the action says so, which takes its time, and goes on along the plan. A map change while
    /// planning ends the step: it calls for another decision.
    fn decide(&mut self, pilot: &mut Pilot, action: &[f32], control: &Control<'_>) -> Result<Departure, EnvError> {
        self.check_decision(action)?;
        let (position, flown_m) = (self.state.position, self.state.path_length_m);
        let window = Window::asked(action[0])?;
        let draft = window.map(|window| pilot.draft(&self.world, position, flown_m, window, control)).transpose()?;
        let mut departure = self.departure(action);
        if let Some(draft) = draft {
            self.charge(draft.evaluations, 1);
            let before = self.state.time_s;
            self.hold(draft.seconds);
            self.state.planning_s += self.state.time_s - before;
            self.state.failed_plans += u64::from(!pilot.take(draft));
        }
        if self.state.outcome == Outcome::Running && !self.state.map_changed {
            let flight = &self.world.scenario().episode;
            pilot.course.advance(self.state.position, flight.capture_radius_m);
            departure.waypoint = Some(pilot.course.aim(self.state.position, flight));
        }
        Ok(departure)
    }

    /// Notes an action, and what its reward is reckoned from.
    fn departure(&mut self, action: &[f32]) -> Departure {
        if self.record == Record::Everything {
            self.state.actions.extend_from_slice(action);
        }
        self.state.map_changed = false;
        Departure { waypoint: None, distance_m: self.distance_to_goal_m(), start_s: self.state.time_s }
    }

    /// The leg that an action ends with, if there is still one to be flown.
    pub(crate) fn leg(&mut self, departure: &Departure) -> Option<Leg<'_>> {
        departure.waypoint.map(|waypoint| Leg::towards(self, waypoint))
    }

    /// The reward of an action whose leg was flown.
    pub(crate) fn arrive(&self, departure: &Departure) -> f64 {
        let elapsed = self.state.time_s - departure.start_s;
        let (before, after) = (departure.distance_m, self.distance_to_goal_m());
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

    /// Keeps station for `seconds`, in whole ticks, or until the end. The map may change meanwhile.
    fn hold(&mut self, seconds: f64) {
        let tick_s = self.world.scenario().episode.tick_s;
        let last = self.state.ticks.saturating_add((seconds / tick_s).ceil() as u64);
        let here = self.state.position;
        while self.state.ticks < last && self.state.outcome == Outcome::Running {
            let ticks = last - self.state.ticks;
            flight::fly(&mut [Leg::hold(self, here, ticks)]);
        }
    }

    /// Judges the leg that was flown, and changes the map if that is due.
    fn judge(&mut self) {
        self.state.outcome = self.outcome();
        let due = self.state.since_change_m >= self.change_every_m();
        if self.state.outcome == Outcome::Running && due && self.world.apply_change(self.state.position) {
            self.state.since_change_m = 0.0;
            self.state.map_changed = true;
            self.neighbour = None;
            let clearance = self.clearance_at(self.state.position, self.state.min_clearance_m);
            self.state.clearance_left_m = clearance;
            self.state.min_clearance_m = self.state.min_clearance_m.min(clearance);
        }
    }

    /// The clearance at a place (m), as far as it can matter where the least so far is `least_m`.
    fn clearance_at(&mut self, position: Vec3, least_m: f64) -> f64 {
        self.world.clearance_along(position, least_m + self.lookout_m, &mut self.neighbour)
    }

    fn outcome(&self) -> Outcome {
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

    /// Path length between map changes (m).
    fn change_every_m(&self) -> f64 {
        self.world.scenario().change.as_ref().map_or(f64::INFINITY, Change::every_m)
    }

    /// The obstacles, in no order, that may be within sonar range of where the vehicle last looked, and where they
    /// lie from there (m).
    pub(crate) fn within_sonar(&self) -> impl Iterator<Item = (usize, Vec3)> {
        self.world.within_sonar(&self.scratch, self.state.position)
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

pub(crate) mod flight;
mod saved;
mod waypoints;

#[cfg(test)]
mod tests;
