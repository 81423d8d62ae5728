//! How a definition becomes a number: E(F0) = F0 A + B by quadrature, by three formulas.
//!
//! With n·v = μ, n·l = x and Schlick's F: E = ∫ f n·l dω = F0 A + B, A = ∫ f/F (1-w) n·l dω, B = ∫ f/F w n·l dω,
//! w = (1 - v·h)^5. The limits on the edges: α = 0 is a mirror, whatever n·v.

pub mod average;
pub mod bounds;
pub mod h_space;
pub mod l_space;
pub mod reference;
pub mod rule;
pub mod rules;
pub mod surrogate;

use crate::ball::Ball;
use crate::lanes::{Number, Real};
use crate::model::fresnel::{schlick_complement, schlick_weight};
use crate::model::{Diffuse, Microfacet};

/// What is integrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integrand {
    /// A specular lobe, to (A, B).
    Specular(Microfacet),
    /// A white diffuse lobe, to (E, 0); the grid's α is the square of its roughness.
    Diffuse(Diffuse),
}

impl From<Microfacet> for Integrand {
    fn from(lobe: Microfacet) -> Self {
        Integrand::Specular(lobe)
    }
}

impl Integrand {
    /// Whether an albedo can exceed 1.
    pub fn may_exceed_one(self) -> bool {
        match self {
            Integrand::Specular(lobe) => lobe.may_exceed_one(),
            Integrand::Diffuse(_) => true,
        }
    }
}

/// The two numbers of the split sum: E(F0) = F0 · `a` + `b` (Karis 2013).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScaleBias<R = f64> {
    /// A, the scale of F0.
    pub a: R,
    /// B, the bias.
    pub b: R,
}

impl<R: Real> ScaleBias<R> {
    /// Nothing.
    #[inline(always)]
    pub fn zero() -> Self {
        ScaleBias { a: R::from(0.0), b: R::from(0.0) }
    }

    /// Adds `weight` times `part`.
    #[inline(always)]
    pub fn add(&mut self, weight: R, part: ScaleBias<R>) {
        self.a = self.a + weight * part.a;
        self.b = self.b + weight * part.b;
    }

    /// The same in the lanes where `value` is above 0, nothing in the others.
    #[inline(always)]
    pub fn where_positive(self, value: R) -> Self {
        let zero = R::from(0.0);
        ScaleBias { a: zero.select_below(value, self.a, zero), b: zero.select_below(value, self.b, zero) }
    }
}

impl<R: Number> ScaleBias<R> {
    /// The limit α → 0 at fixed n·v: a perfect mirror, times `limit` ([`crate::model::Microfacet::smooth_limit`]).
    pub fn mirror(mu: R, limit: R) -> Self {
        ScaleBias { a: limit * schlick_complement(mu), b: limit * schlick_weight(mu) }
    }
}

impl ScaleBias {
    /// The directional albedo at F = 1: E = A + B.
    pub fn e(self) -> f64 {
        self.a + self.b
    }

    /// E(F0) = F0 A + B.
    pub fn at_f0(self, f0: f64) -> f64 {
        f0 * self.a + self.b
    }

    /// Each number at most so far from the truth.
    pub fn within(self, errors: ScaleBias) -> ScaleBias<Ball> {
        ScaleBias { a: Ball { value: self.a, error: errors.a }, b: Ball { value: self.b, error: errors.b } }
    }
}

impl ScaleBias<Ball> {
    /// The directional albedo at F = 1: E = A + B.
    pub fn e(self) -> Ball {
        self.a + self.b
    }

    /// E(F0) = F0 A + B.
    pub fn at_f0(self, f0: f64) -> Ball {
        Ball::exact(f0) * self.a + self.b
    }
}
