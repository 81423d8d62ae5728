// Fresnel's equations of dielectrics: the twin of src/brdf/fresnel/dielectric.rs.

// Nothing real is as small: it keeps 0/0 away where eta = 1 and c = 0.
const SMALLEST_ROOT = 1e-18;

// F at c = v.h with k = eta^2 - 1.
fn dielectric_reflectance(c: f32, k: f32) -> f32 {
    return reflectance_from(c, k + c * c, (1.0 - c) * (1.0 + c), k);
}

// The same from g^2 = k + c^2 and s^2 = 1 - c^2, for whoever has them without cancellation.
fn reflectance_from(c: f32, g2: f32, s2: f32, k: f32) -> f32 {
    let g = sqrt(max(g2, 0.0));
    let sum = max(g + c, SMALLEST_ROOT);
    let a = k / (sum * sum * (c * g + s2));
    if g2 > 0.0 {
        return a * a * (c * c * g2 + s2 * s2);
    }
    return select(0.0, 1.0, k < 0.0);
}
