//! The best numbers of a shape, and how good any numbers can be: Lawson's iteration on weighted
//! least squares (Lawson 1961; Rice and Usow 1968).
//!
//! E(F0) is linear in the numbers c, so that the largest error over its tolerance is a maximum of
//! |Σ_k g_ik c_k - f_i| over rows i: a point and an end of the range of F0 each. For weights w_i ≥
//! 0 that add up to 1, min_c Σ w_i e_i² ≤ min_c max e_i²: every solution of a weighted problem
//! proves that no numbers whatever do better than the root of what it leaves. Lawson's weights
//! w_i ← w_i |e_i| raise that bound towards the least maximum.

mod system;

use super::samples::Sample;
use super::tolerance::Tolerance;
use crate::approximation::{Channels, Region, Shape};
use system::Functions;

/// What is to be fitted.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    /// Where.
    pub region: Region,
    /// The range of F0; both ends are the same where there is one F0.
    pub f0: [f64; 2],
    /// The tolerance of E(F0).
    pub tolerance: Tolerance,
    /// The channels.
    pub channels: Channels,
    /// The shape.
    pub shape: Shape,
    /// The numbers in each channel.
    pub counts: [usize; 2],
    /// The points.
    pub samples: &'a [Sample],
}

/// An error over its tolerance at a sample and an F0: Σ factor · channel - target.
#[derive(Clone, Copy, Debug)]
struct Row {
    f0: f64,
    /// 1 over the tolerance.
    scale: f64,
    target: f64,
    factors: [f64; 2],
}

/// The outcome of a fit.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The numbers of each channel, in the order of the system.
    pub numbers: Vec<Vec<f64>>,
    /// The largest error over its tolerance at the samples.
    pub error: f64,
    /// No numbers whatever have a smaller one there.
    pub bound: f64,
    /// The proof of that.
    pub proof: Vec<Multiplier>,
}

/// The multiplier of an error in a proof.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Multiplier {
    /// n·v
    pub nov: f64,
    /// Perceptual roughness.
    pub roughness: f64,
    /// F0
    pub f0: f64,
    /// Its weight times its sign.
    pub weight: f64,
}

impl Multiplier {
    /// Its place and its weight.
    pub fn array(&self) -> [f64; 4] {
        [self.nov, self.roughness, self.f0, self.weight]
    }

    /// From its place and its weight.
    pub fn of([nov, roughness, f0, weight]: [f64; 4]) -> Self {
        Multiplier { nov, roughness, f0, weight }
    }
}

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Steps at the most.
    pub steps: usize,
    /// A bound that fails a candidate.
    pub fails: f64,
    /// An error that needs no improvement.
    pub enough: f64,
}

/// The largest error over its bound where a fit can be hardly better.
const NEAR: f64 = 1.005;

impl Fit {
    /// Whether other numbers are hardly better.
    pub fn is_finished(&self) -> bool {
        self.error <= NEAR * self.bound
    }
}

impl Problem<'_> {
    /// Fits the numbers. None where the system has no solution in f64.
    pub fn fit(&self, effort: Effort) -> Option<Fit> {
        let functions = Functions::new(self);
        let (rows, ends) = self.rows();
        let mut weights = vec![1.0 / rows.len() as f64; rows.len()];
        let mut fit: Option<Fit> = None;
        let mut errors = vec![0.0; rows.len()];
        for _ in 0..effort.steps {
            let solution = functions.solve(&rows, ends, &weights)?;
            functions.errors(&rows, ends, &solution, &mut errors);
            let largest = errors.iter().fold(0.0, |largest: f64, error| largest.max(error.abs()));
            let squares: f64 = weights.iter().zip(&errors).map(|(w, e)| w * e * e).sum();
            let bound = squares.sqrt();
            let before = fit.as_ref().map_or((f64::INFINITY, 0.0), |fit| (fit.error, fit.bound));
            let mut best = fit.take().unwrap_or_else(|| Fit {
                numbers: Vec::new(),
                error: f64::INFINITY,
                bound: 0.0,
                proof: Vec::new(),
            });
            if largest < before.0 {
                best.numbers = functions.split(&solution);
                best.error = largest;
            }
            if bound > before.1 {
                best.bound = bound;
                if bound > effort.fails {
                    best.proof = self.multipliers(&rows, ends, &weights, &errors);
                }
            }
            let is_enough = best.error <= effort.enough || best.is_finished();
            let is_decided = best.bound > effort.fails || is_enough;
            fit = Some(best);
            if is_decided {
                break;
            }
            weights.iter_mut().zip(&errors).for_each(|(weight, error)| *weight *= error.abs());
            let sum: f64 = weights.iter().sum();
            weights.iter_mut().for_each(|weight| *weight /= sum);
        }
        fit
    }

    /// The rows, those of a sample side by side, and their number for a sample.
    fn rows(&self) -> (Vec<Row>, usize) {
        let ends = if self.f0[0] == self.f0[1] { 1 } else { 2 };
        let row = |sample: &Sample, f0: f64| {
            let albedo = sample.truth.at(f0);
            let scale = 1.0 / self.tolerance.at(albedo);
            let factors = self.channels.weights(sample.nov, f0).map(|factor| factor * scale);
            Row { f0, scale, target: albedo * scale, factors }
        };
        let of = |sample| self.f0.iter().take(ends).map(move |&f0| row(sample, f0));
        (self.samples.iter().flat_map(of).collect(), ends)
    }

    /// The multipliers of a proof: Σ weight · function = 0 for every function, since the solution
    /// leaves errors that are orthogonal to all of them.
    fn multipliers(
        &self,
        rows: &[Row],
        ends: usize,
        weights: &[f64],
        errors: &[f64],
    ) -> Vec<Multiplier> {
        let samples = self.samples.iter().flat_map(|sample| std::iter::repeat_n(sample, ends));
        let all = rows.iter().zip(samples).zip(weights.iter().zip(errors));
        all.map(|((row, sample), (weight, error))| Multiplier {
            nov: sample.nov,
            roughness: sample.roughness,
            f0: row.f0,
            weight: weight * error * row.scale,
        })
        .collect()
    }
}
