//! What can be wrong with a scenario or a world, in words for its author.

use std::path::PathBuf;

/// An error in a scenario or in what is asked of a world.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum WorldError {
    /// A value of a scenario that is not allowed.
    #[error("{}{key} = {value}: {allowed}", place(.file))]
    Scenario {
        /// The file, when there is one.
        file: Option<PathBuf>,
        /// The key, as a path from the top: `obstacles[3].radius_m`.
        key: String,
        /// The value found.
        value: String,
        /// What was allowed.
        allowed: String,
    },
    /// Text that is not a scenario at all: bad syntax, unknown key, missing key, wrong type.
    #[error("{}{message}", place(.file))]
    Format {
        /// The file, when there is one.
        file: Option<PathBuf>,
        /// What is wrong and where.
        message: String,
    },
    /// A file that cannot be read or written.
    #[error("{}: {message}", file.display())]
    File {
        /// The file.
        file: PathBuf,
        /// What kind of failure it is.
        kind: std::io::ErrorKind,
        /// The operating system's words.
        message: String,
    },
    /// A parameter of a generator or a call.
    #[error("{name} = {value}: {allowed}")]
    Parameter {
        /// Its name.
        name: String,
        /// The value found.
        value: String,
        /// What was allowed.
        allowed: String,
    },
}

fn place(file: &Option<PathBuf>) -> String {
    file.as_ref().map_or_else(String::new, |file| format!("{}: ", file.display()))
}

impl WorldError {
    pub(crate) fn key(key: impl Into<String>, value: impl ToString, allowed: impl Into<String>) -> Self {
        Self::Scenario { file: None, key: key.into(), value: value.to_string(), allowed: allowed.into() }
    }

    pub(crate) fn parameter(name: &str, value: impl ToString, allowed: impl Into<String>) -> Self {
        Self::Parameter { name: name.into(), value: value.to_string(), allowed: allowed.into() }
    }

    /// The same error, said of a file.
    pub fn in_file(self, path: &std::path::Path) -> Self {
        match self {
            Self::Scenario { key, value, allowed, .. } => {
                Self::Scenario { file: Some(path.into()), key, value, allowed }
            }
            Self::Format { message, .. } => Self::Format { file: Some(path.into()), message },
            other => other,
        }
    }
}
