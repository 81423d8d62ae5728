//! The quantities of the domain, each with its range checked once and each conversion written once.

use crate::error::{Error, Result};

/// Perceptual roughness r in [0, 1]: what artists and files call roughness. α = r² (Burley 2012).
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct PerceptualRoughness(f64);

/// The width α of a distribution of normals, in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Alpha(f64);

/// The cosine of an angle to the normal: 0, or [`SMALLEST_COSINE`] to 1; n·v is written μ.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Cosine(f64);

/// A real index of refraction relative to air, at least 1.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Ior(f64);

/// Reflectance at normal incidence F0, in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct F0(f64);

/// The least n·v in which renderers' lookups are judged: of a sphere's pixels one in a million has
/// a smaller one.
pub const PRACTICAL_NOV: f64 = 1e-3;

/// The least perceptual roughness of that domain, to which several renderers clamp (Filament).
pub const PRACTICAL_ROUGHNESS: f64 = 0.045;

/// The largest α of a texel of an unclamped axis (roughness 1.06): the bounds of GGX's rules are
/// searched up to there. Half a texel beyond roughness 1, as in Godot's table, is α = 1.0078.
pub const LARGEST_ALPHA: f64 = 1.125;

/// α below this and above 0 is refused: α² must stay a normal number in f32. It is r = 5e-10.
pub const SMALLEST_ALPHA: f64 = 2.5e-19;

/// n·v below this and above 0 is refused. No formula comes near an end of its numbers there: the
/// square of n·v, by which the reference divides, underflows in f64 below 1e-154, and n·v itself in
/// f32 below 1e-38; 1e-30 is what models keep denominators above. No table needs less: a lobe at
/// n·v = 1e-30 differs from its limit at 0 by less than any rule's bound, unless it has no limit.
pub const SMALLEST_COSINE: f64 = 1e-30;

/// A number in words of the command line: short where it has a hundred zeros, and -0 as 0.
pub(crate) fn short(value: f64) -> String {
    let text = format!("{:?}", value + 0.0);
    text.strip_suffix(".0").unwrap_or(&text).to_owned()
}

macro_rules! unit {
    ($name:ident, $what:literal, $expected:literal, $valid:expr) => {
        impl $name {
            /// Checks the range.
            pub fn new(value: f64) -> Result<Self> {
                let valid: fn(f64) -> bool = $valid;
                if valid(value) {
                    // -0 becomes 0.
                    Ok($name(value + 0.0))
                } else {
                    Err(Error::bad_input(
                        $what,
                        $expected,
                        short(value),
                        "give a value in that range",
                    ))
                }
            }

            /// The number.
            pub fn get(self) -> f64 {
                self.0
            }
        }
    };
}

unit!(PerceptualRoughness, "perceptual roughness", "0, or 5e-10 to 1", |v| v == 0.0
    || (alpha_of(v) >= SMALLEST_ALPHA && v <= 1.0));
unit!(Alpha, "alpha", "0, or 2.5e-19 to 1", |v| v == 0.0 || (SMALLEST_ALPHA..=1.0).contains(&v));
unit!(Cosine, "cosine", "0, or 1e-30 to 1", |v| v == 0.0 || (SMALLEST_COSINE..=1.0).contains(&v));
unit!(Ior, "index of refraction", "a finite number of at least 1", |v| v >= 1.0 && v.is_finite());
unit!(F0, "F0", "0 to 1", |v| (0.0..=1.0).contains(&v));

impl PerceptualRoughness {
    /// The roughness of a texel, which may lie a little beyond 1.
    pub fn of_texel(value: f64) -> Result<Self> {
        match value {
            1.0.. if alpha_of(value) <= LARGEST_ALPHA => Ok(PerceptualRoughness(value)),
            1.0.. => Err(beyond_a_texel("perceptual roughness", "1.06", value)),
            _ => PerceptualRoughness::new(value),
        }
    }
}

/// The error of a texel too far beyond 1.
fn beyond_a_texel(what: &str, most: &str, value: f64) -> Error {
    let expected = format!("at most {most} on an unclamped axis");
    Error::bad_input(what, expected, short(value), "give a value in that range")
}

impl Alpha {
    /// The α of a texel, which may lie a little beyond 1.
    pub fn of_texel(value: f64) -> Result<Self> {
        match value {
            1.0..=LARGEST_ALPHA => Ok(Alpha(value)),
            1.0.. => Err(beyond_a_texel("alpha", "1.125", value)),
            _ => Alpha::new(value),
        }
    }
}

/// α = r² (Burley 2012, "Physically Based Shading at Disney").
pub fn alpha_of(roughness: f64) -> f64 {
    roughness * roughness
}

/// r = √α.
pub fn roughness_of(alpha: f64) -> f64 {
    alpha.sqrt()
}

/// α² = 2/(n+2) of the exponent n of Blinn-Phong (Walter et al. 2007, section 5.2).
pub fn alpha_of_exponent(n: f64) -> f64 {
    (2.0 / (n + 2.0)).sqrt()
}

impl From<PerceptualRoughness> for Alpha {
    fn from(r: PerceptualRoughness) -> Self {
        Alpha(alpha_of(r.0))
    }
}

impl From<Ior> for F0 {
    /// F0 = ((1-n)/(1+n))²: Fresnel's reflectance at normal incidence from air.
    fn from(n: Ior) -> Self {
        let r = (1.0 - n.0) / (1.0 + n.0);
        F0(r * r)
    }
}
