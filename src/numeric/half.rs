//! Binary16: correct rounding of an f64 to the nearest half, ties to even.
//!
//! `half::f16::from_f64` drops the low 32 bits of the mantissa before it rounds, and going through
//! f32 rounds twice; both are wrong on some inputs.

use super::lanes::ROUND_F64;

/// The largest finite half.
pub const LARGEST: f64 = 65504.0;

/// The step between halves at the finite `value`: 2^(e-10) for 2^e <= |value| < 2^(e+1), and never
/// below 2^-24.
pub fn step(value: f64) -> f64 {
    // The exponent of an f64 is stored 1023 too large; the smallest normal half is 2^-14.
    let exponent = (value.abs().to_bits() >> 52).max(1023 - 14);
    f64::from_bits((exponent - 10) << 52)
}

/// The half nearest to `value`, ties to even; beyond the largest half by half a step or more,
/// infinity.
pub fn nearest(value: f64) -> f64 {
    // Steps are powers of two, so that the only rounding is that to a whole number of them. A carry
    // out of the mantissa gives the first half of the next binade.
    let step = step(value);
    // Exponents of a number and its reciprocal add up to 2046, twice 1023.
    let inverse = f64::from_bits((2046 << 52) - step.to_bits());
    let nearest = ((value * inverse + ROUND_F64) - ROUND_F64) * step;
    if nearest.abs() > LARGEST { f64::INFINITY.copysign(value) } else { nearest }
}

/// The bits of [`nearest`].
pub fn round(value: f64) -> u16 {
    let sign = if value.is_sign_negative() { 0x8000 } else { 0 };
    let v = nearest(value).abs();
    if v.is_nan() {
        return 0x7e00;
    }
    if v == f64::INFINITY {
        return sign | 0x7c00;
    }
    let step = step(v);
    // Below 2^-14 the steps are subnormals; above, the leading one of the mantissa runs into the
    // exponent.
    let exponent = (step.to_bits() >> 52) as u16 - (1023 - 24);
    sign | ((exponent << 10) + (v / step) as u16)
}

/// The value of a half.
pub fn value(bits: u16) -> f64 {
    let sign = if bits & 0x8000 == 0 { 1.0 } else { -1.0 };
    let (exponent, mantissa) = (i32::from(bits >> 10 & 0x1f), f64::from(bits & 0x3ff));
    sign * match exponent {
        0 => libm::ldexp(mantissa, -24),
        31 if mantissa == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        _ => libm::ldexp(1024.0 + mantissa, exponent - 25),
    }
}
