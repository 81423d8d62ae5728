//! From the codes of a file to values: what a curve or a divisor of the texel does.

use super::channel::Texels;
use crate::choice::choice;
use crate::foreign::{Curve, Foreign};
use crate::table::precision::Precision;
use crate::table::srgb;

/// How codes become values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Decoding {
    /// As they are.
    Linear,
    /// By the curve of sRGB.
    Srgb,
    /// By a power of 2.2.
    Gamma,
    /// By a power of 2.2, over alpha.
    Rgbd,
    /// By the curve of sRGB, over alpha.
    RgbdSrgb,
}

choice!(Decoding, "encoding", {
    Linear = "linear", "values as they are";
    Srgb = "srgb", "on the curve of sRGB";
    Gamma = "gamma-2.2", "on a power of 2.2";
    Rgbd = "rgbd", "on a power of 2.2, over alpha";
    RgbdSrgb = "rgbd-srgb", "on the curve of sRGB, over alpha";
});

impl Decoding {
    /// Those that a slice may have: floats are linear, and a divisor is the fourth component.
    pub fn of(table: &Foreign, slice: usize) -> Vec<Decoding> {
        if matches!(table.storage, Precision::F16 | Precision::F32) {
            return vec![Decoding::Linear];
        }
        let mut list = vec![Decoding::Linear, Decoding::Srgb, Decoding::Gamma];
        // An alpha that is 1 everywhere divides nothing.
        let texels = Texels::new(table, slice);
        let divides = |texel: usize| texels[texel][3] > 0.0 && texels[texel][3] < 1.0;
        if table.components() == 4 && (0..texels.len()).any(divides) {
            list.extend([Decoding::Rgbd, Decoding::RgbdSrgb]);
        }
        list
    }

    /// Whether it divides by alpha.
    pub fn has_divisor(self) -> bool {
        matches!(self, Decoding::Rgbd | Decoding::RgbdSrgb)
    }

    /// The components that are values.
    pub fn components(self, table: &Foreign) -> usize {
        if self.has_divisor() { 3 } else { table.components() }
    }

    /// The value of a component of a texel.
    pub fn value(self, texel: &[f32], component: usize) -> f64 {
        let code = f64::from(texel[component]);
        // Alpha is on no curve.
        if component == 3 {
            return code;
        }
        match self {
            Decoding::Linear => code,
            Decoding::Srgb => srgb::linear(code),
            Decoding::Gamma => libm::pow(code, 2.2),
            Decoding::Rgbd => libm::pow(code, 2.2) / f64::from(texel[3]),
            Decoding::RgbdSrgb => srgb::linear(code) / f64::from(texel[3]),
        }
    }

    /// The curve without a divisor.
    pub fn curve(self) -> Curve {
        match self {
            Decoding::Linear => Curve::Linear,
            Decoding::Srgb | Decoding::RgbdSrgb => Curve::Srgb,
            Decoding::Gamma | Decoding::Rgbd => Curve::Gamma(2.2),
        }
    }
}
