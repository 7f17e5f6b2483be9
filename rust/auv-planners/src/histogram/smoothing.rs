//! Smoothing (LFHH eq. 15): a waypoint whose two segments differ in length moves midway to the neighbour
//! at the end of the longer left, or else of the right one.

use super::settings::Smoothing;
use crate::sections::SectionProblem;

/// A waypoint in the coordinates of the sections: along, lateral, depth (m).
type Place = [f64; 3];

fn square(a: Place, b: Place) -> f64 {
    (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum()
}

/// Smooths a candidate: each waypoint keeps its section, so only the lateral place and depth are averaged.
pub fn smooth(problem: &SectionProblem, old: &[f64], order: Smoothing, new: &mut [f64]) {
    let (frame, sections, inner) = (problem.frame(), problem.sections(), problem.inner());
    let [start, target] = problem.ends().map(|point| {
        let along = frame.section(point[0], point[1]) * frame.spacing_m();
        [along, frame.lateral(point[0], point[1]), point[2]]
    });
    let level = frame.depth_bounds()[0];
    let place = |i: usize| -> Place {
        let depth = if problem.has_depth() { old[inner + i] } else { level };
        [sections[i] as f64 * frame.spacing_m(), old[i], depth]
    };
    let mut left = start;
    for i in 0..inner {
        let here = place(i);
        let right = if i + 1 < inner { place(i + 1) } else { target };
        let neighbour = if square(left, here) > square(here, right) { left } else { right };
        let mut moved = here;
        for (axis, gene) in [(1, i), (2, inner + i)].into_iter().take(if problem.has_depth() { 2 } else { 1 }) {
            // A start outside the box must not draw waypoints out of it.
            let mean = (here[axis] + neighbour[axis]) / 2.0;
            moved[axis] = mean.clamp(problem.low()[gene], problem.high()[gene]);
            new[gene] = moved[axis];
        }
        left = match order {
            Smoothing::Sequential => moved,
            Smoothing::Simultaneous => here,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use crate::{Cost, CostOptions};

    fn smoothed(order: Smoothing) -> Vec<f64> {
        let world = testing::paper_world("lfhh-2d-1", 0);
        let ends = ([5e3, 0.0, 0.0], [5e3, 4e3, 0.0]);
        let problem = SectionProblem::new(&world, ends.0, ends.1, Cost::Lfhh, &CostOptions::default()).unwrap();
        let mut new = vec![0.0; 3];
        smooth(&problem, &[9e3, 6e3, 7e3], order, &mut new);
        new
    }

    #[test]
    fn by_hand() {
        // 5 | 9 6 7 | 5 km. First: left step 4 > right step 3: (5 + 9) / 2 = 7.
        // Second, sequential: left |6 - 7| = 1, right |7 - 6| = 1, not longer: (6 + 7) / 2 = 6.5.
        // Third: left |7 - 6.5| = 0.5, right 2: (7 + 5) / 2 = 6.
        assert_eq!(smoothed(Smoothing::Sequential), [7e3, 6.5e3, 6e3]);
        // Simultaneous, second: left |6 - 9| = 3 > right 1: (9 + 6) / 2 = 7.5.
        // Third: left |7 - 6| = 1, right 2: 6.
        assert_eq!(smoothed(Smoothing::Simultaneous), [7e3, 7.5e3, 6e3]);
    }
}
