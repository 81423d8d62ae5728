//! Shapes: the functions of (n·v, roughness) that the numbers of an approximation are factors of.

use super::texture::{FILTER, Texels, place_on};
use super::{Across, Along, Numbers, Region};
use crate::numeric::lanes::{Real, Vector};
use crate::table::axis::Axis;

/// A shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A polynomial in 2 x - 1 for a coordinate x along n·v, for one roughness: its number i is the
    /// factor of (2 x - 1)^i. Powers of what lies between -1 and 1 have small factors, which halves
    /// hold well.
    Polynomial {
        /// The coordinate x, from 0 to 1 and counted from n·v = 0.
        x: Along,
    },
    /// A polynomial in two coordinates: its number j·columns + i is the factor of x^i y^j.
    Surface {
        /// Along n·v, counted from n·v = 0.
        x: Along,
        /// Across roughness; y is the bare power of the roughness.
        y: Across,
        /// The number of powers of x.
        columns: usize,
    },
    /// A uniform B-spline in two coordinates from 0 to 1: number j·columns + i is the control point
    /// in column i and row j.
    Spline {
        /// Along n·v, counted from the region's least.
        x: Along,
        /// Across the region's roughnesses.
        y: Across,
        /// The number of control points along x and across y.
        size: [usize; 2],
        /// Of the pieces: 1 is bilinear, 2 quadratic, 3 cubic.
        degree: usize,
    },
    /// A texture over all of n·v and roughness, as a bilinear sampler with clamped edges reads it:
    /// number j·columns + i is texel (i, j).
    Texture {
        /// Along n·v.
        x: Axis,
        /// Across roughness or α.
        y: Axis,
        /// What its texels are.
        texels: Texels,
    },
}

/// The control points of a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Net {
    /// Along n·v and across roughness.
    pub size: [usize; 2],
    /// Of its pieces.
    pub degree: usize,
}

impl Net {
    /// Where its control points stand in a system of equations, and how far apart those that count
    /// at one place do at the most: neighbours along the shorter side stand side by side.
    pub fn order(self) -> (Vec<usize>, usize) {
        let Net { size: [columns, rows], degree } = self;
        let is_wide = columns > rows;
        let place = |index: usize| {
            let (i, j) = (index % columns, index / columns);
            if is_wide { i * rows + j } else { index }
        };
        ((0..columns * rows).map(place).collect(), degree * (columns.min(rows) + 1) + 1)
    }
}

/// The numbers that count at a place, and their weights: the control points of the span where it
/// lies.
#[derive(Clone, Copy, Debug)]
pub struct Span<R> {
    /// The first of them.
    pub first: usize,
    /// degree + 1 weights.
    pub weights: [R; 4],
}

/// The weights of the control points of a span at `f` of its width (de Boor 1978).
pub fn weights<R: Real>(degree: usize, f: R) -> [R; 4] {
    let (zero, g) = (R::from(0.0), f.complement());
    match degree {
        1 => [g, f, zero, zero],
        2 => {
            let (first, last) = (g * g * 0.5, f * f * 0.5);
            [first, (first + last).complement(), last, zero]
        }
        _ => {
            let (f2, g2) = (f * f, g * g);
            let (first, last) = (g2 * g * (1.0 / 6.0), f2 * f * (1.0 / 6.0));
            let second = f2 * (f * 0.5 - 1.0) + 2.0 / 3.0;
            [first, second, (first + second + last).complement(), last]
        }
    }
}

/// The span of each lane's place, from 0 to 1, on an axis of `count` control points, and the
/// weights there.
fn spans<V: Vector>(degree: usize, count: usize, place: V) -> (Vec<usize>, [V; 4]) {
    let last = count - degree - 1;
    let place = place.max(V::from(0.0)).min(V::from(1.0)) * (count - degree) as f64;
    let firsts: Vec<usize> = (0..V::LANES).map(|i| (place.lane(i) as usize).min(last)).collect();
    let f = place - V::gather(|i| firsts[i] as f64);
    (firsts, weights(degree, f))
}

/// The span of one place.
pub fn span(degree: usize, count: usize, place: f64) -> Span<f64> {
    let place = place.clamp(0.0, 1.0) * (count - degree) as f64;
    let first = (place as usize).min(count - degree - 1);
    Span { first, weights: weights(degree, place - first as f64) }
}

/// Σ c_i x^i by Horner's rule.
fn horner<R: Real>(count: usize, coefficient: impl Fn(usize) -> f64, x: R) -> R {
    let last = R::from(coefficient(count - 1));
    (0..count - 1).rev().fold(last, |sum, i| sum * x + coefficient(i))
}

impl Shape {
    /// Its control points; none of polynomials.
    pub fn net(&self) -> Option<Net> {
        match *self {
            Shape::Polynomial { .. } | Shape::Surface { .. } => None,
            Shape::Spline { size, degree, .. } => Some(Net { size, degree }),
            Shape::Texture { x, y, .. } => Some(Net { size: [x.size(), y.size()], degree: 1 }),
        }
    }

    /// The coordinates that it takes: those of a net are from 0 to 1, that of a polynomial in n·v
    /// from -1 to 1.
    pub fn coordinates<R: Real>(&self, region: &Region, nov: R, roughness: R) -> [R; 2] {
        match *self {
            Shape::Polynomial { x } => [x.at(0.0, nov, roughness) * 2.0 - 1.0, R::from(0.0)],
            Shape::Surface { x, y, .. } => [x.at(0.0, nov, roughness), y.of(roughness)],
            Shape::Spline { x, y, .. } => {
                [x.at(region.least_nov, nov, roughness), y.at(region, roughness)]
            }
            Shape::Texture { x, y, .. } => {
                [place_on(&x, nov, roughness), place_on(&y, nov, roughness)]
            }
        }
    }

    /// By how much a sampler may be off along each coordinate; nothing where none reads it.
    pub fn filter(&self) -> [f64; 2] {
        match self {
            Shape::Texture { x, y, .. } => [x, y].map(|axis| FILTER / (axis.size() - 1) as f64),
            _ => [0.0; 2],
        }
    }

    /// Σ number · function at these coordinates.
    pub fn sum<V: Vector>(&self, numbers: &Numbers, [x, y]: [V; 2]) -> V {
        if numbers.is_empty() {
            return V::from(0.0);
        }
        let number = |index: usize| numbers.get(index);
        match (*self, self.net()) {
            (_, Some(Net { size: [columns, rows], degree })) => {
                let (i, along) = spans(degree, columns, x);
                let (j, across) = spans(degree, rows, y);
                let mut sum = V::from(0.0);
                for (b, &across) in across.iter().enumerate().take(degree + 1) {
                    let mut row = V::from(0.0);
                    for (a, &along) in along.iter().enumerate().take(degree + 1) {
                        let taken = V::gather(|lane| number((j[lane] + b) * columns + i[lane] + a));
                        row = row + along * taken;
                    }
                    sum = sum + across * row;
                }
                sum
            }
            (Shape::Surface { columns, .. }, None) => {
                let row = |j: usize| horner(columns, |i| number(j * columns + i), x);
                let rows = numbers.len() / columns;
                (0..rows - 1).rev().fold(row(rows - 1), |sum, j| sum * y + row(j))
            }
            _ => horner(numbers.len(), number, x),
        }
    }
}
