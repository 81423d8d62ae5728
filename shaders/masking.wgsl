// Masking and shadowing as n.l V = G / (4 n.v): the twin of src/model/masking.rs.

// Height-correlated Smith (Heitz 2014, equation 99).
fn height_correlated(x: f32, mu: f32, sx: f32, smu: f32) -> f32 {
    return 0.5 / smu * (x / (x + mu / smu * sx));
}

// Separable Smith (Heitz 2014, equation 98).
fn separable(x: f32, mu: f32, sx: f32, smu: f32) -> f32 {
    return 1.0 / (mu + smu) * (x / (x + sx));
}

// Schlick-Smith with k = alpha/2 (Karis 2013).
fn schlick_smith(x: f32, mu: f32, alpha: f32) -> f32 {
    let k = 0.5 * alpha;
    let k1 = 1.0 - k;
    return 0.25 / (mu * k1 + k) * (x / (x * k1 + k));
}
