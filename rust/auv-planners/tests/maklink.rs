//! Zones, links, cells, routes and exact paths of harbours.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "harbor/maps.rs"]
mod maps;

use auv_planners::maklink::funnel::taut;
use auv_planners::maklink::route::{Routes, length};
use auv_planners::maklink::visibility::shortest;
use maps::{GOAL, MAPS, START};

fn close(found: f64, known: f64) {
    assert!((found - known).abs() < 1e-3, "{found} is not {known}");
}

#[test]
fn reference_maps_come_out_exactly() {
    for map in MAPS {
        let chart = map.chart();
        let counts = (chart.zones().len(), chart.links().len(), chart.cells().len());
        assert_eq!(counts, (map.zones, map.links, map.cells), "{}", map.name);
        let route = Routes::new(&chart, START, GOAL).unwrap().shortest().unwrap();
        assert_eq!(route.crossings.len(), map.route_links, "{}", map.name);
        close(route.length, map.dijkstra_m);
        close(length(&route.by_middles(&chart, START, GOAL)), map.dijkstra_m);
        close(length(&taut(&chart, &route, START, GOAL)), map.optimum_m);
        close(length(&shortest(&chart, START, GOAL, &mut || false).unwrap().unwrap()), map.optimum_m);
    }
}
