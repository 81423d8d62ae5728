//! Closed-form stand-ins for a table: (A, B) of GGX fitted by a handful of coefficients, for renderers without a table.

use crate::integrate::ScaleBias;

/// A fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StandIn {
    /// Karis, "Physically Based Shading on Mobile", 2014: of GGX with Schlick-Smith masking.
    KarisMobile,
    /// Lazarov's form ("Getting More Physical in Call of Duty: Black Ops II", 2013), fitted to GGX by Narkowicz ("Analytical DFG
    /// Term for IBL", 2014). His gloss is taken as 1 - √r, where the fit is best; with 1 - r, as many have it, its mean error
    /// doubles.
    Lazarov,
    /// MaterialX's rational fit of GGX with height-correlated masking.
    Materialx,
}

impl StandIn {
    /// All of them.
    pub const ALL: [StandIn; 3] = [StandIn::KarisMobile, StandIn::Lazarov, StandIn::Materialx];

    /// (A, B) at n·v = `mu` and `alpha`.
    pub fn evaluate(self, mu: f64, alpha: f64) -> ScaleBias {
        match self {
            StandIn::KarisMobile => karis_mobile(mu, alpha.sqrt()),
            StandIn::Lazarov => lazarov(mu, 1.0 - alpha.sqrt().sqrt()),
            StandIn::Materialx => materialx(mu, alpha),
        }
    }
}

fn karis_mobile(mu: f64, r: f64) -> ScaleBias {
    let smooth = 1.0 - r;
    let edge = (smooth * smooth).min(libm::exp2(-9.28 * mu)) * smooth + 0.0425 - 0.0275 * r;
    ScaleBias { a: 1.04 - 0.572 * r - 1.04 * edge, b: 1.04 * edge - 0.04 + 0.022 * r }
}

fn lazarov(mu: f64, gloss: f64) -> ScaleBias {
    let edge = (1.548 * gloss - 0.2511).min(libm::exp2(-7.672 * mu));
    let b = ((0.5745 * gloss + 0.5753) * edge - 0.02397 * gloss - 0.02066).clamp(0.0, 1.0);
    ScaleBias { a: (1.301 * gloss + 0.4755).clamp(0.0, 1.0) - b, b }
}

fn materialx(mu: f64, alpha: f64) -> ScaleBias {
    // Of 1, μ, α, μα, μ², α², μ²α, μα², μ²α²; numerators of A and B, then their denominators.
    const FIT: [[f64; 9]; 4] = [
        [0.1003, -0.6303, 9.748, -2.038, 29.34, -8.245, -26.44, 19.99, -5.448],
        [0.9345, -2.323, 2.229, -3.748, 1.424, -0.7684, 1.436, 0.2913, 0.6286],
        [1.0, -1.765, 8.263, 11.53, 28.96, -7.507, -36.11, 15.86, 33.37],
        [1.0, 0.2281, 15.94, -55.83, 13.08, 41.26, 54.9, 300.2, -285.1],
    ];
    let (mu2, a2) = (mu * mu, alpha * alpha);
    let powers = [1.0, mu, alpha, mu * alpha, mu2, a2, mu2 * alpha, mu * a2, mu2 * a2];
    let [a, b, under_a, under_b] = FIT.map(|row| row.iter().zip(powers).map(|(c, p)| c * p).sum::<f64>());
    ScaleBias { a: (a / under_a).clamp(0.0, 1.0), b: (b / under_b).clamp(0.0, 1.0) }
}
