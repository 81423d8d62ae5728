//! Proofs that a candidate fails whatever its numbers are: a few points and multipliers.
//!
//! A candidate's E(F0) is Σ_k c_k g_k with functions g_k of (n·v, roughness, F0). Where multipliers
//! λ_i have Σ_i λ_i g_k(i) = 0 for every k, the errors e_i of any numbers c have
//! Σ_i λ_i e_i = -Σ_i λ_i f_i with the true f_i, so that the largest error over its tolerance τ_i
//! is at least |Σ λ_i f_i| / Σ |λ_i| τ_i (the dual of Chebyshev approximation; Watson 1980).
//! Whoever can evaluate the g_k and f can check it.

use super::banded::Banded;
use super::candidate::Candidate;
use super::chebyshev::Chebyshev;
use super::fit::Multiplier;
use super::tolerance::Tolerance;
use super::truth::{Albedo, Truth};
use crate::approximation::shape::{Net, span};
use crate::approximation::{Region, Shape};

/// Numbers of a candidate up to this size are excluded where multipliers are orthogonal to its
/// functions but for rounding: no sensible fit of albedos in [0, 1] has larger ones.
pub const LARGEST_NUMBER: f64 = 1e6;

/// Digits of the points and multipliers that are kept.
const DIGITS: (usize, usize) = (6, 15);

/// Added to the diagonal of functions of size 1, so that those that depend on others but for
/// rounding stay at rest: the first that leaves a matrix positive definite.
const REGULARISATIONS: [f64; 3] = [1e-14, 1e-13, 1e-12];

/// Steps of a projection at the most. A step leaves a share of 1e-6 of what is not orthogonal to
/// most functions, and a large one of what is not to those that nearly depend on others.
const PROJECTIONS: usize = 24;

/// What is orthogonal but for rounding, as a share of all multipliers.
const ORTHOGONAL: f64 = 1e-15;

/// Digits that change no f64.
const EXACT: usize = 17;

/// A candidate that a proof is about.
#[derive(Clone, Copy, Debug)]
pub struct Claim<'a> {
    /// The candidate.
    pub candidate: &'a Candidate,
    /// Where it is to be right.
    pub region: &'a Region,
    /// How right.
    pub tolerance: Tolerance,
}

/// Rounds to this many significant digits.
fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}

impl Claim<'_> {
    /// The functions that are not 0 at a place, by their index, without factors of channels.
    fn functions(&self, nov: f64, roughness: f64) -> Vec<(usize, f64)> {
        let Candidate { shape, counts, .. } = self.candidate;
        let [x, y] = shape.coordinates(self.region, nov, roughness);
        match (*shape, shape.net()) {
            (Shape::Surface { columns, .. }, _) => {
                let (along, across) = (powers(x, columns), powers(y, counts[0] / columns));
                let rows =
                    across.iter().flat_map(|row| along.iter().map(move |column| row * column));
                rows.enumerate().collect()
            }
            (_, None) => powers(x, counts[0].max(counts[1])).into_iter().enumerate().collect(),
            (_, Some(Net { size: [columns, rows], degree })) => {
                let (along, across) = (span(degree, columns, x), span(degree, rows, y));
                let taps = degree + 1;
                (0..taps * taps)
                    .map(|tap| {
                        let (a, b) = (tap % taps, tap / taps);
                        let index = (across.first + b) * columns + along.first + a;
                        (index, across.weights[b] * along.weights[a])
                    })
                    .collect()
            }
        }
    }

    /// The functions with their factors in E(F0), by their place in the system.
    fn row(&self, point: &Multiplier) -> Vec<(usize, f64)> {
        self.in_channels(point, &self.functions(point.nov, point.roughness))
    }

    /// These functions with the factors of channels in E(F0), by their place in the system.
    fn in_channels(&self, point: &Multiplier, functions: &[(usize, f64)]) -> Vec<(usize, f64)> {
        let Candidate { channels, counts, .. } = self.candidate;
        let factors = channels.weights(point.nov, point.f0);
        let of_channel = |channel: usize| {
            let (first, factor) = (channel * counts[0], factors[channel]);
            let own = functions.iter().filter(move |(index, _)| *index < counts[channel]);
            own.map(move |(index, value)| (first + index, factor * value))
        };
        (0..channels.count()).flat_map(of_channel).collect()
    }

    /// The functions at points in an order, of polynomials in a basis, that suits a projection.
    fn rows(&self, points: &[Multiplier]) -> Rows {
        let Candidate { channels, counts, shape, .. } = self.candidate;
        let count = channels.count();
        if let Some(net) = shape.net() {
            let (order, band) = net.order();
            let places = |point: &Multiplier| {
                let place = |(index, value): (usize, f64)| {
                    (order[index % counts[0]] * count + index / counts[0], value)
                };
                self.row(point).into_iter().map(place).collect()
            };
            let rows = points.iter().map(places).collect();
            return Rows { rows, size: counts[0] * count, band: count * band };
        }
        let basis = Chebyshev::of(shape, self.region, counts[0].max(counts[1]));
        let row = |point: &Multiplier| {
            let functions = basis.at(point.nov, point.roughness).into_iter().enumerate();
            self.in_channels(point, &functions.collect::<Vec<_>>())
        };
        let size = counts.iter().take(count).sum();
        Rows { rows: points.iter().map(row).collect(), size, band: size }
    }

    /// The bound that multipliers prove, where `truths` are E and B at their points: what numbers
    /// up to [`LARGEST_NUMBER`] could still gain by rounding is taken off.
    pub fn bound(&self, proof: &[Multiplier], truths: &[Albedo]) -> f64 {
        let numbers: usize = self.candidate.counts.iter().sum();
        let mut sums = vec![0.0; numbers];
        let (mut target, mut size) = (0.0, 0.0);
        for (point, &truth) in proof.iter().zip(truths) {
            for (place, value) in self.row(point) {
                sums[place] += point.weight * value;
            }
            let albedo = truth.at(point.f0);
            target += point.weight * albedo;
            size += point.weight.abs() * self.tolerance.at(albedo);
        }
        let rest: f64 = sums.iter().map(|sum| sum.abs()).sum();
        let bound = (target.abs() - LARGEST_NUMBER * rest) / size;
        if bound.is_nan() { 0.0 } else { bound }
    }

    /// A proof with few points from one with many, and its bound; none where that loses it.
    pub fn shortened(&self, many: &[Multiplier], truth: &Truth) -> Option<(Vec<Multiplier>, f64)> {
        let mut points: Vec<Multiplier> = many.to_vec();
        points.sort_by(|a, b| b.weight.abs().total_cmp(&a.weight.abs()));
        // Where rounded places lose it, exact ones may not.
        [DIGITS.0, EXACT].into_iter().find_map(|digits| self.with_digits(&points, digits, truth))
    }

    /// The same with so many digits of the points, the heaviest of which come first.
    fn with_digits(
        &self,
        points: &[Multiplier],
        digits: usize,
        truth: &Truth,
    ) -> Option<(Vec<Multiplier>, f64)> {
        let [low, high] = self.region.roughness;
        let place = |point: &Multiplier| Multiplier {
            nov: rounded(point.nov, digits).clamp(self.region.least_nov, 1.0),
            roughness: rounded(point.roughness, digits).clamp(low, high),
            ..*point
        };
        let points: Vec<Multiplier> = points.iter().map(place).collect();
        let places: Vec<(f64, f64)> =
            points.iter().map(|point| (point.nov, point.roughness)).collect();
        let truths = truth.at(&places);
        let numbers: usize = self.candidate.counts.iter().sum();
        let tries = [9, 17, 33, numbers / 2, numbers + 2, 2 * numbers, 4 * numbers, points.len()];
        // Functions that are nowhere 0 leave no multipliers at as few points as there are of them.
        let least = if self.candidate.shape.net().is_some() { 1 } else { numbers + 1 };
        let least = least.min(points.len());
        let mut tries: Vec<usize> =
            tries.into_iter().map(|count| count.clamp(least, points.len())).collect();
        tries.sort_unstable();
        tries.dedup();
        tries.into_iter().find_map(|count| {
            let weights = self.rows(&points[..count]).projected(&points[..count])?;
            let proof: Vec<Multiplier> = points[..count]
                .iter()
                .zip(weights)
                .map(|(point, weight)| Multiplier { weight: rounded(weight, DIGITS.1), ..*point })
                .collect();
            let bound = self.bound(&proof, &truths[..count]);
            (bound > 1.0).then_some((proof, bound))
        })
    }
}

/// x^0 to x^(count - 1)
fn powers(x: f64, count: usize) -> Vec<f64> {
    std::iter::successors(Some(1.0), |power| Some(power * x)).take(count).collect()
}

/// Rows of functions at points: the places and the values of those that are not 0 at each.
struct Rows {
    rows: Vec<Vec<(usize, f64)>>,
    /// The number of functions.
    size: usize,
    /// How far apart those of a row are at the most.
    band: usize,
}

impl Rows {
    /// The multipliers nearest to those of the points that are orthogonal to every function, scaled
    /// to a sum of 1. None where none are left.
    ///
    /// λ - G (GᵀG)⁻¹ Gᵀλ with functions of size 1; a step leaves a share of Gᵀλ, so that it is done
    /// again.
    fn projected(&self, points: &[Multiplier]) -> Option<Vec<f64>> {
        let mut scales = vec![0.0; self.size];
        let entries = || self.rows.iter().flatten();
        entries().for_each(|(place, value)| scales[*place] += value * value);
        let inverse =
            |square: &mut f64| *square = if *square > 0.0 { square.sqrt().recip() } else { 0.0 };
        scales.iter_mut().for_each(inverse);
        let mut matrix = Banded::zeros(self.size, self.band);
        for row in &self.rows {
            let scaled = row.iter().map(|&(place, value)| (place, value * scales[place]));
            let scaled: Vec<(usize, f64)> = scaled.collect();
            for &(i, first) in &scaled {
                for &(j, second) in scaled.iter().filter(|(j, _)| *j <= i) {
                    matrix.add(i, j, first * second);
                }
            }
        }
        let matrix = REGULARISATIONS.into_iter().find_map(|share| {
            let mut matrix = matrix.clone();
            matrix.regularise(share);
            matrix.factorise().map(|()| matrix)
        })?;
        let mut weights: Vec<f64> = points.iter().map(|point| point.weight).collect();
        for _ in 0..PROJECTIONS {
            let mut sums = vec![0.0; self.size];
            for (row, weight) in self.rows.iter().zip(&weights) {
                row.iter().for_each(|(place, value)| sums[*place] += weight * value);
            }
            let size: f64 = weights.iter().map(|weight| weight.abs()).sum();
            if sums.iter().all(|sum| sum.abs() <= ORTHOGONAL * size) {
                break;
            }
            sums.iter_mut().zip(&scales).for_each(|(sum, scale)| *sum *= scale);
            matrix.substitute(&mut sums);
            sums.iter_mut().zip(&scales).for_each(|(share, scale)| *share *= scale);
            for (row, weight) in self.rows.iter().zip(&mut weights) {
                *weight -= row.iter().map(|(place, value)| sums[*place] * value).sum::<f64>();
            }
        }
        let sum: f64 = weights.iter().map(|weight| weight.abs()).sum();
        (sum > 0.0).then(|| weights.iter().map(|weight| weight / sum).collect())
    }
}
