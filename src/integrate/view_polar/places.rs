//! Places of the outer variable p of the polar form about v, and angles between them without
//! cancellation.

use crate::brdf::interface::{Interface, Side};
use crate::numeric::lanes::Real;

/// Places in p.
#[derive(Clone, Copy)]
pub(super) struct Landmarks<R> {
    /// θ = 0.
    pub(super) first: R,
    /// The critical angle; from the thinner side c = √k, below which F rises to 1.
    pub(super) critical: R,
    /// c = 0.
    pub(super) grazing: R,
    /// θ_1
    pub(super) full: R,
    /// θ_2
    pub(super) cut: R,
    /// θ = π/2 - θ_v
    pub(super) upright: R,
    /// tan θ = μη/(1 - η sv)
    pub(super) horizon: R,
}

/// A place of the outer variable: p, with its distances from both ends of its piece.
#[derive(Clone, Copy)]
pub(super) struct Place<R> {
    pub(super) p: R,
    pub(super) start: R,
    pub(super) end: R,
    pub(super) from_start: R,
    pub(super) to_end: R,
}

impl<R: Real> Place<R> {
    /// tan((θ_j - θ)/2), with full relative precision where p_j is an end of the piece.
    #[inline(always)]
    pub(super) fn half_tangent_to(self, p_j: R) -> R {
        let middle = (self.start + self.end) * 0.5;
        let after = -(self.from_start + (self.start - p_j));
        let before = self.to_end + (p_j - self.end);
        p_j.select_below(middle, after, before) / (p_j * self.p + 1.0)
    }

    /// sin(θ_j - θ)
    #[inline(always)]
    pub(super) fn sine_to(self, p_j: R) -> R {
        let q = self.half_tangent_to(p_j);
        q * 2.0 / (q * q + 1.0)
    }

    /// cos(θ_v + 2θ) and cos(2θ - θ_v), whose difference is `swing` = 2 sv sin 2θ.
    ///
    /// They are sin 2(θ_1 - θ) and sin 2(θ_2 - θ), which cancel where the angle is near a right
    /// one; there the other is far from it.
    #[inline(always)]
    pub(super) fn to_horizon(self, at: Landmarks<R>, swing: R) -> (R, R) {
        let double_sine = |q: R| {
            let q2 = q * q;
            q * 4.0 * q2.complement() / ((q2 + 1.0) * (q2 + 1.0))
        };
        let (first, second) = (self.half_tangent_to(at.full), self.half_tangent_to(at.cut));
        let (low, high) = (double_sine(first), double_sine(second));
        let half = R::from(0.5);
        (
            first.abs().select_below(half, low, high - swing),
            second.abs().select_below(half, high, low + swing),
        )
    }
}

/// tan(a - b)
#[inline(always)]
fn difference<R: Real>(a: R, b: R) -> R {
    (a - b) / (a * b + 1.0)
}

impl<R: Real> Landmarks<R> {
    #[inline(always)]
    pub(super) fn new(interface: Interface, mu: R, from_critical: R, sv: R) -> Self {
        let (one, eta) = (R::from(1.0), interface.eta());
        let half_view = sv / (mu + 1.0);
        let grazing = mu / (sv + 1.0);
        let cut = grazing / ((grazing * grazing + 1.0).sqrt() + 1.0);
        // sin²θ_c - sin²θ_v, from what does not cancel.
        let critical = R::from(interface.critical());
        let squares = from_critical * (mu + critical);
        let (critical, horizon) = match interface.side() {
            Side::Inside => {
                let sine = squares / (sv * critical + mu * eta);
                let below = squares / (sv + eta);
                (
                    sine / (mu * critical + sv * eta + 1.0),
                    below / ((below * below + mu * mu).sqrt() + mu).max(R::from(f64::MIN_POSITIVE)),
                )
            }
            Side::Outside => {
                let c = R::from(interface.k()).sqrt().min(one);
                let s = (c.complement() * (c + 1.0)).sqrt();
                ((mu * s - sv * c) / (mu * c + sv * s + 1.0), one)
            }
        };
        Landmarks {
            first: -half_view,
            critical,
            grazing,
            full: difference(cut, half_view),
            cut,
            upright: difference(grazing, half_view),
            horizon,
        }
    }
}
