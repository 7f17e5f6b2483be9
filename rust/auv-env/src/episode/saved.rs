//! Episodes as bytes.

use auv_world::world::ChangeEvent;
use auv_world::{Scenario, World};
use serde::{Deserialize, Serialize};

use super::{Episode, State};
use crate::error::EnvError;
use crate::replan::{self, Pilot};

/// A saved episode.
#[derive(Serialize, Deserialize)]
struct Saved {
    scenario: String,
    seed: u64,
    mission: usize,
    changes: Vec<ChangeEvent>,
    state: State,
    pilot: Option<replan::Saved>,
}

impl Episode {
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
            pilot: self.pilot.as_ref().map(|pilot| pilot.save()),
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
        let pilot = saved.pilot.map(|pilot| Pilot::load(pilot, &world, &saved.changes).map(Box::new)).transpose()?;
        Ok(Self { pilot, ..Self::assemble(world, saved.state) })
    }
}
