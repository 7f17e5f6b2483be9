//! What can be wrong with a question to a planner, in words for whoever asked it.

use auv_world::WorldError;
use auv_world::settings::nearest;

/// A question that cannot be answered. That no path was found is an answer, not an error.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PlanError {
    /// A value that is not allowed.
    #[error("{name} = {value}: {allowed}")]
    Parameter {
        /// Its name.
        name: String,
        /// The value found.
        value: String,
        /// What was allowed.
        allowed: String,
    },
    /// A name that nothing bears.
    #[error("there is no {kind} {name:?}; {}known: {known}", .nearest.as_ref().map_or_else(String::new, |n| format!("did you mean {n:?}? ")))]
    Unknown {
        /// What was looked for: "planner", "cost".
        kind: &'static str,
        /// The name asked for.
        name: String,
        /// The known name most like it, if one is alike.
        nearest: Option<String>,
        /// All known names.
        known: String,
    },
    /// Parameters that are no JSON object of the planner's fields.
    #[error("parameters of {planner}: {message}")]
    Format {
        /// The planner.
        planner: String,
        /// What is wrong and where.
        message: String,
    },
    /// The world or its scenario refused.
    #[error(transparent)]
    World(#[from] WorldError),
    /// The polygons of the world cannot be planned on.
    #[error(transparent)]
    Map(#[from] crate::maklink::MapError),
}

impl PlanError {
    pub(crate) fn parameter(name: impl Into<String>, value: impl ToString, allowed: impl Into<String>) -> Self {
        Self::Parameter { name: name.into(), value: value.to_string(), allowed: allowed.into() }
    }

    /// An unknown name, with the nearest of the known ones.
    pub(crate) fn unknown(kind: &'static str, name: &str, known: &[&str]) -> Self {
        let nearest = nearest(name, known.iter().copied()).map(str::to_owned);
        Self::Unknown { kind, name: name.to_owned(), nearest, known: known.join(", ") }
    }
}

/// Fails unless `value` lies in `low ..= high`.
pub(crate) fn within<T>(name: &str, value: T, low: T, high: T) -> Result<(), PlanError>
where
    T: PartialOrd + std::fmt::Display,
{
    // Written so that NaN fails.
    if value >= low && value <= high {
        return Ok(());
    }
    Err(PlanError::parameter(name, value, format!("must lie in {low} .. {high}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suggests_the_nearest_name() {
        let text = PlanError::unknown("planner", "lfh", &["astar", "lfhh"]).to_string();
        assert_eq!(text, "there is no planner \"lfh\"; did you mean \"lfhh\"? known: astar, lfhh");
        let text = PlanError::unknown("planner", "zzz", &["astar", "lfhh"]).to_string();
        assert_eq!(text, "there is no planner \"zzz\"; known: astar, lfhh");
    }

    #[test]
    fn not_a_number_is_not_within() {
        assert!(within("x", f64::NAN, 0.0, 1.0).is_err());
        assert_eq!(within("x", 2.0, 0.0, 1.0).unwrap_err().to_string(), "x = 2: must lie in 0 .. 1");
    }
}
