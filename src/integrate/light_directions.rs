//! The integrals over directions of light for GGX, with the azimuth in closed form for E = A + B: a
//! second formula, which shares no mechanism with the one over half vectors.
//!
//! In the plane of v and n, T = tan((θ_v - θ_l)/2) is the slope of the half vector and y = T/α; w
//! is the azimuth of l from the mirror direction. With x = n·l, sl = sin θ_l, sv = sin θ_v,
//! M = (μ+x)², f = 1 + T² and b2 = 1 - α²:
//!
//! E = ∫ D n·l V dω_l = ∫ (2 α sl/f) (n·l V) I dy, with I = ∫ D dw over the circle, since V is
//! independent of w, dω_l = sl dθ_l dw and |dθ_l| = 2 dT/f.
//!
//! *The azimuth.* D = α²/π ((1+t)/(α²+t))² with t = tan² θ_h = T² + (4 sv sl/M) sin²(w/2). So
//! α²+t = a - b cos w, where a + b and a - b are its largest and least values: a - b = α²(1+y²),
//! and a + b = Q/M with Q = (sv+sl)² + α² M, by T² = (sv-sl)²/M. Expand the square of
//! (1+t)/(α²+t) = 1 + b2/(α²+t), and take ∫ dw/(a - b cos w) = 2π/r and
//! ∫ dw/(a - b cos w)² = 2π a/r³, r² = a² - b² (Gradshteyn and Ryzhik, 3.661.4). With
//! S = √((1+y²) Q), so that r = α S/(μ+x):
//!
//! J = α I/2 = α³ + 2 α² b2 (μ+x)/S + b2² (μ+x)(M α²(1+y²) + Q)/(2 S³),
//! E = ∫ (4 sl/f) (n·l V) J dy.
//!
//! The other weights take w by a Gauss rule in tan(w/2) = k sinh(c atanh g), k² = M α²(1+y²)/Q: the
//! poles of D lie at tan(w/2) = ±ik.

use super::{Integrals, Kernel};
use crate::brdf::fresnel::Basis;
use crate::brdf::masking::approx_projected_area;
use crate::brdf::{Masking, Microfacet, Ndf};
use crate::numeric::lanes::Real;
use crate::numeric::quadrature::gauss_legendre::{Node, crowded, gauss_legendre, half_gauss};
use crate::numeric::quadrature::slope_map::{MappedSlope, Power, slope_at, slope_interval};
use std::f64::consts::PI;

/// Numbers of nodes, and the map of the slope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightDirectionRule {
    /// Nodes for the slope.
    pub slope: usize,
    /// Nodes for the azimuth of B.
    pub azimuth: usize,
    /// The slope map.
    pub power: Power,
}

/// The nodes of a rule, ready to use on any texel.
#[derive(Clone, Debug)]
pub struct LightDirectionNodes {
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

impl LightDirectionRule {
    /// Evaluations of the integrand for a texel.
    pub fn evaluations(&self) -> usize {
        self.slope * self.azimuth
    }

    /// The rule's nodes.
    pub fn nodes(&self) -> LightDirectionNodes {
        // The exponent of the azimuth's map that converges fastest at each number of nodes, found
        // by trial.
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
        // Crowded at the horizon, n·l = 0, where the masking term has branch points at n·l =
        // ±iα/√(1-α²).
        let slope = crowded(gauss_legendre(self.slope));
        LightDirectionNodes { slope, azimuth, power: self.power }
    }
}

impl Kernel for LightDirectionNodes {
    /// The integrals of a GGX lobe at n·v = `mu` in [0, 1] and `alpha` in (0, 1].
    #[inline(always)]
    fn integrate<const N: usize, B: Basis<N>, R: Real>(
        &self,
        lobe: Microfacet,
        basis: B,
        mu: R,
        alpha: R,
    ) -> Integrals<N, R> {
        // No other lobe need be compiled.
        let lobe = Microfacet { ndf: Ndf::Ggx, ..lobe };
        let sv = (mu.complement() * (mu + 1.0)).sqrt();
        let view =
            View { mu, sv, alpha, a2: alpha * alpha, b2: alpha.complement() * (alpha + 1.0) };
        let area_v = lobe.masking_projected_area(mu, alpha);
        // y at n·l = 0 and at n·l = 1.
        let (first, last) = (-mu / ((sv + 1.0) * alpha), sv / ((mu + 1.0) * alpha));
        let interval = slope_interval(first, last, self.power);
        let layer = Layer::of(lobe, mu, alpha);
        // E at F = 1, and the integrals of the weights: of the first one nothing, since it follows
        // from E and the second.
        let (mut e, mut sums) = (layer.e, Integrals::<N, R>::zero());
        for node in &self.slope {
            let MappedSlope { y, dy } = slope_at(node.at, interval, self.power);
            let plane = view.plane(y);
            let Plane { x, sl, f, .. } = plane;
            let visible = lobe.cosine_visibility_at(x, mu, area_v, alpha);
            let factor = dy * node.weight * 4.0 * sl / f * visible;
            e = e + factor * (view.closed_azimuth(&plane) - layer.part);
            sums.add(factor, view.azimuth(&plane, basis, &self.azimuth));
        }
        sums.0[0] = e - sums.0[1];
        sums
    }
}

/// The quantities that are the same for all directions of light.
struct View<R> {
    mu: R,
    sv: R,
    alpha: R,
    /// α²
    a2: R,
    /// 1 - α²
    b2: R,
}

/// The directions of light of one slope, with the letters of the formulas above.
struct Plane<R> {
    x: R,
    sl: R,
    f: R,
    /// μ + x
    sum: R,
    /// M
    m: R,
    /// 1 + y²
    y1: R,
    /// Q
    q: R,
    /// S
    s: R,
}

impl<R: Real> View<R> {
    #[inline(always)]
    fn plane(&self, y: R) -> Plane<R> {
        let (zero, one) = (R::from(0.0), R::from(1.0));
        let View { mu, sv, .. } = *self;
        let slope = self.alpha * y;
        let f = slope * slope + 1.0;
        // θ_l = θ_v - 2 atan(slope), by the sine and cosine of half the turn.
        let turn = slope * 2.0 / f;
        let x = (mu + turn * (sv - slope * mu)).max(zero).min(one);
        let sl = (sv - turn * (mu + slope * sv)).max(zero).min(one);
        let (sum, y1) = (mu + x, y * y + 1.0);
        let m = sum * sum;
        let q = (sv + sl) * (sv + sl) + self.a2 * m;
        Plane { x, sl, f, sum, m, y1, q, s: (y1 * q).sqrt() }
    }

    /// J
    #[inline(always)]
    fn closed_azimuth(&self, plane: &Plane<R>) -> R {
        let View { alpha, a2, b2, .. } = *self;
        let Plane { sum, m, y1, q, s, .. } = *plane;
        let square = b2 * b2 * sum * 0.5 * (m * a2 * y1 + q) / (s * s * s);
        alpha * a2 + a2 * b2 * sum * 2.0 / s + square
    }

    /// The same with each weight but the first under the integral.
    #[inline(always)]
    fn azimuth<const N: usize, B: Basis<N>>(
        &self,
        plane: &Plane<R>,
        basis: B,
        nodes: &[AzimuthNode],
    ) -> [R; N] {
        let Plane { sl, f, sum, m, y1, q, s, .. } = *plane;
        let k2 = m * self.a2 * y1 / q;
        // (v·h)² = c0 + c1 Y²/t, t = 1 + k² Y²
        let (c0, c1, peak) = (m * f * 0.25, self.sv * sl * k2, self.b2 / y1);
        let mut sums = [R::from(0.0); N];
        for azimuth in nodes {
            let t = k2 * azimuth.y2 + 1.0;
            let r = t.recip();
            let vh = (c0 + c1 * azimuth.y2 * r).sqrt();
            let d = self.a2 + peak * azimuth.c * t;
            let weights = basis.weights(vh);
            for k in 1..N {
                sums[k] = sums[k] + weights[k] * d * d * r * azimuth.weight;
            }
        }
        let factor = sum * y1 / s;
        sums.map(|weighted| weighted * factor)
    }
}

/// The layer of the height-correlated term, or of its approximation, within x ~ μ of the horizon,
/// integrated in closed form and subtracted from the integrand of E: there n·l V = x/(2 (x a(μ) +
/// μ a(x))), a(c) = √(α² + b2 c²), changes faster than a fixed rule resolves as μ → 0. Where μ is
/// no smaller than α/2 there is no layer, and the subtraction would cost digits. The other
/// integrals, whose azimuth is not in closed form, leave it to the nodes that crowd at the
/// horizon.
struct Layer<R> {
    /// 2 α² ∫_0^1 n·l V dx, the layer's part of E, by |dx| = 2 α sl dy/f.
    e: R,
    /// α³, the layer's part of J.
    part: R,
}

impl<R: Real> Layer<R> {
    #[inline(always)]
    fn of(lobe: Microfacet, mu: R, alpha: R) -> Self {
        let zero = R::from(0.0);
        let mass = match lobe.masking {
            Masking::HeightCorrelated => Self::mass,
            Masking::HeightCorrelatedApprox => Self::approx_mass,
            _ => return Layer { e: zero, part: zero },
        };
        let grazing = |value| mu.select_below(alpha * 0.5, value, zero);
        let e = alpha.zip(mu, |alpha, mu| 0.5 * alpha * mass(mu, alpha));
        Layer { e: grazing(e), part: grazing(alpha * alpha * alpha) }
    }

    /// 4 α ∫_0^1 n·l V dx of the approximation, n·l V = x/(2 (p x + q)).
    fn approx_mass(mu: f64, alpha: f64) -> f64 {
        let p = approx_projected_area(mu, alpha) + mu * (1.0 - alpha);
        let q = mu * alpha;
        let log = if q > 0.0 { q / p * libm::log1p(p / q) } else { 0.0 };
        2.0 * alpha / p * (1.0 - log)
    }

    /// 4 α ∫_0^1 n·l V dx. Multiplied by x a(μ) - μ a(x), the denominator becomes α² (x² - μ²), and
    /// the integral (2/α) ∫ (x² a(μ) - x μ a(x))/(x² - μ²) dx, two principal values that are
    /// elementary in x and in a(x): with A = a(μ),
    ///
    /// (2/α) (A - μ(1-α) + (μA/2) ln[(1-μ)(1+A)(A-α) / ((1+μ)(1-A)(A+α))]).
    ///
    /// Below it stands without the differences 1 - μ, 1 - A and A - α.
    fn mass(mu: f64, alpha: f64) -> f64 {
        let (a2, b2) = (alpha * alpha, (1.0 - alpha) * (1.0 + alpha));
        let a = (a2 + b2 * mu * mu).sqrt();
        let log = if mu > 0.0 {
            mu * libm::log((a + mu) * (alpha + a) / (mu * (a2 + a + mu * b2)))
        } else {
            0.0
        };
        2.0 * (1.0 + 2.0 * mu * mu * b2 / a2) * ((a + mu) / alpha - mu)
            - 2.0 * a / alpha * (log + 2.0 * mu * ((a + mu * b2) / a2 - a / alpha))
    }
}
