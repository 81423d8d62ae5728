//! The reference: the integral over directions of light, by double exponential quadrature in both variables.
//!
//! In the plane of v and n, T = tan((θ_v - θ_l)/2) is the slope of the half vector; w is the azimuth of l from the mirror
//! direction, z = tan(w/2). Then tan² θ_h = t = T² + 4 sin θ_v sin θ_l/(μ+x)² sin²(w/2), and
//!
//! E = ∫ (2 sin θ_l/(1+T²)) (n·l V) dT ∫ 4 D(t) F dz/(1+z²), V being independent of w.
//!
//! T runs from -t1 (n·l = 0) to tan(θ_v/2) (n·l = 1), in pieces that meet at the mirror direction and where the masking
//! term is not smooth, each mapped by T = width · sinh r; the inner variable is z = k z', k being the scale of D's peak.

use super::ScaleBias;
use super::h_space::TAIL_DEPTH;
use crate::model::Microfacet;
use crate::model::fresnel::schlick_weight;
use crate::quadrature::double_exponential::{DeNode, half_line, half_line_with_cusp, tanh_sinh};

/// How many nodes: `outer` for each of the pieces, `inner` for the azimuth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReferenceRule {
    /// For each of the pieces of the slope.
    pub outer: usize,
    /// For the azimuth.
    pub inner: usize,
}

/// The nodes of a reference rule.
#[derive(Clone, Debug)]
pub struct ReferenceNodes {
    outer: Vec<DeNode>,
    inner: Vec<(f64, f64)>,
    inner_with_cusp: Vec<(f64, f64)>,
}

impl ReferenceRule {
    /// The rule's nodes.
    pub fn nodes(&self) -> ReferenceNodes {
        // z' = 1e20 at the end: what lies beyond is below 1e-17 of the peak for every k.
        let limit = 4.085;
        ReferenceNodes {
            outer: tanh_sinh(self.outer),
            inner: half_line(self.inner, limit),
            inner_with_cusp: half_line_with_cusp(2 * self.inner, limit),
        }
    }
}

/// (A, B) at n·v = `mu` in [0, 1] and `alpha` in (0, 1].
pub fn reference(lobe: Microfacet, mu: f64, alpha: f64, nodes: &ReferenceNodes) -> ScaleBias {
    let sv = ((1.0 - mu) * (1.0 + mu)).sqrt();
    let view = View { lobe, mu, sv, alpha, width: lobe.ndf.width(alpha), low: mu / (1.0 + sv), high: sv / (1.0 + mu) };
    let inner = if lobe.ndf.smooth_at_normal() { &nodes.inner } else { &nodes.inner_with_cusp };
    // Beyond the lobe's end there is nothing to integrate.
    let end = view.width * lobe.ndf.slope_end(alpha, TAIL_DEPTH);
    let mut breaks = vec![-view.low.min(end), 0.0, view.high.min(end)];
    breaks.extend(
        lobe.break_at(alpha).map(|x| (x - mu) / (sv + ((1.0 - x) * (1.0 + x)).sqrt())).filter(|t| t.abs() < end),
    );
    breaks.sort_by(f64::total_cmp);
    let mut sum = ScaleBias::default();
    for ends in breaks.windows(2) {
        let (start, end) = (ends[0], ends[1]);
        let (r0, r1) = (libm::asinh(start / view.width), libm::asinh(end / view.width));
        for node in &nodes.outer {
            // The nearer end decides how r is written, so that the distance to it in T has no cancellation.
            let (from_start, to_end) = ((r1 - r0) * node.from_start, (r1 - r0) * node.to_end);
            let r = if from_start < to_end { r0 + from_start } else { r1 - to_end };
            let gap = |d: f64, middle: f64| 2.0 * view.width * libm::cosh(middle) * libm::sinh(0.5 * d);
            let from_low = (start + view.low) + gap(from_start, r0 + 0.5 * from_start);
            let to_high = (view.high - end) + gap(to_end, r1 - 0.5 * to_end);
            let value = view.plane(view.width * libm::sinh(r), from_low, to_high, inner);
            sum.add(node.weight * (r1 - r0) * view.width * libm::cosh(r), value);
        }
    }
    sum
}

struct View {
    lobe: Microfacet,
    mu: f64,
    sv: f64,
    alpha: f64,
    /// The unit of slopes.
    width: f64,
    /// T = -low at n·l = 0.
    low: f64,
    /// T = high at n·l = 1.
    high: f64,
}

impl View {
    /// dE/dT at the slope T, whose distances from either end are given.
    fn plane(&self, slope: f64, from_low: f64, to_high: f64, inner: &[(f64, f64)]) -> ScaleBias {
        let f = 1.0 + slope * slope;
        // n·l and sin θ_l as multiples of the distances to their own zeros.
        let x = from_low * (2.0 - self.mu * from_low) / f;
        let sl = to_high * (2.0 - self.sv * to_high) / f;
        if x <= 0.0 || sl <= 0.0 {
            return ScaleBias::default();
        }
        let m = (self.mu + x) * (self.mu + x);
        let ss = self.sv * sl;
        let tau2 = 4.0 * ss / m;
        let w2 = self.width * self.width;
        let t0 = slope * slope;
        let k = ((w2 + t0) / (w2 + t0 + tau2)).sqrt();
        let mut sum = ScaleBias::default();
        for &(z, weight) in inner {
            let z2 = (k * z) * (k * z);
            let sin2 = z2 / (1.0 + z2);
            let t = t0 + tau2 * sin2;
            let d = self.lobe.ndf.slope_density(t / w2, self.alpha) * (1.0 + t) * (1.0 + t) / w2;
            let w = schlick_weight((0.25 * m * f + ss * sin2).sqrt());
            sum.add(weight * k * d / (1.0 + z2), ScaleBias { a: 1.0 - w, b: w });
        }
        let outer = 8.0 * sl / f * self.lobe.cosine_visibility(x, self.mu, self.alpha);
        ScaleBias { a: outer * sum.a, b: outer * sum.b }
    }
}
