//! The space that is sampled: the box and what is free in it, and what a straight motion costs.

use auv_world::World;
use auv_world::kinematics::travel_time;
use auv_world::math::{Vec3, add_scaled, distance, sub};
use auv_world::rng::Stream;

use super::Objective;

/// A sample is drawn at most so often; if no place is free, the last one is taken and fails as a motion.
const DRAWS: usize = 100;
/// A motion that more balls of free water than this do not cover grazes something, and counts as blocked.
const MOST_BALLS: usize = 1000;
/// Start and goal need only this part of the clearance that they have.
const OWN_CLEARANCE: f64 = 0.9;
/// Currents are asked for this often along the longest edge of the box ...
const PIECES: f64 = 160.0;
/// ... but along no motion more often than this.
const MOST_PIECES: f64 = 64.0;

/// A point, and what is known of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Where (m).
    pub point: Vec3,
    /// How far from solids (m).
    pub clearance: f64,
    /// How far motions from and to it must keep from them (m).
    pub required: f64,
}

/// The box of a world as it is now.
pub struct Space<'a> {
    world: &'a World,
    objective: Objective,
    margin: f64,
    low: Vec3,
    high: Vec3,
    longest: f64,
    speed: f64,
}

impl<'a> Space<'a> {
    /// The space of a world, to be crossed at least `margin` metres from solids.
    pub fn new(world: &'a World, objective: Objective, margin: f64) -> Self {
        let (low, high) = (world.scenario().domain.min_m, world.scenario().domain.max_m);
        let longest = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
        Self { world, objective, margin, low, high, longest, speed: world.scenario().vehicle.speed_mps }
    }

    /// What is minimised.
    pub fn objective(&self) -> Objective {
        self.objective
    }

    /// 2 or 3.
    pub fn dimensions(&self) -> usize {
        usize::from(self.world.scenario().dimensions)
    }

    /// The longest edge of the box (m).
    pub fn longest_edge(&self) -> f64 {
        self.longest
    }

    /// Radius (m) of a ball (2-D: a disc) that has this share of the box's volume.
    pub fn radius_of(&self, share: f64) -> f64 {
        use std::f64::consts::PI;
        let edges = || (0..self.dimensions()).map(|axis| self.high[axis] - self.low[axis]);
        let volume = share * edges().product::<f64>();
        if self.dimensions() == 2 { (volume / PI).sqrt() } else { libm::cbrt(volume / (4.0 / 3.0 * PI)) }
    }

    /// A place on the way.
    pub fn place(&self, point: Vec3) -> Place {
        Place { point, clearance: self.world.clearance(point), required: self.margin }
    }

    /// Start or goal: its motions need no more clearance than it can have.
    pub fn end(&self, point: Vec3) -> Place {
        let clearance = self.world.clearance(point);
        Place { point, clearance, required: self.margin.min(OWN_CLEARANCE * clearance).max(0.0) }
    }

    /// A place drawn uniformly from what is free.
    pub fn draw(&self, stream: &mut Stream) -> Place {
        let mut draw = || {
            let mut point = self.low;
            for (axis, value) in point.iter_mut().enumerate().take(self.dimensions()) {
                *value = stream.uniform(self.low[axis], self.high[axis]);
            }
            self.place(point)
        };
        let mut place = draw();
        for _ in 1..DRAWS {
            if place.clearance > place.required {
                break;
            }
            place = draw();
        }
        place
    }

    /// The place no farther than `step` from one towards another, inside the box.
    pub fn steer(&self, from: &Place, to: &Place, step: f64) -> Place {
        let length = distance(from.point, to.point);
        if length <= step {
            return *to;
        }
        let point = add_scaled(from.point, step / length, sub(to.point, from.point));
        // Start and goal may lie in the margin round the box.
        self.place(std::array::from_fn(|axis| point[axis].clamp(self.low[axis], self.high[axis])))
    }

    /// What a motion costs: metres or seconds; infinite where the current beats the vehicle.
    pub fn measure(&self, from: &Place, to: &Place) -> f64 {
        let length = distance(from.point, to.point);
        match self.objective {
            Objective::Length => length,
            Objective::Time => {
                let pieces = (length / self.longest * PIECES).ceil().clamp(1.0, MOST_PIECES) as usize;
                travel_time(self.world, from.point, to.point, self.speed, pieces)
            }
        }
    }

    /// Whether balls of free water cover the straight way, walking from ball to ball. The clearance of a world
    /// is never too large, so that this certifies the motion.
    pub fn is_free(&self, from: &Place, to: &Place) -> bool {
        let required = from.required.min(to.required);
        let (at_from, at_to) = (from.clearance - required, to.clearance - required);
        // Written so that NaN fails.
        if !(at_from > 0.0 && at_to > 0.0) {
            return false;
        }
        let way = sub(to.point, from.point);
        let length = distance(from.point, to.point);
        let mut walked = at_from;
        for _ in 0..MOST_BALLS {
            if walked + at_to >= length {
                return true;
            }
            let free = self.world.clearance(add_scaled(from.point, walked / length, way)) - required;
            if free <= 0.0 {
                return false;
            }
            walked += free;
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use auv_world::rng::Purpose;

    #[test]
    fn free_motions_are_free_everywhere() {
        for world in [testing::paper_world("lfhh-3d-1", 0), testing::other_solids_world()] {
            let space = Space::new(&world, Objective::Length, 120.0);
            let mut stream = Stream::new(3, Purpose::Planner, 0);
            let (mut free, mut blocked) = (0, 0);
            for _ in 0..500 {
                let (a, b) = (space.draw(&mut stream), space.draw(&mut stream));
                let b = space.steer(&a, &b, 8e3);
                let at = |i: i32| add_scaled(a.point, f64::from(i) / 500.0, sub(b.point, a.point));
                let least = (0..=500).map(|i| world.clearance(at(i))).fold(f64::INFINITY, f64::min);
                if space.is_free(&a, &b) {
                    free += 1;
                    assert!(least >= 120.0 - 1e-6, "{least}");
                } else {
                    blocked += 1;
                    // The clearance of these worlds is exact or little too small.
                    assert!(least < 200.0, "{least}");
                }
            }
            assert!(free > 50 && blocked > 50, "{free} {blocked}");
        }
    }

    #[test]
    fn start_and_goal_need_only_what_they_have() {
        let world = testing::other_solids_world();
        // The cylinder at (12, 5) km has a radius of 1 km.
        let space = Space::new(&world, Objective::Length, 300.0);
        let (near, far) = ([12e3, 6.1e3, 0.0], [12e3, 6.4e3, 0.0]);
        assert!((world.clearance(near) - 100.0).abs() < 1e-6);
        assert!(space.is_free(&space.end(near), &space.place(far)));
        assert!(!space.is_free(&space.place(near), &space.place(far)));
        let inside = space.end([12e3, 5.5e3, 0.0]);
        assert!(!space.is_free(&inside, &space.place(far)) && !space.is_free(&inside, &inside));
    }

    #[test]
    fn radii_and_measures() {
        let world = testing::paper_world("lfhh-2d-1", 0);
        let space = Space::new(&world, Objective::Time, 0.0);
        let radius = space.radius_of(0.1);
        assert!((std::f64::consts::PI * radius * radius / 80e6 - 1.0).abs() < 1e-12);
        let (a, b) = (space.place([1e3, 1e3, 0.0]), space.place([9e3, 1e3, 0.0]));
        // Two metres a second, and a current of less than one.
        assert!((8e3 / 3.0..8e3).contains(&space.measure(&a, &b)));
        assert!(space.measure(&a, &b) != space.measure(&b, &a));
        assert_eq!(space.steer(&a, &b, 500.0).point, [1.5e3, 1e3, 0.0]);
        assert_eq!(space.steer(&a, &b, 9e3), b);
    }
}
