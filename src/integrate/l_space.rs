//! The integral over directions of light for GGX, with the azimuth in closed form for A + B: a second formula, which
//! shares no mechanism with the half-vector one.
//!
//! y = T/α is the scaled slope of the half vector in the plane of v and n, T = tan((θ_v - θ_l)/2); with x = n·l, sl = sin θ_l,
//! sv = sin θ_v, M = (μ+x)², f = 1 + T², b2 = 1 - α², Q = (sv+sl)² + α² M, S = √((1+y²) Q):
//!
//! A + B = ∫ (4 sl/f) (n·l V) J dy,  J = α³ + 2 α² b2 (μ+x)/S + b2² (μ+x)(M α²(1+y²) + Q)/(2 S³).
//!
//! B takes the azimuth w by a Gauss rule in tan(w/2) = k sinh(c atanh g), k² = M α²(1+y²)/Q, where D's poles lie.

use super::ScaleBias;
use crate::model::fresnel::schlick_weight;
use crate::model::{Masking, Microfacet, Ndf};
use crate::quadrature::gauss_legendre::{Node, gauss_legendre, half_gauss};
use crate::quadrature::slope_map::{Power, slope_at, slope_interval};
use std::f64::consts::PI;

/// How many nodes, and which maps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LSpaceRule {
    /// Nodes for the slope.
    pub slope: usize,
    /// Nodes for the azimuth of B.
    pub azimuth: usize,
    /// The slope map.
    pub power: Power,
}

/// The nodes of a rule, ready to use on any texel.
#[derive(Clone, Debug)]
pub struct LSpaceNodes {
    slope: Vec<Node>,
    azimuth: Vec<AzimuthNode>,
    power: Power,
}

#[derive(Clone, Copy, Debug)]
struct AzimuthNode {
    /// Y = tan(w/2)/k, squared
    y2: f64,
    /// 1/(1+Y²)
    c: f64,
    weight: f64,
}

impl LSpaceRule {
    /// Evaluations of the integrand for a texel.
    pub fn evaluations(&self) -> usize {
        self.slope * self.azimuth
    }

    /// The rule's nodes.
    pub fn nodes(&self) -> LSpaceNodes {
        // The exponent of the azimuth's map that converges fastest at each number of nodes, found by trial.
        let exponent = match self.azimuth {
            ..10 => 2.5,
            10..14 => 3.0,
            _ => 4.0,
        };
        let azimuth = half_gauss(self.azimuth)
            .into_iter()
            .map(|Node { at: g, weight }| {
                let angle = exponent * libm::atanh(g);
                let (sinh, cosh) = (libm::sinh(angle), libm::cosh(angle));
                let weight = 2.0 / PI * weight * cosh * exponent / ((1.0 - g) * (1.0 + g));
                AzimuthNode { y2: sinh * sinh, c: 1.0 / (cosh * cosh), weight }
            })
            .collect();
        LSpaceNodes { slope: gauss_legendre(self.slope), azimuth, power: self.power }
    }
}

/// Whether the formula serves for a lobe: its azimuth integral is that of GGX, and the layer that it subtracts that of the
/// height-correlated term, which the joint approximation has in another form.
pub fn l_space_applies(lobe: Microfacet) -> bool {
    lobe.ndf == Ndf::Ggx && lobe.masking != Masking::Joint
}

/// (A, B) of a GGX lobe at n·v = `mu` in [0, 1] and `alpha` in (0, 1].
pub fn l_space(lobe: Microfacet, mu: f64, alpha: f64, nodes: &LSpaceNodes) -> ScaleBias {
    let sv = ((1.0 - mu) * (1.0 + mu)).sqrt();
    let (a2, b2) = (alpha * alpha, (1.0 - alpha) * (1.0 + alpha));
    let interval = slope_interval(-mu / ((1.0 + sv) * alpha), sv / ((1.0 + mu) * alpha), nodes.power);
    let layer = (lobe.masking == Masking::HeightCorrelated && mu < 0.5 * alpha).then(|| Layer::new(mu, sv, alpha));
    let (mut e, mut b) = layer.as_ref().map_or((0.0, 0.0), |l| (l.e, l.e * l.bias));
    for node in &nodes.slope {
        let mapped = slope_at(node.at, interval, nodes.power);
        let y = mapped.y;
        let slope = alpha * y;
        let f = 1.0 + slope * slope;
        let x = (mu + 2.0 * slope / f * (sv - slope * mu)).clamp(0.0, 1.0);
        let sl = (sv - 2.0 * slope / f * (mu + slope * sv)).clamp(0.0, 1.0);
        let (sum, y1) = (mu + x, 1.0 + y * y);
        let m = sum * sum;
        let q = (sv + sl) * (sv + sl) + a2 * m;
        let s = (y1 * q).sqrt();
        let mut j = alpha * a2 + 2.0 * a2 * b2 * sum / s + 0.5 * b2 * b2 * sum * (m * a2 * y1 + q) / (s * s * s);
        let k2 = m * a2 * y1 / q;
        let mut j_b = 0.0;
        for azimuth in &nodes.azimuth {
            let t = 1.0 + k2 * azimuth.y2;
            let vh = (0.25 * m * f + sv * sl * k2 * azimuth.y2 / t).sqrt();
            let d = a2 + b2 / y1 * azimuth.c * t;
            j_b += azimuth.weight * schlick_weight(vh) * d * d / t;
        }
        j_b *= sum * y1 / s;
        if let Some(layer) = &layer {
            j -= alpha * a2;
            j_b -= alpha * a2 * layer.bias;
        }
        let weight = node.weight * mapped.dy * 4.0 * sl / f * lobe.cosine_visibility(x, mu, alpha);
        e += weight * j;
        b += weight * j_b;
    }
    ScaleBias { a: e - b, b }
}

/// What the height-correlated term does within x ~ μ of the horizon, integrated in closed form and subtracted from the
/// integrand: there n·l V = x/(2(α x + α μ + …)) has a layer that no fixed rule resolves as μ → 0.
struct Layer {
    /// 2 α² ∫_0^1 n·l V dx, the layer's share of A + B.
    e: f64,
    /// The mean of Schlick's weight over the azimuth at x = 0, for its share of B.
    bias: f64,
}

impl Layer {
    fn new(mu: f64, sv: f64, alpha: f64) -> Self {
        let (a2, b2) = (alpha * alpha, (1.0 - alpha) * (1.0 + alpha));
        let a = (a2 + b2 * mu * mu).sqrt();
        let log = if mu > 0.0 { mu * libm::log((a + mu) * (alpha + a) / (mu * (a2 + a + mu * b2))) } else { 0.0 };
        let w = 2.0 * (1.0 + 2.0 * mu * mu * b2 / a2) * ((a + mu) / alpha - mu)
            - 2.0 * a / alpha * (log + 2.0 * mu * ((a + mu * b2) / a2 - a / alpha));
        let (s2, s3) = (sv * sv, sv * sv * sv);
        let bias = 1.0 - 10.0 * sv / PI + 5.0 * s2 - 40.0 * s3 / (3.0 * PI) + 15.0 * s2 * s2 / 8.0
            - 16.0 * s2 * s3 / (15.0 * PI);
        Layer { e: 0.5 * alpha * w, bias }
    }
}
