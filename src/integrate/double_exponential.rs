//! The reference: the integral over directions of light, by double exponential quadrature in both
//! variables, for any lobe.
//!
//! In the plane of v and n, T = tan((θ_v - θ_l)/2) is the slope of the half vector; w is the
//! azimuth of l from the mirror direction, z = tan(w/2). Then tan² θ_h = t = T² + 4 sin θ_v sin
//! θ_l/(μ+x)² sin²(w/2), and
//!
//! E = ∫ (2 sin θ_l/(1+T²)) (n·l V) dT ∫ 4 D(t) F dz/(1+z²), V being independent of w.
//!
//! T runs from -t1 (n·l = 0) to tan(θ_v/2) (n·l = 1), in pieces that meet at the mirror direction
//! and where the masking term is not smooth, each mapped by T = width · sinh r about the mirror
//! direction, or for sheen, whose half vectors lie near the horizon, by T = -t1 + √α sinh r; the
//! inner variable is z = k z', k being the scale of D's peak.

use super::half_vectors::TAIL_DEPTH;
use super::{Integrals, Kernel};
use crate::brdf::fresnel::Basis;
use crate::brdf::{Microfacet, Ndf};
use crate::numeric::lanes::Real;
use crate::numeric::quadrature::tanh_sinh::{DeNode, half_line, half_line_with_cusp, tanh_sinh};

/// Numbers of nodes: `outer` for each of the pieces, `inner` for the azimuth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DoubleExponentialRule {
    /// For each of the pieces of the slope.
    pub outer: usize,
    /// For the azimuth.
    pub inner: usize,
}

/// The nodes of a reference rule.
#[derive(Clone, Debug)]
pub struct DoubleExponentialNodes {
    outer: Vec<DeNode>,
    inner: Vec<(f64, f64)>,
    inner_with_cusp: Vec<(f64, f64)>,
}

impl DoubleExponentialRule {
    /// Evaluations of the integrand for a texel, of a lobe without kinks.
    pub fn evaluations(&self) -> usize {
        2 * self.outer * self.inner
    }

    /// The rule's nodes.
    pub fn nodes(&self) -> DoubleExponentialNodes {
        // z' = 1e20 at the end: what lies beyond is below 1e-17 of the peak for every k.
        let limit = 4.085;
        DoubleExponentialNodes {
            outer: tanh_sinh(self.outer),
            inner: half_line(self.inner, limit),
            inner_with_cusp: half_line_with_cusp(2 * self.inner, limit),
        }
    }
}

impl Kernel for DoubleExponentialNodes {
    /// The integrals at n·v = `mu` in [0, 1] and `alpha` in (0, 1].
    #[inline(always)]
    fn integrate<const N: usize, B: Basis<N>, R: Real>(
        &self,
        lobe: Microfacet,
        basis: B,
        mu: R,
        alpha: R,
    ) -> Integrals<N, R> {
        let zero = R::from(0.0);
        let sv = (mu.complement() * (mu + 1.0)).sqrt();
        let (low, high) = (mu / (sv + 1.0), sv / (mu + 1.0));
        let width = lobe.ndf.width(alpha);
        // Beyond the lobe's ends there is nothing to integrate.
        let (first, last, centre, unit) = match lobe.ndf {
            Ndf::Ggx => {
                let end = width * ggx_end(mu, alpha);
                (-low.min(end), high.min(end), zero, width)
            }
            Ndf::Beckmann | Ndf::BeckmannWalter | Ndf::BlinnPhong => {
                let end = width * lobe.ndf.slope_end(alpha, TAIL_DEPTH);
                (-low.min(end), high.min(end), zero, width)
            }
            Ndf::Charlie => {
                let unit = alpha.sqrt();
                (-low, high.min(unit * CHARLIE_END - low), -low, unit)
            }
        };
        let area_v = lobe.masking_projected_area(mu, alpha);
        let view = View { lobe, basis, mu, area_v, sv, alpha, width, low, high, centre, unit };
        let inner = if lobe.ndf.definition().smooth_at_normal {
            &self.inner
        } else {
            &self.inner_with_cusp
        };
        let mirror = zero.min(last);
        // Without a break the two pieces meet at the mirror direction; with one, of the two inner
        // ends one is the mirror direction and the other the break.
        let (ends, pieces) = match lobe.break_at(alpha) {
            None => ([first, mirror, last, last], 2),
            Some(x) => {
                let slope = (x - mu) / (sv + (x.complement() * (x + 1.0)).sqrt());
                let at_break = slope.max(first).min(last);
                ([first, at_break.min(mirror), at_break.max(mirror), last], 3)
            }
        };
        let mut sum = Integrals::zero();
        for ends in ends[..=pieces].windows(2) {
            sum.add(R::from(1.0), view.piece(ends[0], ends[1], &self.outer, inner).0);
        }
        sum
    }
}

/// Charlie ends where n·l is 20 √α or more: (sin θ_h)^(1/α) is there below exp(-(n·l)²/(8α)) =
/// 2e-22 of what it is at the horizon. As a multiple of √α in T, of which n·l is at least half.
const CHARLIE_END: f64 = 40.0;

/// Below this α the slopes of GGX are cut off nearer, lest the nodes be spread over twenty decades
/// of which two count.
///
/// Beyond the scaled slope y lie y^-2 of a lobe, and where that is tan θ_v and more α/n·v of y^-1:
/// 2e-18 at the cut. Of B all of what the tail gives may be lost, 3e-4 α² at n·v = 1, which is a
/// tenth of the floor of the reference's promise here, and below it less.
const SHARPEST: f64 = 3e-11;

/// The scaled slope at which GGX ends.
#[inline(always)]
fn ggx_end<R: Real>(mu: R, alpha: R) -> R {
    alpha.select_below(R::from(SHARPEST), alpha / mu * 1e18 + 1e9, R::from(1e18))
}

struct View<B, R> {
    lobe: Microfacet,
    basis: B,
    mu: R,
    area_v: R,
    sv: R,
    alpha: R,
    /// The unit of slopes.
    width: R,
    /// T = -low at n·l = 0.
    low: R,
    /// T = high at n·l = 1.
    high: R,
    /// T = centre + unit sinh r.
    centre: R,
    /// The same.
    unit: R,
}

impl<B, R: Real> View<B, R> {
    /// The integrals over the slopes from `start` to `end`; nothing where they are the same.
    #[inline(always)]
    fn piece<const N: usize>(
        &self,
        start: R,
        end: R,
        outer: &[DeNode],
        inner: &[(f64, f64)],
    ) -> Integrals<N, R>
    where
        B: Basis<N>,
    {
        let (centre, unit) = (self.centre, self.unit);
        let asinh = |t: R| (t - centre).zip(unit, |t, unit| libm::asinh(t / unit));
        let (r0, r1) = (asinh(start), asinh(end));
        let length = r1 - r0;
        let mut sum = Integrals::zero();
        for node in outer {
            // The nearer end decides how r is written, so that the distance to it in T has no
            // cancellation.
            let (from_start, to_end) = (length * node.from_start, length * node.to_end);
            let r = from_start.select_below(to_end, r0 + from_start, r1 - to_end);
            let gap = |d: R, middle: R| {
                unit * 2.0 * middle.zip(d, |m, d| libm::cosh(m) * libm::sinh(0.5 * d))
            };
            let from_low = (start + self.low) + gap(from_start, r0 + from_start * 0.5);
            let to_high = (self.high - end) + gap(to_end, r1 - to_end * 0.5);
            let slope = centre + unit * r.zip(r, |r, _| libm::sinh(r));
            let value = self.plane(slope, from_low, to_high, inner);
            sum.add(length * node.weight * unit * r.zip(r, |r, _| libm::cosh(r)), value.0);
        }
        sum.where_positive(length)
    }

    /// The derivatives of the integrals by T at the slope T, whose distances from either end are
    /// given.
    #[inline(always)]
    fn plane<const N: usize>(
        &self,
        slope: R,
        from_low: R,
        to_high: R,
        inner: &[(f64, f64)],
    ) -> Integrals<N, R>
    where
        B: Basis<N>,
    {
        let f = slope * slope + 1.0;
        // n·l and sin θ_l as multiples of the distances to their own zeros.
        let x = from_low * (-(self.mu * from_low) + 2.0) / f;
        let sl = to_high * (-(self.sv * to_high) + 2.0) / f;
        let m = (self.mu + x) * (self.mu + x);
        let ss = self.sv * sl;
        let tau2 = ss * 4.0 / m;
        let w2 = self.width * self.width;
        let t0 = slope * slope;
        let k2 = (w2 + t0) / (w2 + t0 + tau2);
        let (k, c0) = (k2.sqrt(), m * f * 0.25);
        let mut sum = Integrals::zero();
        for &(z, weight) in inner {
            let z2 = k2 * (z * z);
            let c = (z2 + 1.0).recip();
            let sin2 = z2 * c;
            let t = t0 + tau2 * sin2;
            let d = self.lobe.ndf.slope_density(t / w2, self.alpha) * (t + 1.0) * (t + 1.0);
            sum.add(d * c * weight, self.basis.weights((c0 + ss * sin2).sqrt()));
        }
        let visible = self.lobe.cosine_visibility_at(x, self.mu, self.area_v, self.alpha);
        let outer = k * 8.0 * sl / (f * w2) * visible;
        Integrals(sum.0.map(|inner| outer * inner)).where_positive(x).where_positive(sl)
    }
}
