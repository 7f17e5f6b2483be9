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
    /// A step after the end.
    #[error("the episode has ended ({0}): call reset() first")]
    Ended(&'static str),
    /// A saved episode that cannot be read.
    #[error("saved episode: {0}")]
    Saved(String),
    /// A wrong scenario.
    #[error(transparent)]
    World(#[from] auv_world::WorldError),
}
