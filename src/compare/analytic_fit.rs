//! Closed-form stand-ins for a table: (A, B) of GGX fitted by a handful of coefficients, for
//! renderers without a table.

use crate::choice::{Choice, choice};
use crate::integrate::ScaleBias;
use crate::numeric::lanes::Real;
use crate::numeric::special::exponential;
use std::f64::consts::LN_2;

/// A fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AnalyticFit {
    /// Karis, "Physically Based Shading on Mobile", 2014: of GGX with Schlick-Smith masking.
    KarisMobile,
    /// Lazarov's form ("Getting More Physical in Call of Duty: Black Ops II", 2013), fitted to GGX
    /// by Narkowicz ("Analytical DFG Term for IBL", 2014). His gloss is taken as 1 - √r, where the
    /// fit is best; with 1 - r, as many have it, its mean error doubles.
    Lazarov,
    /// MaterialX's rational fit of GGX with height-correlated masking.
    Materialx,
}

choice!(AnalyticFit, "fit", {
    KarisMobile = "karis-mobile", "Karis 2014";
    Lazarov = "lazarov", "Narkowicz 2014";
    Materialx = "materialx", "rational";
});

impl AnalyticFit {
    /// Its source.
    pub fn source(self) -> &'static str {
        self.about()
    }

    /// (A, B) at n·v = `mu` and `alpha`.
    #[inline(always)]
    pub fn evaluate<R: Real>(self, mu: R, alpha: R) -> ScaleBias<R> {
        match self {
            AnalyticFit::KarisMobile => karis_mobile(mu, alpha.sqrt()),
            AnalyticFit::Lazarov => lazarov(mu, alpha.sqrt().sqrt().complement()),
            AnalyticFit::Materialx => materialx(mu, alpha),
        }
    }
}

#[inline(always)]
fn karis_mobile<R: Real>(mu: R, r: R) -> ScaleBias<R> {
    let smooth = r.complement();
    let edge =
        (smooth * smooth).min(exponential(mu * (-9.28 * LN_2))) * smooth + 0.0425 - r * 0.0275;
    ScaleBias { a: R::from(1.04) - r * 0.572 - edge * 1.04, b: edge * 1.04 - 0.04 + r * 0.022 }
}

#[inline(always)]
fn lazarov<R: Real>(mu: R, gloss: R) -> ScaleBias<R> {
    let edge = (gloss * 1.548 - 0.2511).min(exponential(mu * (-7.672 * LN_2)));
    let b = saturate((gloss * 0.5745 + 0.5753) * edge - gloss * 0.02397 - 0.02066);
    ScaleBias { a: saturate(gloss * 1.301 + 0.4755) - b, b }
}

#[inline(always)]
fn materialx<R: Real>(mu: R, alpha: R) -> ScaleBias<R> {
    // Of 1, μ, α, μα, μ², α², μ²α, μα², μ²α²; numerators of A and B, then their denominators.
    const FIT: [[f64; 9]; 4] = [
        [0.1003, -0.6303, 9.748, -2.038, 29.34, -8.245, -26.44, 19.99, -5.448],
        [0.9345, -2.323, 2.229, -3.748, 1.424, -0.7684, 1.436, 0.2913, 0.6286],
        [1.0, -1.765, 8.263, 11.53, 28.96, -7.507, -36.11, 15.86, 33.37],
        [1.0, 0.2281, 15.94, -55.83, 13.08, 41.26, 54.9, 300.2, -285.1],
    ];
    let (mu2, a2) = (mu * mu, alpha * alpha);
    let powers = [R::from(1.0), mu, alpha, mu * alpha, mu2, a2, mu2 * alpha, mu * a2, mu2 * a2];
    let mut sums = [R::from(0.0); 4];
    for (sum, row) in sums.iter_mut().zip(FIT) {
        for (power, coefficient) in powers.iter().zip(row) {
            *sum = *sum + *power * coefficient;
        }
    }
    ScaleBias { a: saturate(sums[0] / sums[2]), b: saturate(sums[1] / sums[3]) }
}

#[inline(always)]
fn saturate<R: Real>(value: R) -> R {
    value.max(R::from(0.0)).min(R::from(1.0))
}
