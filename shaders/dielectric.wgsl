// Fresnel's equations of dielectrics: the twin of src/brdf/fresnel/dielectric.rs.

// F at c = v.h with k = eta^2 - 1.
fn dielectric_reflectance(c: f32, k: f32) -> f32 {
    let g2 = k + c * c;
    let g = sqrt(max(g2, 0.0));
    let s2 = (1.0 - c) * (1.0 + c);
    let sum = max(g + c, 1e-18);
    let a = k / (sum * sum * (c * g + s2));
    if g2 > 0.0 {
        return a * a * (c * c * g2 + s2 * s2);
    }
    return select(0.0, 1.0, k < 0.0);
}
