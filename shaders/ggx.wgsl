// GGX: the twin of src/brdf/ndf/ggx.rs.

// alpha^2 P22 at the squared scaled slope y^2 = (tan(theta_h)/alpha)^2 (Heitz 2014, section 5).
fn ggx_slope_density(y2: f32) -> f32 {
    let r = 1.0 / (1.0 + y2);
    return 0.318309886 * r * r;
}

// c (1 + 2 Lambda(c)) (Heitz 2014, equation 72).
fn ggx_projected_area(c: f32, alpha: f32) -> f32 {
    let q = c * (1.0 / alpha);
    return alpha * sqrt(1.0 + (1.0 - alpha) * (1.0 + alpha) * (q * q));
}
