//! Special functions of the models. In f64 they come from libm, the same bits everywhere, but for
//! those that integrands take at every evaluation: these are written out, so that they run in
//! vector registers. Their twins on a device use only + - × ÷, since a driver's own exp and log may
//! err by dozens of ulps.

use crate::numeric::lanes::{ROUND_F64, Real};
use std::f64::consts::{LN_2, LOG2_E, PI, SQRT_2};

/// exp(x) for x ≤ 709, within 2 ulps: 2^k e^r with |r| ≤ ln(2)/2, by Taylor's series to r^13, whose
/// rest is 4e-18. 0 below e^-650, since products with such numbers are subnormal, and slow.
#[inline(always)]
pub fn exponential<R: Real>(x: R) -> R {
    // ln 2 in two parts, the first with 32 bits, so that its product with k is exact.
    const HEAD: f64 = 0.693_147_180_369_123_8;
    const REST: f64 = 1.908_214_929_270_587_7e-10;
    let floor = R::from(-650.0);
    let (below, x) = (x, x.max(floor));
    let k = (x * LOG2_E).nearest_whole();
    let r = x - k * HEAD - k * REST;
    let mut sum = r * (1.0 / 13.0) + 1.0;
    for n in (1..13).rev() {
        sum = sum * r * (1.0 / f64::from(n)) + 1.0;
    }
    // Adding ROUND_F64 leaves k in the low bits; 52 places up they are an exponent, 1023 too small.
    let power = k.zip(k, |k, _| {
        f64::from_bits((k + ROUND_F64).to_bits().wrapping_shl(52).wrapping_add(1023 << 52))
    });
    below.select_below(floor, R::from(0.0), sum * power)
}

/// sinh(x) for |x| ≤ 600 within 4 ulps: by Taylor's series to x^19 up to 1, whose rest is 2e-20,
/// else by exponentials.
#[inline(always)]
pub fn hyperbolic_sine<R: Real>(x: R) -> R {
    let x2 = x * x;
    let mut sum = R::from(1.0);
    for n in (1..10).rev() {
        sum = sum * x2 * (1.0 / f64::from(2 * n * (2 * n + 1))) + 1.0;
    }
    let e = exponential(x);
    x2.select_below(R::from(1.0), x * sum, (e - e.recip()) * 0.5)
}

/// e^r - 1.
pub fn expm1_reduced(r: f64) -> f64 {
    libm::expm1(r)
}

/// 2^k for a whole number k.
pub fn power_of_two(k: f64) -> f64 {
    libm::ldexp(1.0, k as i32)
}

/// x^(head + rest) for x > 0 as 2^k and e^r - 1, |r| ≤ ln(2)/2: nearly twice the digits of one
/// number in f32.
pub fn power_parts(x: f64, head: f64, rest: f64) -> (f64, f64) {
    let exponent = (head + rest) * libm::log2(x);
    let k = (exponent + 0.5).floor();
    (power_of_two(k), expm1_reduced((exponent - k) * LN_2))
}

/// k and ln m of x = 2^k m > 0, 1 ≤ m < 2.
pub fn logarithm_parts(x: f64) -> (f64, f64) {
    let k = libm::log2(x).floor();
    (k, libm::log(x / power_of_two(k)))
}

/// ln x, for x > 0.
pub fn logarithm(x: f64) -> f64 {
    libm::log(x)
}

/// ln(1+u)/u for u ≥ 0, 1 at u = 0, within 4 ulps: with 1+u = 2^k m, m near 1, and s = (m-1)/(m+1)
/// the logarithm is k ln 2 + 2 atanh(s), atanh by its series to s^23, whose rest is 1e-20.
#[inline(always)]
pub fn log1p_ratio<R: Real>(u: R) -> R {
    let y = u + 1.0;
    let k = y.zip(u, |y, _| exponent(y));
    let m = y.zip(u, |y, _| f64::from_bits(mantissa_bits(y)));
    // Without a power of two, m - 1 is u itself, not the digits of it that are left in 1 + u.
    let near = R::from(0.5).select_below(k, (m - 1.0) / (m + 1.0), u / (u + 2.0));
    let s2 = near * near;
    let mut sum = R::from(1.0 / 23.0);
    for n in (0..11).rev() {
        sum = sum * s2 + 1.0 / f64::from(2 * n + 1);
    }
    // Keeps 0/0 out; any u that is not 0 is far above it, or its logarithm is u.
    let tiny = R::from(1e-30);
    // Both parts divided by u, so that u → 0 has a limit: atanh(s)/u = (s/u) (1 + s²/3 + …).
    let s_by_u = R::from(0.5).select_below(k, near / u.max(tiny), (u + 2.0).recip());
    k * LN_2 / u.max(tiny) + s_by_u * 2.0 * sum
}

/// The bits of the exponent of y/√2: those of y, one less where its mantissa lies below √2.
#[inline(always)]
fn carry(y: f64) -> u64 {
    const EXPONENT: u64 = 0x7ff0_0000_0000_0000;
    (y * (1.0 / SQRT_2)).to_bits() & EXPONENT
}

/// k of y = 2^k m with m from √½ to √2.
#[inline(always)]
fn exponent(y: f64) -> f64 {
    // 2^52 with the biased exponent as its low bits is the number 2^52 + k + 1022.
    const TWO_TO_52: u64 = 0x4330_0000_0000_0000;
    f64::from_bits((carry(y) >> 52) | TWO_TO_52) - (4_503_599_627_370_496.0 + 1022.0)
}

/// The bits of m of the same: those of y with its exponent taken out.
#[inline(always)]
fn mantissa_bits(y: f64) -> u64 {
    y.to_bits().wrapping_sub(carry(y)).wrapping_add(1022 << 52)
}

/// i¹erfc(a) = exp(-a²)/√π - a erfc(a), the integral of erfc from a ≥ 0 to ∞ (Abramowitz and
/// Stegun, 7.2.1).
pub fn ierfc(a: f64) -> f64 {
    debug_assert!(a >= 0.0 || a.is_nan(), "{a}");
    libm::exp(-a * a) / PI.sqrt() - a * libm::erfc(a)
}

/// atanh(s)/s by the square of s.
pub fn atanh_ratio(s2: f64) -> f64 {
    if s2 == 0.0 { 1.0 } else { libm::atanh(s2.sqrt()) / s2.sqrt() }
}

/// arccos(x).
pub fn arc_cosine(x: f64) -> f64 {
    libm::acos(x)
}

/// ln B(p, q) for p, q ≥ 1, within 1e-14 of 1 + |ln B|: by ln Γ where both are small, else by
/// Stirling's series, whose leading terms would cancel (Didonato and Morris 1992, "Algorithm 708").
pub fn log_beta(p: f64, q: f64) -> f64 {
    let (p, q) = (p.min(q), p.max(q));
    if q < STIRLING {
        return libm::lgamma(p) + libm::lgamma(q) - libm::lgamma(p + q);
    }
    // ln Γ(q) - ln Γ(p + q) with the leading terms taken together.
    let sum = p + q;
    if p < STIRLING {
        let quotient = p - (q - 0.5) * libm::log1p(p / q) - p * libm::log(sum);
        return libm::lgamma(p) + quotient + stirling_rest(q) - stirling_rest(sum);
    }
    let rests = stirling_rest(p) + stirling_rest(q) - stirling_rest(sum);
    let ratio = p / q;
    0.5 * libm::log(2.0 * PI / q) - (p - 0.5) * libm::log1p(1.0 / ratio) - q * libm::log1p(ratio)
        + rests
}

/// Above it the first eight terms of Stirling's series leave 1e-17.
const STIRLING: f64 = 16.0;

/// ln Γ(z) - (z - ½) ln z + z - ½ ln 2π for z ≥ [`STIRLING`] (Abramowitz and Stegun, 6.1.41).
fn stirling_rest(z: f64) -> f64 {
    const TERMS: [f64; 8] = [
        1.0 / 12.0,
        -1.0 / 360.0,
        1.0 / 1260.0,
        -1.0 / 1680.0,
        1.0 / 1188.0,
        -691.0 / 360_360.0,
        1.0 / 156.0,
        -3617.0 / 122_400.0,
    ];
    let r = 1.0 / z;
    TERMS.iter().rev().fold(0.0, |sum, term| sum * r * r + term) * r
}
