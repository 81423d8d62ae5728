//! The integral over half vectors for Charlie, whose lobe is a ring at the horizon.
//!
//! With q = tan(β/2), β the elevation of h, so that n·h = sin β = 2q/(1+q²), and φ the azimuth of h
//! from the plane of v:
//!
//! E = ∫ D cos β dβ ∫ 4 v·h (n·l V) F dφ, v·h = (x+μ)/(2 n·h),
//!
//! and x = n·l as in [`super::half_vectors`], of whose two pieces these are the same: half vectors
//! from sin(ε/2) on, ε being the elevation of v, reflect light from above the horizon where φ is
//! small, and those beyond cos(ε/2) for every φ. Seen from the horizon, the ring lies at the start
//! of the first piece, where its nodes crowd, and so do those of the azimuth at its end, where n·l
//! = 0: there the masking term has a layer. The azimuth's end is π where the first piece ends, and
//! before that less by a root of what is left: for a lobe that reaches so far nodes crowd at the
//! end of the first piece too. Without that errors fall with the fifth power of their number only.

use super::half_vectors::{Ring, TAIL_DEPTH, View, cut_circle, full_circle, midpoints};
use super::{Integrals, Kernel};
use crate::brdf::fresnel::Basis;
use crate::brdf::{Microfacet, Ndf};
use crate::numeric::lanes::Real;
use crate::numeric::quadrature::gauss_legendre::{Node, crowded, crowded_at_end, gauss_legendre};
use crate::numeric::special::exponential;

/// Numbers of nodes: `radial` × `azimuth` where the horizon cuts the circle of half vectors,
/// `radial_full` × `azimuth_full` where it does not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RingRule {
    /// Elevations where the circle is cut.
    pub radial: usize,
    /// Azimuths for each of them.
    pub azimuth: usize,
    /// Elevations where it is full.
    pub radial_full: usize,
    /// Azimuths for each of those.
    pub azimuth_full: usize,
}

/// The nodes of a rule.
#[derive(Clone, Debug)]
pub struct RingNodes {
    /// Crowded at 0, for lobes that end where circles are cut; and those for lobes that reach full
    /// circles, crowded at 1 too: there the azimuth ends like a root.
    radial: Vec<[Node; 2]>,
    /// tan(φ/4) / tan(φ_m/4), crowded at 1.
    azimuth: Vec<Node>,
    /// Crowded at 0.
    radial_full: Vec<Node>,
    /// cos φ at the midpoints of (0, π).
    azimuth_full: Vec<Node>,
}

impl RingRule {
    /// Evaluations of the integrand for a texel.
    pub fn evaluations(&self) -> usize {
        self.radial * self.azimuth + self.radial_full * self.azimuth_full
    }

    /// The rule's nodes.
    pub fn nodes(&self) -> RingNodes {
        // u² twice: the layer at the horizon is a logarithm at n·v = 0.
        let ended = crowded(crowded(gauss_legendre(self.radial)));
        let reaching = crowded_at_end(ended.clone());
        RingNodes {
            radial: ended.into_iter().zip(reaching).map(<[Node; 2]>::from).collect(),
            azimuth: crowded_at_end(gauss_legendre(self.azimuth)),
            radial_full: crowded(gauss_legendre(self.radial_full)),
            azimuth_full: midpoints(self.azimuth_full),
        }
    }
}

impl Kernel for RingNodes {
    /// The integrals at n·v = `mu` in [0, 1] and `alpha` in (0, 1].
    #[inline(always)]
    fn integrate<const N: usize, B: Basis<N>, R: Real>(
        &self,
        lobe: Microfacet,
        basis: B,
        mu: R,
        alpha: R,
    ) -> Integrals<N, R> {
        // No other lobe need be compiled.
        let lobe = Microfacet { ndf: Ndf::Charlie, ..lobe };
        let one = R::from(1.0);
        let sv = (mu.complement() * (mu + 1.0)).sqrt();
        // sin(ε/2) and cos(ε/2); the former by μ, since 1 - sv cancels.
        let large = ((sv + 1.0) * 0.5).sqrt();
        let small = mu / (large * 2.0);
        let (first, full) = (small / (large + 1.0), large / (small + 1.0));
        let end = tail_end(large, alpha);
        let lobe = Lobe::new(lobe, basis, mu, sv, alpha);
        let (cut_end, full_end) = (full.min(end), end.max(full));
        let (mut cut, mut whole) = (Integrals::zero(), Integrals::zero());
        let (length, full_length) = (cut_end - first, full_end - full);
        for [ended, reaching] in &self.radial {
            let at = full.select_below(end, R::from(reaching.at), R::from(ended.at));
            let weight = full.select_below(end, R::from(reaching.weight), R::from(ended.weight));
            let q = first + length * at;
            let (ring, density) = lobe.ring(q, q.complement());
            let part = cut_circle(lobe.view, ring, &self.azimuth);
            cut.add(density * length * weight, part.0);
        }
        for node in &self.radial_full {
            // 1 - q, which is what D depends on at the normal.
            let rest = full_end.complement() + full_length * node.at;
            let (ring, weight) = lobe.ring(rest.complement(), rest);
            let part = full_circle(lobe.view, ring, &self.azimuth_full);
            whole.add(weight * full_length * node.weight, part.0);
        }
        let mut sum = cut.where_positive(sv).where_positive(length);
        sum.add(one, whole.where_positive(mu).where_positive(full_length).0);
        sum
    }
}

/// The q where (cos β)^(1/α) has fallen to exp(-TAIL_DEPTH) of what it is at the start, whose cos β
/// is `large`.
#[inline(always)]
pub(super) fn tail_end<R: Real>(large: R, alpha: R) -> R {
    let rest2 = large * large * exponential(alpha * (-2.0 * TAIL_DEPTH));
    (rest2.complement().max(R::from(0.0)).sqrt() / (rest2.sqrt() + 1.0)).min(R::from(1.0))
}

/// The lobe as seen from one direction.
#[derive(Clone, Copy)]
pub(super) struct Lobe<B, R> {
    lobe: Microfacet,
    /// What is the same for all half vectors.
    pub view: View<B, R>,
    mu: R,
    sv: R,
    alpha: R,
}

impl<B, R: Real> Lobe<B, R> {
    /// From n·v = `mu`, `sv` being sin θ_v.
    #[inline(always)]
    pub fn new(lobe: Microfacet, basis: B, mu: R, sv: R, alpha: R) -> Self {
        Lobe { lobe, view: View::new(lobe, basis, mu, alpha), mu, sv, alpha }
    }

    /// The half vectors of one q, and the weight of their circle: D cos β (dβ/dq)/n·h, the factor
    /// 1/n·h being that of v·h. `rest` is 1 - q.
    #[inline(always)]
    pub fn ring(&self, q: R, rest: R) -> (Ring<R>, R) {
        let Lobe { lobe, mu, sv, alpha, .. } = *self;
        let r = (q * q + 1.0).recip();
        // n·h and cos β
        let (z, c) = (q * 2.0 * r, rest * (q + 1.0) * r);
        let secant2 = (z * z).recip();
        let ring = Ring {
            m: mu * (z * z * 2.0 - 1.0),
            s: sv * z * c * 2.0,
            secant2,
            half_secant: z.recip() * 0.5,
        };
        let inverse_width2 = alpha * 4.0;
        let slope2 = c * c * secant2;
        let density = lobe.ndf.slope_density(slope2 * inverse_width2, alpha);
        let d = density * inverse_width2 * (secant2 * secant2);
        (ring, d * c * r * 2.0 * z.recip())
    }
}
