//! The integral over half vectors, split where the reflected ray meets the horizon. It takes any
//! isotropic distribution and any masking term, with + - × ÷ √ alone: this is what a device runs.
//!
//! With τ = tan θ_h = width · y, t = τ², and φ the azimuth of h from the plane of v:
//!
//! n·l = x = m + s cos φ, m = μ(1-t)/(1+t), s = 2 sin θ_v τ/(1+t); v·h = (x+μ) √(1+t) / 2;
//!
//! E = ∫ y P(y) (1+t) dy ∫ 2 (x+μ) (n·l V) F dφ  (Walter 2007, equations 13 and 14: dω_h = dω_l /
//! (4 v·h)).
//!
//! x > 0 on the full circle up to τ = t1 = μ/(1+sin θ_v), on |φ| < φ_m with cos φ_m = -m/s up to τ
//! = 1/t1, and nowhere beyond. Each piece is smooth, so a Gauss rule converges on each; but φ_m
//! changes like a root at both ends of the second, so that errors fall with the fifth power of the
//! number of its slopes only, unless they crowd there. That pays where a rule has many nodes and
//! the lobe reaches those ends; few nodes are needed elsewhere.

use super::{Integrals, Kernel};
use crate::brdf::Microfacet;
use crate::brdf::fresnel::Basis;
use crate::numeric::lanes::Real;
use crate::numeric::quadrature::gauss_legendre::{
    Node, crowded_at_both_ends, gauss_legendre, half_gauss,
};
use crate::numeric::quadrature::slope_map::{Power, slope_at, slope_interval};
use std::f64::consts::PI;

/// Numbers of nodes: `radial` × `azimuth` on the full circle, `radial_horizon` × `azimuth_horizon`
/// on the cut one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HalfVectorRule {
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
    /// Whether the slopes of the cut circle crowd at both ends, where the end of its azimuths
    /// changes like a root.
    pub crowded: bool,
}

/// The nodes of a rule, ready to use on any texel.
#[derive(Clone, Debug)]
pub struct HalfVectorNodes {
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

impl HalfVectorRule {
    /// Evaluations of the integrand for a texel.
    pub fn evaluations(&self) -> usize {
        self.radial * self.azimuth + self.radial_horizon * self.azimuth_horizon
    }

    /// The numbers of nodes in the order of the shader's `Rule`.
    pub fn counts(&self) -> [usize; 4] {
        [self.radial, self.azimuth, self.radial_horizon, self.azimuth_horizon]
    }

    /// The rule's nodes.
    pub fn nodes(&self) -> HalfVectorNodes {
        let horizon = gauss_legendre(self.radial_horizon);
        HalfVectorNodes {
            radial: gauss_legendre(self.radial),
            azimuth: midpoints(self.azimuth),
            radial_horizon: if self.crowded { crowded_at_both_ends(horizon) } else { horizon },
            azimuth_horizon: half_gauss(self.azimuth_horizon),
            power: self.power,
        }
    }
}

/// cos φ at the midpoints of (0, π), and their common weight in φ over the full circle.
pub(super) fn midpoints(count: usize) -> Vec<Node> {
    let k = count as f64;
    let midpoint =
        |j: usize| Node { at: libm::cos((j as f64 + 0.5) * PI / k), weight: 2.0 * PI / k };
    (0..count).map(midpoint).collect()
}

impl Kernel for HalfVectorNodes {
    #[inline(always)]
    fn integrate<const N: usize, B: Basis<N>, R: Real>(
        &self,
        lobe: Microfacet,
        basis: B,
        mu: R,
        alpha: R,
    ) -> Integrals<N, R> {
        half_vectors(lobe, basis, mu, alpha, self)
    }
}

/// The integrals at n·v = `mu` in [0, 1] and `alpha` in (0, 1].
#[inline(always)]
pub fn half_vectors<const N: usize, B: Basis<N>, R: Real>(
    lobe: Microfacet,
    basis: B,
    mu: R,
    alpha: R,
    nodes: &HalfVectorNodes,
) -> Integrals<N, R> {
    let sv = (mu.complement() * (mu + 1.0)).sqrt();
    let t1 = mu / (sv + 1.0);
    let width = lobe.ndf.width(alpha);
    let end = lobe.ndf.slope_end(alpha, TAIL_DEPTH);
    let y1 = (t1 / width).min(end);
    let y2 = R::from(1.0).select_below(t1 * width * end, (t1 * width).recip(), end);
    let below = slope_interval(R::from(0.0), y1, nodes.power);
    let beyond = slope_interval(y1, y2, nodes.power);
    let view = View::new(lobe, basis, mu, alpha);
    let (mut full, mut cut) = (Integrals::zero(), Integrals::zero());
    for node in &nodes.radial {
        let slope = slope_at(node.at, below, nodes.power);
        let ring = ring(mu, sv, width * slope.y);
        let part = full_circle(view, ring, &nodes.azimuth);
        full.add(
            radial_weight(lobe, alpha, slope.dy * node.weight, slope.y) * ring.secant2,
            part.0,
        );
    }
    for node in &nodes.radial_horizon {
        let slope = slope_at(node.at, beyond, nodes.power);
        let ring = ring(mu, sv, width * slope.y);
        let part = cut_circle(view, ring, &nodes.azimuth_horizon);
        cut.add(radial_weight(lobe, alpha, slope.dy * node.weight, slope.y) * ring.secant2, part.0);
    }
    // No circle is full where v lies on the horizon, and none is cut where it stands upright.
    let mut sum = full.where_positive(mu);
    sum.add(R::from(1.0), cut.where_positive(sv).0);
    sum
}

/// The quantities that are the same for all half vectors.
#[derive(Clone, Copy, Debug)]
pub struct View<B, R> {
    lobe: Microfacet,
    basis: B,
    mu: R,
    /// [`Microfacet::masking_projected_area`] of n·v.
    area_v: R,
    alpha: R,
}

impl<B, R: Real> View<B, R> {
    /// The view at n·v = `mu`.
    #[inline(always)]
    pub fn new(lobe: Microfacet, basis: B, mu: R, alpha: R) -> Self {
        View { lobe, basis, mu, area_v: lobe.masking_projected_area(mu, alpha), alpha }
    }
}

/// The weight of a radial node without the factor 1/cos² θ_h: y P(y) times its weight in y.
#[inline(always)]
pub fn radial_weight<R: Real>(lobe: Microfacet, alpha: R, weight: R, y: R) -> R {
    weight * (y * lobe.ndf.slope_density(y * y, alpha))
}

/// The half vectors of one slope: n·l = `m` + `s` cos φ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring<R = f64> {
    /// The mean of n·l.
    pub m: R,
    /// Its amplitude.
    pub s: R,
    /// 1 + t = 1/cos² θ_h
    pub secant2: R,
    /// v·h / (x + μ)
    pub half_secant: R,
}

/// The half vectors with tan θ_h = `tau`.
#[inline(always)]
pub fn ring<R: Real>(mu: R, sv: R, tau: R) -> Ring<R> {
    let secant2 = tau * tau + 1.0;
    Ring {
        m: mu * (tau.complement() * (tau + 1.0)) / secant2,
        s: sv * 2.0 * tau / secant2,
        secant2,
        half_secant: secant2.sqrt() * 0.5,
    }
}

/// 2 (x+μ) (n·l V) times each weight of the Fresnel model.
#[inline(always)]
pub fn integrand<const N: usize, B: Basis<N>, R: Real>(
    view: View<B, R>,
    x: R,
    half_secant: R,
) -> [R; N] {
    let View { lobe, basis, mu, area_v, alpha } = view;
    let g = (x + mu) * 2.0 * lobe.cosine_visibility_at(x, mu, area_v, alpha);
    basis.weights((x + mu) * half_secant).map(|weight| g * weight)
}

/// The azimuth integral where the whole circle lies above the horizon.
#[inline(always)]
pub fn full_circle<const N: usize, B: Basis<N>, R: Real>(
    view: View<B, R>,
    ring: Ring<R>,
    azimuth: &[Node],
) -> Integrals<N, R> {
    let mut sum = Integrals::zero();
    for node in azimuth {
        let x = (ring.m + ring.s * node.at).max(R::from(0.0));
        sum.add(R::from(node.weight), integrand(view, x, ring.half_secant));
    }
    sum
}

/// The same where the horizon cuts it: tan(φ/4) = tm u, and x = 2 s (C - C_m)(C + C_m) with C =
/// cos(φ/2), which has no cancellation at the horizon.
#[inline(always)]
pub fn cut_circle<const N: usize, B: Basis<N>, R: Real>(
    view: View<B, R>,
    ring: Ring<R>,
    azimuth: &[Node],
) -> Integrals<N, R> {
    let cos_m = (-ring.m / ring.s).max(R::from(-1.0)).min(R::from(1.0));
    let half = ((cos_m + 1.0) * 0.5).sqrt(); // cos(φ_m/2)
    let tm = (cos_m.complement() * 0.5).sqrt() / (half + 1.0);
    let tm2 = tm * tm;
    let scale = ring.s * 4.0 * tm2 / (tm2 + 1.0);
    let mut sum = Integrals::zero();
    for node in azimuth {
        let u2 = node.at * node.at;
        let r = (tm2 * u2 + 1.0).recip();
        let c = (tm2 * u2).complement() * r;
        let x = scale * (1.0 - u2) * r * (c + half);
        sum.add(tm * 8.0 * r * node.weight, integrand(view, x, ring.half_secant));
    }
    sum
}
