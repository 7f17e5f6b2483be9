//! Parameters of the planners in harbours.

use serde::Deserialize;

use super::fitness::Objective;
use super::harbor::ZoneSettings;
use super::line::Penalty;
use super::smoothing::{Curve, Smoothing};
use super::swarm::{Bounds, Inertia, Rules};
use crate::error::{PlanError, within};
use crate::parameters::Parameters;

/// What a fillet may cut off unless told (m): a quarter and more of the safety distance.
const CUT: f64 = 0.5;

/// Parameters of `maklink-dijkstra` and `visibility`.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Plain {
    /// How danger zones are made.
    pub zones: ZoneSettings,
    /// How the path is smoothed.
    pub smoothing: Curve,
    /// What a fillet may cut off at a corner (m).
    pub cut_m: f64,
}

impl Default for Plain {
    fn default() -> Self {
        Self { zones: ZoneSettings::default(), smoothing: Curve::None, cut_m: CUT }
    }
}

impl Plain {
    /// How the path is smoothed.
    pub fn smoothing(&self) -> Smoothing {
        Smoothing::new(self.smoothing, self.cut_m)
    }
}

impl Parameters for Plain {
    fn check(&self) -> Result<(), PlanError> {
        self.zones.check()?;
        within("cut_m", self.cut_m, 0.0, 1e9)
    }
}

/// Parameters of `funnel`.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Funnel {
    /// How danger zones are made.
    pub zones: ZoneSettings,
    /// How the path is smoothed.
    pub smoothing: Curve,
    /// What a fillet may cut off at a corner (m).
    pub cut_m: f64,
    /// The shortest path of so many corridors is taken.
    pub corridors: usize,
}

impl Default for Funnel {
    fn default() -> Self {
        Self { zones: ZoneSettings::default(), smoothing: Curve::None, cut_m: CUT, corridors: 1 }
    }
}

impl Funnel {
    /// How the path is smoothed.
    pub fn smoothing(&self) -> Smoothing {
        Smoothing::new(self.smoothing, self.cut_m)
    }
}

impl Parameters for Funnel {
    fn check(&self) -> Result<(), PlanError> {
        self.zones.check()?;
        within("cut_m", self.cut_m, 0.0, 1e9)?;
        within("corridors", self.corridors, 1, 1000)
    }
}

/// Parameters of `maklink-aco`.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Ants {
    /// How danger zones are made.
    pub zones: ZoneSettings,
    /// How the path is smoothed.
    pub smoothing: Curve,
    /// What a fillet may cut off at a corner (m).
    pub cut_m: f64,
    /// Ants in an iteration.
    pub population: usize,
}

impl Default for Ants {
    fn default() -> Self {
        Self { zones: ZoneSettings::default(), smoothing: Curve::None, cut_m: CUT, population: 80 }
    }
}

impl Ants {
    /// How the path is smoothed.
    pub fn smoothing(&self) -> Smoothing {
        Smoothing::new(self.smoothing, self.cut_m)
    }
}

impl Parameters for Ants {
    fn check(&self) -> Result<(), PlanError> {
        self.zones.check()?;
        within("cut_m", self.cut_m, 0.0, 1e9)?;
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

/// Where the waypoints of a swarm lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Places {
    /// One on each link of the shortest MAKLINK route.
    #[default]
    Links,
    /// Beside the straight line, at equal distances along it: for maps that have no links, as rasters.
    Line,
}

/// Parameters of `maklink-pso` and `rmpso`.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Particles {
    /// How danger zones are made.
    pub zones: ZoneSettings,
    /// How the path is smoothed.
    pub smoothing: Curve,
    /// What a fillet may cut off at a corner (m).
    pub cut_m: f64,
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
    /// Where the waypoints lie.
    pub places: Places,
    /// Beside the line: how many there are, ...
    pub points: usize,
    /// ... how far beside it they may lie (m; 0: a third of its length), ...
    pub reach_m: f64,
    /// ... and what a blocked path pays.
    pub penalty: Penalty,
}

impl Default for Particles {
    fn default() -> Self {
        Self {
            zones: ZoneSettings::default(),
            smoothing: Curve::None,
            cut_m: CUT,
            population: 80,
            inertia: None,
            offset: 0.63,
            bounds: Bounds::Penalty,
            unit: Unit::Metres,
            v_max: 3.0,
            cognitive: 2.0,
            social: 2.0,
            objective: Objective::Length,
            places: Places::Links,
            points: 8,
            reach_m: 0.0,
            penalty: Penalty::Graded,
        }
    }
}

impl Particles {
    /// How the path is smoothed.
    pub fn smoothing(&self) -> Smoothing {
        Smoothing::new(self.smoothing, self.cut_m)
    }
}

impl Parameters for Particles {
    fn check(&self) -> Result<(), PlanError> {
        self.zones.check()?;
        within("cut_m", self.cut_m, 0.0, 1e9)?;
        within("population", self.population, 1, 100_000)?;
        within("offset", self.offset, -10.0, 10.0)?;
        within("v_max", self.v_max, 1e-9, 1e9)?;
        within("cognitive", self.cognitive, 0.0, 10.0)?;
        within("social", self.social, 0.0, 10.0)?;
        within("points", self.points, 1, 1000)?;
        within("reach_m", self.reach_m, 0.0, 1e9)
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
