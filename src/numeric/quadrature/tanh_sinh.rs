//! Double exponential (tanh-sinh) quadrature on [0, 1]: robust against any endpoint singularity, at
//! the price of nodes.
//!
//! Takahasi and Mori, "Double Exponential Formulas for Numerical Integration", 1974.

use std::f64::consts::FRAC_PI_2;

/// One node on [0, 1], with the distances to both ends known to full relative precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeNode {
    /// Distance to 0.
    pub from_start: f64,
    /// Distance to 1.
    pub to_end: f64,
    /// The weight; the weights add up to 1 within rounding.
    pub weight: f64,
}

/// The rule with `n` nodes: the trapezoid rule in s of u = 1/(1 + exp(-π sinh s)), cut where the
/// distance to an end falls to 3.4e-22.
pub fn tanh_sinh(n: usize) -> Vec<DeNode> {
    debug_assert!(n >= 2, "{n}");
    // exp(-π sinh s) = 3.4e-22 at s = 3.45: of bounded integrands the cut leaves out no more, less
    // than f64 rounds.
    let limit = 3.45;
    let step = 2.0 * limit / (n as f64 - 1.0);
    (0..n)
        .map(|i| {
            let s = -limit + step * i as f64;
            let q = 2.0 * FRAC_PI_2 * libm::sinh(s);
            let (a, b) = (1.0 / (1.0 + libm::exp(-q)), 1.0 / (1.0 + libm::exp(q)));
            DeNode {
                from_start: a,
                to_end: b,
                weight: step * 2.0 * FRAC_PI_2 * libm::cosh(s) * a * b,
            }
        })
        .collect()
}

/// Nodes and weights for ∫_0^∞ f(z) dz of an f that is not smooth at 0: z = exp(π/2 sinh s), the
/// trapezoid rule in s.
pub fn half_line_with_cusp(n: usize, limit: f64) -> Vec<(f64, f64)> {
    let step = 2.0 * limit / (n as f64 - 1.0);
    (0..n)
        .map(|i| {
            let s = -limit + step * i as f64;
            let z = libm::exp(FRAC_PI_2 * libm::sinh(s));
            (z, step * FRAC_PI_2 * libm::cosh(s) * z)
        })
        .collect()
}

/// Nodes and weights for ∫_0^∞ f(z) dz of an even f with poles near ±i: z = sinh(π/2 sinh s), the
/// trapezoid rule in positive s with half a weight at 0. `limit` is the last s.
pub fn half_line(n: usize, limit: f64) -> Vec<(f64, f64)> {
    let step = limit / (n as f64 - 1.0);
    (0..n)
        .map(|i| {
            let s = step * i as f64;
            let q = FRAC_PI_2 * libm::sinh(s);
            let half = if i == 0 { 0.5 } else { 1.0 };
            (libm::sinh(q), half * step * FRAC_PI_2 * libm::cosh(s) * libm::cosh(q))
        })
        .collect()
}
