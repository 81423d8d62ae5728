//! The curve of sRGB (IEC 61966-2-1): the linear value of each of 256 codes, and the code that is
//! nearest to a linear value.

use std::sync::OnceLock;

/// The linear value of a code.
pub fn value(code: u8) -> f64 {
    values()[usize::from(code)]
}

/// The code whose linear value is nearest, and of two the even one.
pub fn code(value: f64) -> u8 {
    let values = values();
    // The first code whose value is not below.
    let above = values.partition_point(|&of_code| of_code < value);
    match above {
        0 => 0,
        256 => 255,
        above => {
            let (low, high) = (value - values[above - 1], values[above] - value);
            let upper = high < low || high == low && above % 2 == 0;
            if upper { above as u8 } else { (above - 1) as u8 }
        }
    }
}

/// The linear value that is stored; the value itself where it lies outside of [0, 1] by more than
/// half of the step there.
pub fn nearest(linear: f64) -> f64 {
    let stored = value(code(linear));
    let outside = !(0.0..=1.0).contains(&linear);
    let step = if linear < 0.0 { value(1) } else { 1.0 - value(254) };
    if outside && (linear - stored).abs() > 0.5 * step || linear.is_nan() { linear } else { stored }
}

/// The distance of a linear value from the nearest one at which its code changes.
pub fn distance_to_boundary(linear: f64) -> f64 {
    let code = code(linear);
    let middle = |other: u8| 0.5 * (value(code) + value(other));
    let below = code.checked_sub(1).map_or(f64::INFINITY, |other| linear - middle(other));
    let above = code.checked_add(1).map_or(f64::INFINITY, |other| middle(other) - linear);
    below.min(above).max(0.0)
}

fn values() -> &'static [f64; 256] {
    static VALUES: OnceLock<[f64; 256]> = OnceLock::new();
    VALUES.get_or_init(|| std::array::from_fn(|code| linear(code as f64 / 255.0)))
}

/// The curve itself.
pub fn linear(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}
