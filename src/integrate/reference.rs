//! The reference: the integral over directions of light, by double exponential quadrature in both variables.
//!
//! In the plane of v and n, T = tan((θ_v - θ_l)/2) is the slope of the half vector; w is the azimuth of l from the mirror
//! direction, z = tan(w/2). Then tan² θ_h = t = T² + 4 sin θ_v sin θ_l/(μ+x)² sin²(w/2), and
//!
//! E = ∫ (2 sin θ_l/(1+T²)) (n·l V) dT ∫ 4 D(t) F dz/(1+z²), V being independent of w.
//!
//! The outer variable runs from T = -t1 (n·l = 0) to T = tan(θ_v/2) (n·l = 1), in two pieces that meet at the mirror
//! direction, each mapped by T = α sinh r; the inner one is z = k z', k being where D's poles lie.

use super::ScaleBias;
use crate::model::Microfacet;
use crate::model::fresnel::schlick_weight;
use crate::quadrature::double_exponential::{DeNode, half_line, tanh_sinh};

/// How many nodes: `outer` for each of the two pieces, `inner` for the azimuth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReferenceRule {
    /// For each of the two pieces of the slope.
    pub outer: usize,
    /// For the azimuth.
    pub inner: usize,
}

/// The nodes of a reference rule.
#[derive(Clone, Debug)]
pub struct ReferenceNodes {
    outer: Vec<DeNode>,
    inner: Vec<(f64, f64)>,
}

impl ReferenceRule {
    /// The rule's nodes.
    pub fn nodes(&self) -> ReferenceNodes {
        // z' = 1e20 at the end: what lies beyond is below 1e-17 of the peak for every k.
        ReferenceNodes { outer: tanh_sinh(self.outer), inner: half_line(self.inner, 4.085) }
    }
}

/// (A, B) at n·v = `mu` in [0, 1] and `alpha` in (0, 1].
pub fn reference(lobe: Microfacet, mu: f64, alpha: f64, nodes: &ReferenceNodes) -> ScaleBias {
    let sv = ((1.0 - mu) * (1.0 + mu)).sqrt();
    let view = View { lobe, mu, sv, alpha, low: mu / (1.0 + sv), high: sv / (1.0 + mu) };
    let mut sum = ScaleBias::default();
    for (end, sign) in [(view.low, -1.0), (view.high, 1.0)] {
        let r_end = libm::asinh(end / alpha);
        for node in &nodes.outer {
            // T = sign α sinh(r), r = r_end · from_start; the gap to the piece's end without cancellation.
            let (r, gap) = (r_end * node.from_start, r_end * node.to_end);
            let slope = alpha * libm::sinh(r);
            let to_end = 2.0 * alpha * libm::cosh(r + 0.5 * gap) * libm::sinh(0.5 * gap);
            let jacobian = node.weight * r_end * alpha * libm::cosh(r);
            let value = view.plane(sign * slope, to_end, &nodes.inner);
            sum.add(jacobian, value);
        }
    }
    sum
}

struct View {
    lobe: Microfacet,
    mu: f64,
    sv: f64,
    alpha: f64,
    /// T = -low at n·l = 0
    low: f64,
    /// T = high at n·l = 1
    high: f64,
}

impl View {
    /// dE/dT; `to_end` is the distance from `slope` to the end on its own side.
    fn plane(&self, slope: f64, to_end: f64, inner: &[(f64, f64)]) -> ScaleBias {
        let (from_low, to_high) = if slope < 0.0 { (to_end, self.high - slope) } else { (self.low + slope, to_end) };
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
        let a2 = self.alpha * self.alpha;
        let t0 = slope * slope;
        let k = ((a2 + t0) / (a2 + t0 + tau2)).sqrt();
        let mut sum = ScaleBias::default();
        for &(z, weight) in inner {
            let z2 = (k * z) * (k * z);
            let sin2 = z2 / (1.0 + z2);
            let t = t0 + tau2 * sin2;
            let y2 = t / a2;
            let d = self.lobe.ndf.slope_density(y2) * (1.0 + t) * (1.0 + t) / a2;
            let vh = (0.25 * m * f + ss * sin2).sqrt();
            let w = schlick_weight(vh);
            let value = weight * k * d / (1.0 + z2);
            sum.add(value, ScaleBias { a: 1.0 - w, b: w });
        }
        let outer = 8.0 * sl / f * self.lobe.cosine_visibility(x, self.mu, self.alpha);
        ScaleBias { a: outer * sum.a, b: outer * sum.b }
    }
}
