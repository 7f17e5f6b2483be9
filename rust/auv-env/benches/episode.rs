//! What an environment step costs on one core: a whole leg of the default families, and its parts.

use auv_env::observation::{self, Mode};
use auv_env::{Episode, Source};
use auv_world::families::Parameters;
use auv_world::rng::{Purpose, Stream};
use divan::counter::ItemsCount;

fn main() {
    divan::main();
}

fn source(family: &str) -> Source {
    Source::family(family, Parameters::default()).expect("a family")
}

/// Random waypoints ahead; a new episode whenever one ends. One item = one environment step.
#[divan::bench(args = ["lfhh-2d", "lfhh-3d", "harbor"])]
fn waypoint_steps(bencher: divan::Bencher, family: &str) {
    let source = source(family);
    let mut episode = source.episode(0).expect("a world");
    let mut observation = vec![0.0; observation::length(episode.world().scenario().dimensions, Mode::Waypoint)];
    let mut stream = Stream::new(3, Purpose::Planner, 0);
    let mut seed = 0;
    bencher.counter(ItemsCount::new(100_usize)).bench_local(|| {
        for _ in 0..100 {
            let action: Vec<f32> = (0..episode.action_len()).map(|_| stream.uniform(-1.0, 1.0) as f32).collect();
            if episode.step(&action).is_err() {
                seed += 1;
                episode = source.episode(seed).expect("a world");
            }
            episode.observe(&mut observation);
        }
    });
}

/// Straight legs to the end of 64 episodes that are there already. One item = one physics tick.
#[divan::bench(args = ["lfhh-2d", "lfhh-3d"])]
fn ticks(bencher: divan::Bencher, family: &str) {
    let source = source(family);
    let episodes: Vec<Episode> = (0..64).map(|seed| source.episode(seed).expect("a world")).collect();
    let fly = |mut episodes: Vec<Episode>| {
        let action = vec![0.9; episodes[0].action_len()];
        for episode in &mut episodes {
            while episode.step(&action).is_ok() {}
        }
        episodes.iter().map(|episode| episode.state().ticks).sum::<u64>()
    };
    let total = fly(episodes.clone());
    bencher.counter(ItemsCount::new(total)).with_inputs(|| episodes.clone()).bench_local_values(fly);
}

#[divan::bench(args = ["lfhh-2d", "lfhh-3d"])]
fn observe(bencher: divan::Bencher, family: &str) {
    let mut episode = source(family).episode(1).expect("a world");
    let mut observation = vec![0.0; observation::length(episode.world().scenario().dimensions, Mode::Waypoint)];
    for _ in 0..8 {
        let action = episode.action_for([10_000.0, 20_000.0, 10_000.0]);
        let _ended = episode.step(&action[..episode.action_len()]);
    }
    bencher.bench_local(|| episode.observe(&mut observation));
}

#[divan::bench(args = ["lfhh-2d", "lfhh-3d", "harbor"])]
fn reset(bencher: divan::Bencher, family: &str) {
    let source = source(family);
    let mut seed = 0;
    bencher.bench_local(|| {
        seed += 1;
        source.episode(seed).expect("a world")
    });
}

/// The sonar alone.
#[divan::bench(args = ["lfhh-2d", "lfhh-3d"])]
fn sonar(bencher: divan::Bencher, family: &str) {
    let mut episode = source(family).episode(1).expect("a world");
    for _ in 0..8 {
        let action = episode.action_for([10_000.0, 20_000.0, 10_000.0]);
        let _ended = episode.step(&action[..episode.action_len()]);
    }
    let world = episode.world();
    let beams = auv_env::sonar::beams(world.scenario().dimensions);
    let mut ranges = vec![0.0; beams.len()];
    let mut scratch = auv_world::world::Scratch::default();
    let position = episode.state().position;
    bencher.bench_local(|| world.sonar(position, beams, 5000.0, &mut scratch, &mut ranges));
}
