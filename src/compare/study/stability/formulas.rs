//! The formulas that are mapped: each as textbooks have it beside the one that is used here.

use super::Scale;
use super::case::{Case, Kind, Replaced, Wgsl};
use super::ways::GGX;
use crate::brdf::Ndf;
use crate::compare::textbook::{
    textbook_beckmann, textbook_beckmann_lambda, textbook_blinn_phong, textbook_ggx,
    textbook_sampled_slope, textbook_visibility,
};
use crate::numeric::lanes::{F32x1, Real, Vector};
use std::f64::consts::PI;

/// An expression of two variables as a function in f64, and in f32 with arguments and result
/// rounded.
macro_rules! formula {
    (|$x:ident, $y:ident| $value:expr) => {
        [
            |$x: f64, $y: f64| -> f64 { $value },
            |x: f64, y: f64| -> f64 {
                let ($x, $y) = (F32x1::from(x), F32x1::from(y));
                let value: F32x1 = $value;
                value.lane(0)
            },
        ]
    };
}

/// n·h of a half vector with the slope tan θ_h.
#[inline(always)]
fn nh<R: Real>(tan: R) -> R {
    (tan * tan + 1.0).sqrt().recip()
}

/// D/D(0) by the density of slopes: P(y²) π / cos⁴ θ_h.
#[inline(always)]
fn slope_form<R: Real>(ndf: Ndf, tan: R, alpha: R) -> R {
    let (y, secant2) = (tan / ndf.width(alpha), tan * tan + 1.0);
    ndf.slope_density(y * y, alpha) * PI * (secant2 * secant2)
}

/// The α of Blinn-Phong's exponent n: α² = 2/(n+2).
#[inline(always)]
fn alpha_of<R: Real>(n: R) -> R {
    (R::from(2.0) / (n + 2.0)).sqrt()
}

fn angle() -> Scale {
    Scale::new("tan θ_h", 1e-7, 10.0)
}

/// Perceptual roughness far into the smooth corner.
pub fn roughness() -> Scale {
    Scale::new("roughness", 1e-4, 1.0)
}

/// Every formula.
pub fn formulas() -> Vec<Case> {
    vec![
        d_of_ggx(),
        d_of_blinn_phong(),
        d_of_beckmann(),
        visibility(),
        lambda_of_beckmann(),
        sampled_half_vectors(),
    ]
}

fn d_of_ggx() -> Case {
    Case {
        name: "D of GGX",
        about: "(n·h)² (α²-1) + 1 is what is left of 1 - 1: at roughness 0.1 three digits are \
                left, below 0.013 none, and D is infinite. The density of slopes, 1/(π (1+y²)²) \
                with y = tan θ_h/α, takes no difference.",
        x: angle(),
        y: roughness(),
        fails: 0.1,
        holds: 2e-6,
        kind: Kind::Formula(Replaced {
            textbook: formula!(|t, r| textbook_ggx(nh(t), r * r)),
            ours: formula!(|t, r| slope_form(Ndf::Ggx, t, r * r)),
            truth: |t, r| {
                let (t, a2) = (t * t, r * r * r * r);
                let ratio = a2 * (1.0 + t) / (a2 + t);
                ratio * ratio
            },
            relative: false,
            wgsl: Some(Wgsl {
                ndf: Ndf::Ggx,
                textbook: "textbook_ggx(1.0 / sqrt(1.0 + p.x * p.x), p.y * p.y)",
                ours: "slope_density(p.x / slope_width(p.y * p.y) * (p.x / slope_width(p.y * \
                       p.y)), p.y * p.y) * 3.14159265 * (1.0 + p.x * p.x) * (1.0 + p.x * p.x)",
            }),
        }),
    }
}

fn d_of_blinn_phong() -> Case {
    Case {
        name: "D of Blinn-Phong",
        about: "n·h has seven digits, and (n·h)ⁿ multiplies what is lost by n: at n = 10⁷ a fifth \
                of the peak and more. The power is exp(-(n/2) ln(1 + tan² θ_h)) here, and the \
                logarithm that of 1 plus a small number.",
        x: angle(),
        y: Scale::new("exponent n", 1.0, 1e7),
        fails: 0.2,
        holds: 2e-6,
        kind: Kind::Formula(Replaced {
            textbook: formula!(|t, n| textbook_blinn_phong(nh(t), n)),
            ours: formula!(|t, n| slope_form(Ndf::BlinnPhong, t, alpha_of(n))),
            truth: |t, n| libm::exp(-0.5 * n * libm::log1p(t * t)),
            relative: false,
            wgsl: Some(Wgsl {
                ndf: Ndf::BlinnPhong,
                textbook: "textbook_blinn_phong(1.0 / sqrt(1.0 + p.x * p.x), p.y)",
                ours: "slope_density(p.x * p.x * 0.5 * (p.y + 2.0), sqrt(2.0 / (p.y + 2.0))) * \
                       3.14159265 * (1.0 + p.x * p.x) * (1.0 + p.x * p.x)",
            }),
        }),
    }
}

fn d_of_beckmann() -> Case {
    Case {
        name: "D of Beckmann",
        about: "(n·h)² - 1 again, divided by α²: below roughness 0.02 the exponent is noise. It is \
                -y² here, y = tan θ_h/α.",
        x: angle(),
        y: roughness(),
        fails: 0.3,
        holds: 2e-6,
        kind: Kind::Formula(Replaced {
            textbook: formula!(|t, r| textbook_beckmann(nh(t), r * r)),
            ours: formula!(|t, r| slope_form(Ndf::Beckmann, t, r * r)),
            truth: |t, r| libm::exp(-t * t / (r * r * r * r)) * (1.0 + t * t) * (1.0 + t * t),
            relative: false,
            wgsl: Some(Wgsl {
                ndf: Ndf::Beckmann,
                textbook: "textbook_beckmann(1.0 / sqrt(1.0 + p.x * p.x), p.y * p.y)",
                ours: "slope_density(p.x / (p.y * p.y) * (p.x / (p.y * p.y)), p.y * p.y) * \
                       3.14159265 * (1.0 + p.x * p.x) * (1.0 + p.x * p.x)",
            }),
        }),
    }
}

/// The textbook's n·l V of GGX at n·l = 1/2.
#[inline(always)]
fn textbook_visibility_at_half<R: Real>(c: R, alpha: R) -> R {
    textbook_visibility(R::from(0.5), c, alpha)
}

/// Ours.
#[inline(always)]
fn visibility_at_half<R: Real>(c: R, alpha: R) -> R {
    GGX.cosine_visibility(R::from(0.5), c, alpha)
}

fn visibility() -> Case {
    Case {
        name: "G2/(4 n·l n·v)",
        about: "At n·v = 0 it is 0/0, and before that tan² θ_v leaves the range of f32. n·l V in \
                one piece, with √(α² + (1-α²)c²) in units of α, is finite there.",
        x: Scale::with_zero("n·v, n·l = ½", 1e-24, 1.0),
        y: roughness(),
        fails: 0.9,
        holds: 2e-6,
        kind: Kind::Formula(Replaced {
            textbook: formula!(|c, r| textbook_visibility_at_half(c, r * r)),
            ours: formula!(|c, r| visibility_at_half(c, r * r)),
            truth: |c, r| {
                let area = |c: f64| (r.powi(4) + (1.0 - r * r) * (1.0 + r * r) * c * c).sqrt();
                0.25 / (0.5 * area(c) + c * area(0.5))
            },
            relative: true,
            wgsl: Some(Wgsl {
                ndf: Ndf::Ggx,
                textbook: "textbook_visibility(0.5, p.x, p.y * p.y)",
                ours: "cosine_visibility(0.5, p.x, p.y * p.y)",
            }),
        }),
    }
}

fn lambda_of_beckmann() -> Case {
    Case {
        name: "Λ of Beckmann",
        about: "exp(-a²)/(2a√π) is 1/0 at n·v = 0, and what G needs of it, n·v (1 + 2Λ), is 0·∞. \
                Written n·v + α sin θ i¹erfc(a), it has no quotient, and nothing is left of erf(a) \
                - 1.",
        x: Scale::with_zero("n·v", 1e-24, 0.999),
        y: roughness(),
        fails: f64::INFINITY,
        holds: 2e-6,
        kind: Kind::Formula(Replaced {
            textbook: formula!(|c, r| c * (textbook_beckmann_lambda(c, r * r) * 2.0 + 1.0)),
            ours: formula!(|c, r| Ndf::Beckmann.projected_area(c, r * r)),
            truth: |c, r| {
                let width = r * r * ((1.0 - c) * (1.0 + c)).sqrt();
                let a = c / width;
                c * libm::erf(a) + width * libm::exp(-a * a) / PI.sqrt()
            },
            relative: true,
            // WGSL has no erf.
            wgsl: None,
        }),
    }
}

fn sampled_half_vectors() -> Case {
    Case {
        name: "sampled half vectors",
        about: "The cosine of a smooth lobe's half vector rounds to 1, and its sine, √(1 - cos²), \
                to 0: every sample is the mirror's. tan θ_h = α √(v/(1-v)) has all digits.",
        x: Scale::new("v", 1e-6, 0.999),
        y: roughness(),
        fails: 0.5,
        holds: 1e-6,
        kind: Kind::Formula(Replaced {
            textbook: formula!(|v, r| textbook_sampled_slope(v, r * r)),
            ours: formula!(|v, r| r * r * (v / v.complement()).sqrt()),
            truth: |v, r| r * r * (v / (1.0 - v)).sqrt(),
            relative: true,
            wgsl: Some(Wgsl {
                ndf: Ndf::Ggx,
                textbook: "textbook_sampled_slope(p.x, p.y * p.y)",
                ours: "p.y * p.y * sqrt(p.x / (1.0 - p.x))",
            }),
        }),
    }
}
