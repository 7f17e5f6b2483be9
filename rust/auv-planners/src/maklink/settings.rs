//! Parameters of the planners in harbours.

use serde::Deserialize;

use super::fitness::Objective;
use super::harbor::ZoneSettings;
use super::swarm::{Bounds, Inertia, Rules};
use crate::error::{PlanError, within};
use crate::parameters::Parameters;

/// Parameters of `maklink-dijkstra` and `visibility`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Plain {
    /// How danger zones are made.
    pub zones: ZoneSettings,
}

impl Parameters for Plain {
    fn check(&self) -> Result<(), PlanError> {
        self.zones.check()
    }
}

/// Parameters of `funnel`.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Funnel {
    /// How danger zones are made.
    pub zones: ZoneSettings,
    /// The shortest path of so many corridors is taken.
    pub corridors: usize,
}

impl Default for Funnel {
    fn default() -> Self {
        Self { zones: ZoneSettings::default(), corridors: 1 }
    }
}

impl Parameters for Funnel {
    fn check(&self) -> Result<(), PlanError> {
        self.zones.check()?;
        within("corridors", self.corridors, 1, 1000)
    }
}

/// Parameters of `maklink-aco`.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Ants {
    /// How danger zones are made.
    pub zones: ZoneSettings,
    /// Ants in an iteration.
    pub population: usize,
}

impl Default for Ants {
    fn default() -> Self {
        Self { zones: ZoneSettings::default(), population: 80 }
    }
}

impl Parameters for Ants {
    fn check(&self) -> Result<(), PlanError> {
        self.zones.check()?;
        within("population", self.population, 1, 100_000)
    }
}

/// In what positions on links are measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Unit {
    /// Metres from the first end.
    #[default]
    Metres,
    /// Parts of the link's length.
    Ratio,
}

/// Parameters of `maklink-pso` and `rmpso`.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Particles {
    /// How danger zones are made.
    pub zones: ZoneSettings,
    /// Number of particles.
    pub population: usize,
    /// The inertia weight; without it `linear` in `maklink-pso` and `reinforced` in `rmpso`.
    pub inertia: Option<Inertia>,
    /// Offset in the exponent of the reinforced weight.
    pub offset: f64,
    /// What happens at the ends of links.
    pub bounds: Bounds,
    /// In what positions are measured.
    pub unit: Unit,
    /// Greatest velocity, in units of position an iteration.
    pub v_max: f64,
    /// c1.
    pub cognitive: f64,
    /// c2.
    pub social: f64,
    /// What is minimised.
    pub objective: Objective,
}

impl Default for Particles {
    fn default() -> Self {
        Self {
            zones: ZoneSettings::default(),
            population: 80,
            inertia: None,
            offset: 0.63,
            bounds: Bounds::Penalty,
            unit: Unit::Metres,
            v_max: 3.0,
            cognitive: 2.0,
            social: 2.0,
            objective: Objective::Length,
        }
    }
}

impl Parameters for Particles {
    fn check(&self) -> Result<(), PlanError> {
        self.zones.check()?;
        within("population", self.population, 1, 100_000)?;
        within("offset", self.offset, -10.0, 10.0)?;
        within("v_max", self.v_max, 1e-9, 1e9)?;
        within("cognitive", self.cognitive, 0.0, 10.0)?;
        within("social", self.social, 0.0, 10.0)
    }
}

impl Particles {
    /// How particles move, for a search of so many iterations.
    pub fn rules(&self, inertia: Inertia, iterations: u64) -> Rules {
        Rules {
            inertia: self.inertia.unwrap_or(inertia),
            offset: self.offset,
            bounds: self.bounds,
            v_max: self.v_max,
            cognitive: self.cognitive,
            social: self.social,
            iterations,
        }
    }
}
