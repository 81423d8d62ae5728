//! Masking and shadowing, each as n·l V = G / (4 n·v): finite on the whole closed domain but the point α = n·v = 0. The factors
//! that depend on n·v alone stand apart, so that no product of two tiny numbers underflows in f32.
//!
//! `x` is n·l, `mu` is n·v, and `sx`, `smu` are c (1 + 2Λ(c)) of the distribution at either ([`crate::model::Ndf::smith`]).

use crate::lanes::Real;

/// Height-correlated Smith: G = 1 / (1 + Λ(l) + Λ(v)) (Heitz 2014, equation 99).
#[inline(always)]
pub fn height_correlated<R: Real>(x: R, mu: R, sx: R, smu: R) -> R {
    smu.recip() * 0.5 * (x / (x + mu / smu * sx))
}

/// Separable Smith: G = G1(l) G1(v), G1 = 1 / (1 + Λ) (Heitz 2014, equation 98).
#[inline(always)]
pub fn separable<R: Real>(x: R, mu: R, sx: R, smu: R) -> R {
    (mu + smu).recip() * (x / (x + sx))
}

/// Schlick-Smith: G1(c) = c / (c(1-k) + k) with k = α/2 (Karis 2013, "Real Shading in Unreal Engine 4").
#[inline(always)]
pub fn schlick_smith<R: Real>(x: R, mu: R, alpha: R) -> R {
    let k = alpha * 0.5;
    let k1 = k.complement();
    (mu * k1 + k).recip() * 0.25 * (x / (x * k1 + k))
}

/// The joint approximation of Unreal Engine: height-correlated Smith with c(1-α) + α for c (1 + 2Λ(c)) of GGX (Hammon 2017,
/// "PBR Diffuse Lighting for GGX+Smith Microsurfaces"; `Vis_SmithJointApprox`). The result is that term.
#[inline(always)]
pub fn joint_smith<R: Real>(c: R, alpha: R) -> R {
    c * alpha.complement() + alpha
}

/// The implicit term: G = n·l n·v, so that V = 1/4 (Hoffman 2013). With any distribution.
#[inline(always)]
pub fn implicit<R: Real>(x: R) -> R {
    x * 0.25
}

/// The visibility of velvet: V = 1 / (4 (n·l + n·v - n·l n·v)) (Neubelt and Pettineo 2013, after Ashikhmin 2007).
#[inline(always)]
pub fn neubelt<R: Real>(x: R, mu: R) -> R {
    x * 0.25 / (x + mu - x * mu)
}
