//! The flow: a tick among threats, a whole line, a generation of tuned coefficients, on one core.

use std::path::Path;

use auv_planners::fluid::threats::{Navigator, Rules};
use auv_planners::fluid::{Coefficients, Flow, trace};
use auv_planners::{Control, plan};
use auv_world::{Scenario, World};

fn main() {
    divan::main();
}

fn world(name: &str) -> World {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../auvgym/scenarios/{name}.toml"));
    World::new(Scenario::load(&path).expect("a shipped scenario"), 0, 0).expect("a good world")
}

/// A tick: measurements of all threats, prediction, sides, flow, barrier. 0, 1, 3 threats; 3 threats, ten
/// columns and a jet.
#[divan::bench(args = ["iifds-threat1", "iifds-threats3", "iifds-complex"])]
fn tick(bencher: divan::Bencher, name: &str) {
    let mut world = world(name);
    let (start, goal) = (world.mission().start_m, world.mission().goal_m);
    let moving: Vec<usize> = (0..world.extents().len()).filter(|i| world.obstacle_velocity(*i) != [0.0; 3]).collect();
    let radii: Vec<f64> = moving.iter().map(|i| world.extents()[*i]).collect();
    let rules = Rules { ignore_receding: false, ..Rules::default() };
    let mut navigator = Navigator::new(&world, [start, goal], &radii, 0.6, &Flow::default(), rules);
    // 250 ticks before the meeting; the vehicle's place is given so that every round is the same.
    let ticks = 250;
    let seen: Vec<Vec<_>> = (0..ticks)
        .map(|tick| {
            world.set_time(6.0 * f64::from(tick));
            moving.iter().map(|i| world.obstacle_position(*i)).collect()
        })
        .collect();
    let mut tick = 0;
    bencher.bench_local(|| {
        tick = (tick + 1) % seen.len();
        let time = 6.0 * tick as f64;
        for (threat, place) in seen[tick].iter().enumerate() {
            navigator.measure(threat, *place, time);
        }
        let here = [8.0 * tick as f64, 8.0 * tick as f64, 2.9e3];
        navigator.course(here, time, 6.0)
    });
}

/// A line of about 250 steps round thirteen superquadrics, with the guard and without.
#[divan::bench(args = [true, false])]
fn line_of_13_obstacles(bencher: divan::Bencher, guard: bool) {
    let world = world("iifds-static-dense");
    let ends = [world.mission().start_m, world.mission().goal_m];
    let flow = Flow { step_m: 60.0, guard: Some(guard), ..Flow::default() };
    let mut field = flow.field(&world, ends, 0.0, |_| Coefficients { rho: 1.5, sigma: 2.0, theta: 1.4 });
    let steps = flow.steps(&world, 1.0, ends[0], ends[1]);
    let mut path = Vec::new();
    bencher.bench_local(|| trace(&mut field, &world, &steps, ends, &Control::none(), &mut path));
}

/// The same with the jet.
#[divan::bench]
fn line_with_current(bencher: divan::Bencher) {
    let world = world("iifds-static-dense");
    let ends = [world.mission().start_m, world.mission().goal_m];
    let flow = Flow { step_m: 60.0, ..Flow::default() };
    let mut field = flow.field(&world, ends, 0.0, |_| Coefficients { rho: 1.5, sigma: 2.0, theta: 1.4 });
    let steps = flow.steps(&world, 0.7, ends[0], ends[1]);
    let mut path = Vec::new();
    bencher.bench_local(|| trace(&mut field, &world, &steps, ends, &Control::none(), &mut path));
}

/// A generation of 100 individuals: each a line drawn and judged.
#[divan::bench(sample_count = 20)]
fn generation_of_100(bencher: divan::Bencher) {
    let world = world("iifds-static-dense");
    let mission = world.mission();
    let parameters = r#"{"generations": 0, "cost_options": {"collision": "segment"}, "flow": {"step_m": 60}}"#;
    let mut seed = 0;
    bencher.bench_local(|| {
        seed += 1;
        plan("iifds-ga", &world, mission.start_m, mission.goal_m, seed, parameters, &Control::none())
    });
}

/// Planner `iifds` as it comes, with everything that a plan needs.
#[divan::bench(args = ["lfhh-2d-1", "lfhh-3d-1", "lfhh-3d-3", "iifds-static-dense"], sample_count = 20)]
fn iifds(bencher: divan::Bencher, name: &str) {
    let world = world(name);
    let mission = world.mission();
    let parameters = r#"{"cost_options": {"collision": "segment"}}"#;
    bencher.bench_local(|| plan("iifds", &world, mission.start_m, mission.goal_m, 0, parameters, &Control::none()));
}
