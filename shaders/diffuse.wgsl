// Diffuse albedos: the twin of src/model/diffuse.rs.

// Lambert 1760.
fn lambert_albedo() -> f32 {
    return 1.0;
}

// Burley 2012.
fn burley_albedo(mu: f32, r: f32) -> f32 {
    let h = r - 0.5;
    let v = schlick_weight(mu);
    let light = 0.5 + h / 42.0 + r * mu / 168.0;
    let view = v * (0.5 * h + r * mu / 3.0);
    let both = v * (h * h / 42.0 + h * r * mu / 84.0 + r * r * (mu * mu / 504.0 + 11.0 * (1.0 - mu) * (1.0 + mu) / 1008.0));
    return 2.0 * (light + view + both);
}

// Oren and Nayar 1994, the qualitative model.
fn oren_nayar_albedo(mu: f32, r: f32) -> f32 {
    let s2 = r * r;
    let a = 1.0 - 0.5 * s2 / (s2 + 0.33);
    let b = 0.45 * s2 / (s2 + 0.09);
    let sv = sqrt((1.0 - mu) * (1.0 + mu));
    let forward = mu * (1.0 + sv * (1.0 + sv)) / (3.0 * (1.0 + sv));
    return a + 0.636619772 * b * sv * (forward + 0.5 * (arc_cosine(mu) - sv * mu));
}

// The single scattering of EON (Portsmouth, Kutz and Hill 2025).
fn eon_albedo(mu: f32, r: f32) -> f32 {
    let sv = sqrt((1.0 - mu) * (1.0 + mu));
    let forward = 0.666666667 * sv * mu * (1.0 + sv * (1.0 + sv)) / (1.0 + sv);
    let g = sv * (arc_cosine(mu) - sv * mu - 0.666666667) + forward;
    return (1.0 + 0.318309886 * r * g) / (1.0 + 0.287793409 * r);
}
