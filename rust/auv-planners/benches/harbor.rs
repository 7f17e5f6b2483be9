//! Charts and plans of harbours on one core.

use std::path::Path;

use auv_planners::maklink::fitness::{Corridor, Objective};
use auv_planners::maklink::harbor::{ZoneSettings, drift};
use auv_planners::maklink::route::Routes;
use auv_planners::maklink::swarm::{Bounds, Inertia, Rules, Swarm};
use auv_planners::maklink::{Area, Chart};
use auv_planners::{Control, plan};
use auv_world::rng::{Purpose, Stream};
use auv_world::{Scenario, World};
use divan::counter::ItemsCount;

fn main() {
    divan::main();
}

fn world(name: &str) -> World {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../auvgym/scenarios/{name}.toml"));
    World::new(Scenario::load(&path).expect("a shipped scenario"), 0, 0).expect("a good world")
}

/// Whole plans with their defaults: chart, route and path.
#[divan::bench(args = ["maklink-dijkstra", "maklink-aco", "maklink-pso", "rmpso", "funnel", "visibility"])]
fn whole_plan(bencher: divan::Bencher, planner: &str) {
    let world = world("harbor-a");
    let mission = world.mission();
    bencher.bench_local(|| {
        plan(planner, &world, mission.start_m, mission.goal_m, 0, "", &Control::none()).expect("a plan")
    });
}

/// Eight corridors instead of one.
#[divan::bench]
fn funnel_8(bencher: divan::Bencher) {
    let world = world("harbor-a");
    let mission = world.mission();
    let eight = r#"{"corridors": 8}"#;
    bencher.bench_local(|| plan("funnel", &world, mission.start_m, mission.goal_m, 0, eight, &Control::none()));
}

/// Zones, links and cells of a hundred polygons.
#[divan::bench(args = [10, 100])]
fn chart(bencher: divan::Bencher, obstacles: usize) {
    let mut stream = Stream::new(1, Purpose::Family, 0);
    let columns = (obstacles as f64).sqrt().ceil() as usize;
    let pitch = 2000.0 / columns as f64;
    let ring = |i: usize| -> Vec<[f64; 2]> {
        let centre = [(i % columns) as f64, (i / columns) as f64].map(|k| (k + stream.uniform(0.4, 0.6)) * pitch);
        let corner = |k: usize| {
            let angle = (k as f64 + stream.uniform(0.0, 0.8)) * std::f64::consts::TAU / 5.0;
            let reach = pitch * stream.uniform(0.2, 0.3);
            [centre[0] + reach * libm::cos(angle), centre[1] + reach * libm::sin(angle)]
        };
        (0..5).map(corner).collect()
    };
    let polygons: Vec<_> = (0..obstacles).map(ring).collect();
    let area = Area::new([0.0; 2], [2000.0; 2]).expect("an area");
    bencher.bench_local(|| Chart::new(area, &polygons, 1.875, 10.0).expect("a chart"));
}

/// Costed paths of eight links.
#[divan::bench(args = [Bounds::Clamp, Bounds::Penalty])]
fn swarm(bencher: divan::Bencher, bounds: Bounds) {
    let world = world("harbor-a");
    let chart = ZoneSettings::default().chart(&world).expect("a chart");
    let ends = [world.mission().start_m, world.mission().goal_m].map(|p| [p[0], p[1]]);
    let route = Routes::new(&chart, ends[0], ends[1]).and_then(|routes| routes.shortest()).expect("a route");
    let drift = drift(&world, Objective::Length).expect("any current");
    let corridor = Corridor::new(&chart, &route, ends, false, Objective::Length, drift);
    let (inertia, iterations) = (Inertia::Reinforced, 150);
    let rules = Rules { inertia, offset: 0.63, bounds, v_max: 3.0, cognitive: 2.0, social: 2.0, iterations };
    bencher.counter(ItemsCount::new(80_u64 * 151)).bench_local(|| {
        let mut random = Stream::new(0, Purpose::Planner, 0);
        let mut swarm = Swarm::new(&corridor, rules, 80, 80, &mut random);
        for _ in 0..iterations {
            swarm.step(80, &mut random);
        }
        swarm.best_cost()
    });
}
