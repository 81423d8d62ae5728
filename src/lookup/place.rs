//! The place of (n·v, perceptual roughness) among the texels, as an expression.

use super::Lookup;
use crate::table::axis::{Axis, Parameter, Words};

/// The place along an axis in texels, of which the first is 0, before it is clamped.
pub fn along(axis: &Axis, words: &Words) -> String {
    axis.texel_at(&parameter(axis, words), words)
}

/// The texture coordinate along an axis.
pub fn uv(axis: &Axis, words: &Words) -> String {
    axis.uv_at(&parameter(axis, words), words)
}

/// The axis's parameter.
fn parameter(axis: &Axis, words: &Words) -> String {
    match axis.spec().parameter {
        // Of the latter there is no lookup: see Lookup.
        Parameter::Nov | Parameter::Critical => "nov".to_owned(),
        Parameter::Roughness => "roughness".into(),
        Parameter::Alpha => "roughness * roughness".into(),
        Parameter::F0 => "f0".into(),
        Parameter::Ior => "ior".into(),
        Parameter::Control => "control".into(),
        Parameter::Exponent => {
            // n = 2/α² - 2 and α² = roughness⁴, of which a mirror's n has no end.
            let (one, two, least) =
                ((words.number)(1.0), (words.number)(2.0), (words.number)(1e-7));
            let fourth = (words.max)("roughness * roughness * roughness * roughness", &least);
            (words.max)(&format!("{two} / {fourth} - {two}"), &one)
        }
    }
}

/// The place among slices along an axis.
pub fn along_slices(lookup: &Lookup, words: &Words) -> String {
    let axis = lookup.layout.slices.as_ref().and_then(|slices| slices.axis());
    axis.map_or("0".into(), |axis| along(axis, words))
}
