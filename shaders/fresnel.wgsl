// Fresnel reflectance: the twin of src/brdf/fresnel.rs.

// Schlick's weight (1 - v.h)^5 (Schlick 1994).
fn schlick_weight(cosine: f32) -> f32 {
    let c = 1.0 - cosine;
    let c2 = c * c;
    return c2 * c2 * c;
}
