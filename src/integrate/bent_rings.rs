//! The integral over half vectors for Charlie with the term that it was fitted with, which bends at
//! n·l = 1/2.
//!
//! The variables are those of [`super::rings`]. On a circle of half vectors n·l falls with φ, so
//! that an arc near φ = 0 reflects light from above the bend and the rest from below it. Circles
//! are alike in this between four elevations:
//!
//! - from ε/2 on, ε being the elevation of v, the horizon cuts them;
//! - from (ε + θ)/2 on, sin θ = 1/2, the bend does;
//! - at (ε + π - θ)/2 or (π + θ - ε)/2, whichever is at most π/2, it does so for the last time;
//! - from (π - ε)/2 on they are whole.
//!
//! Between these the integrand is smooth on either arc, but for a power of n·l at the horizon and
//! of 1 - n·l where l is upright, at which nodes crowd.

use super::half_vectors::{Ring, View, cut_circle, full_circle, integrand, midpoints};
use super::rings::{Lobe, tail_end};
use super::{Integrals, Kernel};
use crate::brdf::fresnel::Basis;
use crate::brdf::{Microfacet, Ndf};
use crate::numeric::lanes::Real;
use crate::numeric::quadrature::gauss_legendre::{
    Node, crowded, crowded_at_end, gauss_legendre, half_gauss,
};

/// Numbers of nodes, radial before azimuth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BentRingRule {
    /// On the circles below the first of the upper three elevations.
    pub first: [usize; 2],
    /// On those of each of the two pieces that follow: elevations, azimuths above the bend and
    /// below it.
    pub middle: [usize; 3],
    /// Above the last one.
    pub last: [usize; 2],
}

/// The nodes of a rule.
#[derive(Clone, Debug)]
pub struct BentRingNodes {
    first: Circles,
    middle: [Vec<Node>; 3],
    last: Circles,
}

#[derive(Clone, Debug)]
struct Circles {
    radial: Vec<Node>,
    azimuth: Vec<Node>,
}

impl BentRingRule {
    /// Evaluations of the integrand for a texel.
    pub fn evaluations(&self) -> usize {
        let [elevations, above, below] = self.middle;
        let of = |[radial, azimuth]: [usize; 2]| radial * azimuth;
        of(self.first) + 2 * elevations * (above + below) + of(self.last)
    }

    /// The rule's nodes.
    pub fn nodes(&self) -> BentRingNodes {
        let [elevations, above, below] = self.middle;
        BentRingNodes {
            first: Circles {
                // u² twice, as in the rules without a bend.
                radial: crowded(crowded(gauss_legendre(self.first[0]))),
                azimuth: crowded_at_end(gauss_legendre(self.first[1])),
            },
            middle: [
                gauss_legendre(elevations),
                half_gauss(above),
                crowded_at_end(gauss_legendre(below)),
            ],
            last: Circles {
                radial: crowded(gauss_legendre(self.last[0])),
                azimuth: midpoints(self.last[1]),
            },
        }
    }
}

impl Kernel for BentRingNodes {
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
        // sin θ and cos θ. Without a bend all light is below it.
        let bend = lobe.break_at(alpha).unwrap_or(one);
        let level = (bend.complement() * (bend + 1.0)).sqrt();
        let sv = (mu.complement() * (mu + 1.0)).sqrt();
        // sin(ε/2) and cos(ε/2)
        let large = ((sv + 1.0) * 0.5).sqrt();
        let small = mu / (large * 2.0);
        let (start, whole) = (small / (large + 1.0), large / (small + 1.0));
        let end = tail_end(large, alpha);
        let lower = of_double(level * sv - bend * mu);
        let upper = of_double(-(level * sv + bend * mu));
        let clipped = |q: R| q.min(end).max(start);
        let ends = [
            start,
            clipped(lower.min(whole)),
            clipped(lower.max(whole.min(upper))),
            clipped(upper.max(whole)),
            clipped(one),
        ];
        let lobe = Lobe::new(lobe, basis, mu, sv, alpha);
        let mut sum = Integrals::zero();
        let mut add = |part: Integrals<N, R>, piece: usize| {
            sum.add(one, part.where_positive(ends[piece + 1] - ends[piece]).0);
        };
        add(self.first_circles(&lobe, ends[0], ends[1]), 0);
        add(self.bent_circles(&lobe, bend, ends[1], ends[2]), 1);
        add(self.bent_circles(&lobe, bend, ends[2], ends[3]), 2);
        add(self.last_circles(&lobe, ends[3], ends[4]), 3);
        sum
    }
}

impl BentRingNodes {
    /// Cut by the horizon, below the bend.
    #[inline(always)]
    fn first_circles<const N: usize, B: Basis<N>, R: Real>(
        &self,
        lobe: &Lobe<B, R>,
        start: R,
        end: R,
    ) -> Integrals<N, R> {
        let mut sum = Integrals::zero();
        for node in &self.first.radial {
            let q = start + (end - start) * node.at;
            let (ring, weight) = lobe.ring(q, q.complement());
            let part = cut_circle(lobe.view, ring, &self.first.azimuth);
            sum.add(weight * (end - start) * node.weight, part.0);
        }
        sum
    }

    /// Cut by the bend, and by the horizon or not.
    #[inline(always)]
    fn bent_circles<const N: usize, B: Basis<N>, R: Real>(
        &self,
        lobe: &Lobe<B, R>,
        bend: R,
        start: R,
        end: R,
    ) -> Integrals<N, R> {
        let [radial, above, below] = &self.middle;
        let mut sum = Integrals::zero();
        for node in radial {
            let q = start + (end - start) * node.at;
            let (ring, weight) = lobe.ring(q, q.complement());
            let circle = Circle::new(ring, bend);
            let mut part = circle.arc(lobe.view, R::from(0.0), circle.bend, above);
            part.add(R::from(1.0), circle.arc(lobe.view, circle.bend, circle.end, below).0);
            sum.add(weight * (end - start) * node.weight, part.0);
        }
        sum
    }

    /// Whole, on one side of the bend.
    #[inline(always)]
    fn last_circles<const N: usize, B: Basis<N>, R: Real>(
        &self,
        lobe: &Lobe<B, R>,
        start: R,
        end: R,
    ) -> Integrals<N, R> {
        let mut sum = Integrals::zero();
        for node in &self.last.radial {
            let rest = end.complement() + (end - start) * node.at;
            let (ring, weight) = lobe.ring(rest.complement(), rest);
            let part = full_circle(lobe.view, ring, &self.last.azimuth);
            sum.add(weight * (end - start) * node.weight, part.0);
        }
        sum
    }
}

/// q = tan(β/2) of cos 2β.
#[inline(always)]
fn of_double<R: Real>(cos: R) -> R {
    let c = ((cos + 1.0).max(R::from(0.0)) * 0.5).sqrt();
    (c.complement().max(R::from(0.0)) / (c + 1.0)).sqrt()
}

/// A circle of half vectors, as tan(φ/4).
struct Circle<R> {
    ring: Ring<R>,
    /// At the bend.
    bend: R,
    /// At the horizon, or 1 where the circle does not meet it.
    end: R,
    /// cos(φ/2) at the end.
    half: R,
    /// n·l at the end.
    least: R,
}

impl<R: Real> Circle<R> {
    #[inline(always)]
    fn new(ring: Ring<R>, bend: R) -> Self {
        let (one, zero) = (R::from(1.0), R::from(0.0));
        let half = |cos: R| ((cos + 1.0) * 0.5).sqrt();
        let quarter = |cos: R| (cos.complement() * 0.5).sqrt() / (half(cos) + 1.0);
        let at_horizon = (-ring.m / ring.s).max(-one).min(one);
        let at_bend = ((bend - ring.m) / ring.s).max(at_horizon).min(one);
        let least = (ring.m - ring.s).max(zero);
        let (bend, end) = (quarter(at_bend), quarter(at_horizon));
        Circle { ring, bend, end, half: half(at_horizon), least }
    }

    /// The azimuth integral from one tan(φ/4) to another, on either side of the plane.
    #[inline(always)]
    fn arc<const N: usize, B: Basis<N>>(
        &self,
        view: View<B, R>,
        from: R,
        to: R,
        nodes: &[Node],
    ) -> Integrals<N, R> {
        let Circle { ring, end, half, least, .. } = *self;
        let length = to - from;
        let scale = ring.s * 4.0 / (end * end + 1.0);
        let mut sum = Integrals::zero();
        for node in nodes {
            let t = from + length * node.at;
            // Without cancellation at the horizon, where `to` is the end.
            let to_end = (end - to) + length * (1.0 - node.at);
            let r = (t * t + 1.0).recip();
            let c = (t * t).complement() * r;
            let x = least + scale * to_end * (end + t) * r * (c + half);
            sum.add(length * 8.0 * r * node.weight, integrand(view, x, ring.half_secant));
        }
        sum
    }
}
