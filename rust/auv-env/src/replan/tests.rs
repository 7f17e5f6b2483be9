use super::*;
use crate::measures::{Outcome, Record};
use crate::observation::{self, Mode};
use crate::source::Source;
use crate::{Autoreset, Batch, Episode};
use auv_world::families::Parameters;

fn settings(delay: Delay) -> Settings {
    let parameters = r#"{"spacing_m": 1000.0}"#.into();
    Settings { planner: "astar".into(), parameters, windows: [0.2, 0.5], delay }
}

fn source(family: &str, delay: Delay) -> Source {
    let source = Source::family(family, Parameters::default()).unwrap();
    source.replanning(settings(delay), &Control::none()).unwrap()
}

const DELAY: Delay = Delay::Fixed([120.0, 300.0, 600.0]);

fn act(episode: &mut Episode, action: f32) -> f64 {
    episode.step(&[action]).unwrap()
}

#[test]
fn planning_takes_exactly_its_time_and_is_counted() {
    for (action, seconds) in [(1.0, 120.0), (2.0, 300.0), (3.0, 600.0)] {
        let mut episode = source("lfhh-2d", DELAY).episode(3).unwrap();
        let (first, mut on) = (episode.state().evaluations, episode.clone());
        act(&mut on, 0.0);
        assert_eq!((on.state().planning_s, on.state().replans, on.state().evaluations), (0.0, 0, first));
        act(&mut episode, action);
        let state = episode.state();
        assert_eq!((state.planning_s, state.replans), (seconds, 1));
        assert!(state.evaluations > first);
        // The vehicle has kept its station: what it pays is time, and the energy for holding against the water.
        let held = &state.trail[seconds as usize / 15];
        assert!(auv_world::math::distance(*held, episode.world().mission().start_m) < 150.0, "{held:?}");
        assert!(state.energy_j > 20.0 * seconds);
    }
    let mut free = source("lfhh-2d", Delay::Fixed([0.0; 3])).episode(3).unwrap();
    act(&mut free, 3.0);
    assert_eq!((free.state().planning_s, free.state().replans), (0.0, 1));
    let mut counted = source("lfhh-2d", Delay::PerEvaluation(0.5)).episode(3).unwrap();
    let first = counted.state().evaluations;
    act(&mut counted, 3.0);
    let whole = 0.5 * (counted.state().evaluations - first) as f64;
    assert_eq!(counted.state().planning_s, 15.0 * (whole / 15.0).ceil());
}

#[test]
fn a_window_leaves_the_rest_of_the_plan() {
    let mut episode = source("lfhh-3d", DELAY).episode(1).unwrap();
    for _ in 0..4 {
        act(&mut episode, 0.0);
    }
    let (old, position) = (episode.pilot().unwrap().course.clone(), episode.state().position);
    let (whole_m, mut way) = (episode.limits().distance_m, Way::default());
    let mut far = 0.0;
    for (window, part) in [(Window::Short, 0.2), (Window::Long, 0.5)] {
        let (place, beyond) = old.window(position, part * whole_m, episode.world(), &mut way).expect("a place");
        assert!(episode.world().clearance(place) >= 300.0);
        let mut pilot = episode.pilot().unwrap().clone();
        let draft = pilot.draft(episode.world(), position, 0.0, window, &Control::none()).unwrap();
        let new = draft.course.expect("a way");
        assert_eq!(new.waypoints[0], position);
        let until = new.waypoints.iter().position(|point| *point == place).expect("the window's end is on the way");
        assert_eq!(new.waypoints[until + 1..], old.waypoints[beyond..]);
        let parted = auv_world::math::distance(position, place);
        assert!(parted > far && parted > 0.8 * part * whole_m && draft.seconds == [120.0, 300.0][window.index()]);
        far = parted;
    }
    // A window that reaches the goal is the full one.
    assert_eq!(old.window(position, 2.0 * whole_m, episode.world(), &mut way), None);
}

#[test]
fn without_a_way_the_old_plan_stays_in_flight() {
    let mut episode = source("lfhh-2d", DELAY).episode(2).unwrap();
    let mut pilot = episode.pilot().unwrap().clone();
    let position = episode.state().position;
    let draft = pilot.draft(episode.world(), position, 0.0, Window::Full, &Control::none()).unwrap();
    let before = pilot.course.waypoints.clone();
    assert!(!pilot.take(Draft { course: None, ..draft.clone() }));
    assert_eq!(pilot.course.waypoints, before);
    assert!(pilot.take(draft));
    // The same in an episode: no node of this grid can be left where everything must be 9 km clear.
    let wide = Settings { parameters: r#"{"spacing_m": 1000.0, "inflation_m": 9000.0}"#.into(), ..settings(DELAY) };
    let nowhere = Source::family("lfhh-2d", Parameters::default()).unwrap().replanning(wide, &Control::none()).unwrap();
    episode = nowhere.episode(2).unwrap();
    assert!(!episode.measures().plan_feasible);
    let plan = episode.pilot().unwrap().course.waypoints.clone();
    act(&mut episode, 3.0);
    assert_eq!((episode.measures().failed_plans, episode.measures().replans), (1, 1));
    assert_eq!(episode.state().planning_s, 600.0);
    assert_eq!(episode.pilot().unwrap().course.waypoints, plan);
}

#[test]
fn looking_decides_nothing() {
    let source = source("lfhh-2d", DELAY);
    let (mut looks, mut blind) = (source.episode(7).unwrap(), source.episode(7).unwrap());
    let mut values = vec![0.0; source.widths().1];
    for step in 0.. {
        let action = [f32::from([0_u8, 0, 0, 1, 0, 2][step % 6])];
        looks.observe(&mut values);
        assert_eq!(looks.step(&action), blind.step(&action));
        assert_eq!(looks.state(), blind.state());
        if looks.state().outcome != Outcome::Running {
            break;
        }
    }
    assert!(blind.state().replans > 2);
}

#[test]
fn an_interruption_changes_nothing() {
    let mut episode = source("lfhh-2d", DELAY).episode(2).unwrap();
    act(&mut episode, 0.0);
    let before = episode.state().clone();
    let stop = || true;
    assert_eq!(episode.act(&[3.0], &Control::ask(&stop)), Err(EnvError::Stopped));
    assert_eq!(episode.state(), &before);
    act(&mut episode, 3.0);
}

#[test]
fn wrong_actions_and_settings_are_named() {
    let mut episode = source("lfhh-2d", DELAY).episode(2).unwrap();
    for wrong in [&[4.0][..], &[0.5], &[-1.0], &[f32::NAN], &[0.0, 1.0], &[]] {
        assert!(matches!(episode.act(wrong, &Control::none()), Err(EnvError::Action { .. })));
    }
    let refuse = |settings: Settings| {
        let source = Source::family("lfhh-3d", Parameters::default()).unwrap();
        source.replanning(settings, &Control::none()).unwrap_err().to_string()
    };
    assert!(refuse(Settings { windows: [0.5, 0.2], ..settings(DELAY) }).starts_with("windows = [0.5, 0.2]"));
    assert!(refuse(settings(Delay::Fixed([0.0, -1.0, 0.0]))).starts_with("planning_s = -1"));
    assert!(refuse(settings(Delay::PerEvaluation(f64::NAN))).starts_with("seconds_per_evaluation"));
    assert!(refuse(Settings { planner: "astr".into(), ..settings(DELAY) }).contains("did you mean \"astar\"?"));
    let visibility = Settings { planner: "visibility".into(), parameters: String::new(), ..settings(DELAY) };
    assert!(refuse(visibility).contains("MAKLINK planners know no"));
    assert!(refuse(Settings { parameters: r#"{"spacing": 1}"#.into(), ..settings(DELAY) }).contains("spacing_m"));
}

/// Everything that an episode under pseudo-random actions gives, as bits, saved and loaded on the way if asked.
fn flown(mut episode: Episode, saving: bool) -> Vec<u64> {
    let (mut seen, mut values) = (Vec::new(), Vec::new());
    let dimensions = episode.world().scenario().dimensions;
    values.resize(observation::length(dimensions, Mode::Replan), 0.0);
    let blocks = observation::layout(dimensions, Mode::Replan);
    for step in 0.. {
        if episode.state().outcome != Outcome::Running {
            break;
        }
        if saving {
            episode = Episode::load(&episode.save().unwrap()).unwrap();
        }
        seen.push(act(&mut episode, f32::from([0_u8, 0, 1, 0, 3, 0, 2][step % 7])).to_bits());
        episode.observe(&mut values);
        for block in &blocks {
            let held = values[block.start..block.start + block.len].iter();
            assert!(held.clone().all(|v| (block.low..=block.high).contains(v)), "{} {held:?}", block.name);
        }
        seen.extend(values.iter().map(|v| u64::from(v.to_bits())));
        seen.push(episode.state().time_s.to_bits());
    }
    seen
}

#[test]
fn saved_episodes_go_on_identically_in_every_family() {
    for family in ["lfhh-2d", "lfhh-3d", "iifds", "harbor"] {
        let spacing = match family {
            "harbor" => 5.0,
            "iifds" => 500.0,
            _ => 2000.0,
        };
        let own = Settings { parameters: format!(r#"{{"spacing_m": {spacing}}}"#), ..settings(DELAY) };
        let source = Source::family(family, Parameters::default()).unwrap();
        let source = source.replanning(own, &Control::none()).unwrap();
        let episode = source.episode(5).unwrap();
        let once = flown(episode.clone(), false);
        assert!(once.len() > 300);
        assert!(once == flown(episode, true), "{family}");
    }
}

#[test]
fn a_batch_plans_as_single_episodes_do() {
    const COUNT: usize = 5;
    let source = source("lfhh-2d", DELAY);
    let (_, width) = source.widths();
    let mut expected = Vec::new();
    let mut singles: Vec<_> = (0..COUNT as u64).map(|seed| source.episode(seed).unwrap()).collect();
    let choice = |step: usize, i: usize| f32::from([0_u8, 3, 0, 1, 2][(step + i) % 5]);
    for step in 0..6 {
        for (i, single) in singles.iter_mut().enumerate() {
            let mut values = vec![0.0; width];
            expected.push(act(single, choice(step, i)).to_bits());
            single.observe(&mut values);
            expected.extend(values.iter().map(|v| u64::from(v.to_bits())));
        }
    }
    for threads in [1, 3] {
        let mut batch = Batch::new(source.clone(), COUNT, threads, Autoreset::NextStep, Record::Nothing);
        let mut rows = vec![0.0; COUNT * width];
        let seeds: Vec<_> = (0..COUNT as u64).map(Some).collect();
        batch.reset(&seeds, &mut rows, &mut || false).unwrap();
        let mut found = Vec::new();
        for step in 0..6 {
            let actions: Vec<_> = (0..COUNT).map(|i| choice(step, i)).collect();
            batch.step(&actions, &[0; COUNT], &mut rows, &mut || false).unwrap();
            for (lane, row) in batch.lanes().iter().zip(rows.chunks_exact(width)) {
                found.push(lane.reward.to_bits());
                found.extend(row.iter().map(|v| u64::from(v.to_bits())));
            }
        }
        assert!(found == expected, "{threads}");
    }
}
