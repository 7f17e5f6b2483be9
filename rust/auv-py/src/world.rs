//! `World`.

use auv_world::math::Vec3;
use auv_world::scenario::Obstacle;
use auv_world::world::ChangeEvent;
use numpy::{PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_json::{Value, json};

use crate::errors;
use crate::points;
use crate::scenario::Scenario;

/// One scenario at one time, after the map changes so far.
#[pyclass(module = "auvgym._core")]
#[derive(Clone)]
pub struct World(pub auv_world::World);

impl World {
    /// The world at a time, without touching this one unless it must move.
    fn at(&self, time_s: Option<f64>) -> PyResult<auv_world::World> {
        let mut world = self.0.clone();
        if let Some(time_s) = time_s {
            world.set_time(points::time(time_s)?);
        }
        Ok(world)
    }
}

#[pymethods]
impl World {
    #[new]
    fn new(py: Python<'_>, scenario: &Scenario, seed: u64, mission: usize) -> PyResult<Self> {
        let scenario = scenario.0.clone();
        py.detach(|| auv_world::World::new(scenario, seed, mission)).map(Self).map_err(errors::world)
    }

    /// A world made again from its changes [(time_s, vehicle)] and time.
    #[staticmethod]
    fn restore(
        scenario: &Scenario,
        seed: u64,
        mission: usize,
        changes: Vec<(f64, Vec3)>,
        time_s: f64,
    ) -> PyResult<Self> {
        let mut events = Vec::with_capacity(changes.len());
        for (time_s, vehicle_m) in changes {
            events
                .push(ChangeEvent { time_s: points::time(time_s)?, vehicle_m: points::finite("vehicle", vehicle_m)? });
        }
        let time_s = points::time(time_s)?;
        auv_world::World::restore(scenario.0.clone(), seed, mission, &events, time_s).map(Self).map_err(errors::world)
    }

    #[getter]
    fn scenario(&self) -> Scenario {
        Scenario(self.0.scenario().clone())
    }

    #[getter]
    fn seed(&self) -> u64 {
        self.0.seed()
    }

    #[getter]
    fn mission(&self) -> usize {
        self.0.mission_index()
    }

    #[getter]
    fn dimensions(&self) -> u8 {
        self.0.scenario().dimensions
    }

    #[getter]
    fn start<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        points::point(py, self.0.mission().start_m)
    }

    #[getter]
    fn goal<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        points::point(py, self.0.mission().goal_m)
    }

    #[getter]
    fn domain<'py>(&self, py: Python<'py>) -> (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>) {
        let domain = &self.0.scenario().domain;
        (points::point(py, domain.min_m), points::point(py, domain.max_m))
    }

    #[getter]
    fn changes(&self) -> Vec<(f64, Vec3)> {
        self.0.changes().iter().map(|change| (change.time_s, change.vehicle_m)).collect()
    }

    #[getter]
    fn time_s(&self) -> f64 {
        self.0.time_s()
    }

    #[setter]
    fn set_time_s(&mut self, time_s: f64) -> PyResult<()> {
        self.0.set_time(points::time(time_s)?);
        Ok(())
    }

    /// Clearance and currents as they are now stay so until the next map change.
    #[getter]
    fn is_steady(&self) -> bool {
        self.0.is_steady()
    }

    #[pyo3(signature = (points, time_s=None))]
    fn current<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'py, f64>,
        time_s: Option<f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let rows = points::rows::<3>("points", &points)?;
        let world = self.at(time_s)?;
        let velocities: Vec<Vec3> = py.detach(|| {
            rows.iter()
                .map(|point| {
                    let [u, v] = world.current(*point);
                    [u, v, 0.0]
                })
                .collect()
        });
        points::table(py, &velocities)
    }

    #[pyo3(signature = (points, time_s=None))]
    fn clearance<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'py, f64>,
        time_s: Option<f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let rows = points::rows::<3>("points", &points)?;
        let world = self.at(time_s)?;
        let clearances: Vec<f64> = py.detach(|| rows.iter().map(|point| world.clearance(*point)).collect());
        Ok(PyArray1::from_vec(py, clearances))
    }

    fn floor_depth<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let rows = points::rows::<2>("points", &points)?;
        let depths = rows.iter().map(|point| self.0.floor_depth(point[0], point[1])).collect();
        Ok(PyArray1::from_vec(py, depths))
    }

    /// Changes the map as when a vehicle at `vehicle` has travelled the change distance.
    fn apply_change(&mut self, vehicle: Vec3) -> PyResult<bool> {
        Ok(self.0.apply_change(points::finite("vehicle", vehicle)?))
    }

    /// Every obstacle, vortex and peak with its numbers, as JSON.
    #[pyo3(signature = (time_s=None))]
    fn snapshot_json(&self, time_s: Option<f64>) -> PyResult<String> {
        let world = self.at(time_s)?;
        snapshot(&world).map(|value| value.to_string()).map_err(|error| PyValueError::new_err(error.to_string()))
    }

    fn copy(&self) -> Self {
        self.clone()
    }
}

fn snapshot(world: &auv_world::World) -> serde_json::Result<Value> {
    let scenario = world.scenario();
    let mut obstacles = Vec::with_capacity(scenario.obstacles.len());
    for (i, obstacle) in scenario.obstacles.iter().enumerate() {
        let mut value = serde_json::to_value(obstacle)?;
        let (position, base) = (world.obstacle_position(i), obstacle.position_m());
        if let Obstacle::Polygon(shape) = obstacle {
            let shift = [position[0] - base[0], position[1] - base[1]];
            let moved: Vec<[f64; 2]> = shape.vertices_m.iter().map(|v| [v[0] + shift[0], v[1] + shift[1]]).collect();
            value["vertices_m"] = json!(moved);
        }
        value["position_m"] = json!(position);
        value["velocity_mps"] = json!(world.obstacle_velocity(i));
        // What it will do next nobody sees.
        if let Some(fields) = value.as_object_mut() {
            fields.remove("manoeuvre");
        }
        obstacles.push(value);
    }
    let field = world.vortices();
    let drifts = scenario.currents.iter().flat_map(|current| match current {
        auv_world::scenario::Current::Vortices(group) => group.vortices.as_slice(),
        _ => &[],
    });
    let vortices: Vec<Value> = drifts
        .enumerate()
        .map(|(i, vortex)| {
            let [x_m, y_m] = field.centre(i);
            json!({"x_m": x_m, "y_m": y_m, "circulation_m2ps": field.circulation(i),
                   "core_radius_m": field.core_radius(i), "drift_mps": vortex.drift_mps})
        })
        .collect();
    let (peaks, floor_depth) = match &scenario.seabed {
        Some(auv_world::scenario::Seabed::Peaks(peaks)) => {
            (serde_json::to_value(&peaks.peaks)?, Some(peaks.floor_depth_m))
        }
        Some(auv_world::scenario::Seabed::Flat(flat)) => (json!([]), Some(flat.depth_m)),
        None if scenario.dimensions == 3 => (json!([]), Some(scenario.domain.max_m[2])),
        _ => (json!([]), None),
    };
    Ok(json!({
        "time_s": world.time_s(),
        "changes": world.changes().len(),
        "domain": {"min_m": scenario.domain.min_m, "max_m": scenario.domain.max_m},
        "start_m": world.mission().start_m,
        "goal_m": world.mission().goal_m,
        "goal_radius_m": scenario.limits.goal_radius_m,
        "obstacles": obstacles,
        "vortices": vortices,
        "peaks": peaks,
        "floor_depth_m": floor_depth,
    }))
}
