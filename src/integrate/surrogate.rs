//! A surrogate: (A, B) over all (n·v, α) by Chebyshev interpolation between the values of a rule at a few thousand points. A
//! table of any size costs no more integrals than that, and a texel two short polynomials.
//!
//! With y = μ/α the first variable is s ∝ tanh(asinh(y)/c)^¼, c = 8 or 16, 1 at μ = 1: it spreads the layer μ ~ α over many nodes, and
//! its fourth power, about μ near 0, turns the term μ ln μ of Smith masking into s⁴ ln s, which a polynomial follows. The second is
//! √r = α^¼. What is interpolated is E = A + B and what is left of B beyond a mirror's: B - (1-μ)⁵ E, which vanishes as α → 0
//! (B itself changes over μ ~ 1, which s does not resolve at small α).

use super::ScaleBias;
use super::l_space::LSpaceRule;
use crate::lanes::{Lanes, Real, WIDTH};
use crate::model::fresnel::schlick_weight;
use crate::quadrature::slope_map::Power;
use std::f64::consts::PI;

/// The smallest perceptual roughness of a surrogate: half a texel of a table of 512 rows.
pub const SMOOTHEST: f64 = 1.0 / 1024.0;

/// How many nodes along s and along √r, and which rule integrates there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurrogateRule {
    /// Along s; a multiple of [`WIDTH`].
    pub directions: usize,
    /// Along √r.
    pub roughnesses: usize,
    /// c of s: [`Power::Two`] is 8, for few nodes, [`Power::Four`] 16.
    pub power: Power,
    /// What integrates at the nodes.
    pub source: LSpaceRule,
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
    alpha: f64,
    power: Power,
    /// s at μ = 1 before it is scaled to 1.
    end: f64,
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
                let s = chebyshev_node(i, self.directions);
                let y = libm::sinh(c * libm::atanh(end * s * s * s * s));
                ((alpha * y).min(1.0), alpha)
            })
        })
        .collect()
    }

    /// The surrogate that has these integrals at [`SurrogateRule::points`].
    pub fn fit(&self, integrals: &[ScaleBias]) -> Surrogate {
        let points = self.points();
        let part = |channel: usize| -> Vec<f64> {
            let value = |(integral, &(mu, _)): (&ScaleBias, &(f64, f64))| match channel {
                0 => integral.e(),
                _ => integral.b - schlick_weight(mu) * integral.e(),
            };
            let values: Vec<f64> = integrals.iter().zip(&points).map(value).collect();
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
    let cosine = |turn: usize| libm::cos(PI * turn as f64 / (2.0 * n));
    let cosines: Vec<f64> = (0..4 * count).map(cosine).collect();
    let coefficient = |run: &[f64], k: usize| {
        let sum: f64 = run.iter().enumerate().map(|(j, value)| value * cosines[k * (2 * j + 1) % (4 * count)]).sum();
        if k == 0 { sum / n } else { 2.0 * sum / n }
    };
    values.chunks(count).flat_map(|run| (0..count).map(move |k| coefficient(run, k)).collect::<Vec<_>>()).collect()
}

fn transposed(values: &[f64], width: usize) -> Vec<f64> {
    (0..width).flat_map(|i| values.iter().skip(i).step_by(width).copied()).collect()
}

/// Clenshaw's summation of two series at once, each at two points: Σ c_k T_k(x), the coefficients c_k by `of`. Four sums side by
/// side, since a step of one waits for the step before.
#[inline(always)]
fn clenshaw<R: Real, C>(coefficients: &[C], x: [R; 2], of: impl Fn(&C) -> (R, R)) -> [(R, R); 2] {
    let zero = R::from(0.0);
    let (twice, twice_also) = (x[0] * 2.0, x[1] * 2.0);
    let mut now = [zero; 4];
    let mut before = [zero; 4];
    let (first, others) = coefficients.split_at(1);
    for c in others.iter().rev() {
        let (e, rest) = of(c);
        let next = [
            twice * now[0] + (e - before[0]),
            twice * now[1] + (rest - before[1]),
            twice_also * now[2] + (e - before[2]),
            twice_also * now[3] + (rest - before[3]),
        ];
        (before, now) = (now, next);
    }
    let (e, rest) = of(&first[0]);
    [
        (x[0] * now[0] + (e - before[0]), x[0] * now[1] + (rest - before[1])),
        (x[1] * now[2] + (e - before[2]), x[1] * now[3] + (rest - before[3])),
    ]
}

impl Surrogate {
    /// The polynomials at one `alpha` in the rule's domain.
    #[inline(always)]
    pub fn row(&self, alpha: f64) -> SurrogateRow {
        let x = Lanes::from(2.0 * roughness_variable(alpha) - 1.0);
        let groups = self.coefficients[0].len();
        let coefficients = (0..groups).flat_map(|group| {
            let of = |row: &Vec<[Lanes; 2]>| (row[group][0], row[group][1]);
            let [(e, rest), _] = clenshaw(&self.coefficients, [x, x], of);
            (0..WIDTH).map(move |lane| [e.0[lane], rest.0[lane]])
        });
        let end = compressed(1.0 / alpha, self.power);
        SurrogateRow { alpha, power: self.power, end, coefficients: coefficients.collect() }
    }
}

impl SurrogateRow {
    /// (A, B) at these n·v.
    #[inline(always)]
    pub fn at<R: Real>(&self, mu: [R; 2]) -> [ScaleBias<R>; 2] {
        let of = |c: &[f64; 2]| (R::from(c[0]), R::from(c[1]));
        let [one, other] = clenshaw(&self.coefficients, [self.place(mu[0]), self.place(mu[1])], of);
        let integral = |mu: R, (e, rest): (R, R)| {
            let b = rest + schlick_weight(mu) * e;
            ScaleBias { a: e - b, b }
        };
        [integral(mu[0], one), integral(mu[1], other)]
    }

    /// 2s - 1
    #[inline(always)]
    fn place<R: Real>(&self, mu: R) -> R {
        (compressed(mu / self.alpha, self.power) / self.end).sqrt().sqrt() * 2.0 - 1.0
    }
}
