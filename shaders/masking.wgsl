// Masking and shadowing as n.l V = G / (4 n.v): the twin of src/brdf/masking.rs.

// Height-correlated Smith (Heitz 2014, equation 99).
fn height_correlated(x: f32, mu: f32, area_l: f32, area_v: f32) -> f32 {
    return 0.5 / area_v * (x / (x + mu / area_v * area_l));
}

// Separable Smith (Heitz 2014, equation 98).
fn separable(x: f32, mu: f32, area_l: f32, area_v: f32) -> f32 {
    return 1.0 / (mu + area_v) * (x / (x + area_l));
}

// Schlick-Smith with k = alpha/2 (Karis 2013).
fn schlick_smith(x: f32, mu: f32, alpha: f32) -> f32 {
    let k = 0.5 * alpha;
    let k1 = 1.0 - k;
    return 0.25 / (mu * k1 + k) * (x / (x * k1 + k));
}

// The joint approximation's c (1 + 2 Lambda(c)) (Hammon 2017; Vis_SmithJointApprox).
fn approx_projected_area(c: f32, alpha: f32) -> f32 {
    return c * (1.0 - alpha) + alpha;
}

// The implicit term, V = 1/4 (Hoffman 2013).
fn implicit(x: f32) -> f32 {
    return 0.25 * x;
}

// The visibility of velvet (Neubelt and Pettineo 2013).
fn neubelt(x: f32, mu: f32) -> f32 {
    return 0.25 * x / (x + mu - x * mu);
}
