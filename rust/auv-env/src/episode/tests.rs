use super::*;
use crate::source::Source;
use auv_world::families::Parameters;
use auv_world::math::add_scaled;
use auv_world::rng::{Purpose, Stream};

fn episode(family: &str, parameters: Parameters, seed: u64) -> Episode {
    Source::family(family, parameters).unwrap().episode(seed).unwrap()
}

fn towards_goal(episode: &Episode) -> Vec<f32> {
    episode.action_for(episode.world().mission().goal_m)[..episode.action_len()].to_vec()
}

fn finish(mut episode: Episode) -> (Episode, f64) {
    let mut total = 0.0;
    while episode.state().outcome == Outcome::Running {
        total += episode.step(&towards_goal(&episode)).unwrap();
    }
    (episode, total)
}

#[test]
fn still_water_takes_the_straight_time() {
    let empty = Parameters { obstacles: Some(0), vortices: Some(0), ..Parameters::default() };
    let (end, total) = finish(episode("lfhh-2d", empty, 1));
    assert_eq!(end.state().outcome, Outcome::Goal);
    let straight = end.limits().distance_m / 2.0;
    assert!((end.state().time_s - (straight - 150.0)).abs() < 300.0);
    assert!((end.state().path_length_m / end.limits().distance_m - 1.0).abs() < 0.02);
    assert!(total > 1.0);
}

#[test]
fn failures_sum_to_less_than_arrivals() {
    let mut failed = 0;
    for seed in 0..60 {
        let (end, total) = finish(episode("lfhh-3d", Parameters::default(), seed));
        match end.state().outcome {
            Outcome::Goal => assert!(total > 1.0),
            _ => {
                failed += 1;
                assert!(total < 0.0);
            }
        }
    }
    assert!(failed > 20);
}

/// Leaving a measurement out must never hide a collision or a least clearance.
#[test]
fn min_clearance_is_that_of_the_trail() {
    for (family, speed) in [("lfhh-3d", 0.0), ("lfhh-2d", 0.0), ("lfhh-3d", 0.8)] {
        let parameters = Parameters { obstacle_speed_mps: Some(speed), ..Parameters::default() };
        for seed in 0..20 {
            let mut episode = episode(family, parameters.clone(), seed);
            let mut least = episode.state().min_clearance_m;
            while episode.state().outcome == Outcome::Running {
                let before = episode.clone();
                let action = towards_goal(&episode);
                episode.step(&action).unwrap();
                let mut world = before.world().clone();
                let first = before.state().trail.len();
                for (i, point) in episode.state().trail[first..].iter().enumerate() {
                    world.set_time((before.state().ticks + 1 + i as u64) as f64 * 15.0);
                    least = least.min(world.clearance(*point));
                }
                least = least.min(episode.world().clearance(episode.state().position));
                let found = episode.state().min_clearance_m;
                // The sea floor's clearance is a lower bound and may itself dip faster than a vehicle flies.
                assert!(found >= least - 1e-6 && (found - least < 50.0 || least > 0.0), "{found} {least}");
                assert_eq!(found <= 0.0, least <= 0.0);
            }
        }
    }
}

/// A leg as `spec` has it, one vehicle and one tick after another: what flying side by side must give.
fn flown_alone(episode: &mut Episode, waypoint: Vec3) {
    let flight = episode.world.scenario().episode.clone();
    let (tick_s, first) = (flight.tick_s, episode.state.ticks);
    episode.state.waypoint = Some(waypoint);
    loop {
        let (world, state) = (&mut episode.world, &mut episode.state);
        let current = world.current(state.position);
        let order = episode.helm.steer(state.position, state.heading, waypoint, current);
        let mut position = add_scaled(state.position, order.speed * tick_s, order.heading);
        position[0] += current[0] * tick_s;
        position[1] += current[1] * tick_s;
        position[2] = position[2].max(world.scenario().domain.min_m[2].min(state.position[2]));
        let travelled = distance(state.position, position);
        (state.position, state.heading) = (position, order.heading);
        state.ticks += 1;
        state.time_s = state.ticks as f64 * tick_s;
        state.energy_j += world.scenario().vehicle.power_w(order.speed) * tick_s;
        state.path_length_m += travelled;
        state.since_change_m += travelled;
        state.trail.push(position);
        world.set_time(state.time_s);
        state.clearance_left_m -= travelled + world.fastest_obstacle_mps() * tick_s;
        if state.clearance_left_m <= state.min_clearance_m {
            state.clearance_left_m = world.clearance_within(position, state.min_clearance_m + episode.lookout_m);
            state.min_clearance_m = state.min_clearance_m.min(state.clearance_left_m);
        }
        episode.judge();
        let (state, elapsed) = (&episode.state, (episode.state.ticks - first) as f64 * tick_s);
        let captured = elapsed >= flight.minimum_leg_s && distance(state.position, waypoint) <= flight.capture_radius_m;
        if state.outcome != Outcome::Running || state.map_changed || captured || elapsed >= flight.maximum_leg_s {
            return;
        }
    }
}

#[test]
fn legs_side_by_side_are_what_each_is_alone() {
    let moving = Parameters {
        obstacle_speed_mps: Some(0.4),
        vortex_drift_mps: Some(0.1),
        current_ratio: Some(1.4),
        ..Parameters::default()
    };
    let vessels = Parameters { vessels: Some(6), ..Parameters::default() };
    let mut stream = Stream::new(11, Purpose::Planner, 0);
    for (family, parameters) in [
        ("lfhh-2d", Parameters::default()),
        ("lfhh-3d", Parameters::default()),
        ("lfhh-2d", moving.clone()),
        ("lfhh-3d", moving),
        ("harbor", vessels),
        ("afhh", Parameters::default()),
        ("iifds", Parameters::default()),
    ] {
        let mut together: Vec<Episode> = (0..11).map(|seed| episode(family, parameters.clone(), seed)).collect();
        let mut alone = together.clone();
        for _ in 0..40 {
            let (mut legs, reach) = (Vec::new(), together[0].world.scenario().episode.reach_m);
            for (one, other) in together.iter_mut().zip(&mut alone) {
                if one.state.outcome != Outcome::Running {
                    continue;
                }
                // Near ones too, so that station is kept.
                let size = if stream.unit() < 0.2 { 0.02 } else { 1.0 };
                let offset = std::array::from_fn(|_| stream.uniform(-size, size));
                let waypoint = one.clip(add_scaled(one.state.position, reach, offset));
                (one.state.map_changed, other.state.map_changed) = (false, false);
                flown_alone(other, waypoint);
                legs.push(Leg::towards(one, waypoint));
            }
            flight::fly(&mut legs);
        }
        for (one, other) in together.iter().zip(&alone) {
            assert!(one.state == other.state, "{family} {:?}", one.world.seed());
            assert_eq!(one.world.changes(), other.world.changes());
        }
    }
}

#[test]
fn saved_episodes_go_on_identically() {
    for family in ["lfhh-2d", "lfhh-3d"] {
        let mut original = episode(family, Parameters { vortex_drift_mps: Some(0.1), ..Parameters::default() }, 4);
        let action = vec![0.3; original.action_len()];
        for _ in 0..12 {
            if original.step(&action).is_err() {
                break;
            }
            let mut copy = Episode::load(&original.save().unwrap()).unwrap();
            let mut next = original.clone();
            let mut values = [vec![0.0; 128], vec![0.0; 128]];
            assert_eq!(next.step(&action), copy.step(&action));
            next.observe(&mut values[0]);
            copy.observe(&mut values[1]);
            assert_eq!(values[0], values[1]);
            assert_eq!(next.state(), copy.state());
        }
    }
    assert!(Episode::load(b"nonsense").is_err());
}

#[test]
fn wrong_actions_change_nothing() {
    let mut episode = episode("lfhh-3d", Parameters::default(), 1);
    let before = episode.state().clone();
    for action in [&[0.0, 0.0][..], &[f32::NAN, 0.0, 0.0], &[0.0, 1.5, 0.0], &[0.0, 0.0, f32::INFINITY]] {
        assert!(matches!(episode.step(action), Err(EnvError::Action { .. })));
    }
    assert_eq!(episode.state(), &before);
}

#[test]
fn actions_and_waypoints_are_inverse() {
    let episode = episode("lfhh-3d", Parameters::default(), 2);
    for action in [[0.3_f32, -0.4, 0.2], [-1.0, 1.0, -1.0], [1.0, 0.0, 0.0]] {
        let frame = episode.frame();
        let offset = [f64::from(0.25 + 0.75 * action[0]), f64::from(action[1]), f64::from(action[2])];
        let waypoint = add_scaled(episode.state().position, 2000.0, frame.to_world(offset));
        let back = episode.action_for(waypoint);
        assert!((0..3).all(|i| (back[i] - action[i]).abs() < 1e-5), "{back:?} {action:?}");
    }
    let far = episode.action_for(episode.world().mission().goal_m);
    assert!(far.iter().any(|v| v.abs() == 1.0));
}
