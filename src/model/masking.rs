//! Masking and shadowing, each as n·l V = G / (4 n·v): finite on the whole closed domain but the point α = n·v = 0. The factors that depend on n·v
//! alone stand apart, so that no product of two tiny numbers underflows in f32.
//!
//! `x` is n·l, `mu` is n·v, and `sx`, `smu` are c (1 + 2Λ(c)) of the distribution at either ([`crate::model::Ndf::smith`]).

/// Height-correlated Smith: G = 1 / (1 + Λ(l) + Λ(v)) (Heitz 2014, equation 99).
pub fn height_correlated(x: f64, mu: f64, sx: f64, smu: f64) -> f64 {
    0.5 / smu * (x / (x + mu / smu * sx))
}

/// Separable Smith: G = G1(l) G1(v), G1 = 1 / (1 + Λ) (Heitz 2014, equation 98).
pub fn separable(x: f64, mu: f64, sx: f64, smu: f64) -> f64 {
    1.0 / (mu + smu) * (x / (x + sx))
}

/// Schlick-Smith: G1(c) = c / (c(1-k) + k) with k = α/2 (Karis 2013, "Real Shading in Unreal Engine 4").
pub fn schlick_smith(x: f64, mu: f64, alpha: f64) -> f64 {
    let k = 0.5 * alpha;
    let k1 = 1.0 - k;
    0.25 / (mu * k1 + k) * (x / (x * k1 + k))
}

/// The joint approximation of Unreal Engine: height-correlated Smith with c(1-α) + α for c (1 + 2Λ(c)) of GGX (Hammon 2017,
/// "PBR Diffuse Lighting for GGX+Smith Microsurfaces"; `Vis_SmithJointApprox`). The result is that term.
pub fn joint_smith(c: f64, alpha: f64) -> f64 {
    c * (1.0 - alpha) + alpha
}

/// The implicit term: G = n·l n·v, so that V = 1/4 (Hoffman 2013). With any distribution.
pub fn implicit(x: f64) -> f64 {
    0.25 * x
}

/// The visibility of velvet: V = 1 / (4 (n·l + n·v - n·l n·v)) (Neubelt and Pettineo 2013, after Ashikhmin 2007).
pub fn neubelt(x: f64, mu: f64) -> f64 {
    0.25 * x / (x + mu - x * mu)
}
