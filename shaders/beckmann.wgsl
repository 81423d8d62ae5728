// Beckmann: the twin of src/brdf/ndf/beckmann.rs.

// alpha^2 P22 at the squared scaled slope (Heitz 2014, section 5).
fn beckmann_slope_density(y2: f32) -> f32 {
    return 0.318309886 * exponential(-y2);
}

// alpha sin(theta), kept above 0.
fn beckmann_width(c: f32, alpha: f32) -> f32 {
    return max(alpha * sqrt((1.0 - c) * (1.0 + c)), 1e-30);
}

// c (1 + 2 Lambda(c)), exact (Heitz 2014, section 5).
fn beckmann_projected_area(c: f32, alpha: f32) -> f32 {
    let width = beckmann_width(c, alpha);
    return c + width * ierfc(min(c / width, 1e3));
}

// The same with Walter's rational Lambda (Walter et al. 2007, section 5.2).
fn walter_projected_area(c: f32, alpha: f32) -> f32 {
    let width = beckmann_width(c, alpha);
    let a = c / width;
    if a < 1.6 {
        return c + width * 2.0 * (1.0 - 1.259 * a + 0.396 * a * a) / (3.535 + 2.181 * a);
    }
    return c;
}
