//! Map changes: obstacles and vortices that are put elsewhere.

use std::sync::Arc;

use super::{ChangeEvent, World};
use crate::currents::scale_to_peak;
use crate::math::{Vec2, Vec3, distance};
use crate::motion::Body;
use crate::rng::{Purpose, Stream};
use crate::scenario::{Change, Hold, Redraw};

impl World {
    /// Whether another map change will change anything.
    pub fn can_change(&self) -> bool {
        match &self.fixed.scenario.change {
            None => false,
            Some(Change::Table(table)) => self.changes.len() < table.phases.len(),
            Some(Change::Redraw(_)) => true,
        }
    }

    /// Changes the map, as when a vehicle at `vehicle_m` has travelled the change distance. Says whether
    /// anything was left to change.
    pub fn apply_change(&mut self, vehicle_m: Vec3) -> bool {
        if !self.can_change() {
            return false;
        }
        let fixed = Arc::clone(&self.fixed);
        match &fixed.scenario.change {
            Some(Change::Table(table)) => {
                let phase = &table.phases[self.changes.len()];
                self.move_obstacles(vehicle_m, &phase.obstacles_m);
                for (eddy, centre) in self.eddies.iter_mut().zip(&phase.vortices_m) {
                    eddy.base = [centre[0], centre[1], 0.0];
                }
            }
            Some(Change::Redraw(redraw)) => self.redraw(redraw, vehicle_m),
            None => {}
        }
        self.changes.push(ChangeEvent { time_s: self.time_s, vehicle_m });
        self.refresh();
        true
    }

    /// Puts each obstacle at its target, unless that is too near.
    fn move_obstacles(&mut self, vehicle_m: Vec3, targets: &[Vec3]) {
        let fixed = Arc::clone(&self.fixed);
        let (margin, hold) = fixed.scenario.change.as_ref().map_or((0.0, Hold::All), Change::hold);
        let mission = &fixed.scenario.missions[self.mission];
        let protected = [vehicle_m, mission.start_m, mission.goal_m];
        let protected = match hold {
            Hold::All => &protected[..],
            Hold::Vehicle => &protected[..1],
        };
        for (i, &new) in targets.iter().enumerate() {
            let (flat, room) = (self.is_flat(i), fixed.extents[i] + margin);
            let near = |point: &Vec3| {
                let point = if flat { [point[0], point[1], new[2]] } else { *point };
                distance(new, point) < room
            };
            self.bodies[i].base = if protected.iter().any(near) { self.obstacle_position(i) } else { new };
        }
    }

    fn redraw(&mut self, redraw: &Redraw, vehicle_m: Vec3) {
        let fixed = Arc::clone(&self.fixed);
        let domain = &fixed.scenario.domain;
        let mut stream = Stream::new(self.seed, Purpose::Change, self.changes.len() as u32 + 1);
        let axes = usize::from(fixed.scenario.dimensions);
        let mut places: Vec<Vec3> = (0..self.bodies.len()).map(|i| self.obstacle_position(i)).collect();
        let free = |i: usize| if self.is_flat(i) { 2 } else { axes };
        let mut moved = Vec::with_capacity(axes * places.len());
        places.iter().enumerate().for_each(|(i, place)| moved.extend_from_slice(&place[..free(i)]));
        stream.disturb(&mut moved, redraw.obstacle_step_m);
        let mut moved = moved.into_iter();
        for (i, place) in places.iter_mut().enumerate() {
            for (axis, value) in moved.by_ref().take(free(i)).enumerate() {
                place[axis] = value.clamp(domain.min_m[axis], domain.max_m[axis]);
            }
        }
        self.move_obstacles(vehicle_m, &places);
        if let Some(draw) = &redraw.vortices {
            let place = |eddy: &mut Body, centre: Vec2| eddy.base = [centre[0], centre[1], 0.0];
            let (low, high) = (domain.min_m, domain.max_m);
            for (i, eddy) in self.eddies.iter_mut().enumerate() {
                let (centre, sign) = draw.sample(&mut stream, [low[0], low[1]], [high[0], high[1]]);
                place(eddy, centre);
                self.vortices.place(i, centre);
                self.vortices.spin(i, sign * self.vortices.circulation(i).abs());
            }
            if let Some(peak) = draw.peak_speed_mps {
                scale_to_peak(&mut self.vortices, peak);
            }
        }
    }
}
