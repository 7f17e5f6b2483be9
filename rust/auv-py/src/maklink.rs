//! `maklink`: zones, links, cells and graph of a harbour, for looking at.

use auv_planners::PlanError;
use auv_planners::maklink::graph::Graph;
use auv_planners::maklink::harbor::ZoneSettings;
use auv_planners::maklink::{Chart, MapError};
use auv_world::math::{Vec2, Vec3};
use auv_world::settings;
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::prelude::*;

use crate::errors;
use crate::points;
use crate::world::World;

/// ((ring, polygons) of each zone, links, (ring, links) of each cell, nodes, edges, route).
type Found<'py> = (
    Vec<(Bound<'py, PyArray2<f64>>, Vec<usize>)>,
    Bound<'py, PyArray3<f64>>,
    Vec<(Bound<'py, PyArray2<f64>>, Vec<usize>)>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<i64>>,
    Bound<'py, PyArray1<i64>>,
);

/// The MAKLINK chart and graph of a world as it is now.
#[pyfunction]
pub fn maklink<'py>(
    py: Python<'py>,
    world: &World,
    start: Option<Vec3>,
    goal: Option<Vec3>,
    zones_json: &str,
) -> PyResult<Found<'py>> {
    let wrong = |message: String| errors::PlanningError::new_err(format!("zones: {message}"));
    let value = serde_json::from_str(zones_json).map_err(|error| wrong(error.to_string()))?;
    let zones: ZoneSettings = settings::read(value).map_err(|message| wrong(settings::suggest(message)))?;
    let world = world.0.clone();
    let start = points::finite("start", start.unwrap_or(world.mission().start_m))?;
    let goal = points::finite("goal", goal.unwrap_or(world.mission().goal_m))?;
    let (chart, graph) = py.detach(|| chart(&world, &zones, start, goal)).map_err(errors::planning)?;

    let ring = |corners: &[Vec2]| PyArray1::from_slice(py, corners.as_flattened()).reshape([corners.len(), 2]);
    let zones = chart.zones().iter().map(|zone| Ok((ring(zone.corners())?, zone.polygons().to_vec())));
    let cells =
        chart.cells().iter().map(|cell| Ok((ring(&cell.ring)?, cell.sides.iter().map(|side| side / 2).collect())));
    let ends: Vec<f64> = chart.links().iter().flat_map(|link| link.ends).flatten().collect();
    let edges: Vec<i64> = graph.edges.iter().flatten().map(|&node| node as i64).collect();
    Ok((
        zones.collect::<PyResult<_>>()?,
        PyArray1::from_vec(py, ends).reshape([chart.links().len(), 2, 2])?,
        cells.collect::<PyResult<_>>()?,
        ring(&graph.nodes)?,
        PyArray1::from_vec(py, edges).reshape([graph.edges.len(), 2])?,
        PyArray1::from_iter(py, graph.route.iter().map(|&node| node as i64)),
    ))
}

fn chart(world: &auv_world::World, zones: &ZoneSettings, start: Vec3, goal: Vec3) -> Result<(Chart, Graph), PlanError> {
    zones.check()?;
    let chart = zones.chart(world)?;
    let flat = |p: Vec3| [p[0], p[1]];
    for (name, point) in [("start", flat(start)), ("goal", flat(goal))] {
        if zones.snap && !chart.area().contains(point) {
            return Err(MapError::Outside { name, point }.into());
        }
    }
    let [start, goal] = zones.ends(&chart, [flat(start), flat(goal)])?;
    let graph = Graph::new(&chart, start, goal);
    Ok((chart, graph))
}
