//! The rates that the flow's defaults hold: no surface met in dense fields, no threat met under way.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use auv_planners::fluid::Flow;
use auv_planners::fluid::threats::Rules;
use auv_world::families::Manoeuvres;
use flights::Set;

#[path = "../examples/rates/fields.rs"]
mod fields;
#[path = "../examples/rates/flights.rs"]
mod flights;

type Failure = Box<dyn std::error::Error>;

#[test]
fn lines_through_400_fields_meet_nothing_and_arrive() {
    let worlds = fields::fields(400).unwrap();
    for seconds in [6.0, 30.0] {
        for world in &worlds {
            let line = fields::line(world, seconds, "", true).unwrap();
            let others = 1..=6;
            assert!(!line.met && line.arrived && others.contains(&line.lines), "field {} at {seconds} s", world.seed());
        }
    }
}

/// Flights of so many that arrived, and the least clearance of these (m).
fn flown(count: u64, set: Set) -> (usize, f64) {
    let flights = (0..count).map(|seed| flights::fly(seed, set, &Flow::default(), Rules::default()).unwrap());
    let good: Vec<f64> = flights.filter(|flight| flight.0 && flight.1 > 0.0).map(|flight| flight.1).collect();
    (good.len(), good.iter().copied().fold(f64::INFINITY, f64::min))
}

#[test]
fn the_default_rules_pass_200_threats_of_each_set() {
    for set in flights::STRAIGHT {
        let (good, least) = flown(200, set);
        assert!(good >= 199 && least > 50.0, "{}: {good}, {least}", set.name);
    }
}

/// Nothing tells the navigator that they will turn.
#[test]
fn threats_that_manoeuvre_are_passed_too() {
    for set in flights::STRAIGHT {
        let (good, _) = flown(60, Set { manoeuvres: Manoeuvres::Mixed, ..set });
        assert!(good == 60, "{}: {good}", set.name);
    }
}
