//! The system of weighted least squares of a problem.

use super::{Problem, Row};
use crate::approximation::shape::{Net, span};
use crate::numeric::lanes::{Work, vectorised};
use crate::planner::banded::Banded;
use crate::planner::chebyshev::Chebyshev;

/// Added to the diagonal, as a share of its largest entry: functions that no sample sees stay at 0.
const REGULARISATION: f64 = 1e-14;

/// The functions of a shape at the samples, and where their numbers stand in the system.
pub struct Functions {
    kind: Kind,
    channels: usize,
    size: usize,
    band: usize,
}

enum Kind {
    /// The same functions for each channel, of which it takes its first ones.
    Dense { counts: [usize; 2], width: usize, values: Vec<f64> },
    /// Control points: where each stands in the system, those of a span after its first, for each
    /// sample the first and 16 weights, and the samples in the order of their spans.
    Spans {
        order: Vec<usize>,
        offsets: Vec<usize>,
        samples: Vec<(usize, [f64; 16])>,
        by_span: Vec<usize>,
    },
}

impl Functions {
    /// Of a problem.
    pub fn new(problem: &Problem) -> Self {
        let Problem { region, shape, counts, samples, .. } = problem;
        let channels = problem.channels.count();
        match shape.net() {
            None => {
                let width = counts[0].max(counts[1]);
                let basis = Chebyshev::of(shape, region, width);
                let values = samples
                    .iter()
                    .flat_map(|sample| basis.at(sample.nov, sample.roughness))
                    .collect();
                let size = counts.iter().take(channels).sum();
                Functions {
                    kind: Kind::Dense { counts: *counts, width, values },
                    channels,
                    size,
                    band: size,
                }
            }
            Some(net) => {
                let Net { size: [columns, rows], degree } = net;
                let (order, band) = net.order();
                let taps = degree + 1;
                let offsets =
                    (0..taps * taps).map(|tap| tap / taps * columns + tap % taps).collect();
                let spans = samples.iter().map(|sample| {
                    let [x, y] = shape.coordinates(region, sample.nov, sample.roughness);
                    let along = span(degree, columns, x);
                    let across = span(degree, rows, y);
                    let mut weights = [0.0; 16];
                    for (tap, weight) in weights.iter_mut().enumerate().take(taps * taps) {
                        *weight = across.weights[tap / taps] * along.weights[tap % taps];
                    }
                    (across.first * columns + along.first, weights)
                });
                let samples: Vec<(usize, [f64; 16])> = spans.collect();
                let mut by_span: Vec<usize> = (0..samples.len()).collect();
                by_span.sort_by_key(|&index| samples[index].0);
                Functions {
                    kind: Kind::Spans { order, offsets, samples, by_span },
                    channels,
                    size: channels * columns * rows,
                    band: channels * band,
                }
            }
        }
    }

    /// The numbers that leave the smallest weighted sum of squares.
    pub fn solve(&self, rows: &[Row], ends: usize, weights: &[f64]) -> Option<Vec<f64>> {
        vectorised(Solve { functions: self, rows, ends, weights })
    }

    #[inline(always)]
    fn solution(&self, rows: &[Row], ends: usize, weights: &[f64]) -> Option<Vec<f64>> {
        let mut matrix = Banded::zeros(self.size, self.band);
        let mut side = vec![0.0; self.size];
        match &self.kind {
            Kind::Dense { counts, width, values } => {
                self.add_dense(
                    (*counts, values, *width),
                    (rows, ends, weights),
                    &mut matrix,
                    &mut side,
                );
            }
            Kind::Spans { order, offsets, samples, by_span } => {
                let mut local = Local::new(offsets.len());
                for &index in by_span {
                    let (first, functions) = &samples[index];
                    if local.first != *first {
                        local.flush((order, offsets, self.channels), &mut matrix, &mut side);
                        local.first = *first;
                    }
                    let own = index * ends..(index + 1) * ends;
                    local.add(functions, &rows[own.clone()], &weights[own]);
                }
                local.flush((order, offsets, self.channels), &mut matrix, &mut side);
            }
        }
        matrix.regularise(REGULARISATION);
        matrix.solve(&mut side)?;
        Some(side)
    }

    #[inline(always)]
    fn add_dense(
        &self,
        (counts, values, width): ([usize; 2], &[f64], usize),
        (rows, ends, weights): (&[Row], usize, &[f64]),
        matrix: &mut Banded,
        side: &mut [f64],
    ) {
        let functions = values.chunks_exact(width).flat_map(|own| std::iter::repeat_n(own, ends));
        let each = rows.iter().zip(weights).zip(functions).map(|((row, w), own)| (row, w, own));
        let mut all = vec![0.0; self.size];
        for (row, weight, functions) in each {
            for c in 0..self.channels {
                let own = &mut all[c * counts[0]..][..counts[c]];
                own.iter_mut().zip(functions).for_each(|(one, f)| *one = row.factors[c] * f);
            }
            for (i, value) in all.iter().enumerate() {
                matrix.add_row(i, weight * value, &all);
                side[i] += weight * row.target * value;
            }
        }
    }

    /// The errors that these numbers leave.
    pub fn errors(&self, rows: &[Row], ends: usize, solution: &[f64], errors: &mut [f64]) {
        let each = rows.chunks_exact(ends).zip(errors.chunks_exact_mut(ends)).enumerate();
        for (index, (rows, errors)) in each {
            let mut channels = [0.0; 2];
            for (c, channel) in channels.iter_mut().enumerate().take(self.channels) {
                *channel = match &self.kind {
                    Kind::Dense { counts, width, values } => {
                        let functions = &values[index * width..][..counts[c]];
                        let numbers = &solution[c * counts[0]..][..counts[c]];
                        functions.iter().zip(numbers).map(|(f, n)| f * n).sum()
                    }
                    Kind::Spans { order, offsets, samples, .. } => {
                        let (first, functions) = &samples[index];
                        let number =
                            |offset: &usize| solution[order[first + offset] * self.channels + c];
                        offsets.iter().zip(functions).map(|(o, f)| number(o) * f).sum()
                    }
                };
            }
            for (row, error) in rows.iter().zip(errors) {
                *error = row.factors[0] * channels[0] + row.factors[1] * channels[1] - row.target;
            }
        }
    }

    /// The numbers of each channel.
    pub fn split(&self, solution: &[f64]) -> Vec<Vec<f64>> {
        let channel = |c: usize| match &self.kind {
            Kind::Dense { counts, .. } => solution[c * counts[0]..][..counts[c]].to_vec(),
            Kind::Spans { order, .. } => {
                order.iter().map(|place| solution[place * self.channels + c]).collect()
            }
        };
        (0..self.channels).map(channel).collect()
    }
}

/// A system that is to be solved.
struct Solve<'a> {
    functions: &'a Functions,
    rows: &'a [Row],
    ends: usize,
    weights: &'a [f64],
}

impl Work for Solve<'_> {
    type Output = Option<Vec<f64>>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        self.functions.solution(self.rows, self.ends, self.weights)
    }
}

/// Σ w g_c g_d for the pairs (0, 0), (1, 0) and (1, 1) of channels, and Σ w g_c target, over the
/// rows of a sample.
#[inline(always)]
fn sums(rows: &[Row], weights: &[f64]) -> ([f64; 3], [f64; 2]) {
    let (mut products, mut targets) = ([0.0; 3], [0.0; 2]);
    for (Row { factors: [first, second], target, .. }, weight) in rows.iter().zip(weights) {
        products[0] += weight * first * first;
        products[1] += weight * first * second;
        products[2] += weight * second * second;
        targets[0] += weight * first * target;
        targets[1] += weight * second * target;
    }
    (products, targets)
}

/// The part of the system that the samples of a span add.
struct Local {
    /// Control points of a span.
    taps: usize,
    first: usize,
    is_empty: bool,
    products: [[[f64; 16]; 16]; 3],
    targets: [[f64; 16]; 2],
}

impl Local {
    fn new(taps: usize) -> Self {
        let (products, targets) = ([[[0.0; 16]; 16]; 3], [[0.0; 16]; 2]);
        Local { taps, first: 0, is_empty: true, products, targets }
    }

    #[inline(always)]
    fn add(&mut self, functions: &[f64; 16], rows: &[Row], weights: &[f64]) {
        self.is_empty = false;
        let (products, targets) = sums(rows, weights);
        for (product, sum) in products.iter().zip(&mut self.products) {
            for (row, function) in sum.iter_mut().zip(functions).take(self.taps) {
                let factor = product * function;
                // Those beyond the taps are 0.
                for (entry, function) in row.iter_mut().zip(functions) {
                    *entry += factor * function;
                }
            }
        }
        for (target, sum) in targets.iter().zip(&mut self.targets) {
            for (entry, function) in sum.iter_mut().zip(functions) {
                *entry += target * function;
            }
        }
    }

    /// Adds it to the system and begins anew.
    #[inline(always)]
    fn flush(
        &mut self,
        (order, offsets, channels): (&[usize], &[usize], usize),
        matrix: &mut Banded,
        side: &mut [f64],
    ) {
        if self.is_empty {
            return;
        }
        let place = |tap: usize| order[self.first + offsets[tap]] * channels;
        for a in 0..offsets.len() {
            for c in 0..channels {
                let row = place(a) + c;
                side[row] += self.targets[c][a];
                for b in 0..offsets.len() {
                    for d in 0..channels {
                        let column = place(b) + d;
                        if column <= row {
                            matrix.add(row, column, self.products[c + d][a][b]);
                        }
                    }
                }
            }
        }
        *self = Local { first: self.first, ..Local::new(self.taps) };
    }
}
