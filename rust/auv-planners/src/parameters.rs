//! Parameters as JSON objects: some that every planner has, and the planner's own.

use auv_world::settings::suggest;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use crate::cost::{Cost, CostOptions};
use crate::error::{PlanError, within};

/// When a population planner ends its search.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StopRule {
    /// After the generation that found a feasible path.
    FirstFeasible,
    /// When the generations or evaluations are spent.
    Exhaust,
}

/// What every planner understands.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Common {
    /// At most this many paths are evaluated; a re-planning call spends it over all its attempts.
    pub max_evaluations: Option<u64>,
    /// At most this many generations; without it the planner's default, or no limit if
    /// `max_evaluations` is given.
    pub generations: Option<u64>,
    /// When a population planner stops; without it the planner's default.
    pub stop: Option<StopRule>,
    /// Population planners stop after the generation that found a path of this total cost or less.
    pub target_cost: Option<f64>,
    /// What is minimised.
    pub cost: Cost,
    /// Readings and limits of the cost.
    pub cost_options: CostOptions,
}

impl Common {
    /// Names of the common parameters.
    pub const NAMES: [&'static str; 6] =
        ["max_evaluations", "generations", "stop", "target_cost", "cost", "cost_options"];

    fn check(&self) -> Result<(), PlanError> {
        within("max_evaluations", self.max_evaluations.unwrap_or(1), 1, 1 << 53)?;
        within("generations", self.generations.unwrap_or(0), 0, 1 << 32)?;
        within("target_cost", self.target_cost.unwrap_or(0.0), -1e9, 1e9)?;
        self.cost_options.check()
    }

    /// The number of generations, given the planner's default.
    pub fn generations_or(&self, default: u64) -> u64 {
        let unlimited = if self.max_evaluations.is_some() { u64::MAX } else { default };
        self.generations.unwrap_or(unlimited)
    }
}

/// A planner's own parameters. Implementors are structs that deny unknown fields.
pub trait Parameters: DeserializeOwned {
    /// Checks every value.
    ///
    /// # Errors
    /// [`PlanError::Parameter`] naming field, value and what is allowed.
    fn check(&self) -> Result<(), PlanError>;
}

/// Reads the parameters of a planner; an empty text is an empty object.
///
/// # Errors
/// [`PlanError`] if the text is not such an object or a value is not allowed.
pub fn parse<P: Parameters>(planner: &str, json: &str) -> Result<(Common, P), PlanError> {
    let wrong = |message: String| PlanError::Format { planner: planner.to_owned(), message: suggest(message) };
    let (common, own) = split(planner, json)?;
    let own: P = read(own).map_err(|message| {
        let hint = if message.contains("unknown field") {
            format!(", or for all planners: {}", Common::NAMES.map(|name| format!("`{name}`")).join(", "))
        } else {
            String::new()
        };
        wrong(message + &hint)
    })?;
    own.check()?;
    Ok((common, own))
}

/// Reads the common parameters alone.
///
/// # Errors
/// As [`parse`], but for the planner's own parameters.
pub fn parse_common(planner: &str, json: &str) -> Result<Common, PlanError> {
    split(planner, json).map(|(common, _)| common)
}

/// The common parameters, and what else there is.
fn split(planner: &str, json: &str) -> Result<(Common, Map<String, Value>), PlanError> {
    let wrong = |message: String| PlanError::Format { planner: planner.to_owned(), message: suggest(message) };
    let json = if json.trim().is_empty() { "{}" } else { json };
    let mut own: Map<String, Value> = serde_json::from_str(json).map_err(|error| wrong(error.to_string()))?;
    let mut common = Map::new();
    for name in Common::NAMES {
        if let Some(value) = own.remove(name) {
            common.insert(name.to_owned(), value);
        }
    }
    let common: Common = read(common).map_err(&wrong)?;
    common.check()?;
    Ok((common, own))
}

fn read<T: DeserializeOwned>(object: Map<String, Value>) -> Result<T, String> {
    auv_world::settings::read(Value::Object(object))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::histogram::Settings;

    fn message(json: &str) -> String {
        parse::<Settings>("lfhh", json).unwrap_err().to_string()
    }

    #[test]
    fn reads_common_and_own() {
        let json = r#"{"population": 50, "cost": "time", "max_evaluations": 9, "cost_options": {"margin_m": 300}}"#;
        let (common, own) = parse::<Settings>("lfhh", json).unwrap();
        assert_eq!((own.population, common.cost, common.max_evaluations), (50, Cost::Time, Some(9)));
        assert_eq!(common.cost_options.margin_m, 300.0);
        assert_eq!(common.generations_or(100), u64::MAX);
        assert_eq!(parse::<Settings>("lfhh", "").unwrap().0.generations_or(100), 100);
    }

    #[test]
    fn errors_name_field_value_and_what_is_allowed() {
        assert_eq!(message(r#"{"max_evaluations": 0}"#), "max_evaluations = 0: must lie in 1 .. 9007199254740992");
        assert_eq!(
            message(r#"{"bins": 1.5}"#),
            "parameters of lfhh: bins: invalid type: floating point `1.5`, expected usize"
        );
        let unknown = message(r#"{"lamda": 1}"#);
        assert!(unknown.contains("unknown field `lamda`") && unknown.contains("`learning_rate`"), "{unknown}");
        assert!(unknown.contains("`max_evaluations`") && !unknown.contains("did you mean"), "{unknown}");
        assert!(message(r#"{"max_evaluation": 1}"#).ends_with("; did you mean `max_evaluations`?"));
        let variant = message(r#"{"cost_options": {"collision": "laser"}}"#);
        assert!(variant.contains("cost_options.collision: unknown variant `laser`"), "{variant}");
        assert!(message(r#"{"cost_options": {"margin_m": 9, "collision": "cells"}}"#).contains("margin_m = 9"));
        assert!(message("[1]").starts_with("parameters of lfhh: invalid type"));
    }
}
