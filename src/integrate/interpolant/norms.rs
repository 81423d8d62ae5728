//! How large an interpolant and its derivatives are anywhere, for bounds of what lies between
//! points.
//!
//! A polynomial of degree n is nowhere larger than its largest value at the N > n zeros of T_N over
//! cos(π n/2N) (Ehlich and Zeller 1964), and one in two variables is so along each.

use super::chebyshev::chebyshev_node;
use super::{Interpolant, LANES};
use std::array::from_fn;
use std::f64::consts::PI;

/// The largest |P|, and those of its derivatives by s and by t, each from 0 to 1, where t is the
/// place of √r between its ends.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Norms {
    /// |P|
    pub value: f64,
    /// |P_s| and |P_t|
    pub first: [f64; 2],
    /// |P_ss|, |P_st| and |P_tt|
    pub second: [f64; 3],
}

/// Zeros for each power of a variable: 1/cos(π/6) is 1.15.
const ZEROS: usize = 3;

/// A polynomial in s and t: for each power of t the Chebyshev coefficients in s.
type Coefficients = Vec<Vec<f64>>;

impl<const N: usize> Interpolant<N> {
    /// The norms of what is followed of E and of the rests, of an interpolant in one piece.
    pub fn norms(&self) -> [Norms; N] {
        from_fn(|k| norms(&self.of(k)))
    }

    /// The coefficients of one of the polynomials.
    fn of(&self, k: usize) -> Coefficients {
        let row = |row: &Vec<[crate::numeric::lanes::F64x8; N]>| {
            (0..row.len() * LANES).map(|i| row[i / LANES][k].0[i % LANES]).collect()
        };
        self.pieces[0].sides[0].iter().map(row).collect()
    }
}

fn norms(value: &Coefficients) -> Norms {
    let (s, t) = (along_s(value), along_t(value));
    Norms {
        value: largest(value),
        first: [largest(&s), largest(&t)],
        second: [largest(&along_s(&s)), largest(&along_t(&s)), largest(&along_t(&t))],
    }
}

/// The derivative of a series on [0, 1]: c'_(k-1) = c'_(k+1) + 2 k c_k on [-1, 1], half of it for k
/// = 1, and twice that.
fn derivative(series: &[f64]) -> Vec<f64> {
    let mut result = vec![0.0; series.len() + 1];
    for k in (1..series.len()).rev() {
        result[k - 1] = result[k + 1] + 4.0 * k as f64 * series[k];
    }
    result[0] *= 0.5;
    result.truncate(series.len());
    result
}

fn along_s(polynomial: &Coefficients) -> Coefficients {
    polynomial.iter().map(|row| derivative(row)).collect()
}

fn along_t(polynomial: &Coefficients) -> Coefficients {
    transposed(&along_s(&transposed(polynomial)))
}

fn transposed(rows: &Coefficients) -> Coefficients {
    (0..rows[0].len()).map(|i| rows.iter().map(|row| row[i]).collect()).collect()
}

/// T_0 to T_(count - 1) at the zeros of T_(ZEROS count).
fn values(count: usize) -> Vec<Vec<f64>> {
    let at = |zero: usize| {
        let x = 2.0 * chebyshev_node(zero, ZEROS * count) - 1.0;
        let mut values = vec![1.0, x];
        for k in 2..count {
            values.push(2.0 * x * values[k - 1] - values[k - 2]);
        }
        values
    };
    (0..ZEROS * count).map(at).collect()
}

/// A bound of the largest |P|.
fn largest(polynomial: &Coefficients) -> f64 {
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let (columns, rows) = (polynomial[0].len(), polynomial.len());
    let of_t = values(rows);
    let mut largest: f64 = 0.0;
    for s in values(columns) {
        let series: Vec<f64> = polynomial.iter().map(|row| dot(row, &s)).collect();
        largest = of_t.iter().fold(largest, |largest, t| largest.max(dot(&series, t).abs()));
    }
    let factor =
        |count: usize| 1.0 / libm::cos(PI * (count - 1) as f64 / (2 * ZEROS * count) as f64);
    largest * factor(columns) * factor(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// T_2(2s - 1) + T_1(2t - 1) has the value 2 at a corner, and derivatives 8, 2, 16 and 0.
    #[test]
    fn bounds_of_a_polynomial_hold_and_are_near() {
        let mut polynomial = vec![vec![0.0; 8]; 4];
        polynomial[0][2] = 1.0;
        polynomial[1][0] = 1.0;
        let Norms { value, first, second } = norms(&polynomial);
        let pairs = [(value, 2.0), (first[0], 8.0), (first[1], 2.0), (second[0], 16.0)];
        for (bound, truth) in pairs {
            assert!(truth <= bound * (1.0 + 1e-12) && bound <= 1.5 * truth, "{bound} {truth}");
        }
        assert!(second[1].max(second[2]) < 1e-12, "{second:?}");
    }
}
