//! Blinn-Phong: D = (n+2)/(2π) (n·h)^n, with α² = 2/(n+2), so that it tends to Beckmann's as n
//! grows.
//!
//! Blinn 1977; the normalisation: Walter et al. 2007, equation 30; Hoffman, "Physically Based
//! Shading Models", 2013.

use super::{Definition, Wgsl};
use crate::brdf::masking::Masking::{HeightCorrelated, Implicit, Separable};
use crate::numeric::lanes::Real;
use crate::numeric::special::{exponential, log1p_ratio};
use std::f64::consts::FRAC_1_PI;

/// Everything of it but the formulas.
pub const DEFINITION: Definition = Definition {
    word: "blinn-phong",
    about: "a power of n.h, n = 2/alpha^2 - 2 (Blinn 1977; Hoffman 2013)",
    maskings: &[Implicit, HeightCorrelated, Separable],
    why_no_other_masking: "schlick-smith and height-correlated-approx are fitted to other terms; \
                           neubelt is for sheen",
    // Its Smith terms are Beckmann's.
    energy_conserving: &[Implicit],
    roughness: "alpha = roughness^2, exponent n = 2/alpha^2 - 2",
    smooth_at_normal: true,
    becomes_mirror: true,
    wgsl: Wgsl {
        source: include_str!("../../../shaders/blinn_phong.wgsl"),
        width: "alpha",
        slope_end: "blinn_phong_end(alpha, 20.0)",
        slope_density: "blinn_phong_slope_density(y2, alpha)",
        projected_area: "beckmann_projected_area(c, alpha)",
    },
};

/// α² P22 at the squared scaled slope y²: with t = α² y², (1+t)^-(n+4)/2 / π and (n+4)/2 = 1/α² +
/// 1.
///
/// (n·h)^n as a power of a cosine near 1 loses every digit at large n; -y² ln(1+t)/t - ln(1+t) as
/// the exponent does not.
#[inline(always)]
pub fn blinn_phong_slope_density<R: Real>(y2: R, alpha: R) -> R {
    let t = alpha * alpha * y2;
    exponential(-(y2 + t) * log1p_ratio(t)) * FRAC_1_PI
}

/// The y beyond which less than exp(-`depth`) of the lobe lies: where the density has fallen to
/// exp(-(1+3α²) `depth`) of its peak, since at large α its tail is a power of y, which n·l V makes
/// one degree flatter at grazing.
pub fn blinn_phong_end(alpha: f64, depth: f64) -> f64 {
    let a2 = alpha * alpha;
    (libm::expm1(depth * (1.0 + 3.0 * a2) / (1.0 + a2) * a2) / a2).sqrt()
}
