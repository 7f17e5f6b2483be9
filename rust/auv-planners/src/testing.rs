//! Worlds for tests.

use std::path::Path;

use auv_world::scenario::{Cylinder, Obstacle, Polygon, SectionFrame, Sections};
use auv_world::{Scenario, World};

pub fn paper_scenario(name: &str) -> Scenario {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../auvgym/scenarios").join(format!("{name}.toml"));
    Scenario::load(&path).unwrap()
}

pub fn paper_world(name: &str, mission: usize) -> World {
    World::new(paper_scenario(name), 0, mission).unwrap()
}

/// The first paper world with sections across the mission.
pub fn mission_frame_world() -> World {
    let mut scenario = paper_scenario("lfhh-3d-1");
    scenario.change = None;
    scenario.sections = Some(Sections {
        count: 30,
        frame: SectionFrame::Mission,
        spacing_m: None,
        half_width_m: Some(6e3),
        cell_m: 1e3,
    });
    World::new(scenario, 0, 0).unwrap()
}

/// The first 2-D paper world with a cylinder and a triangle added, on the way of mission 0.
pub fn other_solids_world() -> World {
    let mut scenario = paper_scenario("lfhh-2d-1");
    scenario.change = None;
    scenario.obstacles.push(Obstacle::Cylinder(Cylinder {
        position_m: [12e3, 5e3],
        radius_m: 1e3,
        top_m: -10.0,
        bottom_m: 10.0,
        velocity_mps: [0.0; 2],
    }));
    scenario.obstacles.push(Obstacle::Polygon(Polygon {
        vertices_m: vec![[8e3, 32e3], [12e3, 32e3], [10e3, 35e3]],
        top_m: -10.0,
        bottom_m: 10.0,
        velocity_mps: [0.0; 2],
    }));
    World::new(scenario, 0, 0).unwrap()
}

/// The first 2-D paper world with a wall right across it between start and goal.
pub fn walled_world() -> World {
    let mut scenario = paper_scenario("lfhh-2d-1");
    scenario.change = None;
    scenario.obstacles.push(Obstacle::Polygon(Polygon {
        vertices_m: vec![[-1e3, 20e3], [21e3, 20e3], [21e3, 21e3], [-1e3, 21e3]],
        top_m: -1.0,
        bottom_m: 1.0,
        velocity_mps: [0.0; 2],
    }));
    World::new(scenario, 0, 0).unwrap()
}
