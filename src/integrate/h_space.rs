//! The integral over half vectors, split where the reflected ray meets the horizon. It takes any isotropic distribution
//! and any masking term, with + - × ÷ √ alone: this is what a device runs.
//!
//! With τ = tan θ_h = width · y, t = τ², and φ the azimuth of h from the plane of v:
//!
//! n·l = x = m + s cos φ, m = μ(1-t)/(1+t), s = 2 sin θ_v τ/(1+t); v·h = (x+μ) √(1+t) / 2;
//!
//! E = ∫ y P(y) (1+t) dy ∫ 2 (x+μ) (n·l V) F dφ  (Walter 2007, equations 13 and 14: dω_h = dω_l / (4 v·h)).
//!
//! x > 0 on the full circle up to τ = t1 = μ/(1+sin θ_v), on |φ| < φ_m with cos φ_m = -m/s up to τ = 1/t1, and nowhere
//! beyond. Each piece is smooth, so a Gauss rule converges on each.

use super::ScaleBias;
use crate::model::Microfacet;
use crate::model::fresnel::schlick_weight;
use crate::quadrature::gauss_legendre::{Node, gauss_legendre, half_gauss};
use crate::quadrature::slope_map::{Power, slope_at, slope_interval};
use std::f64::consts::PI;

/// How many nodes: `radial` × `azimuth` on the full circle, `radial_horizon` × `azimuth_horizon` on the cut one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HSpaceRule {
    /// Slopes below the horizon's first touch.
    pub radial: usize,
    /// Azimuths for each of them.
    pub azimuth: usize,
    /// Slopes beyond it.
    pub radial_horizon: usize,
    /// Azimuths for each of those.
    pub azimuth_horizon: usize,
    /// The slope map.
    pub power: Power,
}

/// The nodes of a rule, ready to use on any texel.
#[derive(Clone, Debug)]
pub struct HSpaceNodes {
    /// Gauss nodes for the slope, full circle.
    pub radial: Vec<Node>,
    /// cos φ at the midpoints of (0, π) and their common weight in φ over the full circle.
    pub azimuth: Vec<Node>,
    /// Gauss nodes for the slope, cut circle.
    pub radial_horizon: Vec<Node>,
    /// Gauss nodes for tan(φ/4) / tan(φ_m/4).
    pub azimuth_horizon: Vec<Node>,
    /// The slope map.
    pub power: Power,
}

/// Slopes are cut off where what lies beyond is exp(-40) = 4e-18 of a lobe.
pub const TAIL_DEPTH: f64 = 40.0;

impl HSpaceRule {
    /// Evaluations of the integrand for a texel.
    pub fn evaluations(&self) -> usize {
        self.radial * self.azimuth + self.radial_horizon * self.azimuth_horizon
    }

    /// The numbers of nodes in the order of the shader's `Rule`.
    pub fn counts(&self) -> [usize; 4] {
        [self.radial, self.azimuth, self.radial_horizon, self.azimuth_horizon]
    }

    /// The rule's nodes.
    pub fn nodes(&self) -> HSpaceNodes {
        let k = self.azimuth as f64;
        let midpoint = |j: usize| Node { at: libm::cos((j as f64 + 0.5) * PI / k), weight: 2.0 * PI / k };
        HSpaceNodes {
            radial: gauss_legendre(self.radial),
            azimuth: (0..self.azimuth).map(midpoint).collect(),
            radial_horizon: gauss_legendre(self.radial_horizon),
            azimuth_horizon: half_gauss(self.azimuth_horizon),
            power: self.power,
        }
    }
}

/// (A, B) at n·v = `mu` in [0, 1] and `alpha` in (0, 1].
pub fn h_space(lobe: Microfacet, mu: f64, alpha: f64, nodes: &HSpaceNodes) -> ScaleBias {
    let sv = ((1.0 - mu) * (1.0 + mu)).sqrt();
    let t1 = mu / (1.0 + sv);
    let width = lobe.ndf.width(alpha);
    let end = lobe.ndf.slope_end(alpha, TAIL_DEPTH);
    let y1 = (t1 / width).min(end);
    let y2 = if t1 * width * end > 1.0 { 1.0 / (t1 * width) } else { end };
    let below = slope_interval(0.0, y1, nodes.power);
    let beyond = slope_interval(y1, y2, nodes.power);
    let mut sum = ScaleBias::default();
    if mu > 0.0 {
        for node in &nodes.radial {
            let slope = slope_at(node.at, below, nodes.power);
            let ring = ring(mu, sv, width * slope.y);
            let part = full_circle(lobe, mu, alpha, ring, &nodes.azimuth);
            sum.add(radial_weight(lobe, alpha, node.weight * slope.dy, slope.y) * ring.secant2, part);
        }
    }
    if sv > 0.0 {
        for node in &nodes.radial_horizon {
            let slope = slope_at(node.at, beyond, nodes.power);
            let ring = ring(mu, sv, width * slope.y);
            let part = cut_circle(lobe, mu, alpha, ring, &nodes.azimuth_horizon);
            sum.add(radial_weight(lobe, alpha, node.weight * slope.dy, slope.y) * ring.secant2, part);
        }
    }
    sum
}

/// What a radial node weighs, but for 1/cos² θ_h: y P(y) times its weight in y.
pub fn radial_weight(lobe: Microfacet, alpha: f64, weight: f64, y: f64) -> f64 {
    weight * (y * lobe.ndf.slope_density(y * y, alpha))
}

/// The half vectors of one slope: n·l = `m` + `s` cos φ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// The mean of n·l.
    pub m: f64,
    /// Its amplitude.
    pub s: f64,
    /// 1 + t = 1/cos² θ_h
    pub secant2: f64,
    /// v·h / (x + μ)
    pub half_secant: f64,
}

/// The half vectors with tan θ_h = `tau`.
pub fn ring(mu: f64, sv: f64, tau: f64) -> Ring {
    let secant2 = 1.0 + tau * tau;
    Ring {
        m: mu * ((1.0 - tau) * (1.0 + tau)) / secant2,
        s: 2.0 * sv * tau / secant2,
        secant2,
        half_secant: 0.5 * secant2.sqrt(),
    }
}

/// 2 (x+μ) (n·l V) split by Schlick's weight into (A, B).
pub fn integrand(lobe: Microfacet, x: f64, mu: f64, alpha: f64, half_secant: f64) -> ScaleBias {
    let f = schlick_weight((x + mu) * half_secant);
    let g = 2.0 * (x + mu) * lobe.cosine_visibility(x, mu, alpha);
    ScaleBias { a: g * (1.0 - f), b: g * f }
}

/// The azimuth integral where the whole circle lies above the horizon.
pub fn full_circle(lobe: Microfacet, mu: f64, alpha: f64, ring: Ring, azimuth: &[Node]) -> ScaleBias {
    let mut sum = ScaleBias::default();
    for node in azimuth {
        let x = (ring.m + ring.s * node.at).max(0.0);
        sum.add(node.weight, integrand(lobe, x, mu, alpha, ring.half_secant));
    }
    sum
}

/// The same where the horizon cuts it: tan(φ/4) = tm u, and x = 2 s (C - C_m)(C + C_m) with C = cos(φ/2), which has no
/// cancellation at the horizon.
pub fn cut_circle(lobe: Microfacet, mu: f64, alpha: f64, ring: Ring, azimuth: &[Node]) -> ScaleBias {
    let cos_m = (-ring.m / ring.s).clamp(-1.0, 1.0);
    let half = (0.5 * (1.0 + cos_m)).sqrt(); // cos(φ_m/2)
    let tm = (0.5 * (1.0 - cos_m)).sqrt() / (1.0 + half);
    let tm2 = tm * tm;
    let scale = 4.0 * ring.s * tm2 / (1.0 + tm2);
    let mut sum = ScaleBias::default();
    for node in azimuth {
        let u2 = node.at * node.at;
        let r = 1.0 / (1.0 + tm2 * u2);
        let c = (1.0 - tm2 * u2) * r;
        let x = scale * (1.0 - u2) * r * (c + half);
        sum.add(node.weight * (8.0 * tm * r), integrand(lobe, x, mu, alpha, ring.half_secant));
    }
    sum
}
