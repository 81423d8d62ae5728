// Schlick's approximation of Fresnel reflectance: the twin of src/brdf/fresnel/schlick.rs.

// (1 - w, w) with w = (1 - v.h)^5.
fn schlick_weights(vh: f32) -> vec2<f32> {
    let w = schlick_weight(vh);
    return vec2<f32>(1.0 - w, w);
}
