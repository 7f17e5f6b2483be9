//! The disturbed flow (eq. 1-13): the undisturbed one, times a matrix for each obstacle that takes its
//! normal part away near the surface and turns it into a tangential one.
//!
//! The paper's third axis points up, z here down: theta = pi / 2 still leads over an obstacle.

use auv_world::math::{Vec3, add_scaled, dot, exp, norm, sub};
use libm::log;

use super::shape::Shape;
use super::superquadric::FARTHEST;
use super::union::Clusters;

/// How an obstacle disturbs the flow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficients {
    /// rho0: repulsive reaction.
    pub rho: f64,
    /// sigma0: tangential reaction.
    pub sigma: f64,
    /// theta: the direction round the obstacle (rad). 0 leads to the right, pi to the left, pi / 2 over it.
    pub theta: f64,
}

/// What all obstacles of a field have in common.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Modulation {
    /// The least factor of eq. 8-9; 0: as printed, and the repulsion vanishes near surfaces.
    pub least_factor: f64,
    /// The length that distances in eq. 8-9 are measured in (m).
    pub unit_m: f64,
    /// Whether obstacles act on water that flows away from them.
    pub tail: bool,
    /// Whether the flow inside an obstacle leads out, instead of following the formulas.
    pub escape: bool,
    /// Overlapping obstacles become one, Gamma = (sum Gamma_k^-m)^(-1/m); 0: they stay apart.
    pub union_exponent: f64,
    /// Whether the flow is turned in the frame of obstacles that move.
    pub relative: bool,
}

/// An obstacle in the field.
#[derive(Debug, Clone)]
pub struct Body {
    /// Its shape.
    pub shape: Shape,
    /// How it disturbs.
    pub coefficients: Coefficients,
    /// Its velocity (m/s).
    pub velocity: Vec3,
    /// Whether it counts at present.
    pub active: bool,
    /// cos and sin of theta.
    direction: [f64; 2],
}

impl Body {
    /// A body at rest.
    pub fn new(shape: Shape, coefficients: Coefficients) -> Self {
        let mut body = Self { shape, coefficients, velocity: [0.0; 3], active: true, direction: [1.0, 0.0] };
        body.set(coefficients);
        body
    }

    /// Sets its coefficients.
    pub fn set(&mut self, coefficients: Coefficients) {
        self.coefficients = coefficients;
        self.direction = [libm::cos(coefficients.theta), libm::sin(coefficients.theta)];
    }
}

/// What an obstacle, or a cluster of them, is at one point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    pub(super) gamma: f64,
    pub(super) gradient: Vec3,
    /// The body whose coefficients hold.
    pub(super) body: usize,
}

/// Gamma - 1 counts as at least this in the weights.
const LEAST_GAP: f64 = 1e-9;
/// So many obstacles count at a point; where there are more, those of the least Gamma.
const MOST: usize = 64;
/// A normal is vertical if its horizontal part is less than this part of it.
const VERTICAL: f64 = 1e-9;

/// Obstacles, and room to work.
#[derive(Debug, Clone)]
pub struct Field {
    bodies: Vec<Body>,
    modulation: Modulation,
    /// Whether the world is 2-D.
    flat: bool,
    clusters: Clusters,
    entries: Vec<Entry>,
    gaps: Vec<f64>,
    weights: Vec<f64>,
}

impl Field {
    /// A field.
    pub fn new(bodies: Vec<Body>, modulation: Modulation, flat: bool) -> Self {
        let room = bodies.len();
        let clusters = Clusters::new(if modulation.union_exponent > 0.0 { &bodies } else { &[] });
        Self {
            bodies,
            modulation,
            flat,
            clusters,
            entries: Vec::with_capacity(room),
            gaps: Vec::with_capacity(room),
            weights: Vec::with_capacity(room),
        }
    }

    /// The obstacles.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// The obstacles. Those that are moved keep the clusters that they had.
    pub fn bodies_mut(&mut self) -> &mut [Body] {
        &mut self.bodies
    }

    /// One more obstacle, which belongs to no cluster.
    pub fn push(&mut self, body: Body) {
        self.bodies.push(body);
    }

    /// The rules.
    pub fn modulation(&self) -> &Modulation {
        &self.modulation
    }

    /// The disturbed velocity at a point, for a goal and the undisturbed velocity there (eq. 13).
    pub fn velocity(&mut self, point: Vec3, goal: Vec3, undisturbed: Vec3) -> Vec3 {
        self.look(point);
        if self.modulation.escape
            && let Some(deepest) = self.entries.iter().min_by(|a, b| a.gamma.total_cmp(&b.gamma))
            && deepest.gamma < 1.0
        {
            return escape(deepest.gradient, undisturbed, self.flat);
        }
        if self.entries.len() > MOST {
            self.entries.select_nth_unstable_by(MOST, |a, b| a.gamma.total_cmp(&b.gamma).then(a.body.cmp(&b.body)));
            self.entries.truncate(MOST);
        }
        self.weigh();
        let to_goal = norm(sub(goal, point));
        let mut sum = [0.0; 3];
        for (entry, weight) in self.entries.iter().zip(&self.weights) {
            sum = add_scaled(sum, *weight, self.turned(entry, point, to_goal, undisturbed));
        }
        if self.entries.is_empty() { undisturbed } else { sum }
    }

    /// Gamma and gradient of every obstacle near enough to matter.
    fn look(&mut self, point: Vec3) {
        self.entries.clear();
        for (i, body) in self.bodies.iter().enumerate() {
            if !body.active {
                continue;
            }
            let contact = body.shape.contact(point);
            // Beyond, its weight is 0 and its factor in all others 1.
            if contact.gamma < FARTHEST {
                self.entries.push(Entry { gamma: contact.gamma, gradient: contact.gradient, body: i });
            }
        }
        self.clusters.merge(&mut self.entries, self.modulation.union_exponent);
    }

    /// Eq. 5-6, each pair once.
    fn weigh(&mut self) {
        let n = self.entries.len();
        self.gaps.clear();
        self.gaps.extend(self.entries.iter().map(|entry| (entry.gamma - 1.0).max(LEAST_GAP)));
        self.weights.clear();
        self.weights.resize(n, 1.0);
        for i in 0..n {
            let (gap, mut weight) = (self.gaps[i], self.weights[i]);
            for k in i + 1..n {
                let inverse = 1.0 / (gap + self.gaps[k]);
                weight *= self.gaps[k] * inverse;
                self.weights[k] *= gap * inverse;
            }
            self.weights[i] = weight;
        }
        let sum: f64 = self.weights.iter().sum();
        self.weights.iter_mut().for_each(|weight| *weight /= sum);
    }

    /// What one obstacle makes of the flow, M_k U (eq. 7-12).
    #[inline]
    fn turned(&self, entry: &Entry, point: Vec3, to_goal: f64, undisturbed: Vec3) -> Vec3 {
        let body = &self.bodies[entry.body];
        let velocity = if self.modulation.relative { body.velocity } else { [0.0; 3] };
        let flow = sub(undisturbed, velocity);
        let length = norm(entry.gradient);
        // In its very centre an obstacle has no normal.
        let normal = if length > 0.0 { entry.gradient.map(|g| g / length) } else { [0.0; 3] };
        let inwards = dot(normal, flow);
        if inwards > 0.0 && !self.modulation.tail {
            return undisturbed;
        }
        let Modulation { least_factor, unit_m, .. } = self.modulation;
        let distance = (body.shape.distance(point) / unit_m).max(1e-9);
        let factor = exp(1.0 - 1.0 / (to_goal / unit_m * distance).max(1e-300)).max(least_factor);
        let log_gamma = log(entry.gamma.max(1e-300));
        // Gamma^(-1 / coefficient).
        let strength = |coefficient: f64| exp((-log_gamma / (coefficient * factor).max(1e-300)).clamp(-700.0, 50.0));
        let repulsion = strength(body.coefficients.rho);
        let turning = if body.coefficients.sigma == body.coefficients.rho {
            repulsion
        } else {
            strength(body.coefficients.sigma)
        };
        let tangent = self.tangent(normal, body.direction);
        std::array::from_fn(|axis| {
            velocity[axis] + flow[axis] + inwards * (turning * tangent[axis] - repulsion * normal[axis])
        })
    }

    /// The unit tangent t of eq. 10-12, for a unit normal.
    #[inline]
    fn tangent(&self, normal: Vec3, [cosine, sine]: [f64; 2]) -> Vec3 {
        let [x, y, z] = normal;
        let level = (x * x + y * y).sqrt();
        if self.flat {
            // Left or right is all there is.
            let side = if level > 0.0 { 1.0_f64.copysign(cosine) / level } else { 0.0 };
            return [side * y, -side * x, 0.0];
        }
        // x' of eq. 12, and y' = (-n_x n_z, -n_y n_z, n_x^2 + n_y^2) with z down.
        let (first, second) = if level < VERTICAL {
            ([1.0, 0.0, 0.0], [0.0, -z.signum(), 0.0])
        } else {
            ([y / level, -x / level, 0.0], [-x * z / level, -y * z / level, level])
        };
        std::array::from_fn(|axis| cosine * first[axis] + sine * second[axis])
    }

    /// Whether a point lies outside all obstacles, not on their surface.
    pub fn is_outside(&self, point: Vec3) -> bool {
        self.active().all(|body| body.shape.is_far(point) || body.shape.gamma(point) > 1.0)
    }

    /// A lower bound of the distance to the nearest surface (m), or `beyond` if that is less.
    pub fn clearance(&self, point: Vec3, beyond: f64) -> f64 {
        self.active().fold(beyond, |nearest, body| body.shape.clearance(point, nearest))
    }

    fn active(&self) -> impl Iterator<Item = &Body> {
        self.bodies.iter().filter(|body| body.active)
    }

    /// The body of the least Gamma below `level`, which is at most 1.02, if any.
    pub fn deepest(&self, point: Vec3, level: f64) -> Option<&Body> {
        let near = self.active().filter(|body| !body.shape.is_far(point));
        let gammas = near.map(|body| (body.shape.gamma(point), body));
        let deepest = gammas.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (deepest.0 < level).then_some(deepest.1)
    }
}

/// Out of an obstacle: half of what flows along its surface, and all speed along the normal.
fn escape(gradient: Vec3, undisturbed: Vec3, flat: bool) -> Vec3 {
    let length = norm(gradient);
    let normal = match (length > 0.0, flat) {
        (true, _) => gradient.map(|g| g / length),
        (false, true) => [1.0, 0.0, 0.0],
        (false, false) => [0.0, 0.0, -1.0],
    };
    let along = add_scaled(undisturbed, -dot(undisturbed, normal), normal);
    let speed = norm(undisturbed);
    std::array::from_fn(|axis| 0.5 * along[axis] + speed * normal[axis])
}

#[cfg(test)]
#[path = "field_tests.rs"]
mod tests;
