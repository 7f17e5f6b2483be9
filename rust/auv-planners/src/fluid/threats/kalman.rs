//! Where a threat is and how fast, from positions that are not exact: a Kalman filter that takes velocity
//! as constant but for white noise in the acceleration.

use auv_world::math::{Vec3, add_scaled};

use super::barrier::Ball;

/// What the filter expects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Strength of the acceleration's noise (m^2/s^3).
    pub process: f64,
    /// Standard deviation of a measurement along each axis (m).
    pub measurement_m: f64,
    /// Standard deviation of the velocity before anything is known of it (m/s).
    pub velocity_mps: f64,
}

/// Position and velocity along three axes that do not know of each other. Their covariances are equal, so
/// that one serves all.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kalman {
    noise: Noise,
    time_s: f64,
    position: Vec3,
    velocity: Vec3,
    /// Variance of the position, covariance, variance of the velocity.
    covariance: [f64; 3],
}

impl Kalman {
    /// A filter that has seen one position (m).
    pub fn new(noise: Noise, position: Vec3, time_s: f64) -> Self {
        let covariance = [noise.measurement_m * noise.measurement_m, 0.0, noise.velocity_mps * noise.velocity_mps];
        Self { noise, time_s, position, velocity: [0.0; 3], covariance }
    }

    /// Position (m) at a time, as far as is known now.
    pub fn position(&self, time_s: f64) -> Vec3 {
        add_scaled(self.position, time_s - self.time_s, self.velocity)
    }

    /// Velocity (m/s).
    pub fn velocity(&self) -> Vec3 {
        self.velocity
    }

    /// The threat of a radius (m) that is followed, as it will be at a time as far as is known now.
    pub fn ball(&self, radius: f64, time_s: f64) -> Ball {
        Ball { centre: self.position(time_s), velocity: self.velocity, radius }
    }

    /// How many standard deviations off what is expected a measurement would be, on the axis where it is worst.
    pub fn surprise(&self, position: Vec3, time_s: f64) -> f64 {
        let [pp, _, _] = self.ahead((time_s - self.time_s).max(0.0));
        let deviation = (pp + self.noise.measurement_m * self.noise.measurement_m).max(1e-12).sqrt();
        let expected = self.position(time_s);
        (0..3).map(|axis| (position[axis] - expected[axis]).abs() / deviation).fold(0.0, f64::max)
    }

    /// The covariance that much later: F P F' + Q.
    fn ahead(&self, dt: f64) -> [f64; 3] {
        let [pp, pv, vv] = self.covariance;
        let q = self.noise.process;
        [pp + dt * (2.0 * pv + dt * vv) + q * dt * dt * dt / 3.0, pv + dt * vv + q * dt * dt / 2.0, vv + q * dt]
    }

    /// Takes a measured position (m) in. Measurements older than the last one are not understood and count
    /// as of its time.
    pub fn measure(&mut self, position: Vec3, time_s: f64) {
        let dt = (time_s - self.time_s).max(0.0);
        self.time_s += dt;
        self.position = add_scaled(self.position, dt, self.velocity);
        let [pp, pv, vv] = self.ahead(dt);
        // Exact measurements must not divide 0 by 0.
        let variance = (pp + self.noise.measurement_m * self.noise.measurement_m).max(1e-12);
        let (gain, rate) = (pp / variance, pv / variance);
        for axis in 0..3 {
            let innovation = position[axis] - self.position[axis];
            self.position[axis] += gain * innovation;
            self.velocity[axis] += rate * innovation;
        }
        self.covariance = [(1.0 - gain) * pp, (1.0 - gain) * pv, vv - rate * pv];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use auv_world::rng::{Purpose, Stream};

    /// Without noise in the acceleration and with nothing known of the velocity the filter is a straight
    /// line fitted by least squares.
    #[test]
    fn a_line_by_least_squares() {
        let noise = Noise { process: 0.0, measurement_m: 20.0, velocity_mps: 1e6 };
        let mut stream = Stream::new(1, Purpose::Sensor, 0);
        let times: Vec<f64> = (0..40).map(|i| 6.0 * f64::from(i)).collect();
        let places: Vec<Vec3> =
            times.iter().map(|t| [0.9 * t, 500.0 - 0.4 * t, 0.01 * t].map(|p| p + stream.normal(0.0, 20.0))).collect();
        let mut filter = Kalman::new(noise, places[0], times[0]);
        times.iter().zip(&places).skip(1).for_each(|(time, place)| filter.measure(*place, *time));
        let n = times.len() as f64;
        let mean_time = times.iter().sum::<f64>() / n;
        let spread: f64 = times.iter().map(|t| (t - mean_time) * (t - mean_time)).sum();
        for axis in 0..3 {
            let mean = places.iter().map(|place| place[axis]).sum::<f64>() / n;
            let slope = times.iter().zip(&places).map(|(t, place)| (t - mean_time) * place[axis]).sum::<f64>() / spread;
            assert!((filter.velocity()[axis] - slope).abs() < 1e-6, "{:?} {slope}", filter.velocity());
            assert!((filter.position(300.0)[axis] - mean - slope * (300.0 - mean_time)).abs() < 1e-3);
        }
    }

    /// After long the gains are those of the steady filter: with lambda = q dt^3 / r^2 the covariance solves
    /// Riccati's equation, so that one more measurement does not change it.
    #[test]
    fn the_covariance_comes_to_rest() {
        let noise = Noise { process: 1e-3, measurement_m: 20.0, velocity_mps: 2.0 };
        let mut filter = Kalman::new(noise, [0.0; 3], 0.0);
        for i in 1..2000 {
            filter.measure([0.0; 3], 6.0 * f64::from(i));
        }
        let [pp, pv, vv] = filter.covariance;
        // A fixed point: what the prediction adds the measurement takes away.
        let (dt, q) = (6.0, 1e-3);
        let ahead =
            [pp + 2.0 * dt * pv + dt * dt * vv + q * dt * dt * dt / 3.0, pv + dt * vv + q * dt * dt / 2.0, vv + q * dt];
        let variance = ahead[0] + 400.0;
        assert!((ahead[0] * 400.0 / variance - pp).abs() < 1e-9 * pp);
        assert!((ahead[1] * 400.0 / variance - pv).abs() < 1e-9 * pv);
        assert!((ahead[2] - ahead[1] * ahead[1] / variance - vv).abs() < 1e-9 * vv);
    }

    #[test]
    fn exact_measurements_of_a_steady_course() {
        let mut filter = Kalman::new(Noise { process: 0.0, measurement_m: 0.0, velocity_mps: 2.0 }, [0.0; 3], 0.0);
        for i in 0..5 {
            filter.measure([6.0 * f64::from(i), 0.0, 0.0], 6.0 * f64::from(i));
        }
        assert!((filter.velocity()[0] - 1.0).abs() < 1e-9 && (filter.position(60.0)[0] - 60.0).abs() < 1e-6);
    }
}
