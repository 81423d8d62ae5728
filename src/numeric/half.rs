//! Binary16: correct rounding of an f64 to the nearest half, ties to even.
//!
//! `half::f16::from_f64` drops the low 32 bits of the mantissa before it rounds, and going through
//! f32 rounds twice; both are wrong on some inputs.

use super::lanes::ROUND_F64;

/// The largest finite half.
pub const LARGEST: f64 = 65504.0;

/// The smallest normal half, 2^-14.
const SMALLEST_NORMAL: f64 = 1.0 / 16384.0;

/// The bits of a mantissa of 52 that a half, which has 10, drops.
const DROPPED: u32 = 42;

/// The dropped bits at a boundary of rounding: half a unit of those that stay.
const BOUNDARY: u64 = 1 << (DROPPED - 1);

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

/// The half nearest to every number that is at most `error` from `value`; NaN where they are not
/// all nearest to the same, and below the smallest normal half, for [`nearest`] to tell.
#[inline(always)]
pub fn nearest_to_all(value: f64, error: f64) -> f64 {
    // Of positive numbers with the same upper bits, half round down, the others up, and a carry
    // runs into the exponent.
    let (low, high) = (value - error, value + error);
    // Both ends one unit outwards, since sum and difference are rounded; and what lies on a
    // boundary belongs to neither half.
    let first = low.to_bits().wrapping_add(BOUNDARY - 2) >> DROPPED;
    let last = high.to_bits().wrapping_add(BOUNDARY + 1) >> DROPPED;
    let normal = low > SMALLEST_NORMAL && high < LARGEST;
    // Without a branch, for lanes.
    let half = f64::from_bits(last << DROPPED);
    if normal & (first == last) { half } else { f64::NAN }
}

/// The bits of [`nearest`].
pub fn round(value: f64) -> u16 {
    let sign = if value.is_sign_negative() { 0x8000 } else { 0 };
    let size = value.abs();
    if (SMALLEST_NORMAL..LARGEST).contains(&size) {
        // What is dropped rounds up from half a unit on, or beyond it where the unit is even
        // already; the exponent is stored 15 too large in place of 1023.
        let (bits, odd) = (size.to_bits(), size.to_bits() >> DROPPED & 1);
        let rounded = (bits + (BOUNDARY - 1) + odd) >> DROPPED;
        return sign | (rounded - ((1023 - 15) << 10)) as u16;
    }
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
