//! Legs flown side by side: four vehicles in the lanes of each number. What a tick does it does to all of them, and
//! to each, bit for bit, what it would do to one alone.

use auv_world::currents::VortexLanes;
use auv_world::lanes::LANES;
use auv_world::math::{Vec3, distance};
use wide::f64x4;

use super::Episode;
use crate::measures::Record;
use crate::vehicle::{HelmLanes, Row};

/// A leg to be flown.
#[derive(Debug)]
pub(crate) struct Leg<'a> {
    episode: &'a mut Episode,
    waypoint: Vec3,
    /// The waypoint does not end it before this time (s), ...
    shortest_s: f64,
    /// ... this time does.
    longest_s: f64,
}

impl<'a> Leg<'a> {
    /// Until the waypoint is captured, the leg has lasted its time, the map changes, or the end.
    pub fn towards(episode: &'a mut Episode, waypoint: Vec3) -> Self {
        episode.state.waypoint = Some(waypoint);
        let flight = &episode.world.scenario().episode;
        let (shortest_s, longest_s) = (flight.minimum_leg_s, flight.maximum_leg_s);
        Self { episode, waypoint, shortest_s, longest_s }
    }

    /// Keeping station `here` for so many ticks, until the map changes or the end.
    pub fn hold(episode: &'a mut Episode, here: Vec3, ticks: u64) -> Self {
        let longest_s = ticks as f64 * episode.world.scenario().episode.tick_s;
        Self { shortest_s: f64::INFINITY, longest_s, ..Self::towards(episode, here) }
    }

    fn length_m(&self) -> f64 {
        distance(self.episode.state.position, self.waypoint)
    }
}

/// Flies legs to their ends.
pub(crate) fn fly(legs: &mut [Leg<'_>]) {
    // The short ones last: they fill lanes that would wait for the others.
    legs.sort_unstable_by(|a, b| b.length_m().total_cmp(&a.length_m()));
    let mut waiting = legs.iter_mut();
    let mut fleet = Fleet::default();
    (0..LANES).for_each(|lane| fleet.launch(lane, waiting.next()));
    while fleet.flying != 0 {
        for lane in bits(fleet.tick()) {
            fleet.land(lane);
            fleet.launch(lane, waiting.next());
        }
    }
}

/// The lanes whose bits are set.
fn bits(mut set: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = (set != 0).then(|| set.trailing_zeros() as usize);
        set &= set.wrapping_sub(1);
        lane
    })
}

/// Three coordinates of each vehicle.
type Rows = [Row; 3];

fn put(rows: &mut Rows, lane: usize, place: Vec3) {
    rows.iter_mut().zip(place).for_each(|(row, value)| row[lane] = value);
}

fn get(rows: &Rows, lane: usize) -> Vec3 {
    rows.map(|row| row[lane])
}

fn columns(rows: &Rows) -> [f64x4; 3] {
    rows.map(f64x4::new)
}

/// The vehicles under way.
#[derive(Default)]
struct Fleet<'a, 'e> {
    legs: [Option<&'a mut Leg<'e>>; LANES],
    /// Lanes with a vehicle.
    flying: u32,
    /// Of them those whose worlds move, ...
    moving: u32,
    /// ... have currents other than vortices, ...
    other_currents: u32,
    /// ... or keep trails.
    recording: u32,
    vortices: VortexLanes,
    helms: HelmLanes,
    // As in `State`.
    position: Rows,
    heading: Rows,
    ticks: Row,
    time: Row,
    energy: Row,
    path_length: Row,
    since_change: Row,
    clearance_left: Row,
    min_clearance: Row,
    // What stays as it is through a leg.
    waypoint: Rows,
    goal: Rows,
    low: Rows,
    high: Rows,
    surface: Row,
    tick_s: Row,
    /// What the vehicle flies through the water and spends in a tick at full speed.
    stride: Row,
    spent: Row,
    /// How far obstacles come nearer in a tick, at most.
    approach: Row,
    goal_radius: Row,
    time_limit: Row,
    energy_limit: Row,
    change_every: Row,
    capture_radius: Row,
    /// Ticks at the start of the leg, and how long it takes.
    first: Row,
    shortest: Row,
    longest: Row,
}

impl<'a, 'e> Fleet<'a, 'e> {
    /// Begins a leg in a lane, or leaves it idle.
    fn launch(&mut self, lane: usize, leg: Option<&'a mut Leg<'e>>) {
        let bit = 1 << lane;
        for set in [&mut self.flying, &mut self.moving, &mut self.other_currents, &mut self.recording] {
            *set &= !bit;
        }
        let Some(leg) = leg else { return self.idle(lane) };
        let (episode, state) = (&*leg.episode, &leg.episode.state);
        let (world, scenario) = (&episode.world, episode.world.scenario());
        let (flight, tick_s, speed) = (&scenario.episode, scenario.episode.tick_s, scenario.vehicle.speed_mps);
        self.flying |= bit;
        self.moving |= bit * u32::from(!world.is_steady());
        self.other_currents |= bit * u32::from(!world.only_vortices());
        self.recording |= bit * u32::from(episode.record == Record::Everything);
        self.vortices.put(lane, world.vortices());
        self.helms.put(lane, &episode.helm);
        put(&mut self.position, lane, state.position);
        put(&mut self.heading, lane, state.heading);
        put(&mut self.waypoint, lane, leg.waypoint);
        put(&mut self.goal, lane, world.mission().goal_m);
        put(&mut self.low, lane, episode.bounds[0]);
        put(&mut self.high, lane, episode.bounds[1]);
        let ticks = state.ticks as f64;
        for (row, value) in [
            (&mut self.ticks, ticks),
            (&mut self.time, state.time_s),
            (&mut self.energy, state.energy_j),
            (&mut self.path_length, state.path_length_m),
            (&mut self.since_change, state.since_change_m),
            (&mut self.clearance_left, state.clearance_left_m),
            (&mut self.min_clearance, state.min_clearance_m),
            (&mut self.surface, scenario.domain.min_m[2]),
            (&mut self.tick_s, tick_s),
            (&mut self.stride, speed * tick_s),
            (&mut self.spent, scenario.vehicle.power_w(speed) * tick_s),
            (&mut self.approach, world.fastest_obstacle_mps() * tick_s),
            (&mut self.goal_radius, scenario.limits.goal_radius_m),
            (&mut self.time_limit, episode.limits.time_s),
            (&mut self.energy_limit, episode.limits.energy_j),
            (&mut self.change_every, if world.can_change() { episode.change_every_m() } else { f64::INFINITY }),
            (&mut self.capture_radius, flight.capture_radius_m),
            (&mut self.first, ticks),
            (&mut self.shortest, leg.shortest_s),
            (&mut self.longest, leg.longest_s),
        ] {
            row[lane] = value;
        }
        self.legs[lane] = Some(leg);
    }

    /// Leaves a lane at rest in still water: numbers that are none would cost exponentials.
    fn idle(&mut self, lane: usize) {
        self.vortices.clear(lane);
        put(&mut self.position, lane, [0.0; 3]);
        put(&mut self.waypoint, lane, [1.0, 0.0, 0.0]);
        self.stride[lane] = 0.0;
    }

    /// One tick of all; gives the lanes whose leg ends with it.
    fn tick(&mut self) -> u32 {
        let row = f64x4::new;
        let norm = |v: [f64x4; 3]| (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
        let apart = |a: [f64x4; 3], b: [f64x4; 3]| norm([a[0] - b[0], a[1] - b[1], a[2] - b[2]]);

        let (from, tick_s) = (columns(&self.position), row(self.tick_s));
        let current = self.current();
        let waypoint = columns(&self.waypoint);
        let (mut heading, usual) = self.helms.steer(from, columns(&self.heading), waypoint, current);
        let (mut stride, mut spent) = (row(self.stride), row(self.spent));
        let unusual = self.flying & !usual;
        if unusual != 0 {
            self.steer_alone(unusual, current, &mut heading, &mut stride, &mut spent);
        }
        let mut to: [f64x4; 3] = std::array::from_fn(|axis| from[axis] + stride * heading[axis]);
        to[0] += current[0] * tick_s;
        to[1] += current[1] * tick_s;
        // The surface is no obstacle: a vehicle just cannot rise above it.
        to[2] = to[2].fast_max(row(self.surface).fast_min(from[2]));

        let travelled = apart(from, to);
        let ticks = row(self.ticks) + f64x4::ONE;
        let time = ticks * tick_s;
        let energy = row(self.energy) + spent;
        let since_change = row(self.since_change) + travelled;
        self.position = to.map(f64x4::to_array);
        self.heading = heading.map(f64x4::to_array);
        self.ticks = ticks.to_array();
        self.time = time.to_array();
        self.energy = energy.to_array();
        self.path_length = (row(self.path_length) + travelled).to_array();
        self.since_change = since_change.to_array();
        // No clearance shrinks faster than vehicle and obstacles approach each other: as long as it cannot
        // have become the least so far, it need not be measured.
        let left = row(self.clearance_left) - (travelled + row(self.approach));
        self.clearance_left = left.to_array();
        if self.moving | self.recording != 0 {
            self.keep_up();
        }
        for lane in bits(self.flying & left.simd_le(row(self.min_clearance)).to_bitmask()) {
            self.measure(lane);
        }

        let [outside_x, outside_y, outside_z]: [f64x4; 3] =
            std::array::from_fn(|axis| to[axis].simd_lt(row(self.low[axis])) | to[axis].simd_gt(row(self.high[axis])));
        let elapsed = (ticks - row(self.first)) * tick_s;
        let captured = elapsed.simd_ge(row(self.shortest)) & apart(to, waypoint).simd_le(row(self.capture_radius));
        let ends = row(self.min_clearance).simd_le(f64x4::ZERO)
            | (outside_x | outside_y | outside_z)
            | apart(to, columns(&self.goal)).simd_le(row(self.goal_radius))
            | energy.simd_ge(row(self.energy_limit))
            | time.simd_ge(row(self.time_limit))
            | since_change.simd_ge(row(self.change_every))
            | elapsed.simd_ge(row(self.longest))
            | captured;
        self.flying & ends.to_bitmask()
    }

    /// The currents at the vehicles (m/s).
    #[inline(always)]
    fn current(&self) -> [f64x4; 2] {
        // Zero added, as by `World::current`.
        let mut current = self.vortices.velocity(self.position[0], self.position[1]).map(|v| f64x4::ZERO + v);
        if self.other_currents != 0 {
            let mut rows = current.map(f64x4::to_array);
            for lane in bits(self.other_currents) {
                if let Some(leg) = &self.legs[lane] {
                    let flowing = leg.episode.world.flowing(rows.map(|row| row[lane]), get(&self.position, lane));
                    (rows[0][lane], rows[1][lane]) = (flowing[0], flowing[1]);
                }
            }
            current = rows.map(f64x4::new);
        }
        current
    }

    /// Steers those one by one whose helm does more than to head for the waypoint at full speed.
    #[inline(never)]
    fn steer_alone(
        &self,
        lanes: u32,
        current: [f64x4; 2],
        heading: &mut [f64x4; 3],
        stride: &mut f64x4,
        spent: &mut f64x4,
    ) {
        let current = current.map(f64x4::to_array);
        let mut headings = heading.map(f64x4::to_array);
        let (mut strides, mut costs) = (stride.to_array(), spent.to_array());
        for lane in bits(lanes) {
            let Some(leg) = &self.legs[lane] else { continue };
            let (position, had) = (get(&self.position, lane), get(&self.heading, lane));
            let flow = current.map(|row| row[lane]);
            let order = leg.episode.helm.steer(position, had, leg.waypoint, flow);
            put(&mut headings, lane, order.heading);
            strides[lane] = order.speed * self.tick_s[lane];
            costs[lane] = leg.episode.world.scenario().vehicle.power_w(order.speed) * self.tick_s[lane];
        }
        (*heading, *stride, *spent) = (headings.map(f64x4::new), f64x4::new(strides), f64x4::new(costs));
    }

    /// Moves worlds that move, and keeps trails.
    fn keep_up(&mut self) {
        for lane in bits(self.moving | self.recording) {
            let Some(leg) = &mut self.legs[lane] else { continue };
            if self.recording >> lane & 1 == 1 {
                leg.episode.state.trail.push(get(&self.position, lane));
            }
            if self.moving >> lane & 1 == 1 {
                leg.episode.world.set_time(self.time[lane]);
                self.vortices.put(lane, leg.episode.world.vortices());
            }
        }
    }

    fn measure(&mut self, lane: usize) {
        if let Some(leg) = &mut self.legs[lane] {
            let (position, least) = (get(&self.position, lane), self.min_clearance[lane]);
            let clearance = leg.episode.clearance_at(position, least);
            (self.clearance_left[lane], self.min_clearance[lane]) = (clearance, least.min(clearance));
        }
    }

    /// Gives a vehicle back to its episode, which judges how the leg has ended.
    fn land(&mut self, lane: usize) {
        let Some(leg) = &mut self.legs[lane] else { return };
        let state = &mut leg.episode.state;
        state.position = get(&self.position, lane);
        state.heading = get(&self.heading, lane);
        state.ticks = self.ticks[lane] as u64;
        state.time_s = self.time[lane];
        state.energy_j = self.energy[lane];
        state.path_length_m = self.path_length[lane];
        state.since_change_m = self.since_change[lane];
        state.clearance_left_m = self.clearance_left[lane];
        state.min_clearance_m = self.min_clearance[lane];
        leg.episode.world.set_time(self.time[lane]);
        leg.episode.judge();
    }
}
