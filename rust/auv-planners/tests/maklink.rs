//! Zones, links, cells, routes and exact paths of harbours.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "harbor/maps.rs"]
mod maps;
#[path = "harbor/studies.rs"]
mod studies;

use auv_planners::maklink::funnel::taut;
use auv_planners::maklink::route::{Route, Routes, length};
use auv_planners::maklink::visibility::shortest;
use auv_planners::maklink::{Area, Chart, MapError};
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

type Polygons = Vec<Vec<[f64; 2]>>;

fn rectangle([x, y]: [f64; 2], [width, height]: [f64; 2]) -> Vec<[f64; 2]> {
    vec![[x, y], [x + width, y], [x + width, y + height], [x, y + height]]
}

/// Zones and cells fill the area without overlap, and every link parts two cells.
fn check_tiling(chart: &Chart) {
    let zones: f64 = chart.zones().iter().map(|zone| ring_area(zone.corners())).sum();
    let cells: f64 = chart.cells().iter().map(|cell| cell.area_m2()).sum();
    assert!((zones + cells - 4e4).abs() < 1e-3, "{zones} + {cells}");
    for crossing in 0..2 * chart.links().len() {
        assert_ne!(chart.leaves(crossing), chart.enters(crossing));
    }
}

fn ring_area(ring: &[[f64; 2]]) -> f64 {
    let edges = (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()]));
    0.5 * edges.map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>()
}

/// The lengths of the three ways: midpoints, corridor optimum, visibility optimum; in falling order.
fn lengths(polygons: &Polygons, start: [f64; 2], goal: [f64; 2]) -> Result<[f64; 3], MapError> {
    let chart = Chart::new(maps::area(), polygons, maps::DISTANCE, f64::INFINITY)?;
    check_tiling(&chart);
    let route = Routes::new(&chart, start, goal)?.shortest()?;
    let tight = taut(&chart, &route, start, goal);
    let best = shortest(&chart, start, goal, &mut || false)?.unwrap();
    for path in [&route.by_middles(&chart, start, goal), &tight, &best] {
        assert!(path.windows(2).all(|leg| chart.is_free(leg[0], leg[1])), "{path:?}");
    }
    let all = [route.length, length(&tight), length(&best)];
    assert!(all[0] >= all[1] - 1e-6 && all[1] >= all[2] - 1e-6, "{all:?}");
    Ok(all)
}

#[test]
fn the_order_of_polygons_and_of_their_corners_does_not_matter() {
    for map in MAPS {
        let polygons = map.polygons();
        let known = map.chart();
        let links: Vec<_> = known.links().iter().map(|link| link.ends).collect();
        for turn in 1..polygons.len() {
            let mut others = polygons.clone();
            others.rotate_left(turn);
            if turn % 2 == 0 {
                others.reverse();
            }
            for ring in &mut others {
                ring.rotate_left(turn % 3);
                if turn % 2 == 1 {
                    ring.reverse();
                }
            }
            let again: Vec<_> = maps::chart(&others).links().iter().map(|link| link.ends).collect();
            for (one, two) in links.iter().zip(&again) {
                assert!((0..4).all(|k| (one[k / 2][k % 2] - two[k / 2][k % 2]).abs() < 1e-9), "{}", map.name);
            }
            assert_eq!(links.len(), again.len());
        }
    }
}

#[test]
fn zones_that_touch_are_one() {
    // A gap of exactly twice the safety distance.
    let polygons = vec![rectangle([60.0, 80.0], [30.0, 40.0]), rectangle([93.75, 80.0], [30.0, 40.0])];
    let chart = maps::chart(&polygons);
    assert_eq!((chart.zones().len(), chart.links().len()), (1, 4));
    assert_eq!(chart.zones()[0].polygons(), [0, 1]);
    lengths(&polygons, START, GOAL).unwrap();
    let apart = vec![rectangle([60.0, 80.0], [30.0, 40.0]), rectangle([94.0, 80.0], [30.0, 40.0])];
    assert_eq!(maps::chart(&apart).zones().len(), 2);
}

#[test]
fn a_merged_zone_can_swallow_the_start() {
    // Two bars of an angle: the start lies between them, in the hull of both.
    let polygons = vec![rectangle([10.0, 10.0], [100.0, 10.0]), rectangle([10.0, 20.0], [10.0, 100.0])];
    let chart = maps::chart(&polygons);
    let start = [40.0, 40.0];
    let error = chart.check("start", start).unwrap_err();
    assert_eq!(error, MapError::InZone { name: "start", point: start, polygons: vec![0, 1] });
    let free = chart.nearest_free(start).unwrap();
    assert!(chart.check("start", free).is_ok() && free[0] > 40.0 && free[1] > 40.0);
}

#[test]
fn zones_end_at_the_walls() {
    let at_walls = vec![
        rectangle([1.0, 60.0], [30.0, 30.0]),
        rectangle([80.0, 199.0], [30.0, 30.0]),
        rectangle([190.0, 190.0], [30.0, 30.0]),
        rectangle([100.0, 1.875], [20.0, 20.0]),
        rectangle([300.0, 300.0], [20.0, 20.0]),
    ];
    let chart = maps::chart(&at_walls);
    assert_eq!(chart.zones().len(), 4);
    assert!(chart.zones().iter().flat_map(|zone| zone.corners()).all(|corner| maps::area().contains(*corner)));
    lengths(&at_walls, START, GOAL).unwrap();
}

#[test]
fn no_way_leads_along_a_wall_through_a_zone() {
    // From the upper wall halfway down: the shortest path passes below.
    let pier = vec![rectangle([90.0, 60.0], [20.0, 145.0])];
    let chart = maps::chart(&pier);
    assert!(!chart.is_free([50.0, 200.0], [150.0, 200.0]) && !chart.is_free([100.0, 200.0], [10.0, 200.0]));
    assert!(chart.is_free([10.0, 200.0], [80.0, 200.0]) && chart.is_free([10.0, 0.0], [190.0, 0.0]));
    let [_, tight, best] = lengths(&pier, [50.0, 195.0], [150.0, 195.0]).unwrap();
    let below = length(&[[50.0, 195.0], [88.125, 58.125], [111.875, 58.125], [150.0, 195.0]]);
    assert!((tight - below).abs() < 1e-6 && (best - below).abs() < 1e-6, "{tight} {best} {below}");
}

#[test]
fn start_or_goal_in_a_zone_is_named() {
    let polygons = vec![rectangle([100.0, 100.0], [20.0, 20.0]), rectangle([150.0, 80.0], [8.5, 20.0])];
    let error = lengths(&polygons, START, GOAL).unwrap_err();
    assert_eq!(error, MapError::InZone { name: "goal", point: GOAL, polygons: vec![1] });
    assert!(error.to_string().contains("goal") && error.to_string().contains("polygon [1]"), "{error}");
    let outside = lengths(&polygons, [-1.0, 3.0], GOAL).unwrap_err();
    assert_eq!(outside, MapError::Outside { name: "start", point: [-1.0, 3.0] });
}

#[test]
fn a_wall_right_across_leaves_no_way() {
    for wall in [rectangle([90.0, -5.0], [10.0, 300.0]), rectangle([90.0, 1.0], [10.0, 198.0])] {
        let error = lengths(&vec![wall, rectangle([30.0, 30.0], [9.0, 9.0])], START, GOAL).unwrap_err();
        assert_eq!(error, MapError::NoWay { polygons: vec![0] });
        assert_eq!(error.to_string(), "the danger zones of polygons [0] part the goal from the start");
    }
}

#[test]
fn without_obstacles_the_way_is_straight() {
    let straight = length(&[START, GOAL]);
    for found in lengths(&Vec::new(), START, GOAL).unwrap() {
        assert_eq!(found, straight);
    }
    assert_eq!(lengths(&Vec::new(), START, START).unwrap(), [0.0; 3]);
}

#[test]
fn where_start_sees_goal_only_the_middles_detour() {
    let aside = vec![rectangle([60.0, 110.0], [20.0, 20.0])];
    let [middles, tight, best] = lengths(&aside, START, GOAL).unwrap();
    let straight = length(&[START, GOAL]);
    assert!(middles > straight + 0.1 && tight == straight && best == straight, "{middles} {tight} {best}");
}

#[test]
fn polygons_that_are_none_are_named() {
    let refused = |ring: Vec<[f64; 2]>| {
        let polygons = vec![rectangle([100.0, 100.0], [20.0, 20.0]), ring];
        Chart::new(maps::area(), &polygons, maps::DISTANCE, 2.0).unwrap_err().to_string()
    };
    for ring in [vec![], vec![[9.0, 9.0]], vec![[9.0, 9.0], [20.0, 20.0]], vec![[9.0, 9.0], [20.0, 20.0], [31.0, 31.0]]]
    {
        assert_eq!(refused(ring), "polygon 1: needs three corners that are not on one line");
    }
    assert!(refused(vec![[9.0, 9.0], [20.0, f64::NAN], [30.0, 7.0]]).starts_with("polygon 1: a corner is not"));
    // Corners that come twice, or lie on an edge, do no harm.
    let plain = rectangle([100.0, 100.0], [20.0, 20.0]);
    let twice = vec![plain[0], plain[0], [110.0, 100.0], plain[1], plain[2], [105.0, 111.0], plain[3], plain[3]];
    assert_eq!(maps::chart(&[plain]).zones()[0].corners(), maps::chart(&[twice]).zones()[0].corners());
}

#[test]
fn numbers_that_cannot_be_are_named() {
    for (distance, limit, name) in [(-1.0, 2.0, "distance"), (f64::NAN, 2.0, "distance"), (1.0, 0.5, "mitre_limit")] {
        let error = Chart::new(maps::area(), &[], distance, limit).unwrap_err().to_string();
        assert!(error.starts_with(name), "{error}");
    }
    assert!(Area::new([0.0, 0.0], [0.0, 1.0]).is_err() && Area::new([0.0, f64::NAN], [1.0, 1.0]).is_err());
}

#[test]
fn a_needle_is_cut_off_at_the_mitre_limit() {
    // Three degrees: the full mitre would stick out 38 times the distance.
    let needle = vec![vec![[100.0, 60.0], [180.0, 57.9], [180.0, 62.1]]];
    let reach = |limit: f64| {
        let chart = Chart::new(maps::area(), &needle, maps::DISTANCE, limit).unwrap();
        check_tiling(&chart);
        100.0 - chart.zones()[0].corners()[0][0]
    };
    close(reach(2.0), 2.0 * maps::DISTANCE);
    close(reach(1.0), maps::DISTANCE);
    assert!(reach(f64::INFINITY) > 35.0 * maps::DISTANCE);
    // However it is cut, the zone keeps the distance from the polygon.
    let chart = Chart::new(maps::area(), &needle, maps::DISTANCE, 2.0).unwrap();
    let depth = needle[0].iter().map(|corner| chart.zones()[0].depth(*corner)).fold(f64::INFINITY, f64::min);
    close(depth, maps::DISTANCE);
}

#[test]
fn rows_of_equal_squares_have_one_chart() {
    let grid: Polygons = (0..9)
        .map(|i| rectangle([40.0 + 45.0 * f64::from(i % 3), 40.0 + 45.0 * f64::from(i / 3)], [25.0; 2]))
        .collect();
    let [_, tight, best] = lengths(&grid, START, [180.0, 20.0]).unwrap();
    assert!(tight >= best - 1e-9);
    let mut reversed = grid.clone();
    reversed.reverse();
    assert_eq!(maps::chart(&grid).links(), maps::chart(&reversed).links());
    assert_eq!(lengths(&grid, START, GOAL).unwrap(), lengths(&reversed, START, GOAL).unwrap());
}

/// Every way from the cells of the start to those of the goal that enters no cell twice and ends where it can.
fn all_ways(chart: &Chart, from: usize, goals: &[usize], way: &mut Vec<usize>, found: &mut Vec<Vec<usize>>) {
    if goals.contains(&from) {
        found.push(way.clone());
        return;
    }
    for &side in &chart.cells()[from].sides {
        let cell = chart.enters(side);
        let seen = way.first().is_some_and(|&first| chart.leaves(first) == cell)
            || way.iter().any(|&crossing| chart.enters(crossing) == cell);
        if !seen && cell != from {
            way.push(side);
            all_ways(chart, cell, goals, way, found);
            way.pop();
        }
    }
}

#[test]
fn the_shortest_routes_are_the_shortest_of_all() {
    for map in MAPS {
        let chart = map.chart();
        let few = Routes::new(&chart, START, GOAL).unwrap().shortest_few(12).unwrap();
        let (starts, goals) = (chart.cells_at(START), chart.cells_at(GOAL));
        assert_eq!(starts.len(), 1);
        let mut ways = Vec::new();
        all_ways(&chart, starts[0], &goals, &mut Vec::new(), &mut ways);
        let by_middles = |crossings: &Vec<usize>| {
            let route = Route { crossings: crossings.clone(), length: 0.0 };
            length(&route.by_middles(&chart, START, GOAL))
        };
        let mut lengths: Vec<f64> = ways.iter().map(by_middles).collect();
        lengths.sort_by(f64::total_cmp);
        assert_eq!(few.len(), lengths.len().min(12), "{}", map.name);
        for (route, known) in few.iter().zip(&lengths) {
            close(route.length, *known);
            let tight = taut(&chart, route, START, GOAL);
            assert!(tight.windows(2).all(|leg| chart.is_free(leg[0], leg[1])), "{}", map.name);
            assert!(length(&tight) >= map.optimum_m - 1e-3);
        }
    }
}
