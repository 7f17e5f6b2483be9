//! The one random generator: ChaCha8, with a stream for each purpose so that a new draw in one place
//! shifts no other.

use rand_chacha::ChaCha8Rng;
use rand_core::{Rng as _, SeedableRng};
use wide::f64x4;

use crate::lanes::LANES;

mod box_muller;

/// What a stream of random numbers is for. The numbers are part of the file format: never reuse one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum Purpose {
    /// Drawing a scenario from a family.
    Family = 1,
    /// What happens at a map change.
    Change = 2,
    /// A planner's own draws.
    Planner = 3,
    /// A sensor's noise.
    Sensor = 4,
}

/// A seeded, portable stream of random numbers.
#[derive(Clone, Debug)]
pub struct Stream(ChaCha8Rng);

impl Stream {
    /// The stream of `purpose` number `index` under `seed`.
    pub fn new(seed: u64, purpose: Purpose, index: u32) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(((purpose as u64) << 32) | u64::from(index));
        Self(rng)
    }

    /// A 64-bit integer.
    #[inline]
    pub fn next_u64(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// Passes over so many numbers.
    pub fn skip(&mut self, count: usize) {
        for _ in 0..count {
            self.next_u64();
        }
    }

    /// Uniform in [0, 1) with 53 bits.
    #[inline]
    pub fn unit(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
    }

    /// Two numbers uniform in [0, 1) with 32 bits each, for those who need many.
    #[inline]
    pub fn half_units(&mut self) -> [f64; 2] {
        let bits = self.next_u64();
        [bits as u32, (bits >> 32) as u32].map(|half| f64::from(half) * (1.0 / 4_294_967_296.0))
    }

    /// Fills with numbers uniform in [0, 1) with 32 bits each.
    #[inline]
    pub fn fill_half_units(&mut self, values: &mut [f64]) {
        for pair in values.chunks_mut(2) {
            pair.copy_from_slice(&self.half_units()[..pair.len()]);
        }
    }

    /// Uniform in [low, high).
    #[inline]
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform integer in 0..n (n > 0), by multiplication (bias below n / 2^64).
    #[inline]
    pub fn below(&mut self, n: usize) -> usize {
        ((u128::from(self.next_u64()) * n as u128) >> 64) as usize
    }

    /// Normal with the given mean and standard deviation (Box-Muller).
    pub fn normal(&mut self, mean: f64, deviation: f64) -> f64 {
        let radius = (-2.0 * libm::log(1.0 - self.unit())).sqrt();
        mean + deviation * radius * libm::cos(std::f64::consts::TAU * self.unit())
    }

    /// Adds to each of `values`, one after another, what [`Stream::normal`] with mean 0 would give.
    pub fn disturb(&mut self, values: &mut [f64], deviation: f64) {
        for four in values.chunks_mut(LANES) {
            let (mut a, mut b) = ([0.0; LANES], [0.0; LANES]);
            for (a, b) in a.iter_mut().zip(&mut b).take(four.len()) {
                (*a, *b) = (self.unit(), self.unit());
            }
            let [radius, cos] = box_muller::factors(a, b);
            let steps = f64x4::splat(deviation) * radius * cos;
            four.iter_mut().zip(steps.to_array()).for_each(|(value, step)| *value += step);
        }
    }

    /// Two standard normals at once, for those who need many (Marsaglia's polar method).
    #[inline]
    pub fn normals(&mut self) -> [f64; 2] {
        loop {
            let (a, b) = (self.uniform(-1.0, 1.0), self.uniform(-1.0, 1.0));
            let square = a * a + b * b;
            if square > 0.0 && square < 1.0 {
                let scale = (-2.0 * libm::log(square) / square).sqrt();
                return [a * scale, b * scale];
            }
        }
    }

    /// +1 or -1.
    pub fn sign(&mut self) -> f64 {
        if self.next_u64() >> 63 == 0 { 1.0 } else { -1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_are_fixed_and_differ() {
        let draw = |purpose, index| Stream::new(7, purpose, index).next_u64();
        assert_eq!(draw(Purpose::Family, 0), draw(Purpose::Family, 0));
        assert_ne!(draw(Purpose::Family, 0), draw(Purpose::Change, 0));
        assert_ne!(draw(Purpose::Change, 0), draw(Purpose::Change, 1));
    }

    #[test]
    fn moments_of_pairs() {
        let mut stream = Stream::new(1, Purpose::Planner, 0);
        let n = 50_000;
        let (mut sum, mut square, mut product) = (0.0, 0.0, 0.0);
        for _ in 0..n {
            let [a, b] = stream.normals();
            sum += a + b;
            square += a * a + b * b;
            product += a * b;
        }
        let n = f64::from(n);
        assert!((sum / (2.0 * n)).abs() < 0.01 && (square / (2.0 * n) - 1.0).abs() < 0.02);
        assert!((product / n).abs() < 0.02);
    }

    #[test]
    fn disturbs_as_one_normal_after_another() {
        for count in 0..11 {
            let [mut alone, mut together] = [(); 2].map(|()| Stream::new(3, Purpose::Change, count));
            let mut values: Vec<f64> = (0..count).map(|i| 100.0 * f64::from(i)).collect();
            let expected: Vec<f64> = values.iter().map(|value| value + alone.normal(0.0, 7.0)).collect();
            together.disturb(&mut values, 7.0);
            assert_eq!(values, expected);
            assert_eq!(alone.next_u64(), together.next_u64());
        }
    }

    #[test]
    fn moments() {
        let mut stream = Stream::new(1, Purpose::Planner, 0);
        let n = 100_000;
        let (mut sum, mut square) = (0.0, 0.0);
        for _ in 0..n {
            let z = stream.normal(3.0, 2.0);
            sum += z;
            square += (z - 3.0) * (z - 3.0);
        }
        assert!((sum / f64::from(n) - 3.0).abs() < 0.03);
        assert!((square / f64::from(n) - 4.0).abs() < 0.08);
        assert!((0..1000).all(|_| stream.below(7) < 7));
    }
}
