//! Beckmann: slopes with a Gaussian distribution, and two forms of its Smith term.
//!
//! Beckmann and Spizzichino 1963; Walter et al. 2007, equation 25; Heitz 2014, section 5.

use super::{Definition, Wgsl};
use crate::brdf::masking::Masking::{self, HeightCorrelated, Implicit, SchlickSmith, Separable};
use crate::numeric::lanes::{Function, Real};
use crate::numeric::special::{exponential, ierfc};
use std::f64::consts::FRAC_1_PI;

/// Everything of it but the formulas.
pub const DEFINITION: Definition = Definition {
    word: "beckmann",
    about: "Gaussian slopes, exact Smith term (Beckmann and Spizzichino 1963; Heitz 2014)",
    maskings: MASKINGS,
    why_no_other_masking: "height-correlated-approx is fitted to GGX's term, and neubelt is the \
                           visibility of sheen",
    energy_conserving: MASKINGS,
    roughness: "alpha = roughness^2",
    smooth_at_normal: true,
    becomes_mirror: true,
    wgsl: Wgsl {
        source: include_str!("../../../shaders/beckmann.wgsl"),
        width: "alpha",
        // √20
        slope_end: "4.47",
        slope_density: "beckmann_slope_density(y2)",
        projected_area: "beckmann_projected_area(c, alpha)",
    },
};

/// The same of the distribution with Walter's Smith term, in which alone it differs.
pub const WALTER: Definition = Definition {
    word: "beckmann-walter",
    about: "the same with Walter's rational Smith term, which jumps (Walter et al. 2007)",
    maskings: &[HeightCorrelated, Separable],
    why_no_other_masking: "the model differs from beckmann in its Smith term alone: use beckmann \
                           for another",
    wgsl: Wgsl { projected_area: "walter_projected_area(c, alpha)", ..DEFINITION.wgsl },
    ..DEFINITION
};

const MASKINGS: &[Masking] = &[HeightCorrelated, Separable, SchlickSmith, Implicit];

/// α² P22 at the squared scaled slope y²: exp(-y²)/π (Heitz 2014, section 5).
#[inline(always)]
pub fn beckmann_slope_density<R: Real>(y2: R) -> R {
    exponential(-y2) * FRAC_1_PI
}

/// c (1 + 2Λ(c)) with the exact Λ(a) = (erf(a) - 1)/2 + exp(-a²)/(2a√π), a = c/(α sin θ) (Heitz
/// 2014, section 5).
///
/// Written c + α sin θ i¹erfc(a), it has no difference of near-equal numbers and is finite at c =
/// 0.
#[inline(always)]
pub fn beckmann_projected_area<R: Real>(c: R, alpha: R) -> R {
    let width = beckmann_width(c, alpha);
    c + width * ierfc(c / width)
}

/// [`beckmann_projected_area`], to be called.
pub struct ProjectedArea;

impl Function for ProjectedArea {
    #[inline(always)]
    fn at<R: Real>(c: R, alpha: R) -> R {
        beckmann_projected_area(c, alpha)
    }
}

/// The same with Walter's rational Λ, (1 - 1.259a + 0.396a²)/(3.535a + 2.181a²) for a < 1.6, else 0
/// (Walter et al. 2007, section 5.2, as Λ). At a = 1.6 it jumps by 5.7e-5.
#[inline(always)]
pub fn walter_projected_area<R: Real>(c: R, alpha: R) -> R {
    let width = beckmann_width(c, alpha);
    let a = c / width;
    let masked = (a * a * 0.396 - a * 1.259 + 1.0) * 2.0 / (a * 2.181 + 3.535);
    c + width * a.select_below(R::from(1.6), masked, R::from(0.0))
}

/// α sin θ, kept above 0 so that c can be divided by it; a c that rounding has put beyond 1 is 1.
#[inline(always)]
pub fn beckmann_width<R: Real>(c: R, alpha: R) -> R {
    let sine2 = (c.complement() * (c + 1.0)).max(R::from(0.0));
    (alpha * sine2.sqrt()).max(R::from(1e-30))
}

/// The n·l at which Walter's Λ jumps: a = 1.6.
pub fn walter_break(alpha: f64) -> f64 {
    let a = 1.6 * alpha;
    a / (1.0 + a * a).sqrt()
}
