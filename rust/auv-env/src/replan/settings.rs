//! Who plans, how far ahead, and what it takes.

use serde::{Deserialize, Serialize};

use crate::error::EnvError;

/// How much of the way ahead is planned anew.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Window {
    /// The next part of it.
    Short,
    /// A longer part.
    Long,
    /// All of it, to the goal.
    Full,
}

impl Window {
    /// What an action asks for, nothing if it is to go on with the plan.
    ///
    /// # Errors
    /// [`EnvError`] for anything but 0, 1, 2 or 3.
    pub fn asked(action: f32) -> Result<Option<Self>, EnvError> {
        let known = [(0.0, None), (1.0, Some(Self::Short)), (2.0, Some(Self::Long)), (3.0, Some(Self::Full))];
        let found = known.into_iter().find(|(value, _)| *value == action).map(|(_, window)| window);
        found.ok_or_else(|| EnvError::Action {
            index: String::new(),
            value: action.to_string(),
            allowed: "must be 0 (go on), or plan anew: 1 (short window), 2 (long), 3 (to the goal)".into(),
        })
    }

    /// Its place among the three.
    pub fn index(self) -> usize {
        self as usize
    }
}

/// What planning takes of an episode's time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Delay {
    /// So many seconds in a short, a long and the full window.
    Fixed([f64; 3]),
    /// So many seconds for each evaluation that the planner counts.
    PerEvaluation(f64),
}

impl Delay {
    /// What a plan in a window took (s).
    pub fn seconds(self, window: Window, evaluations: u64) -> f64 {
        match self {
            Self::Fixed(seconds) => seconds[window.index()],
            Self::PerEvaluation(seconds) => seconds * evaluations as f64,
        }
    }
}

/// How an episode in re-plan mode is planned.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// The planner's name.
    pub planner: String,
    /// Its parameters, a JSON object; empty for defaults.
    pub parameters: String,
    /// How far a short and a long window reach along the plan, in parts of the distance from start to goal.
    pub windows: [f64; 2],
    /// What planning takes.
    pub delay: Delay,
}

impl Settings {
    /// Whether its numbers are allowed.
    ///
    /// # Errors
    /// [`EnvError`] naming the one that is not.
    pub fn check(&self) -> Result<(), EnvError> {
        let wrong = |name: &str, value: String, allowed: &str| {
            Err(EnvError::Setting { name: name.into(), value, allowed: allowed.into() })
        };
        let [short, long] = self.windows;
        // Written so that NaN fails.
        if !(short > 0.0 && short < long && long < 1.0) {
            let allowed = "must be two parts of the distance from start to goal, 0 < short < long < 1";
            return wrong("windows", format!("{:?}", self.windows), allowed);
        }
        let allowed = "must be finite, 0 or more";
        match self.delay {
            Delay::Fixed(seconds) => match seconds.iter().find(|value| !(value.is_finite() && **value >= 0.0)) {
                Some(value) => wrong("planning_s", value.to_string(), allowed),
                None => Ok(()),
            },
            Delay::PerEvaluation(value) if value.is_finite() && value >= 0.0 => Ok(()),
            Delay::PerEvaluation(value) => wrong("seconds_per_evaluation", value.to_string(), allowed),
        }
    }
}
