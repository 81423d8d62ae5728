//! Charlie, the distribution of fibres for sheen: D = (2 + 1/α) sin(θ_h)^(1/α) / (2π).
//!
//! Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF", 2017; α = r² as in Filament and
//! glTF.

use super::{Definition, Wgsl};
use crate::brdf::masking::Masking::{HeightCorrelated, Implicit, Neubelt};
use crate::numeric::lanes::{Function, Real};
use crate::numeric::special::{exponential, log1p_ratio, logarithm};
use std::f64::consts::FRAC_2_PI;

/// Everything of it but the formulas.
pub const DEFINITION: Definition = Definition {
    word: "charlie",
    about: "a power of sin(theta_h), for sheen (Estevez and Kulla 2017)",
    // Height-correlated is the pair that Estevez and Kulla fitted.
    maskings: &[Neubelt, HeightCorrelated, Implicit],
    why_no_other_masking: "its Smith term was fitted for correlated heights, and the \
                           approximations are GGX's",
    energy_conserving: &[],
    roughness: "alpha = roughness^2",
    smooth_at_normal: false,
    // The fibres stand upright as α → 0.
    becomes_mirror: false,
    wgsl: Wgsl {
        source: include_str!("../../../shaders/charlie.wgsl"),
        width: "charlie_width(alpha)",
        // 1e9 squares to far less than f32 holds.
        slope_end: "1e9",
        slope_density: "charlie_slope_density(y2, alpha)",
        projected_area: "charlie_projected_area(c, alpha)",
    },
};

/// The unit of slopes, 1/(2√α): where a lobe of small α has its ring.
#[inline(always)]
pub fn charlie_width<R: Real>(alpha: R) -> R {
    alpha.sqrt().recip() * 0.5
}

/// P22/(4α) at the squared slope y² in units of [`charlie_width`]: with t = y²/(4α), D cos⁴ θ_h is
/// (2/π)(1 + 2α) exp(-(2/y²) ln(1+1/t) t) / (4α + y²)².
#[inline(always)]
pub fn charlie_slope_density<R: Real>(y2: R, alpha: R) -> R {
    let (y2, a4) = (y2.max(R::from(1e-30)), alpha * 4.0);
    let scale = a4 + y2;
    (alpha * 2.0 + 1.0) * FRAC_2_PI * exponential(y2.recip() * -2.0 * log1p_ratio(a4 / y2))
        / (scale * scale)
}

/// c (1 + 2Λ(c)) with the Λ that Estevez and Kulla fitted: e^L(c) for c < 1/2, else e^(2 L(1/2) -
/// L(1-c)). With c the term falls to 0 (to 1e-30 of it, so that it can divide), and the lobe's
/// albedo diverges like 1/n·v.
#[inline(always)]
pub fn charlie_projected_area<R: Real>(c: R, alpha: R) -> R {
    let half = R::from(0.5);
    let nearer = charlie_lambda(c.min(c.complement()), alpha);
    let middle = charlie_lambda(half, alpha);
    let lambda = c.select_below(half, nearer, middle * middle / nearer);
    c.max(R::from(1e-30)) * (lambda * 2.0 + 1.0)
}

/// [`charlie_projected_area`], to be called.
pub struct ProjectedArea;

impl Function for ProjectedArea {
    #[inline(always)]
    fn at<R: Real>(c: R, alpha: R) -> R {
        charlie_projected_area(c, alpha)
    }
}

/// e^L(x), L(x) = a/(1 + b x^p) + d x + e, the parameters between those of α = 0 and α = 1 by
/// (1-α)² (Estevez and Kulla 2017, the table of their fit; their roughness is the α of D).
#[inline(always)]
pub fn charlie_lambda<R: Real>(x: R, alpha: R) -> R {
    let s = alpha.complement();
    let mix = |smooth: f64, rough: f64| s * s * (smooth - rough) + rough;
    // 0 at x = 0; what light from below there adds is nothing.
    let tiny = R::from(1e-36);
    let power = exponential(mix(0.16801, 0.19823) * logarithm(x.max(tiny)));
    let power = x.select_below(tiny, R::from(0.0), power);
    let slope = mix(-1.27393, -1.97760) * x + mix(-4.85967, -4.32054);
    exponential(mix(25.3245, 21.5473) / (mix(3.32435, 3.82987) * power + 1.0) + slope)
}
