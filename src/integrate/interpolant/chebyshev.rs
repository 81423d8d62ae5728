//! Chebyshev polynomials on [0, 1]: nodes, transforms and sums.

use crate::numeric::lanes::Real;
use std::f64::consts::PI;

/// The n-th of the zeros of the Chebyshev polynomial of degree `count`, on [0, 1].
pub fn chebyshev_node(n: usize, count: usize) -> f64 {
    0.5 + 0.5 * libm::cos(PI * (n as f64 + 0.5) / count as f64)
}

/// The Chebyshev coefficients of each run of `count` values at the Chebyshev nodes.
pub fn transform(values: &[f64], count: usize) -> Vec<f64> {
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

pub fn transposed(values: &[f64], width: usize) -> Vec<f64> {
    (0..width).flat_map(|i| values.iter().skip(i).step_by(width).copied()).collect()
}

/// Clenshaw's summation Σ c_k T_k(x) of N series at two places x, side by side since a step of one
/// waits for the step before; `of` gives an even number of coefficients. Two steps at a time, so
/// that the sums need not change places.
#[inline(always)]
pub fn clenshaw<const N: usize, R: Real, C>(
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
