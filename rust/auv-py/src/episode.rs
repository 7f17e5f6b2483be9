//! `Source` and `Episode`.

use auv_env::measures::Record;
use auv_env::observation::{self, Mode};
use auv_env::replan::{Delay, Settings};
use auv_planners::Control;
use auv_world::math::Vec3;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::errors;
use crate::info;
use crate::interrupt;
use crate::points;
use crate::scenario::{Scenario, parameters};
use crate::world::World;

/// Blocks of the observation: (name, start, length, low, high, meaning).
#[pyfunction]
pub fn observation_layout(dimensions: u8, replan: bool) -> Vec<(&'static str, usize, usize, f32, f32, &'static str)> {
    observation::layout(dimensions, if replan { Mode::Replan } else { Mode::Waypoint })
        .into_iter()
        .map(|block| (block.name, block.start, block.len, block.low, block.high, block.meaning))
        .collect()
}

/// Unit vectors (forward, left, up) of the sonar's beams, (beams, 3).
#[pyfunction]
pub fn sonar_directions(py: Python<'_>, dimensions: u8) -> PyResult<Bound<'_, PyArray2<f64>>> {
    points::table(py, auv_env::sonar::beams(dimensions))
}

/// (episode, sum of rewards, actions flown, (length of the trail, world) of each map).
type Replayed = (Episode, f64, usize, Vec<(usize, World)>);

/// Makes episodes from seeds.
#[pyclass(frozen, module = "auvgym._core")]
pub struct Source(pub auv_env::Source);

#[pymethods]
impl Source {
    /// Episodes in one scenario.
    #[staticmethod]
    fn fixed(scenario: &Scenario, mission: usize) -> PyResult<Self> {
        auv_env::Source::fixed(scenario.0.clone(), mission).map(Self).map_err(errors::world)
    }

    /// Episodes in worlds drawn from a family.
    #[staticmethod]
    fn family(family: &str, parameters_json: &str) -> PyResult<Self> {
        auv_env::Source::family(family, parameters(parameters_json)?).map(Self).map_err(errors::world)
    }

    /// The same in re-plan mode; planning takes `planning_s` in a short, a long and the full window, or
    /// `seconds_per_evaluation`.
    fn replanning(
        &self,
        py: Python<'_>,
        planner: &str,
        parameters_json: &str,
        windows: [f64; 2],
        planning_s: [f64; 3],
        seconds_per_evaluation: Option<f64>,
    ) -> PyResult<Self> {
        let delay = seconds_per_evaluation.map_or(Delay::Fixed(planning_s), Delay::PerEvaluation);
        let settings = Settings { planner: planner.into(), parameters: parameters_json.into(), windows, delay };
        let source = self.0.clone();
        interrupt::run(py, |control| source.replanning(settings, control), errors::env).map(Self)
    }

    /// The episode with this seed.
    fn episode(&self, py: Python<'_>, seed: u64) -> PyResult<Episode> {
        let work = |control: &Control<'_>| self.0.begin(seed, Record::Everything, control);
        interrupt::run(py, work, errors::env).map(Episode)
    }

    /// The episode with this seed, flown by a log of (n, d) actions without looking.
    fn replay(&self, py: Python<'_>, seed: u64, actions: PyReadonlyArray2<'_, f32>) -> PyResult<Replayed> {
        let actions = actions.as_slice()?;
        let work = |control: &Control<'_>| {
            auv_env::Replay::fly(self.0.begin(seed, Record::Everything, control)?, actions, control)
        };
        let replay = interrupt::run(py, work, errors::env)?;
        let maps = replay.maps.into_iter().map(|(length, world)| (length, World(world))).collect();
        Ok((Episode(replay.episode), replay.reward, replay.flown, maps))
    }
}

/// One episode.
#[pyclass(module = "auvgym._core")]
#[derive(Clone)]
pub struct Episode(pub auv_env::Episode);

impl Episode {
    fn see<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let length = observation::length(self.0.world().scenario().dimensions, self.0.mode());
        let array = PyArray1::zeros(py, length, false);
        let mut view = array.try_readwrite()?;
        self.0.observe(view.as_slice_mut()?);
        drop(view);
        Ok(array)
    }
}

#[pymethods]
impl Episode {
    /// Flies one leg: (observation, reward, terminated).
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        action: PyReadonlyArray1<'py, f32>,
    ) -> PyResult<(Bound<'py, PyArray1<f32>>, f64, bool)> {
        let (episode, action) = (&mut self.0, action.as_slice()?);
        let reward = match episode.mode() {
            Mode::Waypoint => episode.step(action).map_err(errors::env)?,
            Mode::Replan => interrupt::run(py, |control| episode.act(action, control), errors::env)?,
        };
        let over = self.0.state().outcome != auv_env::Outcome::Running;
        Ok((self.see(py)?, reward, over))
    }

    /// What the vehicle sees now.
    fn observe<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f32>>> {
        self.see(py)
    }

    /// Everything that is measured, in SI units.
    fn info<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        info::one(py, &self.0.measures(), self.0.mode())
    }

    /// Charges planning to the episode.
    fn charge(&mut self, evaluations: u64, replans: u64) {
        self.0.charge(evaluations, replans);
    }

    /// The action that steers towards a waypoint, shortened to the reach.
    fn action_for<'py>(&self, py: Python<'py>, waypoint: Vec3) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let action = self.0.action_for(points::finite("waypoint", waypoint)?);
        Ok(PyArray1::from_slice(py, &action[..self.0.action_len()]))
    }

    /// Where an action puts the waypoint, (3,) m.
    fn waypoint_of<'py>(
        &self,
        py: Python<'py>,
        action: PyReadonlyArray1<'py, f32>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(points::point(py, self.0.waypoint_of(action.as_slice()?)))
    }

    /// A copy of the world at the present time.
    #[getter]
    fn world(&self) -> World {
        World(self.0.world().clone())
    }

    #[getter]
    fn dimensions(&self) -> u8 {
        self.0.world().scenario().dimensions
    }

    #[getter]
    fn seed(&self) -> u64 {
        self.0.world().seed()
    }

    #[getter]
    fn position<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        points::point(py, self.0.state().position)
    }

    #[getter]
    fn heading<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        points::point(py, self.0.state().heading)
    }

    #[getter]
    fn waypoint<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        self.0.state().waypoint.map(|waypoint| points::point(py, waypoint))
    }

    /// The plan in flight, (n, 3) m, in re-plan mode.
    #[getter]
    fn plan<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        self.0.pilot().map(|pilot| points::table(py, &pilot.course.waypoints)).transpose()
    }

    /// Where the vehicle was after each tick, the start first, (k, 3) m.
    #[getter]
    fn trail<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        points::table(py, &self.0.state().trail)
    }

    /// All actions so far, (n, d) float32.
    #[getter]
    fn actions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let (actions, width) = (&self.0.state().actions, self.0.action_len());
        PyArray1::from_slice(py, actions).reshape([actions.len() / width, width])
    }

    #[getter]
    fn time_s(&self) -> f64 {
        self.0.state().time_s
    }

    #[getter]
    fn energy_j(&self) -> f64 {
        self.0.state().energy_j
    }

    #[getter]
    fn time_limit_s(&self) -> f64 {
        self.0.limits().time_s
    }

    #[getter]
    fn energy_budget_j(&self) -> f64 {
        self.0.limits().energy_j
    }

    /// Still-water straight-line distance, m.
    #[getter]
    fn straight_distance_m(&self) -> f64 {
        self.0.limits().distance_m
    }

    /// Time of the straight line in still water, s.
    #[getter]
    fn still_water_time_s(&self) -> f64 {
        self.0.limits().distance_m / self.0.world().scenario().vehicle.speed_mps
    }

    /// LFHH cost of the path flown so far, through the maps that the vehicle met: (length of the trail, world)
    /// of each. None if nothing was flown.
    fn flown_cost(&self, maps: Vec<(usize, PyRef<'_, World>)>) -> PyResult<Option<f64>> {
        let trail = &self.0.state().trail;
        let ends = maps.iter().skip(1).map(|(length, _)| *length).chain([trail.len()]);
        let pieces: Vec<_> = maps
            .iter()
            .zip(ends)
            .map(|((begin, world), end)| {
                let begin = begin.saturating_sub(1).min(trail.len());
                (&world.0, &trail[begin..end.clamp(begin, trail.len())])
            })
            .collect();
        auv_planners::cost::flown_cost(&pieces).map_err(errors::planning)
    }

    #[getter]
    fn path_length_m(&self) -> f64 {
        self.0.state().path_length_m
    }

    #[getter]
    fn distance_since_change_m(&self) -> f64 {
        self.0.state().since_change_m
    }

    #[getter]
    fn tick_s(&self) -> f64 {
        self.0.world().scenario().episode.tick_s
    }

    #[getter]
    fn outcome(&self) -> &'static str {
        self.0.state().outcome.name()
    }

    fn copy(&self) -> Self {
        self.clone()
    }

    fn __copy__(&self) -> Self {
        self.clone()
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        self.clone()
    }

    /// The episode as bytes.
    fn save<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        self.0.save().map(|bytes| PyBytes::new(py, &bytes)).map_err(errors::env)
    }

    /// An episode from bytes.
    #[staticmethod]
    fn load(bytes: &[u8]) -> PyResult<Self> {
        auv_env::Episode::load(bytes).map(Self).map_err(errors::env)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        Ok((py.get_type::<Self>().getattr("load")?, (self.save(py)?,)))
    }

    fn __repr__(&self) -> String {
        let state = self.0.state();
        format!("<Episode of {}: {} at {} s>", self.0.world().scenario().name, state.outcome.name(), state.time_s)
    }
}
