//! How things move between map changes: at constant velocity, reflected by the walls of the box.

/// Where `start` is after `travel` metres along one axis between two walls.
#[inline]
pub fn reflect(start: f64, travel: f64, low: f64, high: f64) -> f64 {
    let width = high - low;
    if travel == 0.0 {
        return start;
    }
    if width <= 0.0 {
        return low;
    }
    // Unfolded, the walls repeat with period 2 * width; every second image runs backwards.
    let unfolded = (start - low + travel).rem_euclid(2.0 * width);
    low + if unfolded <= width { unfolded } else { 2.0 * width - unfolded }
}

/// Whether, after `travel`, it runs back: it has met the walls an odd number of times.
pub fn reflects(start: f64, travel: f64, low: f64, high: f64) -> bool {
    let width = high - low;
    travel != 0.0 && width > 0.0 && (start - low + travel).rem_euclid(2.0 * width) > width
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn bounces() {
        assert_eq!(reflect(8.0, 4.0, 0.0, 10.0), 8.0);
        assert_eq!(reflect(8.0, -9.0, 0.0, 10.0), 1.0);
        assert_eq!(reflect(8.0, 0.0, 0.0, 10.0), 8.0);
        assert!(reflects(8.0, 4.0, 0.0, 10.0) && !reflects(8.0, 1.0, 0.0, 10.0));
    }

    proptest! {
        #[test]
        fn stays_inside_and_comes_back(start in 0.0..10.0_f64, travel in -1e4..1e4_f64) {
            let there = reflect(start, travel, 0.0, 10.0);
            prop_assert!((0.0..=10.0).contains(&there));
            prop_assert!((reflect(start, travel + 20.0, 0.0, 10.0) - there).abs() < 1e-9);
        }
    }
}
