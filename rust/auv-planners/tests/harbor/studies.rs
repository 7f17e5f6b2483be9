//! Random harbours, the swarms' distributions, currents and round corners.

use crate::maps::{self, GOAL, MAPS, START};
use auv_planners::maklink::Chart;
use auv_planners::maklink::drift::Drift;
use auv_planners::maklink::fitness::{Corridor, Objective};
use auv_planners::maklink::funnel::taut;
use auv_planners::maklink::harbor::ZoneSettings;
use auv_planners::maklink::route::{Routes, length};
use auv_planners::maklink::smoothing::{fillets, one_bezier};
use auv_planners::maklink::swarm::{Bounds, Inertia, Rules, Swarm};
use auv_planners::maklink::visibility::shortest;
use auv_world::World;
use auv_world::families::{Parameters, generate};
use auv_world::rng::{Purpose, Stream};

/// The paper's vehicle and current: 0.3 m/s towards -75 degrees.
fn drift() -> Drift {
    let angle = (-75.0_f64).to_radians();
    Drift { speed: 1.5, current: [0.3 * angle.cos(), 0.3 * angle.sin()] }
}

fn rules(inertia: Inertia, bounds: Bounds) -> Rules {
    Rules { inertia, offset: 0.63, bounds, v_max: 3.0, cognitive: 2.0, social: 2.0, iterations: 150 }
}

/// The lengths that so many seeds end with.
fn ends(corridor: &Corridor<'_>, rules: Rules, seeds: u64) -> Vec<f64> {
    let run = |seed| {
        let mut random = Stream::new(seed, Purpose::Planner, 0);
        let mut swarm = Swarm::new(corridor, rules, 80, 80, &mut random);
        (0..150).for_each(|_| swarm.step(80, &mut random));
        2.0 * swarm.best_cost()
    };
    (0..seeds).map(run).collect()
}

#[test]
fn random_harbours_are_charted_and_no_swarm_beats_the_taut_string() {
    for seed in 0..1000 {
        let parameters = Parameters { obstacles: Some(3 + (seed % 10) as usize), ..Parameters::default() };
        let world = World::new(generate("harbor", seed, &parameters).unwrap(), seed, 0).unwrap();
        let chart = ZoneSettings::default().chart(&world).unwrap();
        let cells: f64 = chart.cells().iter().map(|cell| cell.area_m2()).sum();
        let zones: f64 = chart.zones().iter().map(|zone| area(zone.corners())).sum();
        assert!((cells + zones - 4e4).abs() < 1e-2, "{seed}");
        let [start, goal] = [world.mission().start_m, world.mission().goal_m].map(|p| [p[0], p[1]]);
        let Ok(route) = Routes::new(&chart, start, goal).and_then(|routes| routes.shortest()) else { continue };
        let tight = taut(&chart, &route, start, goal);
        assert!(tight.windows(2).all(|leg| chart.is_free(leg[0], leg[1])), "{seed}");
        let best = shortest(&chart, start, goal, &mut || false).unwrap().unwrap();
        assert!(length(&best) <= length(&tight) + 1e-6, "{seed}");
        let corridor = Corridor::new(&chart, &route, [start, goal], false, Objective::Length, drift());
        let mut random = Stream::new(seed, Purpose::Planner, 0);
        let mut swarm = Swarm::new(&corridor, rules(Inertia::Linear, Bounds::Clamp), 40, 40, &mut random);
        (0..40).for_each(|_| swarm.step(40, &mut random));
        assert!(2.0 * swarm.best_cost() >= length(&tight) - 1e-6, "{seed}");
        assert!(!corridor.is_blocked(&corridor.path(swarm.best().iter().copied())), "{seed}");
    }
}

fn area(ring: &[[f64; 2]]) -> f64 {
    let edges = (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()]));
    0.5 * edges.map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>()
}

#[test]
fn swarms_are_distributed_as_known() {
    // Means of 2000 seeds; those of 150 lie within 1 m.
    for (map, linear, printed, reinforced) in
        [(0, 176.316, 178.209, 176.197), (1, 177.435, 180.650, 176.777), (2, 175.932, 177.486, 175.745)]
    {
        let chart = MAPS[map].chart();
        let route = Routes::new(&chart, START, GOAL).unwrap().shortest().unwrap();
        let corridor = Corridor::new(&chart, &route, [START, GOAL], false, Objective::Length, drift());
        let means = [
            (Inertia::Linear, Bounds::Clamp, linear, 1.0),
            (Inertia::Printed, Bounds::Clamp, printed, 1.0),
            (Inertia::Reinforced, Bounds::Clamp, reinforced, 1.0),
            (Inertia::Reinforced, Bounds::Penalty, MAPS[map].optimum_m, 0.05),
        ]
        .map(|(inertia, bounds, known, within)| {
            let lengths = ends(&corridor, rules(inertia, bounds), 150);
            let mean = lengths.iter().sum::<f64>() / 150.0;
            assert!((mean - known).abs() < within, "{} {inertia:?} {bounds:?} {mean}", MAPS[map].name);
            mean
        });
        assert!(means[2] < means[0] && means[0] < means[1] && means[3] < means[2], "{means:?}");
    }
}

/// The same against the known means of 2000 seeds, to what two such means differ by chance. A test for each map:
/// they run side by side.
fn means_of_2000_seeds(map: usize, known: [f64; 4]) {
    let chart = MAPS[map].chart();
    let route = Routes::new(&chart, START, GOAL).unwrap().shortest().unwrap();
    let corridor = Corridor::new(&chart, &route, [START, GOAL], false, Objective::Length, drift());
    let readings =
        [(Inertia::Linear, 0.63), (Inertia::Printed, 0.63), (Inertia::Reinforced, -0.63), (Inertia::Reinforced, 0.63)];
    for ((inertia, offset), known) in readings.into_iter().zip(known) {
        let lengths = ends(&corridor, Rules { offset, ..rules(inertia, Bounds::Clamp) }, 2000);
        let mean = lengths.iter().sum::<f64>() / 2000.0;
        assert!((mean - known).abs() < 0.3, "{} {inertia:?} {offset} {mean} {known}", MAPS[map].name);
    }
}

#[test]
fn means_of_2000_seeds_are_the_known_ones_on_p() {
    means_of_2000_seeds(0, [176.316, 178.209, 177.671, 176.197]);
}

#[test]
fn means_of_2000_seeds_are_the_known_ones_on_a() {
    means_of_2000_seeds(1, [177.435, 180.650, 180.060, 176.777]);
}

#[test]
fn means_of_2000_seeds_are_the_known_ones_on_b() {
    means_of_2000_seeds(2, [175.932, 177.486, 177.058, 175.745]);
}

#[test]
fn travel_times_are_the_known_ones_and_the_shortest_path_is_the_fastest() {
    for (map, shortest_s, middles_s) in [(0, 103.878, 156.02), (1, 104.03, 156.94), (3, 100.738, 112.0)] {
        let chart = MAPS[map].chart();
        let route = Routes::new(&chart, START, GOAL).unwrap().shortest().unwrap();
        let tight = taut(&chart, &route, START, GOAL);
        let time = drift().path_time(&tight);
        assert!((time - shortest_s).abs() < 6e-3, "{time}");
        let middles = drift().path_time(&route.by_middles(&chart, START, GOAL));
        assert!((middles - middles_s).abs() < 6e-3, "{middles}");
        // A swarm that minimises time ends at the shortest path.
        let corridor = Corridor::new(&chart, &route, [START, GOAL], false, Objective::Time, drift());
        let found = ends(&corridor, rules(Inertia::Linear, Bounds::Penalty), 5);
        assert!(found.iter().all(|still| (still / 1.5 - time).abs() < 0.1 && *still / 1.5 > time - 1e-6), "{found:?}");
    }
}

#[test]
fn the_papers_current_term_is_not_the_travel_time() {
    let chart = MAPS[0].chart();
    let route = Routes::new(&chart, START, GOAL).unwrap().shortest().unwrap();
    let corridor = |objective| Corridor::new(&chart, &route, [START, GOAL], false, objective, drift());
    let tight = taut(&chart, &route, START, GOAL);
    assert!((corridor(Objective::Current).cost(&tight) - 92.516).abs() < 2e-3);
    let best = |objective| ends(&corridor(objective), rules(Inertia::Linear, Bounds::Clamp), 20);
    let least = |found: Vec<f64>| found.into_iter().fold(f64::INFINITY, f64::min) / 2.0;
    let (degrees, radians) = (least(best(Objective::Current)), least(best(Objective::CurrentRadians)));
    assert!((degrees - 94.502).abs() < 0.02 && (radians - 91.850).abs() < 0.02, "{degrees} {radians}");
}

#[test]
fn fillets_keep_the_distance_and_one_bezier_does_not() {
    let cut = 0.5;
    for map in MAPS {
        let chart = Chart::new(maps::area(), &map.polygons(), maps::DISTANCE + cut, f64::INFINITY).unwrap();
        let path = shortest(&chart, START, GOAL, &mut || false).unwrap().unwrap();
        let round = fillets(&chart, &path, cut);
        assert!(round.depth_m <= cut + 1e-9 && round.depth_m > 0.01, "{} {}", map.name, round.depth_m);
        assert!((round.path[0], round.path[round.path.len() - 1]) == (START, GOAL));
        assert!(length(&round.path) < length(&path));
        // Between the points of the curve nothing turns by more than a few degrees.
        let sharpest = |path: &[[f64; 2]]| {
            let turns = path.windows(3).map(|p| {
                let heading = |a: [f64; 2], b: [f64; 2]| (b[1] - a[1]).atan2(b[0] - a[0]);
                let turn = (heading(p[1], p[2]) - heading(p[0], p[1])).abs();
                turn.min(std::f64::consts::TAU - turn)
            });
            turns.fold(0.0, f64::max)
        };
        assert!(sharpest(&round.path) < 0.5 * sharpest(&path), "{}", map.name);
        let plain = map.chart();
        let path = shortest(&plain, START, GOAL, &mut || false).unwrap().unwrap();
        if map.name != "B" {
            assert!(one_bezier(&plain, &path).depth_m > maps::DISTANCE, "{}", map.name);
        }
    }
}
