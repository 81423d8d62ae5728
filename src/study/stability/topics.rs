//! What is mapped: each formula as textbooks have it beside the one that is used here, each method, each way of storing.

use super::ways::{GGX, METHODS, SUMS, Way};
use super::{Family, Scale};
use crate::integrate::ScaleBias;
use crate::lanes::{Real, Single};
use crate::model::beckmann::beckmann_smith;
use crate::model::{Masking, Microfacet, Ndf};
use crate::study::textbook::{
    textbook_beckmann, textbook_beckmann_lambda, textbook_blinn_phong, textbook_ggx, textbook_sampled_slope,
    textbook_visibility,
};
use std::f64::consts::PI;

/// Something that goes wrong, and what to do instead.
pub struct Topic {
    /// Its name.
    pub name: &'static str,
    /// What goes wrong, why, and what is done here.
    pub about: &'static str,
    /// Along a row of the maps.
    pub x: Scale,
    /// From row to row.
    pub y: Scale,
    /// Some way is off by this much somewhere, or is no number; where this is infinite, it is the latter.
    pub fails: f64,
    /// The last way on the CPU, which is ours in f32, and ours on devices are off by no more than this anywhere, without a fault.
    pub holds: f64,
    pub(super) kind: Kind,
}

pub(super) enum Kind {
    /// A formula and ours, in f64 and in f32, and what is true; the same as WGSL, where a device has it.
    Formula {
        textbook: [Formula; 2],
        ours: [Formula; 2],
        truth: Formula,
        /// Errors count over the truth, or over 1.
        relative: bool,
        device: Option<(Ndf, [&'static str; 2])>,
    },
    /// Ways of integrating GGX.
    Tables(&'static [Way]),
    /// Ways of storing a lobe's B, or its albedo.
    Storage(Microfacet, fn(ScaleBias) -> f64),
}

pub(super) type Formula = fn(f64, f64) -> f64;

/// A formula in f32: arguments and result rounded.
macro_rules! single {
    ($function:expr) => {
        |x, y| f64::from($function(Single::from(x), Single::from(y)).0[0])
    };
}

const CHARLIE: Microfacet = Microfacet { ndf: Ndf::Charlie, masking: Masking::Neubelt };

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

/// All of them.
pub fn topics() -> Vec<Topic> {
    let angle = || Scale::new("tan θ_h", 1e-7, 10.0);
    let roughness = || Scale::new("roughness", 1e-4, 1.0);
    let view = || Scale::with_zero("n·v", 1e-6, 1.0);
    vec![
        Topic {
            name: "D of GGX",
            about: "(n·h)² (α²-1) + 1 is what is left of 1 - 1: at roughness 0.1 three digits are left, below 0.013 none, and D is \
                    infinite. The density of slopes, 1/(π (1+y²)²) with y = tan θ_h/α, takes no difference.",
            x: angle(),
            y: roughness(),
            fails: 0.1,
            holds: 2e-6,
            kind: Kind::Formula {
                textbook: [|t, r| textbook_ggx(nh(t), r * r), single!(|t, r: Single| textbook_ggx(nh(t), r * r))],
                ours: [|t, r| slope_form(Ndf::Ggx, t, r * r), single!(|t, r: Single| slope_form(Ndf::Ggx, t, r * r))],
                truth: |t, r| {
                    let (t, a2) = (t * t, r * r * r * r);
                    let ratio = a2 * (1.0 + t) / (a2 + t);
                    ratio * ratio
                },
                relative: false,
                device: Some((
                    Ndf::Ggx,
                    [
                        "vec4(textbook_ggx(1.0 / sqrt(1.0 + p.x * p.x), p.y * p.y), 0.0, 0.0, 0.0)",
                        "vec4(slope_density(p.x / slope_width(p.y * p.y) * (p.x / slope_width(p.y * p.y)), p.y * p.y) * 3.14159265 \
                         * (1.0 + p.x * p.x) * (1.0 + p.x * p.x), 0.0, 0.0, 0.0)",
                    ],
                )),
            },
        },
        Topic {
            name: "D of Blinn-Phong",
            about: "n·h has seven digits, and (n·h)ⁿ multiplies what is lost by n: at n = 10⁷ a fifth of the peak and more. The power is \
                    exp(-(n/2) ln(1 + tan² θ_h)) here, and the logarithm that of 1 plus a small number.",
            x: angle(),
            y: Scale::new("exponent n", 1.0, 1e7),
            fails: 0.2,
            holds: 2e-6,
            kind: Kind::Formula {
                textbook: [|t, n| textbook_blinn_phong(nh(t), n), single!(|t, n| textbook_blinn_phong(nh(t), n))],
                ours: [
                    |t, n| slope_form(Ndf::BlinnPhong, t, alpha_of(n)),
                    single!(|t, n| slope_form(Ndf::BlinnPhong, t, alpha_of(n))),
                ],
                truth: |t, n| libm::exp(-0.5 * n * libm::log1p(t * t)),
                relative: false,
                device: Some((
                    Ndf::BlinnPhong,
                    [
                        "vec4(textbook_blinn_phong(1.0 / sqrt(1.0 + p.x * p.x), p.y), 0.0, 0.0, 0.0)",
                        "vec4(slope_density(p.x * p.x * 0.5 * (p.y + 2.0), sqrt(2.0 / (p.y + 2.0))) * 3.14159265 \
                         * (1.0 + p.x * p.x) * (1.0 + p.x * p.x), 0.0, 0.0, 0.0)",
                    ],
                )),
            },
        },
        Topic {
            name: "D of Beckmann",
            about: "(n·h)² - 1 again, divided by α²: below roughness 0.02 the exponent is noise. It is -y² here, y = tan θ_h/α.",
            x: angle(),
            y: roughness(),
            fails: 0.3,
            holds: 2e-6,
            kind: Kind::Formula {
                textbook: [
                    |t, r| textbook_beckmann(nh(t), r * r),
                    single!(|t, r: Single| textbook_beckmann(nh(t), r * r)),
                ],
                ours: [
                    |t, r| slope_form(Ndf::Beckmann, t, r * r),
                    single!(|t, r: Single| slope_form(Ndf::Beckmann, t, r * r)),
                ],
                truth: |t, r| libm::exp(-t * t / (r * r * r * r)) * (1.0 + t * t) * (1.0 + t * t),
                relative: false,
                device: Some((
                    Ndf::Beckmann,
                    [
                        "vec4(textbook_beckmann(1.0 / sqrt(1.0 + p.x * p.x), p.y * p.y), 0.0, 0.0, 0.0)",
                        "vec4(slope_density(p.x / (p.y * p.y) * (p.x / (p.y * p.y)), p.y * p.y) * 3.14159265 \
                         * (1.0 + p.x * p.x) * (1.0 + p.x * p.x), 0.0, 0.0, 0.0)",
                    ],
                )),
            },
        },
        Topic {
            name: "G2/(4 n·l n·v)",
            about: "At n·v = 0 it is 0/0, and before that tan² θ_v leaves the range of f32. n·l V in one piece, with √(α² + (1-α²)c²) in \
                    units of α, is finite there.",
            x: Scale::with_zero("n·v, n·l = ½", 1e-24, 1.0),
            y: roughness(),
            fails: 0.9,
            holds: 2e-6,
            kind: Kind::Formula {
                textbook: [
                    |c, r| textbook_visibility(0.5, c, r * r),
                    single!(|c, r: Single| textbook_visibility(Single::from(0.5), c, r * r)),
                ],
                ours: [
                    |c, r| GGX.cosine_visibility(0.5, c, r * r),
                    single!(|c, r: Single| GGX.cosine_visibility(Single::from(0.5), c, r * r)),
                ],
                truth: |c, r| {
                    let smith = |c: f64| (r.powi(4) + (1.0 - r * r) * (1.0 + r * r) * c * c).sqrt();
                    0.25 / (0.5 * smith(c) + c * smith(0.5))
                },
                relative: true,
                device: Some((
                    Ndf::Ggx,
                    [
                        "vec4(textbook_visibility(0.5, p.x, p.y * p.y), 0.0, 0.0, 0.0)",
                        "vec4(cosine_visibility(0.5, p.x, p.y * p.y), 0.0, 0.0, 0.0)",
                    ],
                )),
            },
        },
        Topic {
            name: "Λ of Beckmann",
            about: "exp(-a²)/(2a√π) is 1/0 at n·v = 0, and what G needs of it, n·v (1 + 2Λ), is 0·∞. Written n·v + α sin θ i¹erfc(a), it \
                    has no quotient, and nothing is left of erf(a) - 1.",
            x: Scale::with_zero("n·v", 1e-24, 0.999),
            y: roughness(),
            fails: f64::INFINITY,
            holds: 2e-6,
            kind: Kind::Formula {
                textbook: [
                    |c, r| c * (1.0 + 2.0 * textbook_beckmann_lambda(c, r * r)),
                    single!(|c: Single, r: Single| c * (textbook_beckmann_lambda(c, r * r) * 2.0 + 1.0)),
                ],
                ours: [|c, r| beckmann_smith(c, r * r), single!(|c, r: Single| Ndf::Beckmann.smith(c, r * r))],
                truth: |c, r| {
                    let width = r * r * ((1.0 - c) * (1.0 + c)).sqrt();
                    let a = c / width;
                    c * libm::erf(a) + width * libm::exp(-a * a) / PI.sqrt()
                },
                relative: true,
                // WGSL has no erf.
                device: None,
            },
        },
        Topic {
            name: "sampled half vectors",
            about: "The cosine of a smooth lobe's half vector rounds to 1, and its sine, √(1 - cos²), to 0: every sample is the mirror's. \
                    tan θ_h = α √(v/(1-v)) has all digits.",
            x: Scale::new("v", 1e-6, 0.999),
            y: roughness(),
            fails: 0.5,
            holds: 1e-6,
            kind: Kind::Formula {
                textbook: [
                    |v, r| textbook_sampled_slope(v, r * r),
                    single!(|v, r: Single| textbook_sampled_slope(v, r * r)),
                ],
                ours: [
                    |v, r| r * r * (v / (1.0 - v)).sqrt(),
                    single!(|v: Single, r: Single| r * r * (v / v.complement()).sqrt()),
                ],
                truth: |v, r| r * r * (v / (1.0 - v)).sqrt(),
                relative: true,
                device: Some((
                    Ndf::Ggx,
                    [
                        "vec4(textbook_sampled_slope(p.x, p.y * p.y), 0.0, 0.0, 0.0)",
                        "vec4(p.y * p.y * sqrt(p.x / (1.0 - p.x)), 0.0, 0.0, 0.0)",
                    ],
                )),
            },
        },
        Topic {
            name: "sums of 65,536 samples",
            about: "Added one by one in f32, a sample is rounded to the last digit of the sum so far. In blocks of 64, and blocks of \
                    blocks, what is rounded stays small.",
            x: view(),
            y: Scale::new("roughness", 0.05, 1.0),
            fails: 1e-5,
            holds: 2e-6,
            kind: Kind::Tables(&SUMS),
        },
        Topic {
            name: "A and B",
            about: "The loop that engines ship divides 0 by 0 at n·v = 0, finds nothing where the lobe is smooth, and at grazing angles \
                    most of its samples lie below the horizon; better samplers cure the latter. Quadrature on a map that follows the lobe \
                    holds its bound from corner to corner.",
            x: view(),
            y: roughness(),
            fails: 0.1,
            holds: 3e-6,
            kind: Kind::Tables(&METHODS),
        },
        Topic {
            name: "storing B",
            about: "B spans ten decades. Eight bits keep nothing of it below 0.002, halves turn subnormal below 6e-5 and 0 below 3e-8, \
                    and f32 keeps all of it; what counts for a renderer is the absolute error, which the file states.",
            x: Scale::new("n·v", 1e-3, 1.0),
            y: roughness(),
            fails: 0.99,
            holds: 1e-7,
            kind: Kind::Storage(GGX, |value| value.b),
        },
        Topic {
            name: "storing Charlie's albedo",
            about: "Sheen's albedo has no limit as roughness falls: eight bits end at 1, halves at 65,504. A table whose values do not fit is \
                    refused, with the cure: --precision f32, or --y roughness,min=X.",
            x: Scale::with_zero("n·v", 1e-6, 0.1),
            y: Scale::new("roughness", 1e-6, 1.0),
            fails: f64::INFINITY,
            holds: 1e-7,
            // Where it is next to nothing, what is lost of it does not count.
            kind: Kind::Storage(CHARLIE, |value| value.e().max(1e-3)),
        },
    ]
}

impl Topic {
    /// What its maps on the CPU belong to.
    pub fn family(&self) -> Family {
        match self.kind {
            Kind::Formula { .. } => Family::Formulas,
            Kind::Tables(_) => Family::Methods,
            Kind::Storage(..) => Family::Storage,
        }
    }

    /// What is tested of it, in words.
    pub fn claim(&self) -> String {
        let fails =
            if self.fails.is_finite() { format!("off by {:e} or more", self.fails) } else { "no number".into() };
        format!("The one is {fails}, the other never off by more than {:e}.", self.holds)
    }
}
