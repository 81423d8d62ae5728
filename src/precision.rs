//! How a value is stored: the roundings, what each costs, and the tolerance that befits it.

use crate::error::{Error, Result};
use crate::half;
use serde::{Deserialize, Serialize};

/// How a value is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Precision {
    /// Binary16, rounded to nearest, ties to even.
    F16,
    /// Binary32, rounded to nearest, ties to even.
    F32,
    /// round(65535 v), for values in [0, 1].
    Unorm16,
    /// round(255 v), for values in [0, 1].
    Unorm8,
}

impl Precision {
    /// The tolerance when none is given.
    ///
    /// f16: 2^-16 is a sixteenth of half a step of binary16 in [1/2, 1), 2^-12: storing the number then costs sixteen times
    /// what integrating it does. f32: the least that f32 arithmetic on a device can promise. unorm: as for f16, a
    /// sixteenth of half a step or that least, whichever is more.
    pub fn default_tolerance(self) -> f64 {
        match self {
            Precision::F16 => 1.0 / 65536.0,
            Precision::F32 => 1e-6,
            Precision::Unorm16 => 1e-6,
            Precision::Unorm8 => 1e-4,
        }
    }

    /// The largest error of storing a value in [0, 1].
    pub fn half_step(self) -> f64 {
        match self {
            Precision::F16 => 1.0 / 4096.0,
            Precision::F32 => 1.0 / f64::from(1 << 25),
            Precision::Unorm16 => 0.5 / 65535.0,
            Precision::Unorm8 => 0.5 / 255.0,
        }
    }

    /// The largest number of the values that it can hold, and the smallest.
    fn range(self) -> (f64, f64) {
        match self {
            Precision::F16 => (-half::LARGEST, half::LARGEST),
            Precision::F32 => (f64::from(f32::MIN), f64::from(f32::MAX)),
            Precision::Unorm16 | Precision::Unorm8 => (0.0, 1.0),
        }
    }

    /// The stored value nearest to `value`, ties to even; where only [0, 1] can be stored, the nearer end of it.
    #[inline]
    pub fn nearest(self, value: f64) -> f64 {
        let unorm = |steps: f64| (value.clamp(0.0, 1.0) * steps).round_ties_even() / steps;
        match self {
            Precision::F16 => half::nearest(value),
            Precision::F32 => f64::from(value as f32),
            Precision::Unorm16 => unorm(65535.0),
            Precision::Unorm8 => unorm(255.0),
        }
    }

    /// How far `value` is from the nearest number at which the stored value changes.
    pub fn distance_to_boundary(self, value: f64) -> f64 {
        let v = value.abs();
        let step = match self {
            Precision::F16 => half::step(v),
            Precision::F32 => f64::from_bits(((v.to_bits() >> 52).max(1023 - 126) - 23) << 52),
            Precision::Unorm16 => 1.0 / 65535.0,
            Precision::Unorm8 => 1.0 / 255.0,
        };
        let steps = v / step;
        let above = (steps - steps.floor() - 0.5).abs() * step;
        // Just above a power of two the boundary below is that of the smaller binade.
        let floats = matches!(self, Precision::F16 | Precision::F32);
        let power_of_two = steps.floor().to_bits().trailing_zeros() >= 52;
        let first = floats && power_of_two && steps >= 1024.0;
        if first { above.min((steps - steps.floor() + 0.25) * step) } else { above }
    }

    /// The bits that stand for each value; a value that this precision cannot hold is an error. A value that lies outside
    /// [0, 1] by no more than `slack`, the error it may have, is stored as 0 or 1 where nothing else can be.
    pub fn store(self, values: &[f64], slack: f64) -> Result<Vec<u32>> {
        let (low, high) = self.range();
        let slack = if low == 0.0 { slack } else { 0.0 };
        if let Some(value) = values.iter().find(|value| !(low - slack..=high + slack).contains(*value)) {
            let expected = format!("values from {low} to {high}");
            return Err(Error::bad_input("precision", expected, value.to_string(), "choose f16 or f32"));
        }
        let unorm = |value: f64, steps: f64| (self.nearest(value) * steps).round() as u32;
        let store = |&value: &f64| match self {
            Precision::F16 => u32::from(half::round(value)),
            Precision::F32 => (value as f32).to_bits(),
            Precision::Unorm16 => unorm(value, 65535.0),
            Precision::Unorm8 => unorm(value, 255.0),
        };
        Ok(values.iter().map(store).collect())
    }

    /// Bytes of a stored value.
    pub fn bytes(self) -> usize {
        match self {
            Precision::F32 => 4,
            Precision::F16 | Precision::Unorm16 => 2,
            Precision::Unorm8 => 1,
        }
    }
}
