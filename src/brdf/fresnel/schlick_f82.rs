//! Schlick's approximation with the tint of metals at 82°, where F dips before it rises to 1:
//!
//! F = F0 + (1 - F0) (1 - c)⁵ - a c (1 - c)⁶ with c = v·h, a = (F0 + (1 - F0) (1 - c̄)⁵) (1 - tint)
//! / (c̄ (1 - c̄)⁶) and c̄ = 1/7, where the last weight is largest; there F is `tint` times
//! Schlick's.
//!
//! Hoffman, "Fresnel Equations Considered Harmful", 2019; Kutz, Hašan and Edmondson, "Novel aspects
//! of the Adobe Standard Material", 2021. The albedo is E = F0 A + B - a C.

use super::schlick::{schlick_complement, schlick_weight};
use super::{Basis, Definition, Integral};
use crate::numeric::ball::Ball;
use crate::numeric::lanes::Real;

/// Schlick's approximation with F82 tint.
#[derive(Clone, Copy, Debug)]
pub struct SchlickF82;

impl Basis<3> for SchlickF82 {
    const DEFINITION: Definition = Definition {
        word: "f82",
        usage: "f82",
        about: "the same less a v.h (1-v.h)^6: metals with an F82 tint (Hoffman 2019; Kutz et al. \
                2021)",
        formula: "Schlick with F82 tint: F = F0 + (1 - F0) (1 - v.h)^5 - a v.h (1 - v.h)^6, a = \
                  (F0 + (1 - F0) (6/7)^5) (1 - tint) 7 (7/6)^6",
        albedo: "E(F0, tint) = F0*A + B - a*C",
        channels: "abc",
        smooth_complement: true,
        integrals: &[
            Integral {
                name: "A",
                meaning: "scale: E = F0*A + B - a*C",
                relative_error: 1.0,
                absolute_error: 0.0,
            },
            Integral {
                name: "B",
                meaning: "bias: E = F0*A + B - a*C",
                relative_error: 1.0,
                absolute_error: 0.0,
            },
            Integral {
                name: "C",
                meaning: "tint: E = F0*A + B - a*C, a = (F0 + (1-F0) (6/7)^5) (1-tint) 7 (7/6)^6",
                // The largest that a search found is 2.6.
                relative_error: 4.0,
                absolute_error: 0.0,
            },
        ],
        wgsl: (include_str!("../../../shaders/schlick_f82.wgsl"), "schlick_f82_weights"),
    };

    #[inline(always)]
    fn weights<R: Real>(self, vh: R) -> [R; 3] {
        schlick_f82_weights(vh)
    }

    fn of_mirror(self, mu: f64) -> [Ball; 3] {
        let (mu, one) = (Ball::exact(mu), Ball::exact(1.0));
        let w = schlick_weight(mu);
        [schlick_complement(mu), w, mu * (one - mu) * w]
    }
}

/// (1 - w, w, c (1 - c) w) with c = v·h and w = (1 - c)⁵.
#[inline(always)]
pub fn schlick_f82_weights<R: Real>(vh: R) -> [R; 3] {
    let w = schlick_weight(vh);
    [w.complement(), w, vh * vh.complement() * w]
}
