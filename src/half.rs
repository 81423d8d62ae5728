//! Binary16: correct rounding of an f64 to the nearest half, ties to even.
//!
//! `half::f16::from_f64` drops the low 32 bits of the mantissa before it rounds, and going through f32 rounds twice; both
//! are wrong on some inputs.

/// The largest finite half.
pub const LARGEST: f64 = 65504.0;

/// The bits of the half nearest to `value`, ties to even; beyond the largest half by half a step or more, infinity.
pub fn round(value: f64) -> u16 {
    let sign = if value.is_sign_negative() { 0x8000 } else { 0 };
    let v = value.abs();
    if v.is_nan() {
        return 0x7e00;
    }
    // The step between halves at v: 2^(e-10) for 2^e <= v < 2^(e+1), and never below 2^-24. A division by a power of two
    // is exact, so the one rounding is round_ties_even's.
    let exponent = ((v.to_bits() >> 52) as i32 - 1023).max(-14);
    if exponent > 15 {
        return sign | 0x7c00;
    }
    let steps = (v / libm::ldexp(1.0, exponent - 10)).round_ties_even() as u16;
    // A carry out of the mantissa runs into the exponent, which is just what the next binade is.
    sign | ((((exponent + 14) as u16) << 10) + steps)
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
