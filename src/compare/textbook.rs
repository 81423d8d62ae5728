//! The formulas as textbooks and engines have them, in any arithmetic: each is right on paper and
//! fails in numbers. Beside each stands what is used here instead. Powers, exponentials and error
//! functions are rounded from f64, better than any driver's.

use crate::compare::point_set::Point;
use crate::integrate::{Integrals, ScaleBias};
use crate::numeric::lanes::Real;
use std::f64::consts::PI;

/// D/D(0) of GGX: α⁴ / ((n·h)² (α²-1) + 1)² (Walter et al. 2007, equation 33, in the form of Karis
/// 2013).
#[inline(always)]
pub fn textbook_ggx<R: Real>(nh: R, alpha: R) -> R {
    let a2 = alpha * alpha;
    let d = nh * nh * (a2 - 1.0) + 1.0;
    a2 / d * (a2 / d)
}

/// D/D(0) of Blinn-Phong: (n·h)ⁿ (Blinn 1977).
#[inline(always)]
pub fn textbook_blinn_phong<R: Real>(nh: R, n: R) -> R {
    nh.zip(n, libm::pow)
}

/// D/D(0) of Beckmann: exp(((n·h)²-1)/(α² (n·h)²)) / (n·h)⁴ (Cook and Torrance 1982; Karis 2013).
#[inline(always)]
pub fn textbook_beckmann<R: Real>(nh: R, alpha: R) -> R {
    let nh2 = nh * nh;
    let exponent = (nh2 - 1.0) / (alpha * alpha * nh2);
    exponent.zip(exponent, |x, _| libm::exp(x)) / (nh2 * nh2)
}

/// n·l V of height-correlated GGX as n·l G2/(4 n·l n·v), G2 = 1/(1 + Λ(l) + Λ(v)), Λ by tan² θ
/// (Heitz 2014, equations 72, 99).
#[inline(always)]
pub fn textbook_visibility<R: Real>(nl: R, nv: R, alpha: R) -> R {
    let g2 = (lambda(nl, alpha) + lambda(nv, alpha) + 1.0).recip();
    nl * (g2 / (nl * nv * 4.0))
}

/// Λ of GGX by tan² θ (Heitz 2014, equation 72).
#[inline(always)]
pub fn lambda<R: Real>(c: R, alpha: R) -> R {
    let tan2 = (R::from(1.0) - c * c) / (c * c);
    ((alpha * alpha * tan2 + 1.0).sqrt() - 1.0) * 0.5
}

/// Λ of Beckmann as (erf(a)-1)/2 + exp(-a²)/(2a√π), a = c/(α sin θ) (Heitz 2014, section 5).
#[inline(always)]
pub fn textbook_beckmann_lambda<R: Real>(c: R, alpha: R) -> R {
    let a = c / (alpha * (R::from(1.0) - c * c).sqrt());
    let gauss = (a * a).zip(a, |a2, _| libm::exp(-a2));
    (a.zip(a, |a, _| libm::erf(a)) - 1.0) * 0.5 + gauss / (a * (2.0 * PI.sqrt()))
}

/// tan θ_h of a half vector that D of GGX chooses: cos θ_h = √((1-v)/(1+(α²-1)v)), sin θ_h =
/// √(1-cos² θ_h) (Karis 2013).
#[inline(always)]
pub fn textbook_sampled_slope<R: Real>(v: R, alpha: R) -> R {
    let cosine = (v.complement() / ((alpha * alpha - 1.0) * v + 1.0)).sqrt();
    (R::from(1.0) - cosine * cosine).sqrt() / cosine
}

/// (A, B) of height-correlated GGX by the loop that engines ship (Karis 2013, `IntegrateBRDF`, with
/// the correlated term), every formula as it is in theirs, summed one by one.
#[inline(always)]
pub fn textbook_split_sum<R: Real>(nv: R, alpha: R, points: &[Point]) -> ScaleBias<R> {
    let (zero, one) = (R::from(0.0), R::from(1.0));
    let (vx, vz) = ((one - nv * nv).sqrt(), nv);
    let a2 = alpha * alpha;
    let mut sum = Integrals::<2, R>::zero();
    for point in points {
        let v = R::from(point.v);
        let nh = (v.complement() / ((a2 - 1.0) * v + 1.0)).sqrt();
        let hx = (one - nh * nh).sqrt() * point.cosine;
        let vh = vx * hx + vz * nh;
        let nl = vh * nh * 2.0 - vz;
        let vh = vh.max(zero);
        let smith = |c: R, other: R| other * (c * c * (one - a2) + a2).sqrt();
        let visibility = R::from(0.5) / (smith(nv, nl) + smith(nl, nv));
        let g = visibility * nl * vh * 4.0 / nh;
        let f = vh.complement().zip(vh, |x, _| x * x * x * x * x);
        let part = Integrals([g * f.complement(), g * f]).where_positive(nl);
        sum.add(R::from(point.weight), part.0);
    }
    ScaleBias::from(sum.0)
}
