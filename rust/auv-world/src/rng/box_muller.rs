//! Four normals at once: the logarithm and the cosine of Box and Muller in lanes, bit for bit those of the `libm`
//! crate (fdlibm's), for the arguments that occur here.

#![expect(clippy::excessive_precision, reason = "constants as they were published")]

use wide::f64x4;

use crate::lanes::LANES;

/// ln 2 in two parts.
const LN2: [f64; 2] = [6.931_471_803_691_238_164_90e-1, 1.908_214_929_270_587_700_02e-10];
/// Of the logarithm's series.
const LOG: [f64; 7] = [
    6.666_666_666_666_735_130e-1,
    3.999_999_999_940_941_908e-1,
    2.857_142_874_366_239_149e-1,
    2.222_219_843_214_978_396e-1,
    1.818_357_216_161_805_012e-1,
    1.531_383_769_920_937_332e-1,
    1.479_819_860_511_658_591e-1,
];
/// Of the cosine's.
const COS: [f64; 6] = [
    4.166_666_666_666_660_190_37e-2,
    -1.388_888_888_887_410_957_49e-3,
    2.480_158_728_947_672_941_78e-5,
    -2.755_731_435_139_066_330_35e-7,
    2.087_572_321_298_174_827_90e-9,
    -1.135_964_755_778_819_482_65e-11,
];
/// Of the sine's.
const SIN: [f64; 6] = [
    -1.666_666_666_666_663_243_48e-1,
    8.333_333_333_322_489_461_24e-3,
    -1.984_126_982_985_794_931_34e-4,
    2.755_731_370_707_006_767_89e-6,
    -2.505_076_025_340_686_341_95e-8,
    1.589_690_995_211_550_102_21e-10,
];
/// pi / 2 in two parts, the first with zeros at its end, so that up to four of it are exact.
const HALF_PI: [f64; 2] = [1.570_796_326_734_125_614_17, 6.077_100_506_506_192_249_32e-11];
/// High words of the greatest arguments that lie nearest to 0, 1, 2 and 3 halves of pi.
const NEAREST_TO: [u64; 4] = [0x3fe9_21fb, 0x4002_d97c, 0x400f_6a7a, 0x4015_fdbc];
/// So near to a multiple of pi / 2 two parts of it do not suffice.
const CANCELS: f64 = 1e-3;

/// Factors of normals, sqrt(-2 ln(1 - a)) and cos(2 pi b), of uniform `a` and `b` in [0, 1).
#[inline]
pub(super) fn factors(a: [f64; LANES], b: [f64; LANES]) -> [f64x4; 2] {
    let radius = (f64x4::splat(-2.0) * log(f64x4::ONE - f64x4::new(a))).sqrt();
    [radius, cos(f64x4::splat(std::f64::consts::TAU) * f64x4::new(b))]
}

/// Natural logarithms of normal numbers above zero.
#[inline]
fn log(x: f64x4) -> f64x4 {
    // x = 2^k times a number between sqrt(1/2) and sqrt(2).
    let (mut near, mut power) = ([0.0; LANES], [0.0; LANES]);
    for (lane, bits) in x.to_array().map(f64::to_bits).into_iter().enumerate() {
        let high = (bits >> 32) as u32 + (0x3ff0_0000 - 0x3fe6_a09e);
        power[lane] = f64::from((high >> 20) as i32 - 0x3ff);
        near[lane] = f64::from_bits(u64::from((high & 0x000f_ffff) + 0x3fe6_a09e) << 32 | bits & 0xffff_ffff);
    }
    let (c, k) = (|i: usize| f64x4::splat(LOG[i]), f64x4::new(power));
    let f = f64x4::new(near) - f64x4::ONE;
    let half_square = f64x4::HALF * f * f;
    let s = f / (f64x4::splat(2.0) + f);
    let z = s * s;
    let w = z * z;
    let even = w * (c(1) + w * (c(3) + w * c(5)));
    let odd = z * (c(0) + w * (c(2) + w * (c(4) + w * c(6))));
    let r = odd + even;
    s * (half_square + r) + k * f64x4::splat(LN2[1]) - half_square + f + k * f64x4::splat(LN2[0])
}

/// Cosines of numbers from 0 to 2 pi.
#[inline]
fn cos(x: f64x4) -> f64x4 {
    let n = NEAREST_TO.iter().fold(f64x4::ZERO, |n, high| {
        let beyond = x.simd_ge(f64x4::splat(f64::from_bits((high + 1) << 32)));
        n + beyond.select(f64x4::ONE, f64x4::ZERO)
    });
    let (high, low) = (n * f64x4::splat(HALF_PI[0]), n * f64x4::splat(HALF_PI[1]));
    let rest = x - high;
    let y = rest - low;
    let tail = (rest - y) - low;
    let (one, three) = (n.simd_eq(f64x4::ONE), n.simd_eq(f64x4::splat(3.0)));
    let turned = one | n.simd_eq(f64x4::splat(2.0));
    let value = (one | three).select(sin_near_zero(y, tail), cos_near_zero(y, tail));
    let value = turned.select(-value, value);
    let cancels = y.abs().simd_lt(f64x4::splat(CANCELS)) & n.simd_gt(f64x4::ZERO);
    if cancels.any() {
        return f64x4::new(x.to_array().map(libm::cos));
    }
    value
}

#[inline(always)]
fn cos_near_zero(x: f64x4, tail: f64x4) -> f64x4 {
    let c = |i: usize| f64x4::splat(COS[i]);
    let z = x * x;
    let w = z * z;
    let r = z * (c(0) + z * (c(1) + z * c(2))) + w * w * (c(3) + z * (c(4) + z * c(5)));
    let half = f64x4::HALF * z;
    let w = f64x4::ONE - half;
    w + (((f64x4::ONE - w) - half) + (z * r - x * tail))
}

#[inline(always)]
fn sin_near_zero(x: f64x4, tail: f64x4) -> f64x4 {
    let s = |i: usize| f64x4::splat(SIN[i]);
    let z = x * x;
    let w = z * z;
    let r = s(1) + z * (s(2) + z * s(3)) + z * w * (s(4) + z * s(5));
    let v = z * x;
    x - ((z * (f64x4::HALF * tail - v * r) - tail) - v * s(0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{Purpose, Stream};

    fn each(x: [f64; LANES], lanes: fn(f64x4) -> f64x4, alone: fn(f64) -> f64) {
        let together = lanes(f64x4::new(x)).to_array();
        for lane in 0..LANES {
            assert_eq!(together[lane].to_bits(), alone(x[lane]).to_bits(), "{:e}", x[lane]);
        }
    }

    #[test]
    fn each_is_what_libm_has() {
        let mut stream = Stream::new(5, Purpose::Planner, 0);
        for _ in 0..200_000 {
            each(std::array::from_fn(|_| 1.0 - stream.unit()), log, libm::log);
            each(std::array::from_fn(|_| std::f64::consts::TAU * stream.unit()), cos, libm::cos);
        }
        each([1.0, f64::EPSILON / 2.0, 0.5, 1.0 - f64::EPSILON / 2.0], log, libm::log);
    }

    #[test]
    fn at_the_ends_and_at_multiples_of_half_pi() {
        let last = std::f64::consts::TAU * (1.0 - f64::EPSILON / 2.0);
        each([0.0, 1e-300, 1e-9, last], cos, libm::cos);
        for n in 1..4 {
            let at = f64::from(n) * std::f64::consts::FRAC_PI_2;
            for bits in 0..52 {
                let off = f64::from_bits(at.to_bits() ^ 1 << bits);
                each([at, off, at - (off - at), 1.0], cos, libm::cos);
                each([off, 0.1, 0.2, 0.3], cos, libm::cos);
            }
        }
        for high in NEAREST_TO {
            let [at, next] = [high, high + 1].map(|high| f64::from_bits(high << 32));
            each([at, next, f64::from_bits(next.to_bits() - 1), f64::from_bits(next.to_bits() + 1)], cos, libm::cos);
        }
    }
}
