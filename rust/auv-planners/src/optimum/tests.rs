//! The search against every path of small lattices, and its sums against the cost of whole paths.

use auv_world::families::{self, generate};
use auv_world::math::distance;
use auv_world::rng::{Purpose, Stream};
use auv_world::scenario::Current;
use auv_world::{Scenario, World};

use super::graph::Graph;
use super::lattice::Lattice;
use super::{Optimum, Settings, optimum};
use crate::control::Control;
use crate::cost::{Collision, Cost, CostOptions, CostTerms};
use crate::parameters::Common;
use crate::sections::SectionProblem;
use crate::testing;

const COSTS: [Cost; 4] = [Cost::Lfhh, Cost::Afhh, Cost::Time, Cost::Energy];

/// A drawn world with few, far sections, so that all paths can be counted and turns matter.
fn small_world(family: &str, seed: u64, sections: usize, obstacles: usize) -> World {
    let parameters = families::Parameters { obstacles: Some(obstacles), ..Default::default() };
    let mut scenario: Scenario = generate(family, seed, &parameters).unwrap();
    scenario.change = None;
    let frame = scenario.sections.as_mut().unwrap();
    frame.count = sections;
    frame.spacing_m = Some(40e3 / (sections - 1) as f64);
    World::new(scenario, seed, 0).unwrap()
}

fn problem(world: &World, cost: Cost, options: &CostOptions) -> SectionProblem {
    let mission = world.mission();
    SectionProblem::new(world, mission.start_m, mission.goal_m, cost, options).unwrap()
}

fn solve(problem: &SectionProblem, cost: Cost, options: &CostOptions, settings: &Settings) -> Optimum {
    let common = Common { cost, cost_options: *options, ..Common::default() };
    optimum(&mut problem.clone(), &common, settings, Control::none(), "section-optimum")
}

/// Calls `visit` with every path through the lattice whose steps it has.
fn every_path(lattice: &Lattice, visit: &mut impl FnMut(&[usize])) {
    fn extend(lattice: &Lattice, path: &mut Vec<usize>, visit: &mut impl FnMut(&[usize])) {
        if path.len() == lattice.layers() {
            return visit(path);
        }
        for node in 0..lattice.nodes() {
            let part = |node: usize| [node % lattice.columns, node / lattice.columns];
            let near =
                |last: &usize| (0..2).all(|axis| part(*last)[axis].abs_diff(part(node)[axis]) <= lattice.reach[axis]);
            if path.last().is_none_or(near) {
                path.push(node);
                extend(lattice, path, visit);
                path.pop();
            }
        }
    }
    extend(lattice, &mut Vec::new(), visit);
}

/// The least total of all feasible lattice paths.
fn brute_force(problem: &mut SectionProblem, lattice: &Lattice) -> Option<CostTerms> {
    let mut best: Option<CostTerms> = None;
    every_path(lattice, &mut |path| {
        let terms = problem.evaluate(&lattice.genes(problem, path));
        if terms.feasible && best.is_none_or(|best| terms.total < best.total) {
            best = Some(terms);
        }
    });
    best
}

/// Compares with brute force; gives whether there is a feasible path.
fn certify(world: &World, cost: Cost, options: &CostOptions, settings: &Settings) -> bool {
    let mut problem = problem(world, cost, options);
    let lattice = Lattice::whole(&problem, settings.grain(&problem), problem.segments().longest());
    let best = brute_force(&mut problem, &lattice);
    let Optimum { plan, bound } = solve(&problem, cost, options, settings);
    assert_eq!(plan.feasible, best.is_some());
    let Some(best) = best else {
        assert_eq!(bound, Some(f64::INFINITY));
        return false;
    };
    assert!((plan.cost.total - best.total).abs() < 1e-9, "{cost:?}: {} {}", plan.cost.total, best.total);
    let (bound, least) = (bound.unwrap(), best.time_s.unwrap_or(best.total));
    assert!((bound - least).abs() < 1e-6 * least.abs().max(1.0), "{cost:?}: {bound} {least}");
    true
}

#[test]
fn no_path_of_a_flat_lattice_costs_less() {
    let mut feasible = 0;
    for seed in 0..12 {
        for cost in COSTS {
            let world = small_world("lfhh-2d", seed, 6, 8 + 4 * seed as usize);
            let settings = Settings { lateral_m: 2.3e3, polish: false, ..Settings::default() };
            feasible += usize::from(certify(&world, cost, &CostOptions::default(), &settings));
        }
    }
    assert!((20..48).contains(&feasible), "{feasible}");
}

#[test]
fn no_path_of_a_deep_lattice_costs_less() {
    let mut feasible = 0;
    for seed in 0..6 {
        for cost in COSTS {
            let world = small_world("lfhh-3d", seed, 5, 60 + 40 * seed as usize);
            let wide =
                Settings { lateral_m: 4.7e3, depth_m: 4.3e3, lateral_reach_m: 2e4, depth_reach_m: 2e4, polish: false };
            feasible += usize::from(certify(&world, cost, &CostOptions::default(), &wide));
            let short = Settings { lateral_reach_m: 5e3, depth_reach_m: 5e3, ..wide };
            feasible += usize::from(certify(&world, cost, &CostOptions::default(), &short));
        }
    }
    assert!((20..48).contains(&feasible), "{feasible}");
}

#[test]
fn other_readings_are_exact_too() {
    let settings = Settings { lateral_m: 2.3e3, polish: false, ..Settings::default() };
    let readings = [
        CostOptions { turn_limit_rad: 0.3, ..CostOptions::default() },
        CostOptions { turn_limit_rad: std::f64::consts::PI, ..CostOptions::default() },
        CostOptions { margin_m: 400.0, ..CostOptions::default() },
        CostOptions { collision: Collision::Cells, ..CostOptions::default() },
        CostOptions { step_limit: 1.05, ..CostOptions::default() },
    ];
    let mut feasible = 0;
    for seed in 20..23 {
        let mut world = small_world("lfhh-2d", seed, 6, 6);
        for options in &readings {
            for cost in [Cost::Lfhh, Cost::Afhh] {
                feasible += usize::from(certify(&world, cost, options, &settings));
            }
        }
        // A current that is more than vortices takes another way through the code.
        let mut scenario = world.scenario().clone();
        scenario.currents.push(Current::Uniform(auv_world::scenario::Uniform { velocity_mps: [0.2, -0.1] }));
        world = World::new(scenario, seed, 0).unwrap();
        for cost in [Cost::Lfhh, Cost::Time] {
            feasible += usize::from(certify(&world, cost, &CostOptions::default(), &settings));
        }
    }
    assert!(feasible > 18, "{feasible}");
}

#[test]
fn a_current_that_beats_the_vehicle_is_not_taken() {
    let mut feasible = [0, 0];
    for seed in 0..6 {
        let mut scenario = small_world("lfhh-2d", seed, 6, 4).scenario().clone();
        let settings = Settings { lateral_m: 2.3e3, polish: false, ..Settings::default() };
        for (i, slower) in [1.0, 0.3].into_iter().enumerate() {
            scenario.vehicle.speed_mps *= slower;
            let world = World::new(scenario.clone(), seed, 0).unwrap();
            feasible[i] += usize::from(certify(&world, Cost::Time, &CostOptions::default(), &settings));
        }
    }
    assert!(feasible[0] > feasible[1], "{feasible:?}");
}

/// Sums over segments, found by themselves, are the terms of the whole path; so are the segments that collide.
#[test]
fn a_path_is_the_sum_of_its_segments() {
    let mut finite = 0;
    let mut random = Stream::new(3, Purpose::Planner, 0);
    let margin = CostOptions { margin_m: 200.0, ..CostOptions::default() };
    for world in [
        testing::paper_world("lfhh-2d-1", 0),
        testing::paper_world("lfhh-3d-1", 1),
        testing::mission_frame_world(),
        testing::other_solids_world(),
    ] {
        for (cost, options) in COSTS.into_iter().flat_map(|cost| [(cost, CostOptions::default()), (cost, margin)]) {
            let mut problem = problem(&world, cost, &options);
            let mut segments = problem.segments();
            let wide =
                Settings { lateral_m: 2e3, depth_m: 4e3, depth_reach_m: 2e4, lateral_reach_m: 2e4, polish: false };
            let lattice = Lattice::whole(&problem, wide.grain(&problem), f64::INFINITY);
            let paths: Vec<Vec<usize>> = (0..20)
                .map(|_| {
                    let mut node = random.below(lattice.nodes());
                    let path = (0..lattice.layers()).map(|layer| {
                        let [first, end] = lattice.span(layer);
                        let column = (node % lattice.columns + random.below(5)).saturating_sub(2).clamp(first, end - 1);
                        node = random.below(lattice.rows) * lattice.columns + column;
                        node
                    });
                    path.collect()
                })
                .collect();
            let [start, goal] = problem.ends();
            for path in &paths {
                let points = problem.path(&lattice.genes(&problem, path));
                let last = points.len() - 2;
                let blocked = points.windows(2).enumerate().filter(|(i, leg)| match *i {
                    0 => segments.blocks_first(leg[0], leg[1]),
                    i if i == last => segments.blocks_last(leg[0], leg[1]),
                    _ => segments.blocks(leg[0], leg[1]),
                });
                let blocked = blocked.count() as f64;
                let terms = problem.evaluate(&lattice.genes(&problem, path));
                let divisor = (last + 1) as f64 + if cost == Cost::Afhh { 1.0 } else { 0.0 };
                let expected = if blocked > 0.0 { blocked / divisor + 2.0 } else { 0.0 };
                assert_eq!(terms.block, expected);
            }
            let graph = Graph::new(&problem, &lattice, &mut segments, &Control::none()).unwrap();
            for path in &paths {
                let terms = problem.evaluate(&lattice.genes(&problem, path));
                let (weight, length) = graph.sums(path);
                if weight.is_infinite() {
                    assert!(!terms.feasible);
                    continue;
                }
                finite += 1;
                assert!((length - terms.path_length_m).abs() < 1e-6 * length);
                assert!((1.0 - distance(start, goal) / length - terms.length).abs() < 1e-6);
                match cost {
                    Cost::Lfhh => assert!((weight / (problem.inner() + 1) as f64 - terms.current).abs() < 1e-6),
                    Cost::Afhh => assert_eq!((weight, terms.smooth), (0.0, Some(0.0))),
                    Cost::Time | Cost::Energy => {
                        assert_eq!(terms.current, 0.0);
                        assert!((weight - terms.time_s.unwrap()).abs() < 1e-6 * weight);
                    }
                }
            }
        }
    }
    assert!(finite > 200, "{finite}");
}

#[test]
fn the_bound_is_a_bound_on_the_papers_worlds() {
    for name in ["lfhh-2d-1", "lfhh-3d-1"] {
        let world = testing::paper_world(name, 0);
        let options = CostOptions::default();
        let problem = problem(&world, Cost::Lfhh, &options);
        let coarse = Settings { lateral_m: 1e3, depth_m: 2e3, polish: false, ..Settings::default() };
        let Optimum { plan, bound } = solve(&problem, Cost::Lfhh, &options, &coarse);
        let bound = bound.unwrap();
        assert!(plan.feasible == bound.is_finite());
        assert!(!plan.feasible || (bound <= plan.cost.total + 1e-6 && bound > plan.cost.total - 1e-6), "{name}");
    }
}
