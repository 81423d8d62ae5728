//! Special functions of the models. In f64 they come from libm, the same bits everywhere; their twins on a device use
//! only + - × ÷, since a driver's own exp and log may be off by dozens of ulps.

use std::f64::consts::{LN_2, PI};

/// exp(x).
pub fn exponential(x: f64) -> f64 {
    libm::exp(x)
}

/// e^r - 1.
pub fn expm1_reduced(r: f64) -> f64 {
    libm::expm1(r)
}

/// 2^k for a whole number k.
pub fn power_of_two(k: f64) -> f64 {
    libm::ldexp(1.0, k as i32)
}

/// x^(head + rest) for x > 0 as 2^k and e^r - 1, |r| ≤ ln(2)/2: nearly twice the digits of one number in f32.
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

/// ln(1+u)/u for u ≥ 0, 1 at u = 0.
pub fn log1p_ratio(u: f64) -> f64 {
    if u == 0.0 { 1.0 } else { libm::log1p(u) / u }
}

/// i¹erfc(a) = exp(-a²)/√π - a erfc(a), the integral of erfc from a ≥ 0 to ∞ (Abramowitz and Stegun, 7.2.1).
pub fn ierfc(a: f64) -> f64 {
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
