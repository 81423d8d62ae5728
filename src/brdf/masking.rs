//! Masking and shadowing, each as n·l V = G / (4 n·v): finite on the whole closed domain but the
//! point α = n·v = 0. The factors that depend on n·v alone stand apart, so that no product of two
//! tiny numbers underflows in f32.
//!
//! `x` is n·l, `mu` is n·v; `area_l` and `area_v` are c (1 + 2Λ(c)) of the distribution at either
//! ([`crate::brdf::Ndf::projected_area`]).
//!
//! Every term here depends on n·l and n·v alone, and the integrators rely on it: a term that
//! depends on v·h (of V-cavities, of Kelemen) cannot be added without a rule of its own.

use crate::choice::choice;
use crate::numeric::lanes::{Number, Real};

/// The masking and shadowing term G.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Masking {
    /// Smith, heights correlated (Heitz 2014, equation 99).
    HeightCorrelated,
    /// Smith, G1(l) G1(v) (Heitz 2014, equation 98).
    Separable,
    /// Schlick's approximation with k = α/2 (Karis 2013).
    SchlickSmith,
    /// Unreal Engine's approximation of the height-correlated term of GGX (Hammon 2017).
    HeightCorrelatedApprox,
    /// G = n·l n·v (Hoffman 2013).
    Implicit,
    /// V = 1/(4 (n·l + n·v - n·l n·v)), for sheen (Neubelt and Pettineo 2013).
    Neubelt,
}

choice!(Masking, "masking", {
    HeightCorrelated = "height-correlated", "Smith, heights correlated (Heitz 2014)";
    Separable = "separable", "Smith, G1(l) G1(v) (Heitz 2014)";
    SchlickSmith = "schlick-smith", "Schlick's approximation, k = alpha/2 (Karis 2013)";
    HeightCorrelatedApprox = "height-correlated-approx", "Unreal's approximation for GGX (Hammon \
        2017)";
    Implicit = "implicit", "G = n.l n.v (Hoffman 2013)";
    Neubelt = "neubelt", "for charlie (Neubelt and Pettineo 2013)";
});

impl Masking {
    /// G of the mirror direction in the limit α → 0.
    pub fn of_mirror<R: Number>(self, mu: R) -> R {
        match self {
            Masking::Implicit => mu * mu,
            Masking::HeightCorrelated
            | Masking::Separable
            | Masking::SchlickSmith
            | Masking::HeightCorrelatedApprox
            | Masking::Neubelt => R::from(1.0),
        }
    }

    /// [`Masking::of_mirror`] and n·l V in WGSL, of `mu`, `x` and `alpha`; `projected_area` is the
    /// distribution's.
    pub fn wgsl(self) -> (&'static str, &'static str) {
        match self {
            Masking::HeightCorrelated => (
                "1.0",
                "height_correlated(x, mu, projected_area(x, alpha), projected_area(mu, alpha))",
            ),
            Masking::Separable => {
                ("1.0", "separable(x, mu, projected_area(x, alpha), projected_area(mu, alpha))")
            }
            Masking::SchlickSmith => ("1.0", "schlick_smith(x, mu, alpha)"),
            Masking::HeightCorrelatedApprox => (
                "1.0",
                "height_correlated(x, mu, approx_projected_area(x, alpha), \
                 approx_projected_area(mu, alpha))",
            ),
            Masking::Implicit => ("mu * mu", "implicit(x)"),
            Masking::Neubelt => ("1.0", "neubelt(x, mu)"),
        }
    }
}

/// Height-correlated Smith: G = 1 / (1 + Λ(l) + Λ(v)) (Heitz 2014, equation 99).
#[inline(always)]
pub fn height_correlated<R: Real>(x: R, mu: R, area_l: R, area_v: R) -> R {
    area_v.recip() * 0.5 * (x / (x + mu / area_v * area_l))
}

/// Separable Smith: G = G1(l) G1(v), G1 = 1 / (1 + Λ) (Heitz 2014, equation 98).
#[inline(always)]
pub fn separable<R: Real>(x: R, mu: R, area_l: R, area_v: R) -> R {
    (mu + area_v).recip() * (x / (x + area_l))
}

/// Schlick-Smith: G1(c) = c / (c(1-k) + k) with k = α/2 (Karis 2013, "Real Shading in Unreal Engine
/// 4").
#[inline(always)]
pub fn schlick_smith<R: Real>(x: R, mu: R, alpha: R) -> R {
    let k = alpha * 0.5;
    let k1 = k.complement();
    (mu * k1 + k).recip() * 0.25 * (x / (x * k1 + k))
}

/// The joint approximation of Unreal Engine: height-correlated Smith with c(1-α) + α for c (1 +
/// 2Λ(c)) of GGX (Hammon 2017, "PBR Diffuse Lighting for GGX+Smith Microsurfaces";
/// `Vis_SmithJointApprox`). The result is that term.
#[inline(always)]
pub fn approx_projected_area<R: Real>(c: R, alpha: R) -> R {
    c * alpha.complement() + alpha
}

/// The implicit term: G = n·l n·v, so that V = 1/4 (Hoffman 2013). With any distribution.
#[inline(always)]
pub fn implicit<R: Real>(x: R) -> R {
    x * 0.25
}

/// The visibility of velvet: V = 1 / (4 (n·l + n·v - n·l n·v)) (Neubelt and Pettineo 2013, after
/// Ashikhmin 2007).
#[inline(always)]
pub fn neubelt<R: Real>(x: R, mu: R) -> R {
    x * 0.25 / (x + mu - x * mu)
}
