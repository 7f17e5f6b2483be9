//! One environment of a batch: its episode, what the last step gave, and how the last episode ended.

use auv_planners::Control;

use super::Autoreset;
use crate::episode::Episode;
use crate::error::EnvError;
use crate::measures::{Measures, Outcome, Record};
use crate::source::Source;

/// One environment of a batch.
#[derive(Debug)]
pub struct Lane {
    pub(super) episode: Option<Episode>,
    pub(super) error: Option<EnvError>,
    /// Reward of the last step.
    pub reward: f64,
    /// Whether the last step ended an episode.
    pub ended: bool,
    /// What is measured now.
    pub now: Measures,
    /// What was measured when the last episode ended: with [`Autoreset::SameStep`] another one runs by then.
    pub last: Measures,
    /// The last observation of the last episode, likewise.
    pub last_observation: Vec<f32>,
}

impl Lane {
    /// A lane without an episode.
    pub(super) fn empty() -> Self {
        let (now, last) = (Measures::default(), Measures::default());
        Self { episode: None, error: None, reward: 0.0, ended: false, now, last, last_observation: Vec::new() }
    }

    /// Whether its episode is over.
    pub(super) fn over(&self) -> bool {
        self.episode.as_ref().is_some_and(|episode| episode.state().outcome != Outcome::Running)
    }

    /// Begins the episode with this seed.
    pub(super) fn begin(
        &mut self,
        source: &Source,
        seed: u64,
        record: Record,
        control: &Control<'_>,
        observation: &mut [f32],
    ) {
        (self.reward, self.ended) = (0.0, false);
        match source.begin(seed, record, control) {
            Ok(mut episode) => {
                episode.observe(observation);
                self.now = episode.measures();
                self.episode = Some(episode);
            }
            Err(error) => self.error = Some(error),
        }
    }

    /// Looks again without flying.
    pub(super) fn look(&mut self, observation: &mut [f32]) {
        (self.reward, self.ended) = (0.0, false);
        if let Some(episode) = &mut self.episode {
            episode.observe(observation);
            self.now = episode.measures();
        }
    }

    /// Flies one leg, or begins again, as `autoreset` says.
    pub(super) fn step(
        &mut self,
        action: &[f32],
        autoreset: Autoreset,
        control: &Control<'_>,
        begin: impl Fn(&mut Self, &mut [f32]),
        observation: &mut [f32],
    ) {
        if autoreset == Autoreset::NextStep && self.over() {
            begin(self, observation);
            return;
        }
        let Some(episode) = &mut self.episode else { return };
        match episode.act(action, control) {
            Ok(reward) => self.reward = reward,
            Err(error) => {
                self.error = Some(error);
                return;
            }
        }
        episode.observe(observation);
        self.now = episode.measures();
        self.ended = self.now.outcome != Outcome::Running;
        if self.ended && autoreset == Autoreset::SameStep {
            self.last = self.now;
            self.last_observation.clear();
            self.last_observation.extend_from_slice(observation);
            let reward = self.reward;
            begin(self, observation);
            (self.reward, self.ended) = (reward, true);
        }
    }
}
