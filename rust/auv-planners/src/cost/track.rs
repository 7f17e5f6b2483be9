//! A path as a structure of arrays: waypoints, and the segments between them.
//!
//! Arrays are padded to whole lanes with points that repeat the last one: segments of length 0, whose
//! results are set to 0 before anything is summed.

/// Numbers that are worked on at once. The order of every sum follows from it: never change it lightly.
pub const LANES: usize = 8;

/// One number for each lane.
pub type Lanes = [f64; LANES];

/// A path under evaluation.
#[derive(Debug, Clone, Default)]
pub struct Track {
    points: usize,
    /// Waypoints (m).
    pub x: Vec<f64>,
    /// Waypoints (m).
    pub y: Vec<f64>,
    /// Waypoints (m).
    pub z: Vec<f64>,
    /// Steps from each waypoint to the next (m).
    pub dx: Vec<f64>,
    /// Steps from each waypoint to the next (m).
    pub dy: Vec<f64>,
    /// Steps from each waypoint to the next (m).
    pub dz: Vec<f64>,
    /// Length of each segment (m).
    pub length: Vec<f64>,
    /// One result for each segment.
    pub result: Vec<f64>,
}

impl Track {
    /// Makes room for a path of `points` waypoints.
    pub fn resize(&mut self, points: usize) {
        self.points = points;
        // The last lane of steps needs a waypoint after it.
        let padded = points.next_multiple_of(LANES) + LANES;
        for array in [&mut self.x, &mut self.y, &mut self.z] {
            array.resize(padded, 0.0);
        }
        for array in [&mut self.dx, &mut self.dy, &mut self.dz, &mut self.length, &mut self.result] {
            array.resize(padded - LANES, 0.0);
        }
    }

    /// Number of waypoints.
    pub fn points(&self) -> usize {
        self.points
    }

    /// Number of segments.
    pub fn segments(&self) -> usize {
        self.points - 1
    }

    /// Number of segments with padding.
    pub fn padded(&self) -> usize {
        self.dx.len()
    }

    /// Sets waypoint `i`.
    #[inline]
    pub fn set(&mut self, i: usize, point: [f64; 3]) {
        (self.x[i], self.y[i], self.z[i]) = (point[0], point[1], point[2]);
    }

    /// Waypoint `i` (m).
    pub fn point(&self, i: usize) -> [f64; 3] {
        [self.x[i], self.y[i], self.z[i]]
    }

    /// Segments from one point to each of several, instead of a path.
    pub fn fan(&mut self, from: [f64; 3], to: &[[f64; 3]]) {
        self.resize(to.len() + 1);
        for (axis, place) in [&mut self.x, &mut self.y, &mut self.z].into_iter().enumerate() {
            place.fill(from[axis]);
        }
        for (axis, step) in [&mut self.dx, &mut self.dy, &mut self.dz].into_iter().enumerate() {
            step[to.len()..].fill(0.0);
            for (step, to) in step.iter_mut().zip(to) {
                *step = to[axis] - from[axis];
            }
        }
        self.measure_lengths();
    }

    /// Computes the segments from the waypoints.
    #[inline]
    pub fn measure(&mut self) {
        let last = self.points - 1;
        for array in [&mut self.x, &mut self.y, &mut self.z] {
            let end = array[last];
            array[last + 1..].fill(end);
        }
        let n = self.dx.len();
        for (step, place) in [(&mut self.dx, &self.x), (&mut self.dy, &self.y), (&mut self.dz, &self.z)] {
            for ((step, from), to) in step.iter_mut().zip(&place[..n]).zip(&place[1..]) {
                *step = to - from;
            }
        }
        self.measure_lengths();
    }

    #[inline(always)]
    fn measure_lengths(&mut self) {
        let steps = self.dx.iter().zip(&self.dy).zip(&self.dz);
        for (length, ((dx, dy), dz)) in self.length.iter_mut().zip(steps) {
            *length = (dx * dx + dy * dy + dz * dz).sqrt();
        }
    }

    /// Length of the path (m).
    #[inline]
    pub fn path_length(&self) -> f64 {
        sum(&self.length)
    }

    /// Distance from the first to the last waypoint (m).
    #[inline]
    pub fn direct_length(&self) -> f64 {
        let last = self.points - 1;
        let (dx, dy, dz) = (self.x[last] - self.x[0], self.y[last] - self.y[0], self.z[last] - self.z[0]);
        (dx * dx + dy * dy + dz * dz).sqrt()
    }

    /// Number of inner waypoints at which the cosine of the change of direction is less than `limit`.
    #[inline]
    pub fn sharp_turns(&self, limit: f64) -> usize {
        let n = self.segments();
        let (dx, dy, dz, length) = (&self.dx[..n], &self.dy[..n], &self.dz[..n], &self.length[..n]);
        let mut sharp = 0.0;
        for i in 1..n {
            let dot = dx[i - 1] * dx[i] + dy[i - 1] * dy[i] + dz[i - 1] * dz[i];
            sharp += if dot < limit * (length[i - 1] * length[i]) { 1.0 } else { 0.0 };
        }
        sharp as usize
    }

    /// Number of segments that are longer than `limit` (m).
    #[inline]
    pub fn longer_than(&self, limit: f64) -> usize {
        let longer = self.length[..self.segments()].iter().map(|length| if *length > limit { 1.0 } else { 0.0 });
        longer.sum::<f64>() as usize
    }

    /// Difference between the greatest and the least depth (m).
    #[inline]
    pub fn depth_range(&self) -> f64 {
        // Padding repeats the last waypoint.
        let (mut least, mut most) = ([f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES]);
        for chunk in self.z.chunks_exact(LANES) {
            for lane in 0..LANES {
                least[lane] = if chunk[lane] < least[lane] { chunk[lane] } else { least[lane] };
                most[lane] = if chunk[lane] > most[lane] { chunk[lane] } else { most[lane] };
            }
        }
        let most = most.into_iter().fold(f64::NEG_INFINITY, f64::max);
        most - least.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// Sum of the results of the true segments.
    #[inline]
    pub fn sum_results(&mut self) -> f64 {
        let n = self.segments();
        self.result[n..].fill(0.0);
        sum(&self.result)
    }
}

/// The sum of whole lanes, lane by lane and then across.
#[inline]
fn sum(values: &[f64]) -> f64 {
    let mut lanes = [0.0; LANES];
    for chunk in values.chunks_exact(LANES) {
        for (lane, value) in lanes.iter_mut().zip(chunk) {
            *lane += value;
        }
    }
    ((lanes[0] + lanes[1]) + (lanes[2] + lanes[3])) + ((lanes[4] + lanes[5]) + (lanes[6] + lanes[7]))
}
