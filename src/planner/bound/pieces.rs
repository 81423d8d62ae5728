//! Ranges of a shape's sum and of its derivatives over a rectangle of its coordinates.

use super::interval::{Interval, Jet};
use crate::approximation::{Numbers, Shape};
use crate::integrate::interpolant::norms::Norms;

/// A function of two coordinates over a rectangle.
#[derive(Clone, Copy, Debug)]
pub struct Pieces {
    value: Interval,
    /// By x and by y.
    first: [Interval; 2],
    /// By x twice, by both, by y twice.
    second: [Interval; 3],
    /// The largest jump of the first derivatives at a knot of a bilinear net, by x and by y.
    kinks: [f64; 2],
    /// Knots for each unit of x and of y.
    knots: [f64; 2],
}

impl Pieces {
    /// Of a function with these norms.
    pub fn of(norms: &Norms) -> Self {
        Pieces {
            value: Interval::around_zero(norms.value),
            first: norms.first.map(Interval::around_zero),
            second: norms.second.map(Interval::around_zero),
            kinks: [0.0; 2],
            knots: [0.0; 2],
        }
    }

    /// The same, with a narrower value and first derivatives.
    pub fn known(self, value: Interval, first: [Interval; 2]) -> Self {
        Pieces { value, first, ..self }
    }

    /// Of a shape with these numbers, where its coordinates are in these ranges.
    pub fn new(shape: &Shape, numbers: &Numbers, x: Interval, y: Interval) -> Self {
        if numbers.is_empty() {
            return Pieces::of(&Norms::default());
        }
        match *shape {
            Shape::Polynomial { .. } => polynomial(numbers, numbers.len(), x, y),
            Shape::Surface { columns, .. } => polynomial(numbers, columns, x, y),
            Shape::Spline { size, degree, .. } => spline(numbers, size, degree, [x, y]),
            Shape::Texture { x: columns, y: rows, .. } => {
                let size = [columns.size(), rows.size()];
                // A sampler reads beside a place too.
                let [by, across] = shape.filter();
                let places = [x.widened(by), y.widened(across)];
                spline(numbers, size, 1, places).clamped(places)
            }
        }
    }

    /// The same of a sampler that clamps coordinates: where it begins to, the slope jumps to 0.
    fn clamped(self, places: [Interval; 2]) -> Self {
        let kink = |axis: usize| match places[axis].low <= 0.0 || places[axis].high >= 1.0 {
            true => self.kinks[axis].max(self.first[axis].size()),
            false => self.kinks[axis],
        };
        Pieces { kinks: [kink(0), kink(1)], ..self }
    }

    /// By how much a lookup changes where its coordinates are so far off.
    pub fn moved(&self, by: [f64; 2]) -> f64 {
        self.first[0].size() * by[0] + self.first[1].size() * by[1]
    }

    /// Along a line, on which the coordinates change so.
    pub fn along(&self, x: Jet, y: Jet) -> Jet {
        let [fx, fy] = self.first;
        let [fxx, fxy, fyy] = self.second;
        let first = fx * x.first + fy * y.first;
        let second = fxx * (x.first * x.first)
            + fxy * (x.first * y.first) * 2.0
            + fyy * (y.first * y.first)
            + fx * x.second
            + fy * y.second;
        Jet { value: self.value, first, second }
    }

    /// By how much a line between the ends of a step can be off because of the jumps at the knots
    /// in it: a quarter of the step times each jump; half of it where the coordinate may turn.
    pub fn kinks(&self, x: Jet, y: Jet, step: f64) -> f64 {
        let of = |axis: usize, coordinate: Jet| {
            let speed = coordinate.first.size();
            let turns = coordinate.first.low < 0.0 && coordinate.first.high > 0.0;
            let crossed = (speed * step * self.knots[axis]).ceil() * if turns { 2.0 } else { 1.0 };
            if self.kinks[axis] == 0.0 { 0.0 } else { crossed * self.kinks[axis] * speed }
        };
        0.25 * step * (of(0, x) + of(1, y))
    }
}

/// Σ c_ij δ^i ε^j about the middle of a rectangle, of Σ c_ij x^i y^j.
fn polynomial(numbers: &Numbers, columns: usize, x: Interval, y: Interval) -> Pieces {
    let rows = numbers.len().div_ceil(columns);
    let middle = |range: Interval| 0.5 * (range.low + range.high);
    let half = |range: Interval| 0.5 * (range.high - range.low);
    let of_row = |j: usize| -> Vec<f64> {
        let row = (0..columns).map(|i| numbers.get(j * columns + i)).collect();
        shifted(row, middle(x))
    };
    let mut shifts: Vec<Vec<f64>> = (0..rows).map(of_row).collect();
    for i in 0..columns {
        let column = shifted(shifts.iter().map(|row| row[i]).collect(), middle(y));
        shifts.iter_mut().zip(column).for_each(|(row, value)| row[i] = value);
    }
    // The range of the derivative of this order by x and by y.
    let derivative = |orders: [usize; 2]| {
        let mut range = Interval::point(0.0);
        for (j, row) in shifts.iter().enumerate().skip(orders[1]) {
            for (i, value) in row.iter().enumerate().skip(orders[0]) {
                let powers = [i - orders[0], j - orders[1]];
                let factor = falling(i, orders[0]) * falling(j, orders[1]) * value;
                let size = half(x).powi(powers[0] as i32) * half(y).powi(powers[1] as i32);
                let term = match powers {
                    [0, 0] => Interval::point(factor),
                    _ => Interval::around_zero((factor * size).abs()),
                };
                range = range + term;
            }
        }
        range
    };
    Pieces {
        value: derivative([0, 0]),
        first: [derivative([1, 0]), derivative([0, 1])],
        second: [derivative([2, 0]), derivative([1, 1]), derivative([0, 2])],
        kinks: [0.0; 2],
        knots: [0.0; 2],
    }
}

/// n (n - 1) … of so many factors.
fn falling(n: usize, factors: usize) -> f64 {
    (0..factors).map(|k| (n - k) as f64).product()
}

/// The coefficients of a polynomial about another place, by repeated synthetic division.
fn shifted(mut coefficients: Vec<f64>, place: f64) -> Vec<f64> {
    let count = coefficients.len();
    for k in 0..count {
        for i in (k..count - 1).rev() {
            coefficients[i] += place * coefficients[i + 1];
        }
    }
    coefficients
}

/// A derivative of a uniform B-spline is one of a lower degree through the differences of its
/// control points, and each lies between those that it has a part of (de Boor 1978).
fn spline(numbers: &Numbers, size: [usize; 2], degree: usize, place: [Interval; 2]) -> Pieces {
    let spans = size.map(|count| (count - degree) as f64);
    // The control points of the spans that the rectangle touches; a place that is a rounding away
    // from a knot counts to both sides.
    let touched = |axis: usize| {
        let last = size[axis] - degree - 1;
        let span = |place: f64| ((place * spans[axis]).max(0.0) as usize).min(last);
        let Interval { low, high } = place[axis];
        span(low - 1e-9)..span(high + 1e-9) + degree + 1
    };
    let (columns, rows) = (touched(0), touched(1));
    let net: Vec<Vec<f64>> =
        rows.map(|j| columns.clone().map(|i| numbers.get(j * size[0] + i)).collect()).collect();
    let along = |net: &[Vec<f64>]| -> Vec<Vec<f64>> {
        net.iter().map(|row| differences(row, spans[0])).collect()
    };
    let across = |net: &[Vec<f64>]| -> Vec<Vec<f64>> {
        let steps = |pair: &[Vec<f64>]| {
            let step = |(low, high): (&f64, &f64)| (high - low) * spans[1];
            pair[0].iter().zip(&pair[1]).map(step).collect()
        };
        net.windows(2).map(steps).collect()
    };
    let hull = |net: &[Vec<f64>]| match net.iter().flatten().next() {
        Some(_) => Interval::hull(net.iter().flatten().copied()),
        None => Interval::point(0.0),
    };
    let (x, y) = (along(&net), across(&net));
    let (xx, yy) = (hull(&along(&x)), hull(&across(&y)));
    let first = [hull(&x), hull(&y)];
    let mixed = hull(&across(&x));
    if degree > 1 {
        let second = [xx, mixed, yy];
        return Pieces { value: hull(&net), first, second, kinks: [0.0; 2], knots: spans };
    }
    let zero = Interval::point(0.0);
    Pieces {
        value: hull(&net),
        first,
        second: [zero, mixed, zero],
        kinks: [xx.size() / spans[0], yy.size() / spans[1]],
        knots: spans,
    }
}

/// The steps from each number to the next, times a factor.
fn differences(numbers: &[f64], factor: f64) -> Vec<f64> {
    numbers.windows(2).map(|pair| (pair[1] - pair[0]) * factor).collect()
}
