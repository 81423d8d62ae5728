//! The integral over directions of light for GGX, with the azimuth in closed form for A + B: a second formula, which
//! shares no mechanism with the half-vector one.
//!
//! y = T/α is the scaled slope of the half vector in the plane of v and n, T = tan((θ_v - θ_l)/2); with x = n·l, sl =
//! sin θ_l, sv = sin θ_v, M = (μ+x)², f = 1 + T², b2 = 1 - α², Q = (sv+sl)² + α² M, S = √((1+y²) Q):
//!
//! A + B = ∫ (4 sl/f) (n·l V) J dy,  J = α³ + 2 α² b2 (μ+x)/S + b2² (μ+x)(M α²(1+y²) + Q)/(2 S³).
//!
//! B takes the azimuth w by a Gauss rule in tan(w/2) = k sinh(c atanh g), k² = M α²(1+y²)/Q, where D's poles lie.

use super::ScaleBias;
use crate::lanes::Real;
use crate::model::fresnel::schlick_weight;
use crate::model::{Masking, Microfacet, Ndf};
use crate::quadrature::gauss_legendre::{Node, gauss_legendre, half_gauss};
use crate::quadrature::slope_map::{Power, slope_at, slope_interval};
use std::f64::consts::PI;

/// How many nodes, and which maps.
#[derive(Clone, Copy, Debug, PartialEq)]
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
            14..28 => 4.0,
            _ => 6.0,
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
        // Crowded at the horizon, n·l = 0, where the masking term has branch points at n·l = ±iα/√(1-α²).
        let crowd = |Node { at: v, weight }| Node { at: v * v, weight: weight * 2.0 * v };
        let slope = gauss_legendre(self.slope).into_iter().map(crowd).collect();
        LSpaceNodes { slope, azimuth, power: self.power }
    }
}

/// Whether the formula serves for a lobe: its azimuth integral is that of GGX, and the layer that it subtracts that
/// of the height-correlated term, which the joint approximation has in another form.
pub fn l_space_applies(lobe: Microfacet) -> bool {
    match lobe.ndf {
        Ndf::Ggx => match lobe.masking {
            Masking::HeightCorrelated | Masking::Separable | Masking::SchlickSmith | Masking::Implicit => true,
            Masking::Joint | Masking::Neubelt => false,
        },
        Ndf::Beckmann | Ndf::BeckmannWalter | Ndf::BlinnPhong | Ndf::Charlie => false,
    }
}

/// (A, B) of a GGX lobe at n·v = `mu` in [0, 1] and `alpha` in (0, 1].
#[inline(always)]
pub fn l_space<R: Real>(lobe: Microfacet, mu: R, alpha: R, nodes: &LSpaceNodes) -> ScaleBias<R> {
    let sv = (mu.complement() * (mu + 1.0)).sqrt();
    let (a2, b2) = (alpha * alpha, alpha.complement() * (alpha + 1.0));
    let smu = lobe.masking_smith(mu, alpha);
    let interval = slope_interval(-mu / ((sv + 1.0) * alpha), sv / ((mu + 1.0) * alpha), nodes.power);
    let layer = Layer::of(lobe, mu, alpha);
    let (mut e, mut b) = (layer.e, R::from(0.0));
    for node in &nodes.slope {
        let mapped = slope_at(node.at, interval, nodes.power);
        let y = mapped.y;
        let slope = alpha * y;
        let f = slope * slope + 1.0;
        let turn = slope * 2.0 / f;
        let (zero, one) = (R::from(0.0), R::from(1.0));
        let x = (mu + turn * (sv - slope * mu)).most(zero).least(one);
        let sl = (sv - turn * (mu + slope * sv)).most(zero).least(one);
        let (sum, y1) = (mu + x, y * y + 1.0);
        let m = sum * sum;
        let q = (sv + sl) * (sv + sl) + a2 * m;
        let s = (y1 * q).sqrt();
        let j = alpha * a2 + a2 * b2 * sum * 2.0 / s + b2 * b2 * sum * 0.5 * (m * a2 * y1 + q) / (s * s * s);
        let k2 = m * a2 * y1 / q;
        // (v·h)² = c0 + c1 Y²/t, t = 1 + k² Y²
        let (c0, c1, peak) = (m * f * 0.25, sv * sl * k2, b2 / y1);
        let mut j_b = zero;
        for azimuth in &nodes.azimuth {
            let t = k2 * azimuth.y2 + 1.0;
            let r = t.recip();
            let vh = (c0 + c1 * azimuth.y2 * r).sqrt();
            let d = a2 + peak * azimuth.c * t;
            j_b = j_b + schlick_weight(vh) * d * d * r * azimuth.weight;
        }
        let j_b = j_b * (sum * y1 / s);
        let weight = mapped.dy * node.weight * 4.0 * sl / f * lobe.cosine_visibility_at(x, mu, smu, alpha);
        e = e + weight * (j - layer.share);
        b = b + weight * j_b;
    }
    ScaleBias { a: e - b, b }
}

/// What the height-correlated term does within x ~ μ of the horizon, integrated in closed form and subtracted from
/// the integrand of A + B: there n·l V = x/(2(α x + α μ + …)) has a layer that no fixed rule resolves as μ → 0. Where
/// μ is no smaller than α/2 there is none, and the subtraction would cost digits. B, whose azimuth is not integrated
/// in closed form, leaves it to the nodes that crowd there.
struct Layer<R> {
    /// 2 α² ∫_0^1 n·l V dx, the layer's share of A + B.
    e: R,
    /// α³, the layer's share of J.
    share: R,
}

impl<R: Real> Layer<R> {
    #[inline(always)]
    fn of(lobe: Microfacet, mu: R, alpha: R) -> Self {
        let zero = R::from(0.0);
        if lobe.masking != Masking::HeightCorrelated {
            return Layer { e: zero, share: zero };
        }
        let grazing = |value| mu.select_below(alpha * 0.5, value, zero);
        let e = alpha.zip(mu, |alpha, mu| 0.5 * alpha * Self::mass(mu, alpha));
        Layer { e: grazing(e), share: grazing(alpha * alpha * alpha) }
    }

    /// 4 α ∫_0^1 n·l V dx
    fn mass(mu: f64, alpha: f64) -> f64 {
        let (a2, b2) = (alpha * alpha, (1.0 - alpha) * (1.0 + alpha));
        let a = (a2 + b2 * mu * mu).sqrt();
        let log = if mu > 0.0 { mu * libm::log((a + mu) * (alpha + a) / (mu * (a2 + a + mu * b2))) } else { 0.0 };
        2.0 * (1.0 + 2.0 * mu * mu * b2 / a2) * ((a + mu) / alpha - mu)
            - 2.0 * a / alpha * (log + 2.0 * mu * ((a + mu * b2) / a2 - a / alpha))
    }
}
