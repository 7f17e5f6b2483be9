//! What a world answers, per point, in batches of 1024 on one core.

use auv_world::families::{Parameters, generate};
use auv_world::rng::{Purpose, Stream};
use auv_world::{Scenario, World};
use divan::counter::ItemsCount;

const POINTS: usize = 1024;

fn main() {
    divan::main();
}

fn paper_world(name: &str) -> World {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../auvgym/scenarios").join(name);
    World::new(Scenario::load(&path).expect("a shipped scenario"), 0, 0).expect("a good world")
}

fn points(world: &World) -> Vec<[f64; 3]> {
    let domain = &world.scenario().domain;
    let mut stream = Stream::new(1, Purpose::Planner, 0);
    (0..POINTS)
        .map(|_| std::array::from_fn(|axis| stream.uniform(domain.min_m[axis], domain.max_m[axis] + 1e-9)))
        .collect()
}

#[divan::bench(args = ["lfhh-3d-1.toml", "lfhh-2d-1.toml"])]
fn current(bencher: divan::Bencher, name: &str) {
    let world = paper_world(name);
    let points = points(&world);
    bencher.counter(ItemsCount::new(POINTS)).bench(|| {
        points.iter().fold([0.0, 0.0], |sum, point| {
            let velocity = world.current(*point);
            [sum[0] + velocity[0], sum[1] + velocity[1]]
        })
    });
}

#[divan::bench(args = ["lfhh-3d-1.toml", "lfhh-2d-1.toml"])]
fn clearance(bencher: divan::Bencher, name: &str) {
    let world = paper_world(name);
    let points = points(&world);
    bencher
        .counter(ItemsCount::new(POINTS))
        .bench(|| points.iter().fold(0.0, |sum, point| sum + world.clearance(*point)));
}

#[divan::bench(args = ["lfhh-3d-1.toml", "lfhh-2d-1.toml"])]
fn current_and_clearance(bencher: divan::Bencher, name: &str) {
    let world = paper_world(name);
    let points = points(&world);
    bencher.counter(ItemsCount::new(POINTS)).bench(|| {
        points.iter().fold(0.0, |sum, point| {
            let velocity = world.current(*point);
            sum + velocity[0] + velocity[1] + world.clearance(*point)
        })
    });
}

#[divan::bench(args = ["lfhh-2d", "lfhh-3d"])]
fn new_world_of_a_family(bencher: divan::Bencher, family: &str) {
    let mut seed = 0;
    bencher.bench_local(|| {
        seed += 1;
        World::new(generate(family, seed, &Parameters::default()).expect("a family"), seed, 0).expect("a good world")
    });
}
