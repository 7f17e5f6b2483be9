//! Parameters of IIFDS, in the two sets that the literature and experience give.

use auv_world::World;
use auv_world::math::{Vec3, distance};
use serde::Deserialize;

use super::field::{Coefficients, Field, Modulation};
use super::obstacles::{Class, bodies};
use super::trace::{Advance, Steps};
use crate::error::{PlanError, within};

/// A whole set of options.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Options {
    /// As the paper prints it, in kilometres.
    Literal,
    /// Repulsion that does not vanish at surfaces, a way out of obstacles, no brake behind them, a guard.
    #[default]
    Recommended,
}

/// Coefficients of one class of obstacle; what is left out is as for all.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ClassCoefficients {
    /// rho0.
    pub rho: Option<f64>,
    /// sigma0.
    pub sigma: Option<f64>,
    /// theta (rad).
    pub theta: Option<f64>,
}

/// Coefficients by class of obstacle.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Classes {
    /// Of balls.
    pub sphere: ClassCoefficients,
    /// Of discs.
    pub disc: ClassCoefficients,
    /// Of cylinders.
    pub cylinder: ClassCoefficients,
    /// Of superquadrics.
    pub superquadric: ClassCoefficients,
    /// Of polygons.
    pub polygon: ClassCoefficients,
    /// Of the sea floor.
    pub seabed: ClassCoefficients,
}

/// How the flow is made and followed, for all planners of this family. What is left out is as `options` has it.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Flow {
    /// The set that all else is a change to.
    pub options: Options,
    /// A step along the line (m); 0: 1/250 of the way.
    pub step_m: f64,
    /// The guard makes no shorter steps (m); 0: 1/5000 of the way.
    pub substep_m: f64,
    /// V0 (m/s); 0: the vehicle's speed.
    pub virtual_speed_mps: f64,
    /// Obstacles are this much larger than they are (m).
    pub margin_m: f64,
    /// The length in which eq. 8-9 measure (m); 0: 1/15 of the way.
    pub unit_m: Option<f64>,
    /// Least factor of eq. 8-9.
    pub least_factor: Option<f64>,
    /// Whether obstacles act on water that leaves them.
    pub tail: Option<bool>,
    /// Whether the flow in an obstacle leads out.
    pub escape: Option<bool>,
    /// Whether the guard is on.
    pub guard: Option<bool>,
    /// The guard lets nothing come nearer than this Gamma.
    pub guard_gamma: Option<f64>,
    /// The goal is reached this near (m), and within a step in any case.
    pub capture_m: f64,
    /// Exponent of the union of overlapping obstacles; 0: none.
    pub union_exponent: f64,
    /// How far a step goes.
    pub advance: Option<Advance>,
    /// A line so many times as long as the straight one is lost.
    pub length_factor: Option<f64>,
}

/// The way is this many units long: 15 km, in kilometres.
const UNITS: f64 = 15.0;
const STEPS: f64 = 250.0;
const SUBSTEPS: f64 = 5000.0;

impl Flow {
    /// Checks every value.
    ///
    /// # Errors
    /// [`PlanError::Parameter`] naming the first that is not allowed.
    pub fn check(&self) -> Result<(), PlanError> {
        within("step_m", self.step_m, 0.0, 1e9)?;
        within("substep_m", self.substep_m, 0.0, 1e9)?;
        within("virtual_speed_mps", self.virtual_speed_mps, 0.0, 1e6)?;
        within("margin_m", self.margin_m, 0.0, 1e9)?;
        within("unit_m", self.unit_m.unwrap_or(0.0), 0.0, 1e9)?;
        within("least_factor", self.least_factor.unwrap_or(0.0), 0.0, 10.0)?;
        within("guard_gamma", self.guard_gamma.unwrap_or(1.0), 1.0, 1.015)?;
        within("capture_m", self.capture_m, 0.0, 1e9)?;
        within("union_exponent", self.union_exponent, 0.0, 100.0)?;
        within("length_factor", self.length_factor.unwrap_or(1.0), 1.0, 1e3)
    }

    fn recommended(&self) -> bool {
        self.options == Options::Recommended
    }

    /// The rules of the field, for a way from `start` to `goal`.
    pub fn modulation(&self, start: Vec3, goal: Vec3) -> Modulation {
        let usual_unit = if self.recommended() { 0.0 } else { 1000.0 };
        let unit = self.unit_m.unwrap_or(usual_unit);
        Modulation {
            least_factor: self.least_factor.unwrap_or(if self.recommended() { 0.5 } else { 0.0 }),
            unit_m: if unit > 0.0 { unit } else { (distance(start, goal) / UNITS).max(1e-6) },
            tail: self.tail.unwrap_or(!self.recommended()),
            escape: self.escape.unwrap_or(self.recommended()),
            union_exponent: self.union_exponent,
            relative: false,
        }
    }

    /// How the line is followed.
    pub fn steps(&self, world: &World, lambda: f64, start: Vec3, goal: Vec3) -> Steps {
        let speed = world.scenario().vehicle.speed_mps;
        let part = |length: f64, parts: f64| {
            if length > 0.0 { length } else { (distance(start, goal) / parts).max(1e-6) }
        };
        Steps {
            step_m: part(self.step_m, STEPS),
            substep_m: part(self.substep_m, SUBSTEPS),
            speed_mps: speed,
            virtual_speed_mps: if self.virtual_speed_mps > 0.0 { self.virtual_speed_mps } else { speed },
            lambda,
            advance: self.advance.unwrap_or(Advance::Unit),
            guard: self.guard.unwrap_or(self.recommended()),
            guard_gamma: self.guard_gamma.unwrap_or(1.01),
            capture_m: self.capture_m,
            length_factor: self.length_factor.unwrap_or(4.0),
        }
    }

    /// The field of a world for a way from `start` to `goal`, at least `margin` (m) clear of obstacles.
    pub fn field(
        &self,
        world: &World,
        [start, goal]: [Vec3; 2],
        margin: f64,
        coefficients: impl Fn(Class) -> Coefficients,
    ) -> Field {
        let flat = world.scenario().dimensions == 2;
        Field::new(bodies(world, self.margin_m.max(margin), coefficients), self.modulation(start, goal), flat)
    }
}

impl Classes {
    /// The coefficients of a class, where those of all are given.
    pub fn of(&self, class: Class, all: Coefficients) -> Coefficients {
        let own = match class {
            Class::Sphere => self.sphere,
            Class::Disc => self.disc,
            Class::Cylinder => self.cylinder,
            Class::Superquadric => self.superquadric,
            Class::Polygon => self.polygon,
            Class::Seabed => self.seabed,
        };
        Coefficients {
            rho: own.rho.unwrap_or(all.rho),
            sigma: own.sigma.unwrap_or(all.sigma),
            theta: own.theta.unwrap_or(all.theta),
        }
    }

    /// Checks every value.
    ///
    /// # Errors
    /// [`PlanError::Parameter`] naming the first that is not allowed.
    pub fn check(&self) -> Result<(), PlanError> {
        let all = [
            ("sphere", self.sphere),
            ("disc", self.disc),
            ("cylinder", self.cylinder),
            ("superquadric", self.superquadric),
            ("polygon", self.polygon),
            ("seabed", self.seabed),
        ];
        all.iter().try_for_each(|(class, own)| {
            let usual = Coefficients { rho: 1.0, sigma: 1.0, theta: 0.0 };
            let found = Coefficients {
                rho: own.rho.unwrap_or(usual.rho),
                sigma: own.sigma.unwrap_or(usual.sigma),
                theta: own.theta.unwrap_or(usual.theta),
            };
            check_coefficients(&format!("classes.{class}."), found)
        })
    }
}

/// Fails unless the coefficients are allowed; `prefix` goes before their names.
///
/// # Errors
/// [`PlanError::Parameter`] naming the first that is not allowed.
pub fn check_coefficients(prefix: &str, coefficients: Coefficients) -> Result<(), PlanError> {
    within(&format!("{prefix}rho"), coefficients.rho, 1e-3, 1e3)?;
    within(&format!("{prefix}sigma"), coefficients.sigma, 1e-3, 1e3)?;
    within(&format!("{prefix}theta"), coefficients.theta, -std::f64::consts::PI, std::f64::consts::PI)
}
