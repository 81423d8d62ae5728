//! What the polynomials follow, and over which stretches of n·v: see [`super`].

use super::Beyond;
use super::map::Placement;
use crate::brdf::fresnel::Basis;
use crate::brdf::{Microfacet, Ndf};
use crate::integrate::Integrals;
use crate::numeric::lanes::Real;
use crate::numeric::special::exponential;

/// What the polynomials of a piece follow.
#[derive(Clone, Copy, Debug)]
pub(super) struct Follows {
    pub lobe: Microfacet,
    pub beyond: Beyond,
    /// Whether one polynomial follows the integrals on either side of a break.
    pub apart: bool,
}

/// A part of [0, 1] that one polynomial spans in n·v.
#[derive(Clone, Copy, Debug)]
pub(super) enum Stretch {
    /// Between these s.
    Between(f64, f64),
    /// From a bend to μ = 1, about which the fitted term of Charlie is a power of 1-μ: √(1-μ).
    Upright(f64),
}

impl Stretch {
    /// The place in [0, 1] of n·v = `mu`, whose place along s is given.
    #[inline(always)]
    pub fn of<R: Real>(self, mu: R, s: R) -> R {
        match self {
            Stretch::Between(from, to) => (s - from) * (1.0 / (to - from)),
            Stretch::Upright(bend) => (mu.complement() * (1.0 / (1.0 - bend))).sqrt().complement(),
        }
    }

    /// n·v at a place in [0, 1].
    pub fn inverse(self, place: &Placement, t: f64) -> f64 {
        match self {
            Stretch::Between(from, to) => place.inverse(from + (to - from) * t),
            Stretch::Upright(bend) => 1.0 - (1.0 - bend) * (1.0 - t) * (1.0 - t),
        }
    }
}

impl Follows {
    /// n·v of the break at an α, if the polynomials are apart there.
    pub fn break_at(self, alpha: f64) -> Option<f64> {
        self.lobe.break_at(alpha).filter(|_| self.apart)
    }

    /// The number of polynomials over n·v.
    pub fn sides(self) -> usize {
        1 + usize::from(self.break_at(1.0).is_some())
    }

    /// What each of them spans at an α.
    pub fn stretches(self, place: &Placement, alpha: f64) -> Vec<Stretch> {
        match self.break_at(alpha) {
            None => vec![Stretch::Between(0.0, 1.0)],
            Some(mu) => {
                let at = place.of(mu);
                let above = match self.lobe.jumps() {
                    true => Stretch::Between(at, 1.0),
                    false => Stretch::Upright(mu),
                };
                vec![Stretch::Between(0.0, at), above]
            }
        }
    }

    /// What is subtracted from E.
    #[inline(always)]
    fn limit<R: Real>(self, mu: R) -> R {
        match self.beyond {
            Beyond::Nothing => R::from(0.0),
            Beyond::Limit => self.lobe.smooth_limit(mu),
        }
    }

    /// What the polynomials are multiplied by, if anything. Charlie's integrals grow like 1/√α as
    /// α → 0, and with the fitted term like the inverse of n·v (1 + 2Λ); beyond n·v ~ √α they fall
    /// like exp(-(n·v)²/(8α)).
    #[inline(always)]
    fn scale<R: Real>(self, mu: R, alpha: f64) -> Option<R> {
        if self.lobe.ndf != Ndf::Charlie || self.beyond == Beyond::Nothing {
            return None;
        }
        let fall = exponential(mu * mu * (-0.125 / alpha)) * (1.0 / alpha.sqrt());
        Some(match self.lobe.diverges_at_grazing() {
            true => fall / self.lobe.masking_projected_area(mu, R::from(alpha)),
            false => fall,
        })
    }

    /// E less its limit, and the rests of the integrals, over their scale.
    pub fn follow<const N: usize, B: Basis<N>>(
        self,
        basis: B,
        (mu, alpha): (f64, f64),
        integrals: &[f64],
    ) -> [f64; N] {
        let e: f64 = integrals.iter().take(2).sum();
        let (weights, scale) = (basis.weights(mu), self.scale(mu, alpha).unwrap_or(1.0));
        let beyond = |k: usize| match k {
            0 => e - self.limit(mu),
            _ => integrals[k] - weights[k] * e,
        };
        std::array::from_fn(|k| beyond(k) / scale)
    }

    /// The inverse of [`Follows::follow`].
    #[inline(always)]
    pub fn unfollow<const N: usize, B: Basis<N>, R: Real>(
        self,
        basis: B,
        mu: R,
        alpha: f64,
        followed: [R; N],
    ) -> Integrals<N, R> {
        let weights = basis.weights(mu);
        let beyond = match self.scale(mu, alpha) {
            Some(scale) => followed.map(|value| value * scale),
            None => followed,
        };
        let e = beyond[0] + self.limit(mu);
        let mut integrals = Integrals::zero();
        for k in 1..N {
            integrals.0[k] = beyond[k] + weights[k] * e;
        }
        integrals.0[0] = e - integrals.0[1];
        integrals
    }
}
