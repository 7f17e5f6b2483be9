//! Many environments at once: one call steps them all, on threads of the batch's own.
//!
//! Environments do not know each other, and each writes its own row: what comes out is what single
//! episodes give, whatever the number of threads.

mod lane;
mod pool;

use std::cell::RefCell;

use auv_planners::Control;
use auv_world::lanes::LANES;

pub use lane::Lane;
use pool::Pool;

use crate::episode::{Episode, flight};
use crate::error::EnvError;
use crate::measures::Record;
use crate::observation::Mode;
use crate::source::Source;

/// What follows when an episode ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Autoreset {
    /// The next step begins another and takes no action.
    NextStep,
    /// The same step begins another and gives its first observation.
    SameStep,
    /// Nothing: whoever steps begins another.
    Disabled,
}

/// Environments between two looks at whether to stop.
const AT_ONCE: usize = 1024;

/// How many of `count` environments a thread takes at a time: enough to fill the lanes of a flight for most of it, and
/// few enough that threads do not wait long for each other at the end of a step. Who plans takes a thread of its own.
fn together(mode: Mode, count: usize, threads: usize) -> usize {
    match mode {
        Mode::Waypoint => (count / (4 * threads)).clamp(LANES, 4 * LANES).min(count.div_ceil(threads)).max(1),
        Mode::Replan => 1,
    }
}

/// Many environments.
#[derive(Debug)]
pub struct Batch {
    source: Source,
    autoreset: Autoreset,
    record: Record,
    lanes: Vec<Lane>,
    pool: Pool,
    /// Environments that a thread takes at a time.
    together: usize,
    /// Entries of an action and of an observation.
    widths: (usize, usize),
}

impl Batch {
    /// `count` environments of `source` on `threads` threads, before their first episode.
    pub fn new(source: Source, count: usize, threads: usize, autoreset: Autoreset, record: Record) -> Self {
        let widths = source.widths();
        let lanes = (0..count).map(|_| Lane::empty()).collect();
        let pool = Pool::new(threads.min(count));
        let together = together(source.mode(), count, pool.threads());
        Self { source, autoreset, record, lanes, pool, together, widths }
    }

    /// The environments.
    pub fn lanes(&self) -> &[Lane] {
        &self.lanes
    }

    /// What actions decide.
    pub fn mode(&self) -> Mode {
        self.source.mode()
    }

    /// Entries of one action.
    pub fn action_len(&self) -> usize {
        self.widths.0
    }

    /// Entries of one observation.
    pub fn observation_len(&self) -> usize {
        self.widths.1
    }

    /// Number of threads.
    pub fn threads(&self) -> usize {
        self.pool.threads()
    }

    /// The episode of environment `index`, once it has begun one.
    pub fn episode(&self, index: usize) -> Option<&Episode> {
        self.lanes.get(index)?.episode.as_ref()
    }

    /// The same, to be changed.
    pub fn episode_mut(&mut self, index: usize) -> Option<&mut Episode> {
        self.lanes.get_mut(index)?.episode.as_mut()
    }

    /// Puts an episode in the place of environment `index`'s.
    pub fn replace(&mut self, index: usize, mut episode: Episode) {
        if let Some(lane) = self.lanes.get_mut(index) {
            episode.record(self.record);
            (lane.now, lane.episode) = (episode.measures(), Some(episode));
        }
    }

    /// Begins the episodes with these seeds; where there is none, the present one goes on. Writes a row of
    /// `observations` for each environment.
    ///
    /// # Errors
    /// [`EnvError`] if a world cannot be drawn or `stop` said so: some episodes have begun then.
    pub fn reset(
        &mut self,
        seeds: &[Option<u64>],
        observations: &mut [f32],
        stop: &mut dyn FnMut() -> bool,
    ) -> Result<(), EnvError> {
        let (source, record) = (self.source.clone(), self.record);
        let width = self.widths.1;
        self.each(observations, stop, |first, lanes, rows, control| {
            for (i, (lane, row)) in lanes.iter_mut().zip(rows.chunks_exact_mut(width)).enumerate() {
                match seeds[first + i] {
                    Some(seed) => lane.begin(&source, seed, record, control, row),
                    None => lane.look(row),
                }
            }
        })
    }

    /// Steps every environment. `actions` has a row for each, `seeds` the seed of the episode that each
    /// begins if it begins one.
    ///
    /// # Errors
    /// [`EnvError`] for a wrong action or an ended episode that nothing begins again: nothing has moved
    /// then. If a world cannot be drawn or `stop` said so, some environments have stepped.
    pub fn step(
        &mut self,
        actions: &[f32],
        seeds: &[u64],
        observations: &mut [f32],
        stop: &mut dyn FnMut() -> bool,
    ) -> Result<(), EnvError> {
        let (width, autoreset) = (self.action_len(), self.autoreset);
        for (index, (lane, action)) in self.lanes.iter().zip(actions.chunks_exact(width)).enumerate() {
            let begins = autoreset == Autoreset::NextStep && lane.over();
            if let Some(episode) = lane.episode.as_ref().filter(|_| !begins) {
                episode.check(action).map_err(|error| error.of(index))?;
            }
        }
        let (source, record) = (self.source.clone(), self.record);
        let row_width = self.widths.1;
        self.each(observations, stop, |first, lanes, rows, control| {
            let begin = |i: usize| {
                let seed = seeds[first + i];
                let source = &source;
                move |lane: &mut Lane, row: &mut [f32]| lane.begin(source, seed, record, control, row)
            };
            for (i, (lane, row)) in lanes.iter_mut().zip(rows.chunks_exact_mut(row_width)).enumerate() {
                let action = &actions[(first + i) * width..][..width];
                lane.depart(action, autoreset, control, begin(i), row);
            }
            flight::fly(&mut lanes.iter_mut().filter_map(Lane::leg).collect::<Vec<_>>());
            for (i, (lane, row)) in lanes.iter_mut().zip(rows.chunks_exact_mut(row_width)).enumerate() {
                lane.arrive(autoreset, begin(i), row);
            }
        })
    }

    /// Works on all environments and their rows of `observations`, some at a time, on all threads, asking now and
    /// then whether to `stop`. `work` gets the number of the first of them.
    fn each(
        &mut self,
        observations: &mut [f32],
        stop: &mut dyn FnMut() -> bool,
        work: impl Fn(usize, &mut [Lane], &mut [f32], &Control<'_>) + Sync,
    ) -> Result<(), EnvError> {
        let (width, together) = (self.widths.1, self.together);
        let chunks = self.lanes.chunks_mut(AT_ONCE).zip(observations.chunks_mut(AT_ONCE * width));
        for (chunk, (lanes, rows)) in chunks.enumerate() {
            let first = chunk * AT_ONCE;
            let groups = lanes.chunks_mut(together).zip(rows.chunks_mut(together * width)).enumerate();
            let one = |(i, (lanes, rows)): (usize, (&mut [Lane], &mut [f32])), control: &Control<'_>| {
                work(first + i * together, lanes, rows, control);
            };
            match self.pool.running() {
                None => {
                    let asked = RefCell::new(&mut *stop);
                    let ask = || (asked.borrow_mut())();
                    groups.for_each(|group| one(group, &Control::ask(&ask)));
                }
                Some(others) => pool::share(others, groups, stop, one),
            }
            if let Some((i, error)) = lanes.iter_mut().enumerate().find_map(|(i, lane)| Some((i, lane.error.take()?))) {
                return Err(error.of(first + i));
            }
            if stop() {
                return Err(EnvError::Stopped);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
