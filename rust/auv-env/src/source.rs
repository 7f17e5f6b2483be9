//! Where episodes come from: one scenario, or a seeded draw from a family.

use auv_world::families::{self, Parameters, generate};
use auv_world::{Scenario, World, WorldError};

use crate::episode::Episode;

/// Makes episodes from seeds.
#[derive(Debug, Clone)]
pub enum Source {
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
        Ok(Self::Fixed(Box::new(World::new(scenario, 0, mission)?)))
    }

    /// Episodes in worlds drawn from a family.
    ///
    /// # Errors
    /// [`WorldError`] if the family or a parameter is not allowed.
    pub fn family(family: &str, parameters: Parameters) -> Result<Self, WorldError> {
        let scenario = generate(family, 0, &parameters)?;
        scenario.check()?;
        let dimensions = scenario.dimensions;
        Ok(Self::Family { family: family.into(), parameters: Box::new(parameters), dimensions })
    }

    /// Dimensions of its worlds.
    pub fn dimensions(&self) -> u8 {
        match self {
            Self::Fixed(world) => world.scenario().dimensions,
            Self::Family { dimensions, .. } => *dimensions,
        }
    }

    /// The world of the episode with this seed.
    ///
    /// # Errors
    /// [`WorldError`] if the family cannot be drawn.
    pub fn world(&self, seed: u64) -> Result<World, WorldError> {
        match self {
            Self::Fixed(world) => Ok(world.fresh(seed)),
            Self::Family { family, parameters, .. } => families::world(family, seed, parameters),
        }
    }

    /// The episode with this seed.
    ///
    /// # Errors
    /// As [`Source::world`].
    pub fn episode(&self, seed: u64) -> Result<Episode, WorldError> {
        self.world(seed).map(Episode::new)
    }
}
