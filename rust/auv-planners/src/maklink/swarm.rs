//! Particle swarms on a corridor (eq. 3-4): the inertia weight falls with time (eq. 12) or follows each
//! particle's cost (RMPSO, eq. 13).

use auv_world::rng::Stream;
use serde::Deserialize;

use super::fitness::{BLOCKED, Corridor};

/// The inertia weight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Inertia {
    /// From 0.9 down to 0.3, evenly.
    Linear,
    /// 0.3 over the number of the iteration, as eq. 12 is printed.
    Printed,
    /// 0.3 exp(0.03 (F - 100) + offset) for each particle, at most 0.9 (eq. 13).
    Reinforced,
}

/// What happens at the ends of links.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Bounds {
    /// Particles stop there. The weight follows their present cost.
    Clamp,
    /// Particles may go on, and pay 100 if their path is blocked (eq. 7-8). The weight follows their best cost.
    #[default]
    Penalty,
}

/// How the particles move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rules {
    /// The inertia weight.
    pub inertia: Inertia,
    /// Offset in the exponent of eq. 13.
    pub offset: f64,
    /// At the ends of links.
    pub bounds: Bounds,
    /// Greatest velocity, in units of position an iteration.
    pub v_max: f64,
    /// c1.
    pub cognitive: f64,
    /// c2.
    pub social: f64,
    /// T, the number of iterations over which a linear weight falls.
    pub iterations: u64,
}

/// Weights are never greater (eq. 13).
const HEAVIEST: f64 = 0.9;
/// The weight at F = 100 without offset, and the last of a linear one.
const LIGHT: f64 = 0.3;

/// Particles on their way. Arrays hold all particles' values on the first link, then on the second, and so on.
pub struct Swarm<'a> {
    corridor: &'a Corridor<'a>,
    rules: Rules,
    size: usize,
    positions: Vec<f64>,
    velocities: Vec<f64>,
    bests: Vec<f64>,
    best_costs: Vec<f64>,
    costs: Vec<f64>,
    weights: Vec<f64>,
    leader: Vec<f64>,
    leader_cost: f64,
    draws: Vec<f64>,
    last: [Vec<f64>; 2],
    iteration: u64,
}

impl<'a> Swarm<'a> {
    /// A swarm spread evenly over the links; the first `counted` of its particles are costed.
    pub fn new(corridor: &'a Corridor<'a>, rules: Rules, size: usize, counted: usize, random: &mut Stream) -> Self {
        let links = corridor.links();
        let mut positions = vec![0.0; links * size];
        for (link, positions) in positions.chunks_exact_mut(size).enumerate() {
            positions.iter_mut().for_each(|x| *x = random.uniform(0.0, corridor.high(link)));
        }
        let mut swarm = Self {
            corridor,
            rules,
            size,
            velocities: vec![0.0; positions.len()],
            bests: positions.clone(),
            best_costs: vec![f64::INFINITY; size],
            costs: vec![0.0; size],
            weights: vec![0.0; size],
            leader: vec![0.0; links],
            leader_cost: f64::INFINITY,
            draws: vec![0.0; 2 * size],
            last: [Vec::new(), Vec::new()],
            positions,
            iteration: 0,
        };
        swarm.judge(counted);
        swarm
    }

    /// The best cost so far.
    pub fn best_cost(&self) -> f64 {
        self.leader_cost
    }

    /// The best positions so far.
    pub fn best(&self) -> &[f64] {
        &self.leader
    }

    /// Moves all particles and costs the first `counted` of them.
    pub fn step(&mut self, counted: usize, random: &mut Stream) {
        self.weigh();
        let Rules { v_max, cognitive, social, bounds, .. } = self.rules;
        let n = self.size;
        for link in 0..self.corridor.links() {
            random.fill_half_units(&mut self.draws);
            let (r1, r2) = self.draws.split_at(n);
            let all = link * n..(link + 1) * n;
            let leader = self.leader[link];
            let high = if bounds == Bounds::Clamp { self.corridor.high(link) } else { f64::INFINITY };
            let low = if bounds == Bounds::Clamp { 0.0 } else { f64::NEG_INFINITY };
            let (x, v) = (&mut self.positions[all.clone()], &mut self.velocities[all.clone()]);
            let best = &self.bests[all];
            for i in 0..n {
                let pull = cognitive * r1[i] * (best[i] - x[i]) + social * r2[i] * (leader - x[i]);
                v[i] = (self.weights[i] * v[i] + pull).max(-v_max).min(v_max);
                x[i] = (x[i] + v[i]).max(low).min(high);
            }
        }
        self.iteration += 1;
        self.judge(counted);
    }

    /// Sets the weights for the next step.
    fn weigh(&mut self) {
        let t = self.iteration as f64;
        match self.rules.inertia {
            Inertia::Linear => {
                let last = self.rules.iterations.saturating_sub(1).max(1) as f64;
                self.weights.fill(HEAVIEST - (HEAVIEST - LIGHT) * (t / last).min(1.0));
            }
            Inertia::Printed => self.weights.fill(LIGHT / (t + 1.0)),
            Inertia::Reinforced => {
                let costs = if self.rules.bounds == Bounds::Clamp { &self.costs } else { &self.best_costs };
                for (weight, cost) in self.weights.iter_mut().zip(costs) {
                    let exponent = 0.03 * (cost - 100.0) + self.rules.offset;
                    *weight = (LIGHT * auv_world::math::exp(exponent.min(10.0))).min(HEAVIEST);
                }
            }
        }
    }

    /// Costs the first particles, and remembers what is best for each and for all.
    fn judge(&mut self, counted: usize) {
        let n = self.size;
        self.corridor.costs(&self.positions, n, &mut self.last, &mut self.costs[..counted]);
        if self.corridor.is_open() {
            for i in 0..counted {
                self.costs[i] += self.corridor.penalty(|link| self.positions[link * n + i]);
            }
        }
        for i in 0..counted {
            // A penalty makes no path better: only where a path would be the best is it looked at.
            if self.costs[i] >= self.best_costs[i] {
                continue;
            }
            if self.rules.bounds == Bounds::Penalty && !self.corridor.is_open() && self.is_blocked(i) {
                self.costs[i] += BLOCKED;
                if self.costs[i] >= self.best_costs[i] {
                    continue;
                }
            }
            self.best_costs[i] = self.costs[i];
            for link in 0..self.corridor.links() {
                self.bests[link * n + i] = self.positions[link * n + i];
            }
            if self.costs[i] < self.leader_cost {
                self.leader_cost = self.costs[i];
                for link in 0..self.corridor.links() {
                    self.leader[link] = self.positions[link * n + i];
                }
            }
        }
    }

    /// Whether a particle has left its links and its path is blocked: neighbours on links see each other.
    fn is_blocked(&self, particle: usize) -> bool {
        let place = |link: usize| self.positions[link * self.size + particle];
        let links = self.corridor.links();
        let on_links = (0..links).all(|link| (0.0..=self.corridor.high(link)).contains(&place(link)));
        !on_links && self.corridor.is_blocked(&self.corridor.path((0..links).map(place)))
    }
}
