use super::*;
use auv_world::families::Parameters;
use auv_world::rng::{Purpose, Stream};

const COUNT: usize = 7;

fn source(family: &str) -> Source {
    Source::family(family, Parameters::default()).unwrap()
}

fn batch(family: &str, threads: usize, autoreset: Autoreset) -> Batch {
    Batch::new(source(family), COUNT, threads, autoreset, Record::Nothing)
}

fn never() -> bool {
    false
}

/// Seed of the n-th episode of environment `i`.
fn seed(i: usize, n: usize) -> u64 {
    (1000 * i + n) as u64
}

fn actions(step: usize, width: usize) -> Vec<f32> {
    let mut stream = Stream::new(step as u64, Purpose::Planner, 0);
    (0..COUNT * width).map(|_| stream.uniform(-1.0, 1.0) as f32).collect()
}

/// Everything that 240 steps of random actions give, as bits.
fn flown(family: &str, threads: usize, autoreset: Autoreset) -> Vec<u64> {
    let mut batch = batch(family, threads, autoreset);
    let mut observations = vec![0.0; COUNT * batch.observation_len()];
    let mut episodes = [0; COUNT];
    let first: Vec<_> = (0..COUNT).map(|i| Some(seed(i, 0))).collect();
    batch.reset(&first, &mut observations, &mut never).unwrap();
    let mut seen = Vec::new();
    // In the step that ends an episode its end is not counted yet.
    let ahead = usize::from(autoreset == Autoreset::SameStep);
    for step in 0..240 {
        let seeds: Vec<_> = (0..COUNT).map(|i| seed(i, episodes[i] + ahead)).collect();
        batch.step(&actions(step, batch.action_len()), &seeds, &mut observations, &mut never).unwrap();
        seen.extend(observations.iter().map(|v| u64::from(v.to_bits())));
        for (lane, n) in batch.lanes().iter().zip(&mut episodes) {
            seen.extend([lane.reward.to_bits(), u64::from(lane.ended), lane.now.time_s.to_bits()]);
            *n += usize::from(lane.ended);
        }
    }
    assert!(episodes.iter().sum::<usize>() > 3);
    seen
}

/// The same from single episodes.
fn alone(family: &str, autoreset: Autoreset) -> Vec<u64> {
    let source = source(family);
    let mut observation = vec![0.0; source.widths().1];
    let mut episodes: Vec<_> = (0..COUNT).map(|i| (0, source.episode(seed(i, 0)).unwrap(), false)).collect();
    let mut seen = Vec::new();
    for step in 0..240 {
        let actions = actions(step, usize::from(source.dimensions()));
        let mut sums = Vec::new();
        for (i, (n, episode, over)) in episodes.iter_mut().enumerate() {
            let (mut reward, mut ended) = (0.0, false);
            if !std::mem::take(over) {
                let width = usize::from(source.dimensions());
                reward = episode.step(&actions[i * width..][..width]).unwrap();
                ended = episode.state().outcome != crate::Outcome::Running;
                *n += usize::from(ended);
                *over = ended && autoreset == Autoreset::NextStep;
            }
            if (ended && autoreset == Autoreset::SameStep)
                || (!ended && episode.state().outcome != crate::Outcome::Running)
            {
                *episode = source.episode(seed(i, *n)).unwrap();
            }
            episode.observe(&mut observation);
            seen.extend(observation.iter().map(|v| u64::from(v.to_bits())));
            sums.extend([reward.to_bits(), u64::from(ended), episode.state().time_s.to_bits()]);
        }
        seen.extend(sums);
    }
    seen
}

#[test]
fn a_batch_flies_as_single_episodes_do_whatever_its_threads() {
    for family in ["lfhh-2d", "lfhh-3d", "iifds"] {
        for autoreset in [Autoreset::NextStep, Autoreset::SameStep] {
            let expected = alone(family, autoreset);
            for threads in [1, 2, 5] {
                assert!(flown(family, threads, autoreset) == expected, "{family} {autoreset:?} {threads}");
            }
        }
    }
}

#[test]
fn a_wrong_action_is_named_and_nothing_has_moved() {
    let mut batch = batch("lfhh-2d", 2, Autoreset::NextStep);
    let mut observations = vec![0.0; COUNT * batch.observation_len()];
    batch.reset(&[Some(1); COUNT], &mut observations, &mut never).unwrap();
    let mut wrong = [0.0_f32; 2 * COUNT];
    wrong[2 * 4 + 1] = f32::NAN;
    let error = batch.step(&wrong, &[2; COUNT], &mut observations, &mut never).unwrap_err();
    assert_eq!(error.to_string(), "environment 4: action[1] = NaN: must lie in -1 .. 1");
    assert!((0..COUNT).all(|i| batch.episode(i).unwrap().state().ticks == 0));
}

#[test]
fn without_autoreset_an_ended_episode_refuses() {
    let mut batch = batch("lfhh-3d", 1, Autoreset::Disabled);
    let mut observations = vec![0.0; COUNT * batch.observation_len()];
    batch.reset(&[Some(1); COUNT], &mut observations, &mut never).unwrap();
    let forward = [1.0, 0.0, 0.0].repeat(COUNT);
    while !batch.lanes()[0].ended {
        batch.step(&forward, &[2; COUNT], &mut observations, &mut never).unwrap();
    }
    let error = batch.step(&forward, &[2; COUNT], &mut observations, &mut never).unwrap_err();
    assert!(error.to_string().starts_with("environment 0: the episode has ended"));
}

#[test]
fn stops_when_told() {
    let mut batch = batch("lfhh-2d", 2, Autoreset::NextStep);
    let mut observations = vec![0.0; COUNT * batch.observation_len()];
    let stopped = batch.reset(&[Some(1); COUNT], &mut observations, &mut || true);
    assert_eq!(stopped, Err(EnvError::Stopped));
}

#[test]
fn the_last_observation_survives_the_reset_of_the_same_step() {
    let mut batch = batch("lfhh-3d", 1, Autoreset::SameStep);
    let mut observations = vec![0.0; COUNT * batch.observation_len()];
    batch.reset(&[Some(1); COUNT], &mut observations, &mut never).unwrap();
    let mut single = source("lfhh-3d").episode(1).unwrap();
    let forward = [1.0, 0.0, 0.0];
    while !batch.lanes()[0].ended {
        batch.step(&forward.repeat(COUNT), &[2; COUNT], &mut observations, &mut never).unwrap();
        single.step(&forward).unwrap();
    }
    let mut observation = vec![0.0; batch.observation_len()];
    single.observe(&mut observation);
    let lane = &batch.lanes()[0];
    assert_eq!((lane.last, &lane.last_observation), (single.measures(), &observation));
    assert_eq!(lane.now, source("lfhh-3d").episode(2).unwrap().measures());
}
