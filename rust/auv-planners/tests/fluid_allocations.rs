//! The hot loops of the flow ask for no memory.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;

use allocation_counter::measure;
use auv_planners::Control;
use auv_planners::fluid::threats::{Navigator, Rules};
use auv_planners::fluid::{Coefficients, Flow, trace};
use auv_world::{Scenario, World};

fn world(name: &str) -> World {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../auvgym/scenarios");
    World::new(Scenario::load(&folder.join(format!("{name}.toml"))).unwrap(), 0, 0).unwrap()
}

#[test]
fn a_tick_among_threats_allocates_nothing() {
    for name in ["iifds-threat1", "iifds-threats3", "iifds-complex"] {
        let world = world(name);
        let ends = [world.mission().start_m, world.mission().goal_m];
        let moving: Vec<usize> =
            (0..world.extents().len()).filter(|i| world.obstacle_velocity(*i) != [0.0; 3]).collect();
        let radii: Vec<f64> = moving.iter().map(|i| world.extents()[*i]).collect();
        let mut navigator = Navigator::new(&world, ends, &radii, 0.6, &Flow::default(), Rules::default());
        let mut here = ends[0];
        let mut tick = |navigator: &mut Navigator, number: usize| {
            let time = 6.0 * number as f64;
            for (threat, i) in moving.iter().enumerate() {
                navigator.measure(threat, world.obstacle_position(*i), time);
            }
            here = navigator.course(here, time, 6.0).waypoint;
        };
        // The first tick may make room.
        tick(&mut navigator, 0);
        let counted = measure(|| (1..500).for_each(|number| tick(&mut navigator, number)));
        assert_eq!(counted.count_total, 0, "{name}");
    }
}

#[test]
fn a_line_allocates_nothing_once_there_is_room() {
    let world = world("iifds-static-dense");
    let ends = [world.mission().start_m, world.mission().goal_m];
    let flow = Flow { step_m: 60.0, ..Flow::default() };
    let mut field = flow.field(&world, ends, 0.0, |_| Coefficients { rho: 1.5, sigma: 2.0, theta: 1.4 });
    let steps = flow.steps(&world, 0.7, ends[0], ends[1]);
    let mut path = Vec::new();
    trace(&mut field, &world, &steps, ends, &Control::none(), &mut path);
    let counted = measure(|| {
        trace(&mut field, &world, &steps, ends, &Control::none(), &mut path);
    });
    assert_eq!(counted.count_total, 0);
    assert!(path.len() > 200);
}
