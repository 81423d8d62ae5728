// Schlick's approximation with F82 tint: the twin of src/brdf/fresnel/schlick_f82.rs.

// (1 - w, w, c (1 - c) w) with c = v.h and w = (1 - c)^5.
fn schlick_f82_weights(vh: f32) -> vec3<f32> {
    let w = schlick_weight(vh);
    return vec3<f32>(1.0 - w, w, vh * (1.0 - vh) * w);
}
