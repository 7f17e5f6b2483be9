//! Elementary functions that give the same bytes on every machine.
//!
//! The platform's math library differs from machine to machine, so nothing that decides a result may
//! call it. Rare calls go to the `libm` crate; `exp` and `acos`, which bound the hot loops, are written
//! here without branches so that the compiler can run two or more lanes at once.

#![expect(clippy::excessive_precision, reason = "constants as they were published")]

/// A point or vector (x, y, z) in metres, z the depth, positive down.
pub type Vec3 = [f64; 3];
/// A horizontal vector (x, y).
pub type Vec2 = [f64; 2];

/// a - b.
#[inline]
pub fn sub(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// a + s b.
#[inline]
pub fn add_scaled(a: Vec3, s: f64, b: Vec3) -> Vec3 {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

/// Scalar product.
#[inline]
pub fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Euclidean length.
#[inline]
pub fn norm(a: Vec3) -> f64 {
    dot(a, a).sqrt()
}

/// Euclidean distance.
#[inline]
pub fn distance(a: Vec3, b: Vec3) -> f64 {
    norm(sub(a, b))
}

/// ln 2 in two parts, the first with zeros at its end, so that an integer times it is exact.
pub(crate) const LN2_HIGH: f64 = 6.931_471_803_691_238_164_9e-1;
pub(crate) const LN2_LOW: f64 = 1.908_214_929_270_587_700_0e-10;
/// Adding and taking away 1.5 * 2^52 rounds to the nearest integer and leaves it in the low bits.
pub(crate) const ROUNDER: f64 = 6_755_399_441_055_744.0;
/// 1/n!: Taylor to degree 12 leaves less than 2e-16 for |r| <= ln 2 / 2.
pub(crate) const EXP_TAYLOR: [f64; 13] = [
    1.0,
    1.0,
    0.5,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 720.0,
    1.0 / 5_040.0,
    1.0 / 40_320.0,
    1.0 / 362_880.0,
    1.0 / 3_628_800.0,
    1.0 / 39_916_800.0,
    1.0 / 479_001_600.0,
];

/// e^x, to 2 units in the last place for -708 <= x <= 709; clamped outside.
#[inline]
pub fn exp(x: f64) -> f64 {
    let x = if x < -708.0 { -708.0 } else { x };
    let x = if x > 709.0 { 709.0 } else { x };
    let shifted = x * std::f64::consts::LOG2_E + ROUNDER;
    let n = shifted - ROUNDER;
    let r = (x - n * LN2_HIGH) - n * LN2_LOW;
    // Estrin's order: the products do not wait for each other.
    let c = &EXP_TAYLOR;
    let (r2, pair) = (r * r, |i: usize| c[i] + c[i + 1] * r);
    let (r4, quad) = (r2 * r2, |i: usize| pair(i) + pair(i + 2) * r2);
    let p = (quad(0) + quad(4) * r4) + (quad(8) + c[12] * r4) * (r4 * r4);
    let scale = f64::from_bits(shifted.to_bits().wrapping_add(1023) << 52);
    p * scale
}

/// arccos of x, clamped to [-1, 1]; rational approximation after fdlibm, relative error below 1e-15.
#[inline]
pub fn acos(x: f64) -> f64 {
    let a = x.abs();
    let a = if a > 1.0 { 1.0 } else { a };
    let small = a <= 0.5;
    let z = if small { a * a } else { (1.0 - a) * 0.5 };
    let s = if small { a } else { z.sqrt() };
    let p = z
        * (1.666_666_666_666_666_574_15e-1
            + z * (-3.255_658_186_224_009_154_05e-1
                + z * (2.012_125_321_348_629_258_81e-1
                    + z * (-4.005_553_450_067_941_140_27e-2
                        + z * (7.915_349_942_898_145_321_76e-4 + z * 3.479_331_075_960_211_675_70e-5)))));
    let q = 1.0
        + z * (-2.403_394_911_734_414_218_78
            + z * (2.020_945_760_233_505_694_71
                + z * (-6.882_839_716_054_532_930_30e-1 + z * 7.703_815_055_590_193_527_91e-2)));
    let arcsine = s + s * (p / q);
    let positive = if small { std::f64::consts::FRAC_PI_2 - arcsine } else { 2.0 * arcsine };
    if x < 0.0 { std::f64::consts::PI - positive } else { positive }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exp_agrees_with_libm() {
        for i in 0..200_000 {
            let x = -700.0 + 0.007 * f64::from(i);
            let (ours, reference) = (exp(x), libm::exp(x));
            assert!((ours / reference - 1.0).abs() < 1e-15, "exp({x}) = {ours:e}, libm {reference:e}");
        }
        assert_eq!(exp(0.0), 1.0);
    }

    #[test]
    fn acos_agrees_with_libm() {
        for i in -100_000..=100_000 {
            let x = f64::from(i) / 100_000.0;
            assert!((acos(x) - libm::acos(x)).abs() < 1e-15, "acos({x})");
        }
        assert_eq!(acos(1.5), 0.0);
    }
}
