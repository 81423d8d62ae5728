//! GGX, the distribution of Trowbridge and Reitz.
//!
//! Walter, Marschner, Li and Torrance, "Microfacet Models for Refraction through Rough Surfaces",
//! 2007; Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", 2014.

use super::{Definition, Wgsl};
use crate::brdf::masking::Masking::{
    self, HeightCorrelated, HeightCorrelatedApprox, Implicit, SchlickSmith, Separable,
};
use crate::numeric::lanes::Real;
use std::f64::consts::{FRAC_1_PI, PI};

/// Everything of it but the formulas.
pub const DEFINITION: Definition = Definition {
    word: "ggx",
    about: "GGX, long tails (Trowbridge and Reitz 1975; Walter et al. 2007)",
    maskings: MASKINGS,
    why_no_other_masking: "neubelt is the visibility of sheen",
    energy_conserving: MASKINGS,
    roughness: "alpha = roughness^2",
    smooth_at_normal: true,
    becomes_mirror: true,
    wgsl: Wgsl {
        source: include_str!("../../../shaders/ggx.wgsl"),
        width: "alpha",
        // 1e9 squares to far less than f32 holds.
        slope_end: "1e9",
        slope_density: "ggx_slope_density(y2)",
        projected_area: "ggx_projected_area(c, alpha)",
    },
};

const MASKINGS: &[Masking] =
    &[HeightCorrelated, Separable, SchlickSmith, HeightCorrelatedApprox, Implicit];

/// D(n·h) as a function of t = tan²(θ_h): α²/π ((1+t)/(α²+t))² (Walter 2007, equation 33).
///
/// No difference of near-equal numbers is taken, unlike in α²/(π((n·h)²(α²-1)+1)²), which loses
/// every digit as α → 0.
pub fn ggx_d(t: f64, alpha: f64) -> f64 {
    let a2 = alpha * alpha;
    let ratio = (1.0 + t) / (a2 + t);
    a2 / PI * ratio * ratio
}

/// α² P22 at the squared scaled slope y² = (tan(θ_h)/α)²: 1 / (π (1+y²)²) (Heitz 2014, section 5).
#[inline(always)]
pub fn ggx_slope_density<R: Real>(y2: R) -> R {
    let r = (y2 + 1.0).recip();
    r * FRAC_1_PI * r
}

/// c (1 + 2Λ(c)) = √(α² + (1-α²) c²), with Smith's Λ of GGX (Heitz 2014, equation 72).
///
/// In units of α: c² alone would underflow in f32 where both are tiny.
#[inline(always)]
pub fn ggx_projected_area<R: Real>(c: R, alpha: R) -> R {
    let q = c * alpha.recip();
    alpha * (alpha.complement() * (alpha + 1.0) * (q * q) + 1.0).sqrt()
}
