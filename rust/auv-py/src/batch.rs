//! `Batch`: many episodes at once.

use auv_env::Autoreset;
use auv_env::batch::Lane;
use auv_env::measures::{Measures, Record};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::episode::{Episode, Source};
use crate::errors;
use crate::info;
use crate::interrupt::Signals;

/// Many episodes at once.
#[pyclass(module = "auvgym._core")]
pub struct Batch(auv_env::Batch);

type Stepped<'py> = (Bound<'py, PyArray2<f32>>, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<bool>>);

impl Batch {
    fn lane(&self, index: i64) -> PyResult<&Lane> {
        let lane = usize::try_from(index).ok().and_then(|index| self.0.lanes().get(index));
        lane.ok_or_else(|| missing(index))
    }

    fn at(&self, index: usize) -> PyResult<&auv_env::Episode> {
        self.0.episode(index).ok_or_else(|| missing(index))
    }

    /// Works without the GIL on a new array with a row for each environment; asks for Ctrl-C meanwhile.
    fn fill<'py>(
        &mut self,
        py: Python<'py>,
        work: impl FnOnce(&mut auv_env::Batch, &mut [f32], &mut dyn FnMut() -> bool) -> Result<(), auv_env::EnvError> + Send,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let array = PyArray2::zeros(py, [self.0.lanes().len(), self.0.observation_len()], false);
        let mut view = array.try_readwrite()?;
        let (values, mut signals) = (view.as_slice_mut()?, Signals::new());
        let batch = &mut self.0;
        let done = py.detach(|| work(batch, values, &mut || signals.stop()));
        signals.finish()?;
        done.map_err(errors::env)?;
        drop(view);
        Ok(array)
    }
}

fn missing(index: impl std::fmt::Display) -> PyErr {
    PyIndexError::new_err(format!("no episode of environment {index}"))
}

#[pymethods]
impl Batch {
    /// `autoreset`: "NextStep", "SameStep" or "Disabled"; `record` keeps trails and actions.
    #[new]
    fn new(source: &Source, count: usize, threads: usize, autoreset: &str, record: bool) -> PyResult<Self> {
        let autoreset = match autoreset {
            "NextStep" => Autoreset::NextStep,
            "SameStep" => Autoreset::SameStep,
            "Disabled" => Autoreset::Disabled,
            other => return Err(PyValueError::new_err(format!("autoreset = {other:?}: there is none of that name"))),
        };
        let record = if record { Record::Everything } else { Record::Nothing };
        Ok(Self(auv_env::Batch::new(source.0.clone(), count, threads, autoreset, record)))
    }

    #[getter]
    fn threads(&self) -> usize {
        self.0.threads()
    }

    fn __len__(&self) -> usize {
        self.0.lanes().len()
    }

    /// Begins the episodes with these seeds where `mask` says so; observations of all.
    fn reset<'py>(
        &mut self,
        py: Python<'py>,
        seeds: PyReadonlyArray1<'py, u64>,
        mask: PyReadonlyArray1<'py, bool>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let chosen = seeds.as_slice()?.iter().zip(mask.as_slice()?);
        let seeds: Vec<_> = chosen.map(|(seed, begins)| begins.then_some(*seed)).collect();
        self.expect("seeds", seeds.len(), 1)?;
        self.fill(py, |batch, observations, stop| batch.reset(&seeds, observations, stop))
    }

    /// Steps all: (observations, rewards, ended).
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        actions: PyReadonlyArray2<'py, f32>,
        seeds: PyReadonlyArray1<'py, u64>,
    ) -> PyResult<Stepped<'py>> {
        let (actions, seeds) = (actions.as_slice()?, seeds.as_slice()?);
        self.expect("actions", actions.len(), self.0.action_len())?;
        self.expect("seeds", seeds.len(), 1)?;
        let observations = self.fill(py, |batch, rows, stop| batch.step(actions, seeds, rows, stop))?;
        let lanes = self.0.lanes();
        let rewards = PyArray1::from_iter(py, lanes.iter().map(|lane| lane.reward));
        Ok((observations, rewards, PyArray1::from_iter(py, lanes.iter().map(|lane| lane.ended))))
    }

    /// What is measured, a column each: now, or when the `last` episode ended. Where `only` is false zeros stand
    /// instead, and None for an outcome; with `masks` a column `_name` beside each says where.
    #[pyo3(signature = (last, only=None, masks=false))]
    fn info<'py>(
        &self,
        py: Python<'py>,
        last: bool,
        only: Option<PyReadonlyArray1<'py, bool>>,
        masks: bool,
    ) -> PyResult<Bound<'py, PyDict>> {
        let only = only.as_ref().map(|only| only.as_slice()).transpose()?;
        let lanes = self.0.lanes();
        self.expect("only", only.map_or(lanes.len(), <[bool]>::len), 1)?;
        let counts = |index: usize| only.is_none_or(|only| only[index]);
        let of = |(index, lane): (usize, &Lane)| counts(index).then_some(if last { lane.last } else { lane.now });
        // Side by side first: environments lie far apart.
        let rows: Vec<Option<Measures>> = lanes.iter().enumerate().map(of).collect();
        info::columns(py, &rows, self.0.mode(), masks)
    }

    /// What is measured of some environments, a dict each: now, or when the `last` episode ended.
    fn infos<'py>(
        &self,
        py: Python<'py>,
        indices: PyReadonlyArray1<'py, i64>,
        last: bool,
    ) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let one = |&index: &i64| {
            let lane = self.lane(index)?;
            info::one(py, if last { &lane.last } else { &lane.now }, self.0.mode())
        };
        indices.as_slice()?.iter().map(one).collect()
    }

    /// The last observations of the last episodes of some environments, a row each.
    fn last_observations<'py>(
        &self,
        py: Python<'py>,
        indices: PyReadonlyArray1<'py, i64>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let (indices, width) = (indices.as_slice()?, self.0.observation_len());
        let array = PyArray2::zeros(py, [indices.len(), width], false);
        let mut view = array.try_readwrite()?;
        for (&index, row) in indices.iter().zip(view.as_slice_mut()?.chunks_exact_mut(width)) {
            let last = &self.lane(index)?.last_observation;
            if last.len() != width {
                return Err(missing(index));
            }
            row.copy_from_slice(last);
        }
        drop(view);
        Ok(array)
    }

    /// A copy of environment `index`'s episode.
    fn episode(&self, index: usize) -> PyResult<Episode> {
        self.at(index).cloned().map(Episode)
    }

    /// Puts a copy of an episode in the place of environment `index`'s.
    fn replace(&mut self, index: usize, episode: &Episode) {
        self.0.replace(index, episode.0.clone());
    }

    /// Charges planning to environment `index`'s episode.
    fn charge(&mut self, index: usize, evaluations: u64, replans: u64) -> PyResult<()> {
        self.0.episode_mut(index).ok_or_else(|| missing(index))?.charge(evaluations, replans);
        Ok(())
    }
}

impl Batch {
    fn expect(&self, what: &str, entries: usize, each: usize) -> PyResult<()> {
        let count = self.0.lanes().len() * each;
        if entries == count {
            return Ok(());
        }
        Err(PyValueError::new_err(format!("{what} has {entries} entries: must have {count}")))
    }
}
