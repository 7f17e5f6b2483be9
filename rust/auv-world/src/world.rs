//! A world: one scenario at one time, after the map changes so far.
//!
//! It is a pure function of scenario, seed and the changes so far (each a time and the vehicle's place),
//! so it can be copied, saved as those few numbers, and made again.

use std::sync::Arc;

use crate::currents::{GriddedField, VortexField, jet_velocity};
use crate::error::WorldError;
use crate::lanes::LANES;
use crate::math::{Vec2, Vec3, norm};
use crate::motion::Body;
use crate::obstacles::{Discs, Solid, Solids, Spheres, polygon::Prism};
use crate::scenario::{Current, Jet, Manoeuvre, Mission, Obstacle, Scenario, Seabed};
use crate::seabed::Floor;
use serde::{Deserialize, Serialize};

mod change;
mod clearance;
mod sonar;

pub use clearance::Neighbour;
pub use sonar::Scratch;

/// A map change that has happened.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ChangeEvent {
    /// When (s).
    pub time_s: f64,
    /// Where the vehicle was (m).
    pub vehicle_m: Vec3,
}

/// What never changes in a world: shared by its copies.
#[derive(Debug)]
struct Fixed {
    scenario: Scenario,
    floor: Floor,
    gridded: Vec<GriddedField>,
    jets: Vec<Jet>,
    uniform: Vec2,
    steady: bool,
    extents: Vec<f64>,
    /// Which obstacles the spheres, discs and other solids are.
    numbers: [Vec<u32>; 3],
    fastest_obstacle: f64,
    /// Whether the clearance of each solid is its distance.
    exact_solids: bool,
}

/// Where an obstacle is kept.
#[derive(Debug, Clone, Copy)]
enum Slot {
    Sphere(usize),
    Disc(usize),
    Solid(usize),
}

/// One scenario at one time.
#[derive(Debug, Clone)]
pub struct World {
    fixed: Arc<Fixed>,
    seed: u64,
    mission: usize,
    changes: Vec<ChangeEvent>,
    time_s: f64,
    bodies: Vec<Body>,
    slots: Vec<Slot>,
    eddies: Vec<Body>,
    spheres: Spheres,
    discs: Discs,
    solids: Solids,
    /// Circles on the map round the other solids.
    hulls: Discs,
    vortices: VortexField,
}

impl World {
    /// A world at time 0. `mission` chooses among the scenario's start/goal pairs.
    ///
    /// # Errors
    /// [`WorldError`] if the scenario is not allowed or has no such mission.
    pub fn new(scenario: Scenario, seed: u64, mission: usize) -> Result<Self, WorldError> {
        scenario.check_numbers()?;
        let count = scenario.missions.len();
        if mission >= count {
            let allowed = format!("the scenario has missions 0 .. {}", count - 1);
            return Err(WorldError::parameter("mission", mission, allowed));
        }
        let world = Self { seed, mission, ..Self::unchecked(scenario) };
        world.scenario().check_clear(&world)?;
        Ok(world)
    }

    /// A world made again from its scenario, seed, mission, changes and time.
    ///
    /// # Errors
    /// As [`World::new`].
    pub fn restore(
        scenario: Scenario,
        seed: u64,
        mission: usize,
        changes: &[ChangeEvent],
        time_s: f64,
    ) -> Result<Self, WorldError> {
        let mut world = Self::new(scenario, seed, mission)?;
        for change in changes {
            world.set_time(change.time_s);
            world.apply_change(change.vehicle_m);
        }
        world.set_time(time_s);
        Ok(world)
    }

    /// A world of a scenario that is known to be allowed.
    pub(crate) fn trusted(scenario: Scenario, seed: u64) -> Self {
        Self { seed, ..Self::unchecked(scenario) }
    }

    /// A world at time 0 of a scenario whose numbers are known to be good.
    fn unchecked(scenario: Scenario) -> Self {
        let low = [scenario.domain.min_m[0], scenario.domain.min_m[1]].map(|v| v - scenario.domain.margin_m);
        let high = [scenario.domain.max_m[0], scenario.domain.max_m[1]].map(|v| v + scenario.domain.margin_m);
        let projection = scenario.projection.as_ref();
        let floor = match &scenario.seabed {
            None if scenario.dimensions == 3 => Floor::Flat(scenario.domain.max_m[2]),
            None => Floor::None,
            Some(Seabed::Flat(flat)) => Floor::Flat(flat.depth_m),
            Some(Seabed::Peaks(peaks)) => Floor::Peaks(crate::seabed::PeakFloor::new(peaks)),
            Some(Seabed::Gridded(grid)) => {
                Floor::Gridded(crate::seabed::GridFloor::new(grid, projection, (low, high), scenario.dimensions == 2))
            }
        };
        let (mut gridded, mut jets, mut uniform) = (Vec::new(), Vec::new(), [0.0, 0.0]);
        let (mut vortices, mut eddies) = (VortexField::default(), Vec::new());
        for current in &scenario.currents {
            match current {
                Current::Uniform(current) => {
                    uniform = [uniform[0] + current.velocity_mps[0], uniform[1] + current.velocity_mps[1]];
                }
                Current::Jet(jet) => jets.push(jet.clone()),
                Current::Gridded(grid) => gridded.push(GriddedField::new(grid, projection, (low, high))),
                Current::Vortices(group) => {
                    for vortex in &group.vortices {
                        vortices.push([vortex.x_m, vortex.y_m], vortex.circulation_m2ps, group.core_radius_m);
                        eddies.push(Body {
                            base: [vortex.x_m, vortex.y_m, 0.0],
                            velocity: [vortex.drift_mps[0], vortex.drift_mps[1], 0.0],
                        });
                    }
                }
            }
        }
        let balls = scenario.obstacles.iter().filter(|obstacle| matches!(obstacle, Obstacle::Sphere(_))).count();
        let (mut spheres, mut discs, mut solids) = (Spheres::with_room(balls), Discs::default(), Solids::default());
        let mut slots = Vec::with_capacity(scenario.obstacles.len());
        let mut bodies = Vec::with_capacity(scenario.obstacles.len());
        for obstacle in &scenario.obstacles {
            bodies.push(Body { base: obstacle.position_m(), velocity: obstacle.velocity_mps() });
            slots.push(match obstacle {
                Obstacle::Sphere(sphere) => {
                    spheres.push(sphere.position_m, sphere.radius_m);
                    Slot::Sphere(spheres.len() - 1)
                }
                Obstacle::Disc(disc) => {
                    discs.push(disc.position_m, disc.radius_m);
                    Slot::Disc(discs.len() - 1)
                }
                Obstacle::Cylinder(shape) => {
                    solids.push(Solid::Cylinder(shape.clone()));
                    Slot::Solid(solids.shapes().len() - 1)
                }
                Obstacle::Superquadric(shape) => {
                    solids.push(Solid::Superquadric(shape.clone()));
                    Slot::Solid(solids.shapes().len() - 1)
                }
                Obstacle::Polygon(shape) => {
                    solids.push(Solid::Polygon(Prism::new(shape)));
                    Slot::Solid(solids.shapes().len() - 1)
                }
            });
        }
        spheres.arrange();
        let steady = gridded.iter().all(GriddedField::is_steady)
            && jets.iter().all(|jet| jet.time_scale_s.is_none())
            && bodies.iter().chain(&eddies).all(|body| body.velocity == [0.0; 3])
            && scenario.obstacles.iter().all(|obstacle| obstacle.manoeuvre().is_none());
        let mut numbers: [Vec<u32>; 3] = Default::default();
        for (number, slot) in slots.iter().enumerate() {
            let kind = match slot {
                Slot::Sphere(_) => 0,
                Slot::Disc(_) => 1,
                Slot::Solid(_) => 2,
            };
            numbers[kind].push(number as u32);
        }
        let extents: Vec<f64> = scenario.obstacles.iter().map(Obstacle::extent_m).collect();
        let mut hulls = Discs::default();
        for i in numbers[2].iter().map(|number| *number as usize) {
            hulls.push([bodies[i].base[0], bodies[i].base[1]], extents[i]);
        }
        let fastest_obstacle = bodies.iter().map(|body| norm(body.velocity)).fold(0.0, f64::max);
        let manoeuvres = scenario.obstacles.iter().filter_map(Obstacle::manoeuvre);
        let fastest_obstacle = manoeuvres.map(Manoeuvre::fastest_mps).fold(fastest_obstacle, f64::max);
        let exact_solids = solids.shapes().iter().all(|shape| !matches!(shape, Solid::Superquadric(_)));
        let fixed = Arc::new(Fixed {
            scenario,
            floor,
            gridded,
            jets,
            uniform,
            steady,
            extents,
            numbers,
            fastest_obstacle,
            exact_solids,
        });
        Self {
            fixed,
            seed: 0,
            mission: 0,
            changes: Vec::new(),
            time_s: 0.0,
            bodies,
            slots,
            eddies,
            spheres,
            discs,
            solids,
            hulls,
            vortices,
        }
    }

    /// The same world at time 0 before any change, for another seed: nothing is made again.
    pub fn fresh(&self, seed: u64) -> Self {
        let mut world = self.clone();
        if !self.changes.is_empty() {
            // A change moves bases and spins: only the scenario still knows them.
            world = Self { mission: self.mission, ..Self::unchecked(self.fixed.scenario.clone()) };
        }
        world.seed = seed;
        world.set_time(0.0);
        world
    }

    /// Its scenario.
    pub fn scenario(&self) -> &Scenario {
        &self.fixed.scenario
    }

    /// Its seed.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Which of the scenario's missions it is for.
    pub fn mission_index(&self) -> usize {
        self.mission
    }

    /// Start and goal.
    pub fn mission(&self) -> &Mission {
        &self.fixed.scenario.missions[self.mission]
    }

    /// The changes so far.
    pub fn changes(&self) -> &[ChangeEvent] {
        &self.changes
    }

    /// The present time (s).
    pub fn time_s(&self) -> f64 {
        self.time_s
    }

    /// Whether currents and obstacles stay as they are between map changes.
    pub fn is_steady(&self) -> bool {
        self.fixed.steady
    }

    /// The sea floor.
    pub fn floor(&self) -> &Floor {
        &self.fixed.floor
    }

    /// Spheres at the present time.
    pub fn spheres(&self) -> &Spheres {
        &self.spheres
    }

    /// Discs at the present time.
    pub fn discs(&self) -> &Discs {
        &self.discs
    }

    /// Cylinders, superquadrics and polygons at the present time.
    pub fn solids(&self) -> &[Solid] {
        self.solids.shapes()
    }

    /// Whether there are obstacles other than spheres and discs.
    pub fn has_other_solids(&self) -> bool {
        !self.solids.shapes().is_empty()
    }

    /// Vortices at the present time.
    pub fn vortices(&self) -> &VortexField {
        &self.vortices
    }

    /// Whether vortices are all the current there is.
    pub fn only_vortices(&self) -> bool {
        self.fixed.gridded.is_empty() && self.fixed.jets.is_empty() && self.fixed.uniform == [0.0, 0.0]
    }

    /// Whether currents are the same at all depths.
    pub fn has_level_currents(&self) -> bool {
        self.fixed.gridded.iter().all(GriddedField::is_level)
    }

    /// Position (m) of obstacle `i` at the present time.
    #[inline]
    pub fn obstacle_position(&self, i: usize) -> Vec3 {
        if self.fixed.fastest_obstacle == 0.0 { self.bodies[i].base } else { self.place_obstacle(i) }
    }

    /// Velocity (m/s) of obstacle `i` at the present time, turned about by the walls it has met.
    pub fn obstacle_velocity(&self, i: usize) -> Vec3 {
        if self.fixed.fastest_obstacle == 0.0 {
            return [0.0; 3];
        }
        let manoeuvre = self.fixed.scenario.obstacles[i].manoeuvre();
        self.bodies[i].velocity(manoeuvre, self.times(), &self.fixed.scenario.domain)
    }

    /// Whether obstacle `i` reaches through all depths, so that only the distance on the map counts.
    fn is_flat(&self, i: usize) -> bool {
        self.fixed.scenario.obstacles[i].is_flat()
    }

    /// Radius (m) of a ball or circle that holds each obstacle.
    pub fn extents(&self) -> &[f64] {
        &self.fixed.extents
    }

    /// Speed of the fastest obstacle (m/s).
    pub fn fastest_obstacle_mps(&self) -> f64 {
        self.fixed.fastest_obstacle
    }

    /// Moves everything to `time_s` (s). Between map changes this may go forwards and backwards.
    pub fn set_time(&mut self, time_s: f64) {
        if time_s == self.time_s {
            return;
        }
        self.time_s = time_s;
        if !self.fixed.steady {
            self.refresh();
        }
    }

    /// When everything last was put somewhere, and the present (s).
    fn times(&self) -> [f64; 2] {
        [self.changes.last().map_or(0.0, |change| change.time_s), self.time_s]
    }

    fn place_obstacle(&self, i: usize) -> Vec3 {
        let manoeuvre = self.fixed.scenario.obstacles[i].manoeuvre();
        self.bodies[i].place(manoeuvre, self.times(), &self.fixed.scenario.domain)
    }

    /// Puts everything that moves where it belongs now.
    fn refresh(&mut self) {
        for i in 0..self.bodies.len() {
            let position = self.obstacle_position(i);
            match self.slots[i] {
                Slot::Sphere(slot) => self.spheres.place(slot, position),
                Slot::Disc(slot) => self.discs.place(slot, [position[0], position[1]]),
                Slot::Solid(slot) => {
                    self.solids.place(slot, position);
                    self.hulls.place(slot, [position[0], position[1]]);
                }
            }
        }
        self.spheres.arrange();
        for i in 0..self.eddies.len() {
            let position = self.eddies[i].place(None, self.times(), &self.fixed.scenario.domain);
            self.vortices.place(i, [position[0], position[1]]);
        }
    }

    /// Velocity of the water (m/s, horizontal) at a point (m) at the present time.
    #[inline]
    pub fn current(&self, point: Vec3) -> Vec2 {
        self.flowing(self.vortices.velocity(point[0], point[1]), point)
    }

    /// The same at four points.
    pub fn currents(&self, points: [Vec3; LANES]) -> [Vec2; LANES] {
        let [u, v] = self.vortices.velocities(points.map(|point| point[0]), points.map(|point| point[1]));
        std::array::from_fn(|i| self.flowing([u[i], v[i]], points[i]))
    }

    /// The same where the velocity of the vortices (m/s) is known.
    #[inline]
    pub fn flowing(&self, vortices: Vec2, point: Vec3) -> Vec2 {
        let mut sum = [self.fixed.uniform[0] + vortices[0], self.fixed.uniform[1] + vortices[1]];
        for jet in &self.fixed.jets {
            let velocity = jet_velocity(jet, point[0], point[1], self.time_s);
            sum = [sum[0] + velocity[0], sum[1] + velocity[1]];
        }
        for grid in &self.fixed.gridded {
            let velocity = grid.velocity(point, self.time_s);
            sum = [sum[0] + velocity[0], sum[1] + velocity[1]];
        }
        sum
    }

    /// Depth of the sea floor (m) at (x, y); infinite where there is none.
    pub fn floor_depth(&self, x: f64, y: f64) -> f64 {
        self.fixed.floor.depth(x, y)
    }
}
