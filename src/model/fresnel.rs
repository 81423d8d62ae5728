//! Fresnel reflectance.

/// Schlick's weight (1 - v·h)^5: F = F0 + (1 - F0) weight (Schlick 1994, "An Inexpensive BRDF Model for
/// Physically-Based Rendering").
pub fn schlick_weight(cosine: f64) -> f64 {
    let c = 1.0 - cosine;
    let c2 = c * c;
    c2 * c2 * c
}
