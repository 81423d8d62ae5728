//! Special functions of the models. In f64 they come from libm, the same bits everywhere, but for
//! those that integrands take at every evaluation: these are written out, so that they run in
//! vector registers. Their twins on a device use only + - × ÷, since a driver's own exp and log may
//! err by dozens of ulps.

use crate::numeric::lanes::{ROUND_F64, Real};
use std::f64::consts::{LN_2, LOG2_E, PI, SQRT_2};

/// The polynomial with these coefficients, ascending, by four interleaved schemes of Horner's in
/// x⁴: one alone would wait for each product and sum before the next.
#[inline(always)]
fn polynomial<R: Real, const N: usize>(x: R, coefficients: &[f64; N]) -> R {
    const { assert!(N.is_multiple_of(4)) };
    let (x2, mut sums) = (x * x, [R::from(0.0); 4]);
    let x4 = x2 * x2;
    for (k, sum) in sums.iter_mut().enumerate() {
        *sum = R::from(coefficients[N - 4 + k]);
    }
    for n in (0..N / 4 - 1).rev() {
        for k in 0..4 {
            sums[k] = sums[k] * x4 + coefficients[4 * n + k];
        }
    }
    sums[0] + sums[1] * x + x2 * (sums[2] + sums[3] * x)
}

/// 1/n! for n up to 15.
const INVERSE_FACTORIALS: [f64; 16] = {
    let (mut values, mut factorial, mut n) = ([1.0; 16], 1.0, 1);
    while n < 16 {
        factorial *= n as f64;
        values[n] = 1.0 / factorial;
        n += 1;
    }
    values
};

/// 1/(2n+1) for n up to 11: the coefficients of atanh(s)/s in s².
const INVERSE_ODDS: [f64; 12] = {
    let (mut values, mut n) = ([1.0; 12], 1);
    while n < 12 {
        values[n] = 1.0 / (2 * n + 1) as f64;
        n += 1;
    }
    values
};

/// exp(x) for x ≤ 709, within 2 ulps: 2^k e^r with |r| ≤ ln(2)/2, by Taylor's series to r^15, whose
/// rest is 2e-21. 0 below e^-650, since products with such numbers are subnormal, and slow.
#[inline(always)]
pub fn exponential<R: Real>(x: R) -> R {
    // ln 2 in two parts, the first with 32 bits, so that its product with k is exact.
    const HEAD: f64 = 0.693_147_180_369_123_8;
    const REST: f64 = 1.908_214_929_270_587_7e-10;
    let floor = R::from(-650.0);
    let (below, x) = (x, x.max(floor));
    let k = (x * LOG2_E).nearest_whole();
    let r = x - k * HEAD - k * REST;
    let sum = polynomial(r, &INVERSE_FACTORIALS);
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

/// ln x for normal x > 0, within 2 ulps of the larger of 1 and |ln x|: with x = 2^k m and s =
/// (m-1)/(m+1), k ln 2 + 2 atanh(s).
#[inline(always)]
pub fn logarithm<R: Real>(x: R) -> R {
    let (k, m) = split(x);
    let s = (m - 1.0) / (m + 1.0);
    k * LN_2 + s * 2.0 * atanh_series(s * s)
}

/// ln(1+u)/u for u ≥ 0, 1 at u = 0, within 4 ulps: with 1+u = 2^k m, m near 1, and s = (m-1)/(m+1)
/// the logarithm is k ln 2 + 2 atanh(s).
#[inline(always)]
pub fn log1p_ratio<R: Real>(u: R) -> R {
    let (k, m) = split(u + 1.0);
    // Without a power of two, m - 1 is u itself, not the digits of it that are left in 1 + u.
    let near = R::from(0.5).select_below(k, (m - 1.0) / (m + 1.0), u / (u + 2.0));
    let sum = atanh_series(near * near);
    // Keeps 0/0 out; any u that is not 0 is far above it, or its logarithm is u.
    let tiny = R::from(1e-30);
    // Both parts divided by u, so that u → 0 has a limit: atanh(s)/u = (s/u) (1 + s²/3 + …).
    let s_by_u = R::from(0.5).select_below(k, near / u.max(tiny), (u + 2.0).recip());
    k * LN_2 / u.max(tiny) + s_by_u * 2.0 * sum
}

/// atanh(s)/s by the square of an s within ±(√2 - 1)/(√2 + 1): the series to s^23, whose rest is
/// 1e-20.
#[inline(always)]
fn atanh_series<R: Real>(s2: R) -> R {
    polynomial(s2, &INVERSE_ODDS)
}

/// k and m of a normal x = 2^k m with m from √½ to √2.
#[inline(always)]
fn split<R: Real>(x: R) -> (R, R) {
    let m = |x: f64| f64::from_bits(x.to_bits().wrapping_sub(carry(x)).wrapping_add(1022 << 52));
    (x.zip(x, |x, _| exponent(x)), x.zip(x, |x, _| m(x)))
}

/// The bits of the exponent of x/√2: those of x, one less where its mantissa lies below √2.
#[inline(always)]
fn carry(x: f64) -> u64 {
    const EXPONENT: u64 = 0x7ff0_0000_0000_0000;
    (x * (1.0 / SQRT_2)).to_bits() & EXPONENT
}

/// k of x = 2^k m with m from √½ to √2.
#[inline(always)]
fn exponent(x: f64) -> f64 {
    // 2^52 with the biased exponent as its low bits is the number 2^52 + k + 1022.
    const TWO_TO_52: u64 = 0x4330_0000_0000_0000;
    f64::from_bits((carry(x) >> 52) | TWO_TO_52) - (4_503_599_627_370_496.0 + 1022.0)
}

/// i¹erfc(a) = exp(-a²)/√π - a erfc(a), the integral of erfc from a ≥ 0 to ∞ (Abramowitz and
/// Stegun, 7.2.1), within 3e-16: exp(-a²), of which two units are 2.5e-16, times a polynomial in
/// (a - 3)/(a + 3).
#[inline(always)]
pub fn ierfc<R: Real>(a: R) -> R {
    let t = (a - 3.0) / (a + 3.0);
    exponential(-(a * a)) * polynomial(t, &IERFC)
}

/// The coefficients of [`ierfc`], by ascending powers: the least squares of the products' errors
/// over a ≤ 6.2, in 50 digits, where the largest is 1e-17. Beyond, the value is below 1e-18.
const IERFC: [f64; 16] = [
    0.027_186_130_003_646_607,
    -0.095_306_226_958_782_95,
    0.146_583_047_974_802_95,
    -0.139_880_549_216_336_47,
    0.095_469_730_025_541_02,
    -0.046_350_416_622_003_05,
    0.014_019_052_504_970_644,
    -0.000_913_557_703_793_492,
    -0.001_249_821_368_435_097_2,
    0.000_399_851_342_071_277_07,
    6.829_804_057_026_463e-5,
    -8.258_179_916_481_859e-5,
    -1.165_884_088_993_715_9e-5,
    1.377_655_601_103_583_9e-5,
    5.850_660_802_613_688e-6,
    7.498_552_512_314_354e-7,
];

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
