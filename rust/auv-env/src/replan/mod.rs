//! Re-plan mode: a planner's path is flown leg by leg, and each action says whether to plan anew.
//!
//! Planning takes time: the vehicle keeps station meanwhile, in the moving world, and the plan rests on the map as
//! it was when planning began.

mod course;
mod observation;
mod settings;

use std::sync::Arc;

use auv_planners::Control;
use auv_planners::registry::{Request, answer};
use auv_world::World;
use auv_world::math::Vec3;
use auv_world::world::ChangeEvent;
use serde::{Deserialize, Serialize};

pub use course::Course;
use course::Way;
pub use observation::BLOCKS;
pub(crate) use observation::observe;
pub use settings::{Delay, Settings, Window};

use crate::error::EnvError;

/// A plan that is still being paid for.
#[derive(Debug, Clone)]
pub struct Draft {
    /// The course, if the planner found a way.
    pub course: Option<Course>,
    /// What the planner spent.
    pub evaluations: u64,
    /// How long planning takes (s).
    pub seconds: f64,
    window: Window,
}

/// Who flies a plan.
#[derive(Debug, Clone)]
pub struct Pilot {
    settings: Arc<Settings>,
    /// The plan in flight.
    pub course: Course,
    /// Plans made, which number the planner's random streams.
    plans: u32,
    /// What planning in each window takes (s), as far as is known.
    delays: [f64; 3],
    way: Way,
}

/// A saved pilot.
#[derive(Serialize, Deserialize)]
pub(crate) struct Saved {
    settings: Settings,
    waypoints: Vec<Vec3>,
    next: usize,
    feasible: bool,
    made_m: f64,
    made_s: f64,
    changes: usize,
    plans: u32,
    delays: [f64; 3],
}

impl Pilot {
    /// A pilot with a plan of the whole way, made before departure, and what the planner spent. A plan that breaks
    /// a constraint is flown all the same: there is no other.
    ///
    /// # Errors
    /// [`EnvError`] for a planner or parameter that is not allowed or does not fit the world, or if interrupted.
    pub fn new(settings: Arc<Settings>, world: &World, control: &Control<'_>) -> Result<(Self, u64), EnvError> {
        let (start, goal) = (world.mission().start_m, world.mission().goal_m);
        let plan = plan(&settings, world, start, goal, 0, control)?;
        let [short, long] = settings.windows;
        let delays = match settings.delay {
            Delay::Fixed(seconds) => seconds,
            Delay::PerEvaluation(seconds) => [short, long, 1.0].map(|part| part * seconds * plan.evaluations as f64),
        };
        let course = Course::new(plan.waypoints, world.clone(), plan.feasible, 0.0);
        Ok((Self { settings, course, plans: 1, delays, way: Way::default() }, plan.evaluations))
    }

    /// Plans anew from `position` within a window, on the present map; nothing is taken yet.
    ///
    /// # Errors
    /// [`EnvError`] if interrupted, or if the planner refuses.
    pub fn draft(
        &mut self,
        world: &World,
        position: Vec3,
        flown_m: f64,
        window: Window,
        control: &Control<'_>,
    ) -> Result<Draft, EnvError> {
        let scenario = world.scenario();
        self.course.advance(position, scenario.episode.capture_radius_m);
        let [low, high] = [scenario.domain.min_m, scenario.domain.max_m];
        // The current may have carried the vehicle a little outside the box.
        let start = std::array::from_fn(|axis| position[axis].clamp(low[axis], high[axis]));
        let mission = world.mission();
        let whole_m = auv_world::math::distance(mission.start_m, mission.goal_m);
        let [short, long] = self.settings.windows;
        let target = match window {
            Window::Short => self.course.window(start, short * whole_m, world, &mut self.way),
            Window::Long => self.course.window(start, long * whole_m, world, &mut self.way),
            Window::Full => None,
        };
        let goal = target.map_or(mission.goal_m, |(place, _)| place);
        let plan = plan(&self.settings, world, start, goal, self.plans, control)?;
        let course = plan.feasible.then(|| {
            let rest = target.map_or(&[][..], |(_, beyond)| &self.course.waypoints[beyond..]);
            Course::new([plan.waypoints.as_slice(), rest].concat(), world.clone(), true, flown_m)
        });
        let seconds = self.settings.delay.seconds(window, plan.evaluations);
        Ok(Draft { course, evaluations: plan.evaluations, seconds, window })
    }

    /// Takes a plan that has been paid for; one that found no way leaves the old plan in flight. Says whether it
    /// was taken.
    pub fn take(&mut self, draft: Draft) -> bool {
        self.plans += 1;
        self.delays[draft.window.index()] = draft.seconds;
        let taken = draft.course.is_some();
        if let Some(course) = draft.course {
            self.course = course;
        }
        taken
    }

    pub(crate) fn save(&self) -> Saved {
        let course = &self.course;
        Saved {
            settings: (*self.settings).clone(),
            waypoints: course.waypoints.clone(),
            next: course.next,
            feasible: course.feasible,
            made_m: course.made_m,
            made_s: course.map.time_s(),
            changes: course.map.changes().len(),
            plans: self.plans,
            delays: self.delays,
        }
    }

    /// A pilot from what was saved, in a `world` whose changes so far are `changes`.
    pub(crate) fn load(saved: Saved, world: &World, changes: &[ChangeEvent]) -> Result<Self, EnvError> {
        let before = changes.get(..saved.changes).ok_or_else(|| EnvError::Saved("a plan of another world".into()))?;
        if saved.next == 0 || saved.next >= saved.waypoints.len() {
            return Err(EnvError::Saved("a plan without a next waypoint".into()));
        }
        let scenario = world.scenario().clone();
        let map = World::restore(scenario, world.seed(), world.mission_index(), before, saved.made_s)?;
        let mut course = Course::new(saved.waypoints, map, saved.feasible, saved.made_m);
        course.next = saved.next;
        let settings = Arc::new(saved.settings);
        Ok(Self { settings, course, plans: saved.plans, delays: saved.delays, way: Way::default() })
    }
}

fn plan(
    settings: &Settings,
    world: &World,
    start: Vec3,
    goal: Vec3,
    stream: u32,
    control: &Control<'_>,
) -> Result<auv_planners::Plan, EnvError> {
    let plan = answer(&Request {
        planner: &settings.planner,
        world,
        start,
        goal,
        seed: world.seed(),
        // Another one for each plan: a planner must not repeat an unlucky draw.
        stream,
        parameters: &settings.parameters,
        control: *control,
        evaluations_left: None,
    })?;
    if plan.interrupted { Err(EnvError::Stopped) } else { Ok(plan) }
}

#[cfg(test)]
mod tests;
