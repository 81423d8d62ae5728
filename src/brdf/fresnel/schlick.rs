//! Schlick's approximation: F = F0 + (1 - F0) (1 - v·h)⁵ (Schlick 1994, "An Inexpensive BRDF Model
//! for Physically-Based Rendering"), so that E(F0) = F0 A + B (Karis 2013).

use super::{Basis, Definition, Integral};
use crate::numeric::ball::Ball;
use crate::numeric::lanes::{Number, Real};

/// Schlick's approximation.
#[derive(Clone, Copy, Debug)]
pub struct Schlick;

/// A with Schlick's weights.
pub(super) const A: Integral = Integral {
    name: "A",
    meaning: "scale: E(F0) = F0*A + B",
    relative_error: 1.0,
    absolute_error: 0.0,
};
/// B with Schlick's weights.
pub(super) const B: Integral = Integral {
    name: "B",
    meaning: "bias: E(F0) = F0*A + B",
    relative_error: 1.0,
    absolute_error: 0.0,
};

/// Everything of it but the formulas.
pub(super) const DEFINITION: Definition = Definition {
    word: "schlick",
    usage: "schlick",
    about: "F = F0 + (1-F0) (1-v.h)^5 (Schlick 1994)",
    formula: "Schlick: F = F0 + (1 - F0) (1 - v.h)^5",
    albedo: "E(F0) = F0*A + B",
    channels: "ab",
    smooth_complement: true,
    integrals: &[A, B],
    wgsl: (include_str!("../../../shaders/schlick.wgsl"), "schlick_weights"),
};

impl Basis<2> for Schlick {
    const DEFINITION: Definition = DEFINITION;

    #[inline(always)]
    fn weights<R: Real>(self, vh: R) -> [R; 2] {
        schlick_weights(vh)
    }

    fn of_mirror(self, mu: f64) -> [Ball; 2] {
        [schlick_complement(mu.into()), schlick_weight(mu.into())]
    }
}

/// (1 - w, w) with w = (1 - v·h)⁵.
#[inline(always)]
pub fn schlick_weights<R: Real>(vh: R) -> [R; 2] {
    let w = schlick_weight(vh);
    [w.complement(), w]
}

/// (1 - c)⁵.
#[inline(always)]
pub fn schlick_weight<R: Number>(cosine: R) -> R {
    let c = R::from(1.0) - cosine;
    let c2 = c * c;
    c2 * c2 * c
}

/// 1 - (1 - c)⁵ = c (1 + q (1 + q (1 + q (1 + q)))) with q = 1 - c: without the cancellation of 1 -
/// F at grazing angles.
#[inline(always)]
pub fn schlick_complement<R: Number>(cosine: R) -> R {
    let one = R::from(1.0);
    let q = one - cosine;
    cosine * (one + q * (one + q * (one + q * (one + q))))
}

/// The average of F over all directions, 2 ∫_0^1 F(μ) μ dμ = F0 + (1 - F0)/21.
pub fn average_schlick(f0: f64) -> f64 {
    f0 + (1.0 - f0) / 21.0
}
