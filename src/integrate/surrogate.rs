//! A surrogate: (A, B) over all (n·v, α) by Chebyshev interpolation between the values of a rule at a few thousand
//! points. A table of any size costs no more integrals than that, and a texel two short polynomials.
//!
//! With y = μ/α the first variable is s ∝ tanh(asinh(y)/c)^(1/q), 1 at μ = 1: it spreads the layer μ ~ α over many
//! nodes, and its power q, about μ near 0, turns the term μ ln μ of Smith masking into s^q ln s, which a polynomial
//! follows. The second is √r = α^¼. What is interpolated is E = A + B and what is left of B beyond a mirror's: B -
//! (1-μ)⁵ E, which vanishes as α → 0 (B itself changes over μ ~ 1, which s does not resolve at small α).

use super::ScaleBias;
use super::l_space::{LSpaceRule, l_space_applies};
use crate::lanes::{Lanes, Real, WIDTH};
use crate::model::fresnel::schlick_weight;
use crate::model::{Masking, Microfacet};
use crate::quadrature::slope_map::Power;
use std::f64::consts::PI;

/// The smallest perceptual roughness of a surrogate: half a texel of a table of 512 rows.
pub const SMOOTHEST: f64 = 1.0 / 1024.0;

/// How many nodes along s and along √r, and which rule integrates there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurrogateRule {
    /// Along s; a multiple of twice [`WIDTH`].
    pub directions: usize,
    /// Along √r; even.
    pub roughnesses: usize,
    /// c and q of s: [`Power::Two`] is 8 and 2, for few nodes, [`Power::Four`] 16 and 4.
    pub power: Power,
    /// What integrates at the nodes.
    pub source: LSpaceRule,
}

/// Whether it follows a lobe: of those that its source integrates, not the implicit term's, whose albedo falls with μ².
pub fn surrogate_applies(lobe: Microfacet) -> bool {
    let followed = match lobe.masking {
        Masking::HeightCorrelated | Masking::Separable | Masking::SchlickSmith => true,
        Masking::Joint | Masking::Implicit | Masking::Neubelt => false,
    };
    followed && l_space_applies(lobe)
}

/// The polynomials, as Chebyshev coefficients.
#[derive(Clone, Debug)]
pub struct Surrogate {
    /// For each power of √r the coefficients in s of E and of the rest of B, eight of E, then eight of the other.
    coefficients: Vec<Vec<[Lanes; 2]>>,
    power: Power,
}

/// The polynomials of one α.
#[derive(Clone, Debug)]
pub struct SurrogateRow {
    power: Power,
    /// 1/α
    steepness: f64,
    /// What scales s to 1 at μ = 1, before the root is taken.
    scale: f64,
    coefficients: Vec<[f64; 2]>,
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

impl SurrogateRule {
    /// How many integrals it takes.
    pub fn len(&self) -> usize {
        self.directions * self.roughnesses
    }

    /// Whether it takes none; never so.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether an α lies in its domain.
    pub fn covers(&self, alpha: f64) -> bool {
        alpha >= SMOOTHEST * SMOOTHEST
    }

    /// The (n·v, α) at which it takes integrals, n·v varying fastest.
    pub fn points(&self) -> Vec<(f64, f64)> {
        let start = SMOOTHEST.sqrt();
        let rows = (0..self.roughnesses).map(|j| start + (1.0 - start) * chebyshev_node(j, self.roughnesses));
        rows.flat_map(|root| {
            let alpha = root * root * root * root;
            let end = compressed(1.0 / alpha, self.power);
            let c = if self.power == Power::Four { 16.0 } else { 8.0 };
            (0..self.directions).map(move |i| {
                let s2 = chebyshev_node(i, self.directions) * chebyshev_node(i, self.directions);
                let root = if self.power == Power::Four { s2 * s2 } else { s2 };
                let y = libm::sinh(c * libm::atanh(end * root));
                ((alpha * y).min(1.0), alpha)
            })
        })
        .collect()
    }

    /// The surrogate that has these integrals at its `points`, those of [`SurrogateRule::points`].
    pub fn fit(&self, points: &[(f64, f64)], integrals: &[ScaleBias]) -> Surrogate {
        let part = |channel: usize| -> Vec<f64> {
            let value = |(integral, &(mu, _)): (&ScaleBias, &(f64, f64))| match channel {
                0 => integral.e(),
                _ => integral.b - schlick_weight(mu) * integral.e(),
            };
            let values: Vec<f64> = integrals.iter().zip(points).map(value).collect();
            // The transform along √r of the transform along s.
            let along_s = transform(&values, self.directions);
            transform(&transposed(&along_s, self.directions), self.roughnesses)
        };
        let (e, rest) = (part(0), part(1));
        // Both are now (power of s, power of √r), the latter varying fastest.
        let at = |from: &[f64], group: usize, j: usize| {
            Lanes(std::array::from_fn(|lane| from[(group * WIDTH + lane) * self.roughnesses + j]))
        };
        let groups = |j: usize| (0..self.directions / WIDTH).map(|g| [at(&e, g, j), at(&rest, g, j)]).collect();
        Surrogate { coefficients: (0..self.roughnesses).map(groups).collect(), power: self.power }
    }
}

/// The Chebyshev coefficients of each run of `count` values at the Chebyshev nodes.
fn transform(values: &[f64], count: usize) -> Vec<f64> {
    let n = count as f64;
    let rows: Vec<Vec<f64>> = (0..count)
        .map(|k| {
            let scale = if k == 0 { 1.0 / n } else { 2.0 / n };
            (0..count).map(|j| scale * libm::cos(PI * (k * (2 * j + 1) % (4 * count)) as f64 / (2.0 * n))).collect()
        })
        .collect();
    let dot = |run: &[f64], row: &[f64]| -> f64 { run.iter().zip(row).map(|(value, weight)| value * weight).sum() };
    values.chunks(count).flat_map(|run| rows.iter().map(move |row| dot(run, row))).collect()
}

fn transposed(values: &[f64], width: usize) -> Vec<f64> {
    (0..width).flat_map(|i| values.iter().skip(i).step_by(width).copied()).collect()
}

/// Clenshaw's summation of four series side by side, since a step of one waits for the step before: Σ c_k T_k(x), an
/// even number of coefficients c_k by `of`. Two steps at a time, so that the sums need not change places.
#[inline(always)]
fn clenshaw<R: Real, C>(coefficients: &[C], x: [R; 4], of: impl Fn(&C) -> [R; 4]) -> [R; 4] {
    let (zero, last) = (R::from(0.0), coefficients.len() - 1);
    let twice = [x[0] * 2.0, x[1] * 2.0, x[2] * 2.0, x[3] * 2.0];
    let (mut now, mut before) = (of(&coefficients[last]), [zero; 4]);
    for pair in coefficients[1..last].rchunks_exact(2) {
        let c = of(&pair[1]);
        for i in 0..4 {
            before[i] = twice[i] * now[i] + (c[i] - before[i]);
        }
        let c = of(&pair[0]);
        for i in 0..4 {
            now[i] = twice[i] * before[i] + (c[i] - now[i]);
        }
    }
    let mut sum = of(&coefficients[0]);
    for i in 0..4 {
        sum[i] = x[i] * now[i] + (sum[i] - before[i]);
    }
    sum
}

impl Surrogate {
    /// The polynomials at one `alpha` in the rule's domain.
    #[inline(always)]
    pub fn row(&self, alpha: f64) -> SurrogateRow {
        let x = Lanes::from(2.0 * roughness_variable(alpha) - 1.0);
        let groups = self.coefficients[0].len();
        let mut coefficients = vec![[0.0; 2]; groups * WIDTH];
        for (pair, coefficients) in coefficients.chunks_exact_mut(2 * WIDTH).enumerate() {
            let of = |row: &Vec<[Lanes; 2]>| {
                let ([e, rest], [e_also, rest_also]) = (row[2 * pair], row[2 * pair + 1]);
                [e, rest, e_also, rest_also]
            };
            let [e, rest, e_also, rest_also] = clenshaw(&self.coefficients, [x; 4], of);
            for lane in 0..WIDTH {
                coefficients[lane] = [e.0[lane], rest.0[lane]];
                coefficients[WIDTH + lane] = [e_also.0[lane], rest_also.0[lane]];
            }
        }
        let steepness = 1.0 / alpha;
        SurrogateRow { power: self.power, steepness, scale: 1.0 / compressed(steepness, self.power), coefficients }
    }
}

impl SurrogateRow {
    /// (A, B) at these n·v.
    #[inline(always)]
    pub fn at<R: Real>(&self, mu: [R; 2]) -> [ScaleBias<R>; 2] {
        let of = |c: &[f64; 2]| {
            let (e, rest) = (R::from(c[0]), R::from(c[1]));
            [e, rest, e, rest]
        };
        let (x, x_also) = (self.place(mu[0]), self.place(mu[1]));
        let [e, rest, e_also, rest_also] = clenshaw(&self.coefficients, [x, x, x_also, x_also], of);
        let integral = |mu: R, e: R, rest: R| {
            let b = rest + schlick_weight(mu) * e;
            ScaleBias { a: e - b, b }
        };
        [integral(mu[0], e, rest), integral(mu[1], e_also, rest_also)]
    }

    /// 2s - 1
    #[inline(always)]
    fn place<R: Real>(&self, mu: R) -> R {
        let root = (compressed(mu * self.steepness, self.power) * self.scale).sqrt();
        let s = if self.power == Power::Four { root.sqrt() } else { root };
        s * 2.0 - 1.0
    }
}
