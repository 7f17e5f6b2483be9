//! Places on each section between start and goal: over its whole width and depth, or in a tube around a path.

use auv_world::math::Vec3;

use crate::sections::SectionProblem;

/// A whole lattice with more steps than this is made coarser: memory and time stay bounded.
const MOST_STEPS: f64 = 8e6;
/// A place this near to a bound, in distances between places, counts as on it.
const ROUNDING: f64 = 1e-9;

/// How fine a lattice is, lateral and in depth.
#[derive(Debug, Clone, Copy)]
pub struct Grain {
    /// Distance between places (m).
    pub step: [f64; 2],
    /// Longest step from a section to the next (m).
    pub reach: [f64; 2],
}

/// Places in columns and rows on several layers, one layer to each section.
#[derive(Debug, Clone)]
pub struct Lattice {
    /// Number of places across each layer.
    pub columns: usize,
    /// Number of depths.
    pub rows: usize,
    /// Distance between columns and between rows (m).
    pub grain: [f64; 2],
    /// The longest step between layers, in columns and rows.
    pub reach: [usize; 2],
    /// Columns that lie within the bounds, first and one past the last, of each layer.
    spans: Vec<[usize; 2]>,
    /// Lateral places (m), layer by layer.
    lateral: Vec<f64>,
    /// Depths (m), layer by layer.
    depth: Vec<f64>,
}

impl Lattice {
    /// Places over the whole width and depth, start's own among them as far as it lies within, and steps no
    /// longer than `longest` in either direction. Coarser than asked where it would have too many steps.
    pub fn whole(problem: &SectionProblem, mut grain: Grain, longest: f64) -> Self {
        let layers = problem.inner();
        let [start, _] = problem.ends();
        let (low, high) = (&problem.low()[..layers], &problem.high()[..layers]);
        let (least, most) =
            (low.iter().copied().fold(f64::INFINITY, f64::min), high.iter().copied().fold(f64::NEG_INFINITY, f64::max));
        let anchor = problem.frame().lateral(start[0], start[1]);
        let [top, bottom] = problem.frame().depth_bounds();
        loop {
            let across = Ticks::new(anchor, grain.step[0], [least, most]);
            let down = if problem.has_depth() {
                Ticks::new(start[2], grain.step[1], [top, bottom])
            } else {
                Ticks::new(problem.level(), 1.0, [problem.level(); 2])
            };
            let (columns, rows) = (across.count, down.count);
            let reach = [0, 1].map(|axis| {
                let steps = (grain.reach[axis].min(longest) / grain.step[axis] + ROUNDING).floor();
                steps.min(([columns, rows][axis] - 1) as f64) as usize
            });
            let steps = (2 * reach[0] + 1) * (2 * reach[1] + 1);
            if (layers * columns * rows) as f64 * steps as f64 > MOST_STEPS {
                grain.step = grain.step.map(|step| 1.1 * step);
                continue;
            }
            let (across, down) = (across.places(), down.places());
            let mut lateral = Vec::with_capacity(layers * columns);
            let spans = low.iter().zip(high).map(|(low, high)| {
                let slack = ROUNDING * grain.step[0];
                let first = across.iter().take_while(|place| **place < low - slack).count().min(columns - 1);
                let end = across.iter().take_while(|place| **place <= high + slack).count().max(first + 1);
                lateral.extend(across.iter().map(|place| place.clamp(*low, *high)));
                [first, end]
            });
            let spans = spans.collect();
            return Self { columns, rows, grain: grain.step, reach, spans, lateral, depth: down.repeat(layers) };
        }
    }

    /// Places around a candidate: `halves` columns and rows to each side, every `step` (m), within the bounds
    /// and the `band` of depths (m).
    pub fn tube(problem: &SectionProblem, genes: &[f64], step: [f64; 2], halves: [usize; 2], band: [f64; 2]) -> Self {
        let layers = problem.inner();
        let [columns, rows] = halves.map(|half| 2 * half + 1);
        let offset = |i: usize, half: usize| i as f64 - half as f64;
        let mut lateral = Vec::with_capacity(layers * columns);
        let mut depth = Vec::with_capacity(layers * rows);
        for layer in 0..layers {
            let (low, high) = (problem.low()[layer], problem.high()[layer]);
            lateral.extend((0..columns).map(|i| (genes[layer] + offset(i, halves[0]) * step[0]).clamp(low, high)));
            if problem.has_depth() {
                let own = genes[layers + layer];
                depth.extend((0..rows).map(|i| (own + offset(i, halves[1]) * step[1]).clamp(band[0], band[1])));
            } else {
                depth.extend((0..rows).map(|_| problem.level()));
            }
        }
        let reach = [columns - 1, rows - 1];
        Self { columns, rows, grain: step, reach, spans: vec![[0, columns]; layers], lateral, depth }
    }

    /// Number of layers.
    pub fn layers(&self) -> usize {
        self.spans.len()
    }

    /// Number of places on a layer.
    pub fn nodes(&self) -> usize {
        self.columns * self.rows
    }

    /// Number of steps that leave a place, those that leave the lattice included.
    pub fn steps(&self) -> usize {
        (2 * self.reach[0] + 1) * (2 * self.reach[1] + 1)
    }

    /// Columns of a layer that lie within the bounds, first and one past the last.
    pub fn span(&self, layer: usize) -> [usize; 2] {
        self.spans[layer]
    }

    /// Lateral place and depth of a node (m).
    #[inline]
    pub fn place(&self, layer: usize, node: usize) -> [f64; 2] {
        let (row, column) = (node / self.columns, node % self.columns);
        [self.lateral[layer * self.columns + column], self.depth[layer * self.rows + row]]
    }

    /// Depths of a layer (m).
    pub fn depths(&self, layer: usize) -> &[f64] {
        &self.depth[layer * self.rows..][..self.rows]
    }

    /// All nodes of a layer as points (m).
    pub fn points(&self, problem: &SectionProblem, layer: usize) -> impl Iterator<Item = Vec3> {
        (0..self.nodes()).map(move |node| {
            let [lateral, depth] = self.place(layer, node);
            problem.frame().point(problem.sections()[layer], lateral, depth)
        })
    }

    /// The candidate that goes through one node of each layer.
    pub fn genes(&self, problem: &SectionProblem, path: &[usize]) -> Vec<f64> {
        let places = path.iter().enumerate().map(|(layer, node)| self.place(layer, *node));
        let (mut lateral, depth): (Vec<f64>, Vec<f64>) = places.map(|[lateral, depth]| (lateral, depth)).unzip();
        if problem.has_depth() {
            lateral.extend(depth);
        }
        lateral
    }
}

/// Multiples of a step from an anchor within bounds; their middle if there is none.
struct Ticks {
    anchor: f64,
    /// The first multiple.
    first: f64,
    step: f64,
    bounds: [f64; 2],
    count: usize,
}

impl Ticks {
    fn new(anchor: f64, step: f64, bounds: [f64; 2]) -> Self {
        let [low, high] = bounds;
        let first = ((low - anchor) / step - ROUNDING).ceil();
        let last = ((high - anchor) / step + ROUNDING).floor();
        if high <= low || last < first {
            return Self { anchor: 0.5 * (low + high), first: 0.0, step, bounds, count: 1 };
        }
        // Steps may be so fine that the count is beyond all numbers: the caller makes them coarser.
        let count = (last - first).min(MOST_STEPS) as usize + 1;
        Self { anchor, first, step, bounds, count }
    }

    fn places(&self) -> Vec<f64> {
        let [low, high] = self.bounds;
        (0..self.count).map(|i| (self.anchor + (self.first + i as f64) * self.step).clamp(low, high)).collect()
    }
}
