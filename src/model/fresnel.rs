//! Fresnel reflectance.

use crate::lanes::Real;

/// Schlick's weight (1 - v·h)^5: F = F0 + (1 - F0) weight (Schlick 1994, "An Inexpensive BRDF Model for
/// Physically-Based Rendering").
#[inline(always)]
pub fn schlick_weight<R: Real>(cosine: R) -> R {
    let c = cosine.complement();
    let c2 = c * c;
    c2 * c2 * c
}
