// Schlick's approximation with another exponent: the twin of src/brdf/fresnel/schlick_power.rs.

// (1 - w, w) with w = (1 - v.h)^(whole + half/2), half being 0 or 1.
fn schlick_power_weights(vh: f32, whole: u32, half: u32) -> vec2<f32> {
    let base = max(1.0 - vh, 0.0);
    var w = 1.0;
    if half == 1u {
        w = sqrt(base);
    }
    for (var i = 0u; i < whole; i++) {
        w *= base;
    }
    return vec2<f32>(1.0 - w, w);
}
