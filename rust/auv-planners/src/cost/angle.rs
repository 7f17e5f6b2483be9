//! The angle between two horizontal vectors, without branches, so that several lanes run at once.

/// atan(sqrt t) / sqrt t for t in 0 ..= 1, coefficients of 1, t, t^2 ...: a Chebyshev fit to 2e-12.
const ARCTANGENT: [f64; 14] = [
    0.999_999_999_998_196_7,
    -0.333_333_332_624_797,
    0.199_999_953_403_850_63,
    -0.142_855_923_942_825_29,
    0.111_094_283_643_305_06,
    -0.090_767_988_766_504_77,
    0.076_142_501_990_031_21,
    -0.063_660_922_360_968_26,
    0.050_455_577_528_416_146,
    -0.035_267_720_869_422_44,
    0.019_937_442_836_256_17,
    -0.008_241_899_893_996_813,
    0.002_162_794_422_156_479,
    -0.000_266_601_967_192_674_25,
];

/// The angle (rad, 0 ..= pi, to 2e-12) between vectors of the given scalar and cross product; pi / 2 if
/// both are 0.
#[inline(always)]
pub fn between(dot: f64, cross: f64) -> f64 {
    let (along, across) = (dot.abs(), cross.abs());
    let steep = across >= along;
    let small = if steep { along } else { across };
    let large = if steep { across } else { along };
    let ratio = small / if large > f64::MIN_POSITIVE { large } else { f64::MIN_POSITIVE };
    let angle = ratio * series(ratio * ratio);
    let angle = if steep { std::f64::consts::FRAC_PI_2 - angle } else { angle };
    if dot < 0.0 { std::f64::consts::PI - angle } else { angle }
}

/// The series by its even and odd terms: two short chains instead of a long one.
#[inline(always)]
fn series(t: f64) -> f64 {
    let t2 = t * t;
    let (mut even, mut odd) = (ARCTANGENT[12], ARCTANGENT[13]);
    for k in (0..6).rev() {
        even = even * t2 + ARCTANGENT[2 * k];
        odd = odd * t2 + ARCTANGENT[2 * k + 1];
    }
    even + t * odd
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_libm_all_around() {
        for i in 0..=200_000 {
            let angle = std::f64::consts::TAU * f64::from(i) / 200_000.0;
            let (dot, cross) = (3.0 * libm::cos(angle), 3.0 * libm::sin(angle));
            let expected = libm::atan2(cross.abs(), dot);
            assert!((between(dot, cross) - expected).abs() < 3e-12, "{angle}");
        }
    }

    #[test]
    fn without_a_direction_it_is_a_right_angle() {
        assert_eq!(between(0.0, 0.0), std::f64::consts::FRAC_PI_2);
        assert_eq!(between(0.0, 1.0), std::f64::consts::FRAC_PI_2);
        assert_eq!(between(1.0, 0.0), 0.0);
        assert_eq!(between(-1.0, 0.0), std::f64::consts::PI);
    }
}
