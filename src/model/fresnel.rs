//! Fresnel reflectance.

use crate::lanes::Number;

/// Schlick's weight (1 - v·h)^5: F = F0 + (1 - F0) weight (Schlick 1994, "An Inexpensive BRDF Model for
/// Physically-Based Rendering").
#[inline(always)]
pub fn schlick_weight<R: Number>(cosine: R) -> R {
    let c = R::from(1.0) - cosine;
    let c2 = c * c;
    c2 * c2 * c
}

/// 1 - (1 - μ)^5 = μ (1 + q (1 + q (1 + q (1 + q)))) with q = 1 - μ: what is left where F0 = 0, without the
/// cancellation of 1 - F at grazing angles.
#[inline(always)]
pub fn schlick_complement<R: Number>(cosine: R) -> R {
    let one = R::from(1.0);
    let q = one - cosine;
    cosine * (one + q * (one + q * (one + q * (one + q))))
}
