//! A whole episode from its action log, without looking: what holds a results file to its logs.

use auv_planners::Control;
use auv_world::World;

use crate::episode::Episode;
use crate::error::EnvError;
use crate::measures::Outcome;

/// An episode flown by its log.
#[derive(Debug, Clone)]
pub struct Replay {
    /// As it stands after the last action.
    pub episode: Episode,
    /// The sum of rewards, added up as they came.
    pub reward: f64,
    /// Actions flown: no more once the episode has ended.
    pub flown: usize,
    /// Each map that the vehicle met, with the length of the trail when it came.
    pub maps: Vec<(usize, World)>,
}

impl Replay {
    /// Flies `actions`, one after another as they are kept, from where an episode stands.
    ///
    /// # Errors
    /// [`EnvError`] for an action that is none, or if interrupted while planning.
    pub fn fly(episode: Episode, actions: &[f32], control: &Control<'_>) -> Result<Self, EnvError> {
        let maps = vec![(0, episode.world().clone())];
        let mut replay = Self { episode, reward: 0.0, flown: 0, maps };
        for action in actions.chunks(replay.episode.action_len()) {
            if replay.episode.state().outcome != Outcome::Running {
                break;
            }
            let changes = replay.episode.world().changes().len();
            replay.reward += replay.episode.act(action, control)?;
            replay.flown += 1;
            if replay.episode.world().changes().len() != changes {
                replay.maps.push((replay.episode.state().trail.len(), replay.episode.world().clone()));
            }
        }
        Ok(replay)
    }
}

#[cfg(test)]
mod tests {
    use auv_world::families::Parameters;

    use super::*;
    use crate::Source;

    #[test]
    fn a_log_gives_what_its_steps_gave() {
        let source = Source::family("lfhh-3d", Parameters::default()).unwrap();
        let mut stepped = source.episode(3).unwrap();
        let mut seen = vec![0.0; crate::observation::length(3, stepped.mode())];
        let mut reward = 0.0;
        for i in 0_u8.. {
            let turn = f32::from(i % 3) - 1.0;
            reward += stepped.step(&[1.0, 0.2 * turn, 0.1 * turn]).unwrap();
            stepped.observe(&mut seen);
            if stepped.state().outcome != Outcome::Running {
                break;
            }
        }
        let log = [stepped.state().actions.as_slice(), &[0.0; 6]].concat();
        let replay = Replay::fly(source.episode(3).unwrap(), &log, &Control::none()).unwrap();
        assert_eq!(replay.episode.state(), stepped.state());
        assert_eq!((replay.reward, replay.flown), (reward, stepped.state().actions.len() / 3));
        assert_eq!(replay.maps.len(), 1 + stepped.world().changes().len());
        assert!(replay.maps.windows(2).all(|pair| pair[0].0 < pair[1].0));
        assert!(Replay::fly(source.episode(3).unwrap(), &log[..4], &Control::none()).is_err());
    }
}
