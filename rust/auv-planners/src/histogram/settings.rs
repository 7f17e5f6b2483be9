//! LFHH's parameters, with the paper's values (section V) as defaults.

use serde::Deserialize;

use crate::error::{PlanError, within};
use crate::parameters::Parameters;

/// Whether a waypoint sees its left neighbour before or after that was moved (eq. 15).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Smoothing {
    /// After.
    #[default]
    Sequential,
    /// Before.
    Simultaneous,
}

/// Parameters of the histogram planners.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Paths in the population (NP).
    pub population: usize,
    /// Best paths that the histograms are built from (S); by default half the population.
    pub selected: Option<usize>,
    /// Bins of each histogram (binNum); by default as many as are selected.
    pub bins: Option<usize>,
    /// Whether the selected learn from the best (LTS, eq. 14).
    pub learning: bool,
    /// How far they move towards the best (lambda).
    pub learning_rate: f64,
    /// Whether some generations smooth the old paths instead of sampling new ones.
    pub smooth: bool,
    /// Every how many generations (T).
    pub smooth_every: u64,
    /// How they are smoothed.
    pub smoothing: Smoothing,
    /// Whether bins without any free place are drawn again; by default in 3-D only.
    pub safe_bins: Option<bool>,
    /// How often, at most.
    pub safe_draws: u32,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            population: 200,
            selected: None,
            bins: None,
            learning: true,
            learning_rate: 0.08,
            smooth: true,
            smooth_every: 5,
            smoothing: Smoothing::Sequential,
            safe_bins: None,
            safe_draws: 200,
        }
    }
}

impl Settings {
    /// S: how many paths the histograms are built from.
    pub fn selected(&self) -> usize {
        self.selected.unwrap_or(self.population / 2)
    }

    /// binNum: how many bins each histogram has.
    pub fn bins(&self) -> usize {
        self.bins.unwrap_or(self.selected())
    }
}

impl Parameters for Settings {
    fn check(&self) -> Result<(), PlanError> {
        within("population", self.population, 4, 100_000)?;
        within("selected", self.selected(), 2, self.population)?;
        within("bins", self.bins(), 2, self.selected())?;
        within("learning_rate", self.learning_rate, 0.0, 1.0)?;
        within("smooth_every", self.smooth_every, 1, u64::from(u32::MAX))?;
        within("safe_draws", self.safe_draws, 1, 1_000_000)
    }
}
