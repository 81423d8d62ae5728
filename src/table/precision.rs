//! The storage of a value: its rounding, the error that it makes, and the tolerance that befits it.

use super::{rgbd, srgb};
use crate::choice::choice;
use crate::numeric::half;

/// The storage of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// Binary16, rounded to nearest, ties to even.
    F16,
    /// Binary32, rounded to nearest, ties to even.
    F32,
    /// round(65535 v), for values in [0, 1].
    Unorm16,
    /// round(255 v), for values in [0, 1].
    Unorm8,
    /// round(1023 v), for values in [0, 1]; files pack three of them and a fourth of 2 bits into 32
    /// bits.
    A2b10g10r10,
    /// 8 bits on the curve of sRGB, whichever is nearest to the value.
    Srgb8,
    /// 8 bits on a curve of 2.2, over a divisor of 8 bits that the channels of a texel share: see
    /// [`super::rgbd`].
    Rgbd8,
    /// Binary64 as it was computed: for charts and comparisons; no file holds it, and it is not
    /// certified.
    F64,
}

choice!(Precision, "precision", {
    F16 = "f16", "half";
    F32 = "f32", "float";
    Unorm16 = "unorm16", "16 bits for [0, 1]";
    Unorm8 = "unorm8", "8 bits for [0, 1]";
    A2b10g10r10 = "a2b10g10r10", "10 bits for [0, 1], three channels in 32 bits";
    Srgb8 = "srgb8", "8 bits for [0, 1] on the curve of sRGB";
    Rgbd8 = "rgbd8", "8 bits for [0, 255], three channels and their divisor (Babylon.js)";
    F64 = "f64", "double, in no file";
});

impl Precision {
    /// Whether values are rounded once, correctly; others are stored within a tolerance.
    pub fn is_rounded_once(self) -> bool {
        !matches!(self, Precision::F32 | Precision::Rgbd8)
    }

    /// The default tolerance.
    ///
    /// f16: 2^-16 is a sixteenth of half a step of binary16 in [1/2, 1), 2^-12: storing the number
    /// then costs sixteen times what integrating it does. f32 and f64: the least that f32
    /// arithmetic on a device can promise. Others: as for f16, a sixteenth of half a step or that
    /// least, whichever is more.
    pub fn default_tolerance(self) -> f64 {
        match self {
            Precision::F16 => 1.0 / 65536.0,
            Precision::F32 | Precision::F64 | Precision::Unorm16 | Precision::Rgbd8 => 1e-6,
            Precision::A2b10g10r10 => 3e-5,
            // Near 0 the steps of sRGB are a twelfth as wide.
            Precision::Srgb8 => 1e-5,
            Precision::Unorm8 => 1e-4,
        }
    }

    /// The largest error of storing a value in [-1, 1]; of [`Precision::Rgbd8`] in a texel without
    /// values above 1.
    pub fn half_step(self) -> f64 {
        match self {
            Precision::F16 => 1.0 / 4096.0,
            Precision::F32 => 1.0 / f64::from(1 << 25),
            Precision::F64 => 0.25 * f64::EPSILON,
            Precision::Unorm16 => 0.5 / 65535.0,
            Precision::Unorm8 => 0.5 / 255.0,
            Precision::A2b10g10r10 => 0.5 / 1023.0,
            // The widest steps are at 1.
            Precision::Srgb8 => 0.5 * (1.0 - srgb::value(254)),
            Precision::Rgbd8 => 0.5 * (1.0 - rgbd::value(254, 255)),
        }
    }

    /// The rounding in words.
    pub fn rounding(self) -> &'static str {
        match self {
            Precision::Srgb8 => "to the code whose linear value is nearest",
            Precision::Rgbd8 => "to the nearest code, after the divisor of the texel",
            _ => "to nearest, ties to even",
        }
    }

    /// The number of steps of a fraction of 1; none of floats and curves.
    fn unorm(self) -> Option<f64> {
        match self {
            Precision::Unorm16 => Some(65535.0),
            Precision::Unorm8 => Some(255.0),
            Precision::A2b10g10r10 => Some(1023.0),
            Precision::F16
            | Precision::F32
            | Precision::F64
            | Precision::Srgb8
            | Precision::Rgbd8 => None,
        }
    }

    /// The smallest value that it holds, and the largest.
    pub fn range(self) -> (f64, f64) {
        match self {
            Precision::F16 => (-half::LARGEST, half::LARGEST),
            Precision::F32 => (f64::from(f32::MIN), f64::from(f32::MAX)),
            Precision::F64 => (f64::MIN, f64::MAX),
            Precision::Rgbd8 => (0.0, rgbd::LARGEST),
            Precision::Unorm16 | Precision::Unorm8 | Precision::A2b10g10r10 | Precision::Srgb8 => {
                (0.0, 1.0)
            }
        }
    }

    /// Whether the value is in its range; NaN is not.
    #[inline]
    pub fn holds(self, value: f64) -> bool {
        let (low, high) = self.range();
        (low..=high).contains(&value)
    }

    /// The value nearest to `value`, ties to even, of those that it would hold if its range had no
    /// end: beyond the range unorms go on in their steps, and floats are infinite.
    #[inline]
    pub fn nearest(self, value: f64) -> f64 {
        match self {
            Precision::F16 => half::nearest(value),
            Precision::F64 => value,
            // Those of RGBD follow where the texel is complete.
            Precision::F32 | Precision::Rgbd8 => f64::from(value as f32),
            Precision::Srgb8 => srgb::nearest(value),
            Precision::Unorm16 => steps(value, 65535.0) / 65535.0,
            Precision::Unorm8 => steps(value, 255.0) / 255.0,
            Precision::A2b10g10r10 => steps(value, 1023.0) / 1023.0,
        }
    }

    /// The value nearest to this one; this one itself where the storage does not reach so far.
    #[inline]
    pub fn stored(self, value: f64) -> f64 {
        let nearest = self.nearest(value);
        // The sum that rounds to a half loses the sign of what becomes 0.
        if self.holds(nearest) { nearest.copysign(value) } else { value }
    }

    /// The distance of `value` from the nearest number at which the stored value changes.
    pub fn distance_to_boundary(self, value: f64) -> f64 {
        let v = value.abs();
        let step = match self {
            Precision::F16 => half::step(v),
            Precision::F64 => return 0.0,
            Precision::Srgb8 => return srgb::distance_to_boundary(value),
            // As half::step: the smallest normal float is 2^-126, and a float has 23 bits.
            Precision::F32 | Precision::Rgbd8 => {
                f64::from_bits(((v.to_bits() >> 52).max(1023 - 126) - 23) << 52)
            }
            Precision::Unorm16 | Precision::Unorm8 | Precision::A2b10g10r10 => {
                self.unorm().map_or(1.0, f64::recip)
            }
        };
        let steps = v / step;
        let above = (steps - steps.floor() - 0.5).abs() * step;
        // Just above a power of two the boundary below is that of the smaller binade.
        let floats = matches!(self, Precision::F16 | Precision::F32);
        // A power of two has no bit set below its exponent.
        let power_of_two = steps.floor().to_bits().trailing_zeros() >= 52;
        let first = floats && power_of_two && steps >= 1024.0;
        if first { above.min((steps - steps.floor() + 0.25) * step) } else { above }
    }

    /// Writes a value that it holds, little-endian, into [`Precision::bytes`] bytes.
    #[inline]
    pub fn write(self, value: f64, bytes: &mut [u8]) {
        debug_assert_eq!(bytes.len(), self.bytes());
        match self {
            Precision::F16 => bytes.copy_from_slice(&half::round(value).to_le_bytes()),
            Precision::F32 | Precision::Rgbd8 => {
                bytes.copy_from_slice(&(value as f32).to_le_bytes())
            }
            Precision::F64 => bytes.copy_from_slice(&value.to_le_bytes()),
            Precision::Unorm16 => {
                bytes.copy_from_slice(&(steps(value, 65535.0) as u16).to_le_bytes())
            }
            Precision::A2b10g10r10 => {
                bytes.copy_from_slice(&(steps(value, 1023.0) as u16).to_le_bytes())
            }
            Precision::Unorm8 => bytes.copy_from_slice(&[steps(value, 255.0) as u8]),
            Precision::Srgb8 => bytes.copy_from_slice(&[srgb::code(value)]),
        }
    }

    /// The value that these bytes stand for; 0 of too few of them.
    #[inline]
    pub fn read(self, bytes: &[u8]) -> f64 {
        fn first<const N: usize>(bytes: &[u8]) -> [u8; N] {
            bytes.first_chunk().copied().unwrap_or([0; N])
        }
        match self {
            Precision::F16 => half::value(u16::from_le_bytes(first(bytes))),
            Precision::F32 | Precision::Rgbd8 => f64::from(f32::from_le_bytes(first(bytes))),
            Precision::F64 => f64::from_le_bytes(first(bytes)),
            Precision::Unorm16 => f64::from(u16::from_le_bytes(first(bytes))) / 65535.0,
            Precision::A2b10g10r10 => f64::from(u16::from_le_bytes(first(bytes))) / 1023.0,
            Precision::Unorm8 => f64::from(u8::from_le_bytes(first(bytes))) / 255.0,
            Precision::Srgb8 => srgb::value(u8::from_le_bytes(first(bytes))),
        }
    }

    /// Bytes of a value in a [`super::Table`]: those of files where each value has its own.
    pub fn bytes(self) -> usize {
        match self {
            Precision::F64 => 8,
            Precision::F32 | Precision::Rgbd8 => 4,
            Precision::F16 | Precision::Unorm16 | Precision::A2b10g10r10 => 2,
            Precision::Unorm8 | Precision::Srgb8 => 1,
        }
    }
}

/// The whole number nearest to `value` times `count`, ties to even. The product is rounded itself,
/// and that can only make a tie of what is none: then what was rounded away tells the side.
fn steps(value: f64, count: f64) -> f64 {
    let product = value * count;
    let whole = product.round_ties_even();
    if (product - whole).abs() != 0.5 {
        return whole;
    }
    let residue = value.mul_add(count, -product);
    if residue == 0.0 { whole } else { product + 0.5 * residue.signum() }
}
