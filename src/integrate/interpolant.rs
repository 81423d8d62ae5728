//! Integrals over all (n·v, α) by Chebyshev interpolation between those of a rule at a few thousand
//! points. A table of any size costs no more integrals than that, and a texel a few short
//! polynomials.
//!
//! With y = μ/α the first variable is s ∝ tanh(asinh(y)/c)^(1/q), 1 at μ = 1: it spreads the layer
//! μ ~ α over many nodes, and its power q, about μ near 0, turns the term μ ln μ of Smith masking
//! into s^q ln s, which a polynomial follows. The second is √r = α^¼.
//!
//! The polynomials follow E, the sum of the first two integrals, and of every integral but the
//! first the rest beyond a mirror's: B - (1-μ)⁵ E for Schlick's. The rests vanish as α → 0; the
//! integrals themselves change over μ ~ 1, which s does not resolve at small α.

pub mod norms;

use super::light_directions::LightDirectionRule;
use super::{Field, Integrals};
use crate::brdf::fresnel::Basis;
use crate::numeric::lanes::{F64x8, Real, Vector};
use crate::numeric::quadrature::slope_map::Power;
use std::array::from_fn;
use std::f64::consts::PI;

/// The smallest perceptual roughness of an interpolant: half a texel of a table of 512 rows.
pub const SMOOTHEST: f64 = 1.0 / 1024.0;

const LANES: usize = F64x8::LANES;

/// Numbers of nodes along s and along √r, and the rule that integrates there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InterpolantRule {
    /// Along s; a multiple of twice the lanes of [`F64x8`].
    pub directions: usize,
    /// Along √r; even.
    pub roughnesses: usize,
    /// c and q of s: [`Power::Two`] is 8 and 2, for few nodes, [`Power::Four`] 16 and 4.
    pub power: Power,
    /// The rule that integrates at the nodes.
    pub source: LightDirectionRule,
}

/// Polynomials in s and √r, as Chebyshev coefficients: of E, then of the rests of the other
/// integrals.
#[derive(Clone, Debug)]
pub struct Interpolant<const N: usize> {
    /// For each power of √r the coefficients in s, eight powers of s to a group.
    coefficients: Vec<Vec<[F64x8; N]>>,
    power: Power,
}

/// The polynomials in s at one α.
#[derive(Clone, Debug)]
pub struct InterpolantRow<const N: usize> {
    power: Power,
    /// 1/α
    steepness: f64,
    /// The factor that scales s to 1 at μ = 1, before the root is taken.
    scale: f64,
    coefficients: Vec<[f64; N]>,
}

/// tanh(asinh(y)/c) for y ≥ 0.
#[inline(always)]
fn compressed<R: Real>(y: R, power: Power) -> R {
    let e = (y + (y * y + 1.0).sqrt()).sqrt().sqrt();
    let e = if power == Power::Four { e.sqrt() } else { e };
    (e - 1.0) / (e + 1.0)
}

/// The n-th of the zeros of the Chebyshev polynomial of degree `count`, on [0, 1].
fn chebyshev_node(n: usize, count: usize) -> f64 {
    0.5 + 0.5 * libm::cos(PI * (n as f64 + 0.5) / count as f64)
}

/// √r on [0, 1].
fn roughness_variable(alpha: f64) -> f64 {
    let start = SMOOTHEST.sqrt();
    (alpha.sqrt().sqrt() - start) / (1.0 - start)
}

impl InterpolantRule {
    /// The number of integrals that it takes.
    #[allow(clippy::len_without_is_empty, reason = "a rule always has nodes")]
    pub fn len(&self) -> usize {
        self.directions * self.roughnesses
    }

    /// Whether an α lies in its domain.
    pub fn covers(&self, alpha: f64) -> bool {
        (SMOOTHEST * SMOOTHEST..=1.0).contains(&alpha)
    }

    /// The (n·v, α) of its nodes, n·v varying fastest.
    pub fn points(&self) -> Vec<(f64, f64)> {
        let start = SMOOTHEST.sqrt();
        let mut points = Vec::with_capacity(self.len());
        for j in 0..self.roughnesses {
            let root = start + (1.0 - start) * chebyshev_node(j, self.roughnesses);
            let alpha = root * root * root * root;
            points.extend((0..self.directions).map(|i| (self.direction(i, alpha), alpha)));
        }
        points
    }

    /// n·v of the i-th node along s.
    fn direction(&self, i: usize, alpha: f64) -> f64 {
        let end = compressed(1.0 / alpha, self.power);
        let s = chebyshev_node(i, self.directions);
        let s2 = s * s;
        let (power, c) = match self.power {
            Power::Two => (s2, 8.0),
            Power::Four => (s2 * s2, 16.0),
        };
        let y = libm::sinh(c * libm::atanh(end * power));
        (alpha * y).min(1.0)
    }

    /// The interpolant through these integrals at the rule's points.
    pub fn fit<const N: usize, B: Basis<N>>(&self, basis: B, integrals: &Field) -> Interpolant<N> {
        let points = self.points();
        debug_assert_eq!((integrals.len(), integrals.count()), (points.len(), N));
        let followed: Vec<[f64; N]> = integrals
            .iter()
            .zip(&points)
            .map(|(integrals, &(mu, _))| follow(basis, mu, integrals))
            .collect();
        let parts: [Vec<f64>; N] =
            from_fn(|k| self.transform(followed.iter().map(|values| values[k]).collect()));
        // Of power k of s and power j of √r, the latter varying fastest.
        let at = |part: &[f64], group: usize, j: usize| {
            F64x8(from_fn(|lane| part[(group * LANES + lane) * self.roughnesses + j]))
        };
        let groups = |j: usize| {
            (0..self.directions / LANES).map(|g| from_fn(|k| at(&parts[k], g, j))).collect()
        };
        Interpolant { coefficients: (0..self.roughnesses).map(groups).collect(), power: self.power }
    }

    /// The coefficients in s and √r of values at the points: the transform along √r of the
    /// transform along s.
    fn transform(&self, values: Vec<f64>) -> Vec<f64> {
        let along_s = transform(&values, self.directions);
        transform(&transposed(&along_s, self.directions), self.roughnesses)
    }
}

/// E and the rests of the integrals at n·v = `mu`.
fn follow<const N: usize, B: Basis<N>>(basis: B, mu: f64, integrals: &[f64]) -> [f64; N] {
    let e: f64 = integrals.iter().take(2).sum();
    let weights = basis.weights(mu);
    from_fn(|k| if k == 0 { e } else { integrals[k] - weights[k] * e })
}

/// The inverse of [`follow`].
#[inline(always)]
fn unfollow<const N: usize, B: Basis<N>, R: Real>(
    basis: B,
    mu: R,
    followed: [R; N],
) -> Integrals<N, R> {
    let weights = basis.weights(mu);
    let mut integrals = Integrals::zero();
    for k in 1..N {
        integrals.0[k] = followed[k] + weights[k] * followed[0];
    }
    integrals.0[0] = followed[0] - integrals.0[1];
    integrals
}

/// The Chebyshev coefficients of each run of `count` values at the Chebyshev nodes.
fn transform(values: &[f64], count: usize) -> Vec<f64> {
    let n = count as f64;
    let row = |k: usize| -> Vec<f64> {
        let scale = if k == 0 { 1.0 / n } else { 2.0 / n };
        // The angle in units of π/(2n), less whole turns, is a whole number and exact.
        (0..count)
            .map(|j| scale * libm::cos(PI * (k * (2 * j + 1) % (4 * count)) as f64 / (2.0 * n)))
            .collect()
    };
    let rows: Vec<Vec<f64>> = (0..count).map(row).collect();
    let dot = |run: &[f64], row: &[f64]| -> f64 {
        run.iter().zip(row).map(|(value, weight)| value * weight).sum()
    };
    values.chunks(count).flat_map(|run| rows.iter().map(move |row| dot(run, row))).collect()
}

fn transposed(values: &[f64], width: usize) -> Vec<f64> {
    (0..width).flat_map(|i| values.iter().skip(i).step_by(width).copied()).collect()
}

/// Clenshaw's summation Σ c_k T_k(x) of N series at two places x, side by side since a step of one
/// waits for the step before; `of` gives an even number of coefficients. Two steps at a time, so
/// that the sums need not change places.
#[inline(always)]
fn clenshaw<const N: usize, R: Real, C>(
    coefficients: &[C],
    x: [R; 2],
    of: impl Fn(&C) -> [[R; N]; 2],
) -> [[R; N]; 2] {
    let last = coefficients.len() - 1;
    let twice = [x[0] * 2.0, x[1] * 2.0];
    let (mut now, mut before) = (of(&coefficients[last]), [[R::from(0.0); N]; 2]);
    for pair in coefficients[1..last].rchunks_exact(2) {
        let c = of(&pair[1]);
        for i in 0..2 {
            for k in 0..N {
                before[i][k] = twice[i] * now[i][k] + (c[i][k] - before[i][k]);
            }
        }
        let c = of(&pair[0]);
        for i in 0..2 {
            for k in 0..N {
                now[i][k] = twice[i] * before[i][k] + (c[i][k] - now[i][k]);
            }
        }
    }
    let mut sum = of(&coefficients[0]);
    for i in 0..2 {
        for k in 0..N {
            sum[i][k] = x[i] * now[i][k] + (sum[i][k] - before[i][k]);
        }
    }
    sum
}

impl<const N: usize> Interpolant<N> {
    /// The polynomials at one `alpha` in the rule's domain.
    #[inline(always)]
    pub fn row(&self, alpha: f64) -> InterpolantRow<N> {
        debug_assert!((SMOOTHEST * SMOOTHEST..=1.0).contains(&alpha), "{alpha}");
        let x = F64x8::from(2.0 * roughness_variable(alpha) - 1.0);
        let groups = self.coefficients[0].len();
        let mut coefficients = vec![[0.0; N]; groups * LANES];
        for (pair, coefficients) in coefficients.chunks_exact_mut(2 * LANES).enumerate() {
            let of = |row: &Vec<[F64x8; N]>| [row[2 * pair], row[2 * pair + 1]];
            let groups = clenshaw(&self.coefficients, [x; 2], of);
            for (coefficients, group) in coefficients.chunks_exact_mut(LANES).zip(&groups) {
                for (i, coefficients) in coefficients.iter_mut().enumerate() {
                    for k in 0..N {
                        coefficients[k] = group[k].0[i];
                    }
                }
            }
        }
        let steepness = 1.0 / alpha;
        InterpolantRow {
            power: self.power,
            steepness,
            scale: 1.0 / compressed(steepness, self.power),
            coefficients,
        }
    }
}

impl<const N: usize> InterpolantRow<N> {
    /// The integrals at these n·v.
    #[inline(always)]
    pub fn at<B: Basis<N>, R: Real>(&self, basis: B, mu: [R; 2]) -> [Integrals<N, R>; 2] {
        let of = |c: &[f64; N]| [c.map(R::from); 2];
        let [first, second] = clenshaw(&self.coefficients, mu.map(|mu| self.place(mu)), of);
        [unfollow(basis, mu[0], first), unfollow(basis, mu[1], second)]
    }

    /// 2s - 1
    #[inline(always)]
    fn place<R: Real>(&self, mu: R) -> R {
        let root = (compressed(mu * self.steepness, self.power) * self.scale).sqrt();
        let s = if self.power == Power::Four { root.sqrt() } else { root };
        s * 2.0 - 1.0
    }
}
