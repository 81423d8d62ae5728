//! The integral over directions of light for lobes whose slopes end like a Gaussian's: Beckmann and
//! Blinn-Phong. Few nodes make it as sharp as the double exponential rules.
//!
//! In the plane of v and n, T = α y is the slope of the half vector and w the azimuth of l from the
//! mirror direction; t = T² + τ² sin²(w/2) is tan² θ_h, τ² = 4 sin θ_v sin θ_l/(μ+x)²
//! ([`super::double_exponential`] has the same variables), and
//!
//! E = ∫ (2 sin θ_l/(1+T²)) (n·l V) α dy ∫ D(t) F dw.
//!
//! *The slope.* Beyond the lobe's end, |y| = 6.3 for Beckmann, there is nothing, so that a Gauss
//! rule up to there converges at once. It crowds at the horizon, where the masking term has a
//! layer, and is split where that term jumps.
//!
//! *The azimuth.* tan(w/2) = k tan(ψ/2), k² = 1/(1 + κ/10), κ = τ²/α² for Beckmann and
//! τ² (1/α² - 1) for Blinn-Phong: how fast the exponent falls at the centre. It is a Möbius map of
//! the circle onto itself, under which a peak of any width looks alike, and the integrand stays
//! smooth and periodic. The midpoint rule in ψ converges faster than any power of its nodes.

use super::half_vectors::TAIL_DEPTH;
use super::{Integrals, Kernel};
use crate::brdf::fresnel::Basis;
use crate::brdf::{Microfacet, Ndf};
use crate::numeric::lanes::Real;
use crate::numeric::quadrature::gauss_legendre::gauss_legendre;
use std::f64::consts::PI;

/// Numbers of nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightPlaneRule {
    /// For the slope; as many on either side of a jump.
    pub slope: usize,
    /// For the azimuth.
    pub azimuth: usize,
}

/// The nodes of a rule.
#[derive(Clone, Debug)]
pub struct LightPlaneNodes {
    slope: Vec<SlopeNode>,
    azimuth: Vec<AzimuthNode>,
}

#[derive(Clone, Copy, Debug)]
struct SlopeNode {
    /// Distances to the ends of an interval of length 1.
    from_start: f64,
    to_end: f64,
    weight: f64,
}

#[derive(Clone, Copy, Debug)]
struct AzimuthNode {
    /// tan²(ψ/2)
    z2: f64,
    /// dψ over cos²(ψ/2), either side of the plane.
    weight: f64,
}

/// κ/10 in k². With twelve nodes this share makes the largest error over all κ smallest: 3e-9 of a
/// Gaussian's integral.
const SHARE: f64 = 0.1;

impl LightPlaneRule {
    /// Evaluations of the integrand for a texel, of a lobe without a jump.
    pub fn evaluations(&self) -> usize {
        self.slope * self.azimuth
    }

    /// The rule's nodes.
    pub fn nodes(&self) -> LightPlaneNodes {
        let crowd = |u: f64, weight: f64| SlopeNode {
            from_start: u * u,
            to_end: (1.0 - u) * (1.0 + u),
            weight: 2.0 * u * weight,
        };
        let count = self.azimuth as f64;
        let midpoint = |j: usize| {
            let z = libm::tan(0.5 * PI * (j as f64 + 0.5) / count);
            AzimuthNode { z2: z * z, weight: 2.0 * PI / count * (1.0 + z * z) }
        };
        LightPlaneNodes {
            slope: gauss_legendre(self.slope)
                .iter()
                .map(|node| crowd(node.at, node.weight))
                .collect(),
            azimuth: (0..self.azimuth).map(midpoint).collect(),
        }
    }
}

impl Kernel for LightPlaneNodes {
    /// The integrals at n·v = `mu` in [0, 1] and `alpha` in (0, 1].
    #[inline(always)]
    fn integrate<const N: usize, B: Basis<N>, R: Real>(
        &self,
        lobe: Microfacet,
        basis: B,
        mu: R,
        alpha: R,
    ) -> Integrals<N, R> {
        let sv = (mu.complement() * (mu + 1.0)).sqrt();
        let (low, high) = (mu / (sv + 1.0), sv / (mu + 1.0));
        let end = alpha * lobe.ndf.slope_end(alpha, TAIL_DEPTH);
        let (first, last) = (-low.min(end), high.min(end));
        let area_v = lobe.masking_projected_area(mu, alpha);
        let view = View { lobe, basis, mu, area_v, sv, alpha, low, high };
        let Some(x) = lobe.break_at(alpha) else { return view.piece(first, last, self) };
        let slope = (x - mu) / (sv + (x.complement() * (x + 1.0)).sqrt());
        let jump = slope.max(first).min(last);
        let mut sum = view.piece(first, jump, self);
        sum.add(R::from(1.0), view.piece(jump, last, self).0);
        sum
    }
}

struct View<B, R> {
    lobe: Microfacet,
    basis: B,
    mu: R,
    /// [`Microfacet::masking_projected_area`] of n·v.
    area_v: R,
    sv: R,
    alpha: R,
    /// T = -low at n·l = 0.
    low: R,
    /// T = high at n·l = 1.
    high: R,
}

impl<B, R: Real> View<B, R> {
    /// The integrals over the slopes from `start` to `end`; nothing where they are the same.
    #[inline(always)]
    fn piece<const N: usize>(&self, start: R, end: R, nodes: &LightPlaneNodes) -> Integrals<N, R>
    where
        B: Basis<N>,
    {
        let length = end - start;
        let (to_low, to_high) = (start + self.low, self.high - end);
        let mut sum = Integrals::zero();
        for node in &nodes.slope {
            // The distances to either horizon, n·l = 0 and n·l = 1, without cancellation.
            let (from_low, from_high) =
                (to_low + length * node.from_start, to_high + length * node.to_end);
            let slope = start + length * node.from_start;
            let value = self.plane(slope, from_low, from_high, &nodes.azimuth);
            sum.add(length * node.weight, value.0);
        }
        sum.where_positive(length)
    }

    /// The derivatives of the integrals by T at the slope T, whose distances from the slopes of n·l
    /// = 0 and n·l = 1 are given.
    #[inline(always)]
    fn plane<const N: usize>(
        &self,
        slope: R,
        from_low: R,
        from_high: R,
        azimuth: &[AzimuthNode],
    ) -> Integrals<N, R>
    where
        B: Basis<N>,
    {
        let View { lobe, basis, mu, area_v, sv, alpha, .. } = self;
        let f = slope * slope + 1.0;
        let x = from_low * (-(*mu * from_low) + 2.0) / f;
        let sl = from_high * (-(*sv * from_high) + 2.0) / f;
        let m = (*mu + x) * (*mu + x);
        let ss = *sv * sl;
        let (t0, tau2, a2) = (slope * slope, ss * 4.0 / m, *alpha * *alpha);
        // κ/τ²
        let fall = match lobe.ndf {
            Ndf::BlinnPhong => a2.recip() - 1.0,
            _ => a2.recip(),
        };
        let k2 = (tau2 * fall * SHARE + 1.0).recip();
        let (c0, inverse_a2) = (m * f * 0.25, a2.recip());
        let mut sum = Integrals::zero();
        for node in azimuth {
            let z2 = k2 * node.z2;
            let r = (z2 + 1.0).recip();
            let sin2 = z2 * r;
            let t = t0 + tau2 * sin2;
            let secant2 = t + 1.0;
            let density = lobe.ndf.slope_density(t * inverse_a2, *alpha) * (secant2 * secant2);
            sum.add(density * r * node.weight, basis.weights((c0 + ss * sin2).sqrt()));
        }
        let visible = lobe.cosine_visibility_at(x, *mu, *area_v, *alpha);
        let outer = k2.sqrt() * 2.0 * sl * inverse_a2 / f * visible;
        Integrals(sum.0.map(|inner| outer * inner)).where_positive(x).where_positive(sl)
    }
}
