//! Where episodes come from: one scenario, or a seeded draw from a family.

use std::sync::Arc;

use auv_planners::Control;
use auv_world::families::{self, Parameters, generate};
use auv_world::{Scenario, World, WorldError};

use crate::episode::Episode;
use crate::error::EnvError;
use crate::measures::Record;
use crate::observation::{self, Mode};
use crate::replan::{Pilot, Settings};

/// Makes episodes from seeds.
#[derive(Debug, Clone)]
pub struct Source {
    worlds: Worlds,
    /// How episodes are planned, in re-plan mode.
    replan: Option<Arc<Settings>>,
}

/// Where worlds come from.
#[derive(Debug, Clone)]
enum Worlds {
    /// Always this scenario; the seed decides how its map changes.
    Fixed(Box<World>),
    /// A new scenario for every seed.
    Family {
        /// The family's name.
        family: String,
        /// Its parameters.
        parameters: Box<Parameters>,
        /// Dimensions of its worlds.
        dimensions: u8,
    },
}

impl Source {
    /// Episodes in one scenario, on its start/goal pair `mission`.
    ///
    /// # Errors
    /// [`WorldError`] if the scenario is not allowed.
    pub fn fixed(scenario: Scenario, mission: usize) -> Result<Self, WorldError> {
        let worlds = Worlds::Fixed(Box::new(World::new(scenario, 0, mission)?));
        Ok(Self { worlds, replan: None })
    }

    /// Episodes in worlds drawn from a family.
    ///
    /// # Errors
    /// [`WorldError`] if the family or a parameter is not allowed.
    pub fn family(family: &str, parameters: Parameters) -> Result<Self, WorldError> {
        let scenario = generate(family, 0, &parameters)?;
        scenario.check()?;
        let dimensions = scenario.dimensions;
        let worlds = Worlds::Family { family: family.into(), parameters: Box::new(parameters), dimensions };
        Ok(Self { worlds, replan: None })
    }

    /// The same in re-plan mode. The planner is asked for a plan of one evaluation in the first world, so that what
    /// it does not allow is known now.
    ///
    /// # Errors
    /// [`EnvError`] for a setting, planner or parameter that is not allowed or does not fit these worlds, or if
    /// interrupted.
    pub fn replanning(self, settings: Settings, control: &Control<'_>) -> Result<Self, EnvError> {
        settings.check()?;
        let trial = Settings { parameters: one_evaluation(&settings.parameters)?, ..settings.clone() };
        Pilot::new(Arc::new(trial), &self.world(0)?, control)?;
        Ok(Self { replan: Some(Arc::new(settings)), ..self })
    }

    /// Dimensions of its worlds.
    pub fn dimensions(&self) -> u8 {
        match &self.worlds {
            Worlds::Fixed(world) => world.scenario().dimensions,
            Worlds::Family { dimensions, .. } => *dimensions,
        }
    }

    /// What actions decide in its episodes.
    pub fn mode(&self) -> Mode {
        if self.replan.is_some() { Mode::Replan } else { Mode::Waypoint }
    }

    /// Entries of an action and of an observation.
    pub fn widths(&self) -> (usize, usize) {
        let (mode, dimensions) = (self.mode(), self.dimensions());
        (mode.action_len(dimensions), observation::length(dimensions, mode))
    }

    /// The world of the episode with this seed.
    ///
    /// # Errors
    /// [`WorldError`] if the family cannot be drawn.
    pub fn world(&self, seed: u64) -> Result<World, WorldError> {
        match &self.worlds {
            Worlds::Fixed(world) => Ok(world.fresh(seed)),
            Worlds::Family { family, parameters, .. } => families::world(family, seed, parameters),
        }
    }

    /// The episode with this seed, keeping what `record` says, planned if it is to be.
    ///
    /// # Errors
    /// [`EnvError`] as [`Source::world`] and [`Episode::plan`].
    pub fn begin(&self, seed: u64, record: Record, control: &Control<'_>) -> Result<Episode, EnvError> {
        let mut episode = Episode::recording(self.world(seed)?, record);
        if let Some(settings) = &self.replan {
            episode.plan(Arc::clone(settings), control)?;
        }
        Ok(episode)
    }

    /// The same, keeping everything; nothing interrupts it.
    ///
    /// # Errors
    /// As [`Source::begin`].
    pub fn episode(&self, seed: u64) -> Result<Episode, EnvError> {
        self.begin(seed, Record::Everything, &Control::none())
    }
}

/// A planner's parameters, but with a budget of one evaluation.
fn one_evaluation(parameters: &str) -> Result<String, EnvError> {
    let text = if parameters.trim().is_empty() { "{}" } else { parameters };
    let wrong = |error: serde_json::Error| EnvError::Setting {
        name: "planner_parameters".into(),
        value: text.into(),
        allowed: format!("must be a JSON object ({error})"),
    };
    let mut object: serde_json::Map<String, serde_json::Value> = serde_json::from_str(text).map_err(wrong)?;
    object.insert("max_evaluations".into(), 1.into());
    serde_json::to_string(&object).map_err(wrong)
}
