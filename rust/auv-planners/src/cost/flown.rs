//! What the path that a vehicle has flown costs, through maps that changed on the way.

use auv_world::World;
use auv_world::math::{Vec3, add_scaled, distance, sub};

use super::{Cost, CostOptions, path_cost};
use crate::error::PlanError;
use crate::sections::Frame;

/// A piece shorter than this is not counted (m).
const SHORTEST_M: f64 = 1.0;

/// The LFHH cost of a flown path, piece by piece in the map that the piece was flown in: each is cut anew at the
/// spacing of the sections, as the paper's paths are, and their costs are averaged by length. `None` if nothing
/// was flown.
///
/// # Errors
/// As [`path_cost`].
pub fn flown_cost(pieces: &[(&World, &[Vec3])]) -> Result<Option<f64>, PlanError> {
    let (mut total, mut flown_m) = (0.0, 0.0);
    for (world, piece) in pieces {
        let length_m = length(piece);
        if length_m >= SHORTEST_M {
            let path = cut(piece, length_m, Frame::new(world).spacing_m());
            total += length_m * path_cost(world, &path, Cost::Lfhh, &CostOptions::default())?.total;
            flown_m += length_m;
        }
    }
    Ok((flown_m > 0.0).then(|| total / flown_m))
}

fn length(path: &[Vec3]) -> f64 {
    path.windows(2).map(|pair| distance(pair[0], pair[1])).sum()
}

/// A path cut into equal steps of about `spacing` along its length.
fn cut(path: &[Vec3], length_m: f64, spacing: f64) -> Vec<Vec3> {
    let steps = (length_m / spacing).round().max(1.0) as usize;
    let mut points = Vec::with_capacity(steps + 1);
    points.extend(path.first());
    let mut passed = 0.0;
    for pair in path.windows(2) {
        let step = distance(pair[0], pair[1]);
        while points.len() < steps {
            let along = length_m * points.len() as f64 / steps as f64 - passed;
            if along > step {
                break;
            }
            let part = if step > 0.0 { along / step } else { 0.0 };
            points.push(add_scaled(pair[0], part, sub(pair[1], pair[0])));
        }
        passed += step;
    }
    points.extend(path.last());
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn cuts_are_even_along_the_way() {
        let path = [[0.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 3.0, 0.0], [4.0, 3.0, 0.0], [4.0, 3.0, 3.0]];
        let points = cut(&path, length(&path), 2.1);
        let expected =
            [[0.0, 0.0, 0.0], [0.0, 2.0, 0.0], [1.0, 3.0, 0.0], [3.0, 3.0, 0.0], [4.0, 3.0, 1.0], [4.0, 3.0, 3.0]];
        assert_eq!(points, expected);
        assert_eq!(cut(&path, length(&path), 1e9), [path[0], path[4]]);
    }

    #[test]
    fn pieces_are_averaged_by_their_length() {
        let world = testing::paper_world("lfhh-3d-1", 0);
        let frame = Frame::new(&world);
        let path: Vec<Vec3> = (3..20).map(|section| frame.point(section, 9000.0, 4000.0)).collect();
        let cost = |path: &[Vec3]| path_cost(&world, path, Cost::Lfhh, &CostOptions::default()).unwrap().total;
        assert_eq!(flown_cost(&[(&world, &path)]).unwrap(), Some(cost(&path)));
        let mean = (4.0 * cost(&path[..5]) + 12.0 * cost(&path[4..])) / 16.0;
        let found = flown_cost(&[(&world, &path[..5]), (&world, &path[4..])]).unwrap().unwrap();
        assert!((found - mean).abs() < 1e-12, "{found} {mean}");
        assert_eq!(flown_cost(&[(&world, &path[..1])]).unwrap(), None);
    }
}
