//! RGBD: three channels of 8 bits on a curve of 2.2 over a divisor D of 8 bits, which they share:
//! value = (code/255)^2.2 / (D/255). D is 255 unless a value exceeds 1; then it is the largest that
//! keeps all codes in their range. Babylon.js stores its tables so (its shader functions toRGBD and
//! fromRGBD).

/// The exponent of the curve.
const GAMMA: f64 = 2.2;

/// The largest value: that of the largest code over the smallest divisor.
pub const LARGEST: f64 = 255.0;

/// The value of a code.
pub fn value(code: u8, divisor: u8) -> f64 {
    libm::pow(f64::from(code) / 255.0, GAMMA) * 255.0 / f64::from(divisor)
}

/// The codes of a texel's values, each in [0, [`LARGEST`]], and their divisor. The values that are
/// stored have the same codes and the same divisor again.
pub fn codes(values: &[f64]) -> (Vec<u8>, u8) {
    let largest = values.iter().copied().fold(1.0, f64::max);
    let divisor = largest_divisor(largest);
    // The largest value may be stored as one that is so much smaller that the next divisor serves.
    let divisor = largest_divisor(value(code(largest, divisor), divisor)).max(divisor);
    (values.iter().map(|&value| code(value, divisor)).collect(), divisor)
}

/// The largest divisor that keeps the code of a value in its range; a value may lie above by what
/// f32 rounds.
fn largest_divisor(value: f64) -> u8 {
    (255.0 / value.max(1.0) * (1.0 + 1e-6)).floor().clamp(1.0, 255.0) as u8
}

/// The code whose value is nearest.
fn code(wanted: f64, divisor: u8) -> u8 {
    let scaled = wanted * f64::from(divisor) / 255.0;
    let guess = (libm::pow(scaled.clamp(0.0, 1.0), 1.0 / GAMMA) * 255.0).floor() as u8;
    let next = guess.saturating_add(1);
    let distance = |code| (value(code, divisor) - wanted).abs();
    if distance(next) < distance(guess) { next } else { guess }
}

/// Replaces the values of a texel by those that are stored.
pub fn round(values: &mut [f64]) {
    let (codes, divisor) = codes(values);
    values.iter_mut().zip(codes).for_each(|(stored, code)| *stored = value(code, divisor));
}
