//! One environment of a batch: its episode, what the last step gave, and how the last episode ended.

use auv_planners::Control;

use super::Autoreset;
use crate::episode::flight::Leg;
use crate::episode::{Departure, Episode};
use crate::error::EnvError;
use crate::measures::{Measures, Outcome, Record};
use crate::source::Source;

/// One environment of a batch.
#[derive(Debug)]
pub struct Lane {
    pub(super) episode: Option<Episode>,
    pub(super) error: Option<EnvError>,
    /// The action whose leg is being flown.
    departure: Option<Departure>,
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
        Self {
            episode: None,
            error: None,
            departure: None,
            reward: 0.0,
            ended: false,
            now,
            last,
            last_observation: Vec::new(),
        }
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

    /// Takes an action up to its leg, or begins again, as `autoreset` says.
    pub(super) fn depart(
        &mut self,
        action: &[f32],
        autoreset: Autoreset,
        control: &Control<'_>,
        begin: impl Fn(&mut Self, &mut [f32]),
        observation: &mut [f32],
    ) {
        self.departure = None;
        if autoreset == Autoreset::NextStep && self.over() {
            begin(self, observation);
            return;
        }
        let Some(episode) = &mut self.episode else { return };
        match episode.depart(action, control) {
            Ok(departure) => self.departure = Some(departure),
            Err(error) => self.error = Some(error),
        }
    }

    /// The leg that is to be flown now, if there is one.
    pub(super) fn leg(&mut self) -> Option<Leg<'_>> {
        self.episode.as_mut()?.leg(self.departure.as_ref()?)
    }

    /// After the leg: reward, measures and observation, and another episode if `autoreset` says so.
    pub(super) fn arrive(
        &mut self,
        autoreset: Autoreset,
        begin: impl Fn(&mut Self, &mut [f32]),
        observation: &mut [f32],
    ) {
        let (Some(departure), Some(episode)) = (self.departure.take(), &mut self.episode) else { return };
        self.reward = episode.arrive(&departure);
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
