//! Overlapping obstacles as one: Gamma = (sum Gamma_k^-m)^(-1/m), whose level surfaces have no seams.

use auv_world::math::{Vec3, distance, exp, sub};
use libm::log;

use super::field::{Body, Entry};
use super::shape::Shape;

/// Which bodies hang together.
#[derive(Debug, Clone, Default)]
pub struct Clusters {
    /// The first member of each body's cluster.
    first: Vec<usize>,
    /// Where the clusters' entries are, while merging.
    slots: Vec<usize>,
}

const NONE: usize = usize::MAX;

impl Clusters {
    /// Superquadrics overlap if they meet on the line between their centres.
    pub(super) fn new(bodies: &[Body]) -> Self {
        let mut first: Vec<usize> = (0..bodies.len()).collect();
        for i in 0..bodies.len() {
            for k in 0..i {
                if overlap(&bodies[i].shape, &bodies[k].shape) {
                    let (one, other) = (first[i].min(first[k]), first[i].max(first[k]));
                    first.iter_mut().filter(|name| **name == other).for_each(|name| *name = one);
                }
            }
        }
        let slots = vec![NONE; bodies.len()];
        Self { first, slots }
    }

    /// Puts the members of each cluster into one entry, with the coefficients of the nearest.
    pub(super) fn merge(&mut self, entries: &mut Vec<Entry>, exponent: f64) {
        if self.first.is_empty() {
            return;
        }
        self.slots.fill(NONE);
        let mut kept = 0;
        for i in 0..entries.len() {
            let entry = entries[i];
            let slot = &mut self.slots[self.first[entry.body]];
            if *slot == NONE {
                *slot = kept;
                entries[kept] = entry;
                kept += 1;
            } else {
                entries[*slot] = joined(entries[*slot], entry, exponent);
            }
        }
        entries.truncate(kept);
    }
}

/// The union of two; that of many is the same, one after the other.
fn joined(a: Entry, b: Entry, m: f64) -> Entry {
    let (near, far) = if a.gamma <= b.gamma { (a, b) } else { (b, a) };
    // Gamma_u / Gamma_near = (1 + r^m)^(-1/m) with r = Gamma_near / Gamma_far.
    let ratio = near.gamma / far.gamma.max(1e-300);
    let power = exp(m * log(ratio.max(1e-300)));
    let share = exp(-log(1.0 + power) / m);
    let near_share = exp((m + 1.0) * log(share));
    let far_share = near_share * power * ratio;
    Entry {
        gamma: near.gamma * share,
        gradient: std::array::from_fn(|axis| near_share * near.gradient[axis] + far_share * far.gradient[axis]),
        body: near.body,
    }
}

fn overlap(a: &Shape, b: &Shape) -> bool {
    let (Shape::Superquadric(a), Shape::Superquadric(b)) = (a, b) else { return false };
    let (from, to): (Vec3, Vec3) = (a.centre(), b.centre());
    let apart = distance(from, to);
    if sub(to, from) == [0.0; 3] {
        return true;
    }
    a.ray_distance(to) + b.ray_distance(from) < apart
}
