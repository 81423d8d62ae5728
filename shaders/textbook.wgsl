// Formulas as textbooks have them, for the study of what drivers make of them: the twin of
// src/compare/textbook.rs. No bake uses them.

// D/D(0) of GGX.
fn textbook_ggx(nh: f32, alpha: f32) -> f32 {
    let a2 = alpha * alpha;
    let d = nh * nh * (a2 - 1.0) + 1.0;
    return a2 / d * (a2 / d);
}

// D/D(0) of Blinn-Phong.
fn textbook_blinn_phong(nh: f32, n: f32) -> f32 {
    return pow(nh, n);
}

// D/D(0) of Beckmann.
fn textbook_beckmann(nh: f32, alpha: f32) -> f32 {
    let nh2 = nh * nh;
    return exp((nh2 - 1.0) / (alpha * alpha * nh2)) / (nh2 * nh2);
}

// Lambda of GGX.
fn lambda(c: f32, alpha: f32) -> f32 {
    let tan2 = (1.0 - c * c) / (c * c);
    return 0.5 * (sqrt(1.0 + alpha * alpha * tan2) - 1.0);
}

// n.l V of height-correlated GGX.
fn textbook_visibility(nl: f32, nv: f32, alpha: f32) -> f32 {
    let g2 = 1.0 / (1.0 + lambda(nl, alpha) + lambda(nv, alpha));
    return nl * (g2 / (4.0 * nl * nv));
}

// tan(theta_h) of a half vector that D of GGX chooses.
fn textbook_sampled_slope(v: f32, alpha: f32) -> f32 {
    let cosine = sqrt((1.0 - v) / (1.0 + (alpha * alpha - 1.0) * v));
    return sqrt(1.0 - cosine * cosine) / cosine;
}
