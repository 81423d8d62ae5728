//! Proofs that a candidate fails whatever its numbers are: a few points and multipliers.
//!
//! A candidate's E(F0) is Σ_k c_k g_k with functions g_k of (n·v, roughness, F0). Where multipliers
//! λ_i have Σ_i λ_i g_k(i) = 0 for every k, the errors e_i of any numbers c have
//! Σ_i λ_i e_i = -Σ_i λ_i f_i with the true f_i, so that the largest error over its tolerance τ_i
//! is at least |Σ λ_i f_i| / Σ |λ_i| τ_i (the dual of Chebyshev approximation; Watson 1980).
//! Whoever can evaluate the g_k and f can check it.

use super::candidate::Candidate;
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
        let Candidate { channels, counts, .. } = self.candidate;
        let factors = channels.weights(point.nov, point.f0);
        let functions = self.functions(point.nov, point.roughness);
        let of_channel = |channel: usize| {
            let (first, factor) = (channel * counts[0], factors[channel]);
            let own = functions.iter().filter(move |(index, _)| *index < counts[channel]);
            own.map(move |(index, value)| (first + index, factor * value))
        };
        (0..channels.count()).flat_map(of_channel).collect()
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
        let mut tries: Vec<usize> =
            tries.into_iter().map(|count| count.clamp(1, points.len())).collect();
        tries.sort_unstable();
        tries.dedup();
        tries.into_iter().find_map(|count| {
            let rows: Vec<Vec<(usize, f64)>> =
                points[..count].iter().map(|point| self.row(point)).collect();
            let weights = projected(&rows, &points[..count])?;
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

/// The multipliers nearest to those of the points that are orthogonal to every function, scaled to
/// a sum of 1: by Gram and Schmidt's orthogonalisation of the functions, done twice.
fn projected(rows: &[Vec<(usize, f64)>], points: &[Multiplier]) -> Option<Vec<f64>> {
    let numbers = rows.iter().flatten().map(|(place, _)| place + 1).max()?;
    let mut functions = vec![vec![0.0; rows.len()]; numbers];
    for (i, row) in rows.iter().enumerate() {
        row.iter().for_each(|(place, value)| functions[*place][i] += value);
    }
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let remove = |from: &mut [f64], part: &[f64]| {
        let share = dot(from, part);
        from.iter_mut().zip(part).for_each(|(from, part)| *from -= share * part);
    };
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for mut function in functions {
        let size = dot(&function, &function).sqrt();
        if size == 0.0 {
            continue;
        }
        for _ in 0..2 {
            basis.iter().for_each(|part| remove(&mut function, part));
        }
        let left = dot(&function, &function).sqrt();
        // What depends on the others but for rounding needs no place in the basis.
        if left > 1e-13 * size {
            function.iter_mut().for_each(|value| *value /= left);
            basis.push(function);
        }
    }
    if basis.len() >= rows.len() {
        return None;
    }
    let mut weights: Vec<f64> = points.iter().map(|point| point.weight).collect();
    for _ in 0..3 {
        basis.iter().for_each(|part| remove(&mut weights, part));
    }
    let sum: f64 = weights.iter().map(|weight| weight.abs()).sum();
    (sum > 0.0).then(|| weights.iter().map(|weight| weight / sum).collect())
}
