//! An ant colony on a corridor, by the rules of the teaching case of MAKLINK planning: each link has ten places,
//! and trails lie on the places.

use auv_world::rng::Stream;

use super::fitness::Corridor;

/// Places on a link: a tenth of its length, two tenths, ... all of it.
const PLACES: usize = 10;
/// The trail at first (tau0).
const FIRST_TRAIL: f64 = 3e-4;
/// Probability that an ant takes the best place instead of drawing (q0).
const GREED: f64 = 0.8;
/// What evaporates (rho).
const EVAPORATION: f64 = 0.1;

/// Ants on their way.
pub struct Colony<'a> {
    corridor: &'a Corridor<'a>,
    trails: Vec<[f64; PLACES]>,
    /// (eta, the liking for the middle) of each place.
    liking: [f64; PLACES],
    positions: Vec<f64>,
    best: Vec<f64>,
    best_cost: f64,
    last: [Vec<f64>; 2],
}

fn share(place: usize) -> f64 {
    (place + 1) as f64 / PLACES as f64
}

impl<'a> Colony<'a> {
    /// A colony before its first ants.
    pub fn new(corridor: &'a Corridor<'a>) -> Self {
        let links = corridor.links();
        let liking = std::array::from_fn(|place| {
            let eta = (1.1 - (share(place) - 0.5).abs()) / 1.1;
            eta * eta
        });
        Self {
            corridor,
            trails: vec![[FIRST_TRAIL; PLACES]; links],
            liking,
            positions: vec![0.0; links],
            best: vec![0.0; links],
            best_cost: f64::INFINITY,
            last: [Vec::new(), Vec::new()],
        }
    }

    /// The best cost so far.
    pub fn best_cost(&self) -> f64 {
        self.best_cost
    }

    /// The best positions so far.
    pub fn best(&self) -> &[f64] {
        &self.best
    }

    /// Sends so many ants one after the other; the best of them strengthens its trail.
    pub fn step(&mut self, ants: usize, random: &mut Stream) {
        let mut iteration_best = f64::INFINITY;
        let mut chosen = vec![0; self.trails.len()];
        let mut winner = chosen.clone();
        for _ in 0..ants {
            for (link, place) in chosen.iter_mut().enumerate() {
                *place = self.choose(link, random);
                let trail = &mut self.trails[link][*place];
                *trail = (1.0 - EVAPORATION) * *trail + EVAPORATION * FIRST_TRAIL;
                self.positions[link] = share(*place) * self.corridor.high(link);
            }
            let mut cost = [0.0];
            self.corridor.costs(&self.positions, 1, &mut self.last, &mut cost);
            let [cost] = cost;
            if cost < iteration_best {
                iteration_best = cost;
                winner.copy_from_slice(&chosen);
            }
            if cost < self.best_cost {
                self.best_cost = cost;
                self.best.copy_from_slice(&self.positions);
            }
        }
        // The cost is half a length.
        for (trails, place) in self.trails.iter_mut().zip(winner) {
            trails[place] = (1.0 - EVAPORATION) * trails[place] + EVAPORATION / (2.0 * iteration_best);
        }
    }

    fn choose(&self, link: usize, random: &mut Stream) -> usize {
        let pull: [f64; PLACES] = std::array::from_fn(|place| self.trails[link][place] * self.liking[place]);
        if random.unit() < GREED {
            // The first of equals.
            return (1..PLACES).fold(0, |best, place| if pull[place] > pull[best] { place } else { best });
        }
        let mut left = random.unit() * pull.iter().sum::<f64>();
        (0..PLACES - 1)
            .find(|&place| {
                left -= pull[place];
                left < 0.0
            })
            .unwrap_or(PLACES - 1)
    }
}
