//! Parameters of a navigator, in the paper's set and the recommended one.

use auv_world::World;
use auv_world::math::Vec3;
use serde::Deserialize;

use super::kalman::Noise;
use super::navigator::{Navigator, Prediction, Rules, Side};
use crate::error::{PlanError, within};
use crate::fluid::field::Coefficients;
use crate::fluid::settings::{Flow, Options, check_coefficients};
use crate::sections::check_place;

/// Whose rules.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RuleSet {
    /// The paper's: the flow as printed, threats as large as they are, no barrier.
    Paper,
    /// The mended flow, a margin, a barrier, and no heed of what goes away.
    #[default]
    Recommended,
}

/// Parameters of a navigator; what is left out is as `rules` has it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// The set that all else is a change to.
    pub rules: RuleSet,
    /// rho0 of threats.
    pub rho: f64,
    /// sigma0 of threats.
    pub sigma: f64,
    /// s: 0 passes threats level, 1 over them.
    pub share: f64,
    /// On which side threats are passed.
    pub side: Side,
    /// theta of what is at rest (rad).
    pub theta: f64,
    /// lambda: 1 leaves the current out.
    pub lambda: f64,
    /// V0 (m/s); 0: the vehicle's speed.
    pub virtual_speed_mps: f64,
    /// The flow takes threats to be this much larger than they are (m).
    pub margin_m: Option<f64>,
    /// A threat's side, once chosen, changes only when the angle of eq. 32 is so far beyond a right one (rad).
    pub latch_rad: f64,
    /// The flow takes threats to be where they will be then (s).
    pub horizon_s: f64,
    /// Whether it meets them there or all the way there.
    pub prediction: Prediction,
    /// alpha: the gap to a threat may shrink by this part of it in a second (1/s); 0: no barrier.
    pub barrier_per_s: Option<f64>,
    /// Whether the flow passes over threats that go away by themselves.
    pub ignore_receding: Option<bool>,
    /// Whether threats turn the flow in their own frame instead.
    pub relative: bool,
    /// Standard deviation of measurements along each axis (m).
    pub noise_m: f64,
    /// Strength of the noise in a threat's acceleration (m^2/s^3): how much it may manoeuvre.
    pub process_m2ps3: f64,
}

impl Default for Settings {
    fn default() -> Self {
        let rules = Rules::default();
        Self {
            rules: RuleSet::default(),
            rho: rules.rho,
            sigma: rules.sigma,
            share: rules.share,
            side: rules.side,
            theta: rules.still.theta,
            lambda: 1.0,
            virtual_speed_mps: 0.0,
            margin_m: None,
            latch_rad: rules.latch_rad,
            horizon_s: rules.horizon_s,
            prediction: rules.prediction,
            barrier_per_s: None,
            ignore_receding: None,
            relative: rules.relative,
            noise_m: rules.noise.measurement_m,
            process_m2ps3: rules.noise.process,
        }
    }
}

impl Settings {
    /// Checks every value.
    ///
    /// # Errors
    /// [`PlanError::Parameter`] naming the first that is not allowed.
    pub fn check(&self) -> Result<(), PlanError> {
        check_coefficients("", self.still())?;
        within("share", self.share, -1.0, 1.0)?;
        within("lambda", self.lambda, 0.0, 1.0)?;
        within("virtual_speed_mps", self.virtual_speed_mps, 0.0, 1e6)?;
        within("margin_m", self.margin_m.unwrap_or(0.0), 0.0, 1e9)?;
        within("latch_rad", self.latch_rad, 0.0, std::f64::consts::FRAC_PI_2)?;
        within("horizon_s", self.horizon_s, 0.0, 1e9)?;
        within("barrier_per_s", self.barrier_per_s.unwrap_or(0.0), 0.0, 1e3)?;
        within("noise_m", self.noise_m, 0.0, 1e9)?;
        within("process_m2ps3", self.process_m2ps3, 0.0, 1e9)
    }

    fn still(&self) -> Coefficients {
        Coefficients { rho: self.rho, sigma: self.sigma, theta: self.theta }
    }

    /// A navigator from `start` to `goal` that knows of no threat yet.
    ///
    /// # Errors
    /// [`PlanError::Parameter`] naming what is not allowed.
    pub fn navigator(&self, world: &World, [start, goal]: [Vec3; 2]) -> Result<Navigator, PlanError> {
        self.check()?;
        check_place(world, "start", start)?;
        check_place(world, "goal", goal)?;
        let (options, usual) = match self.rules {
            RuleSet::Paper => (Options::Literal, Rules::paper()),
            RuleSet::Recommended => (Options::Recommended, Rules::default()),
        };
        let rules = Rules {
            rho: self.rho,
            sigma: self.sigma,
            share: self.share,
            side: self.side,
            margin_m: self.margin_m.unwrap_or(usual.margin_m),
            latch_rad: self.latch_rad,
            horizon_s: self.horizon_s,
            prediction: self.prediction,
            relative: self.relative,
            ignore_receding: self.ignore_receding.unwrap_or(usual.ignore_receding),
            barrier_per_s: self.barrier_per_s.unwrap_or(usual.barrier_per_s),
            noise: Noise { measurement_m: self.noise_m, process: self.process_m2ps3, ..usual.noise },
            still: self.still(),
        };
        let flow = Flow { options, virtual_speed_mps: self.virtual_speed_mps, ..Flow::default() };
        Ok(Navigator::new(world, [start, goal], &[], self.lambda, &flow, rules))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    fn message(json: &str) -> String {
        let world = testing::paper_world("iifds-threat1", 0);
        let settings: Settings = serde_json::from_str(json).unwrap();
        let ends = [world.mission().start_m, world.mission().goal_m];
        settings.navigator(&world, ends).err().map_or_else(String::new, |error| error.to_string())
    }

    #[test]
    fn what_is_not_allowed_is_named() {
        assert_eq!(message("{}"), "");
        assert_eq!(message(r#"{"rules": "paper", "margin_m": 50.0}"#), "");
        assert_eq!(message(r#"{"share": 2}"#), "share = 2: must lie in -1 .. 1");
        assert!(message(r#"{"rho": 0}"#).starts_with("rho = 0"));
        assert!(serde_json::from_str::<Settings>(r#"{"rules": "mine"}"#).is_err());
    }

    /// The paper's rules come nearer to a threat than the recommended ones.
    #[test]
    fn rules_differ() {
        let world = testing::paper_world("iifds-threat1", 0);
        let ends = [[0.0, 5e3, 2e3], [10e3, 5e3, 2e3]];
        let course = |json: &str| {
            let settings: Settings = serde_json::from_str(json).unwrap();
            let mut navigator = settings.navigator(&world, ends).unwrap();
            for time in [0.0, 6.0, 12.0] {
                navigator.see([1600.0, 5e3 + time, 2e3], 1e3, time);
            }
            navigator.course(ends[0], 12.0, 6.0).velocity
        };
        assert!(course("{}")[0] < course(r#"{"rules": "paper"}"#)[0]);
    }
}
