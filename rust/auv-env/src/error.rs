//! What can be wrong with what is asked of an episode.

/// An error in an action or a saved episode.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum EnvError {
    /// A wrong action.
    #[error("action{index} = {value}: {allowed}")]
    Action {
        /// Which entry, as `[2]`, or empty for the whole.
        index: String,
        /// What was given.
        value: String,
        /// What was allowed.
        allowed: String,
    },
    /// A wrong setting.
    #[error("{name} = {value}: {allowed}")]
    Setting {
        /// Its name.
        name: String,
        /// What was given.
        value: String,
        /// What was allowed.
        allowed: String,
    },
    /// A step after the end.
    #[error("the episode has ended ({0}): call reset() first")]
    Ended(&'static str),
    /// A saved episode that cannot be read.
    #[error("saved episode: {0}")]
    Saved(String),
    /// The same of one environment of a batch.
    #[error("environment {index}: {error}")]
    Environment {
        /// Which environment.
        index: usize,
        /// What is wrong.
        error: Box<EnvError>,
    },
    /// Work that was stopped half way.
    #[error("stopped: call reset() first")]
    Stopped,
    /// What a planner refuses.
    #[error(transparent)]
    Planning(#[from] auv_planners::PlanError),
    /// A wrong scenario.
    #[error(transparent)]
    World(#[from] auv_world::WorldError),
}

impl EnvError {
    /// The error as that of environment `index` of a batch.
    pub fn of(self, index: usize) -> Self {
        Self::Environment { index, error: Box::new(self) }
    }
}
