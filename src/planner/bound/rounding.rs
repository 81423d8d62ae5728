//! What single precision adds to the error of a lookup at the most, by counting its roundings
//! (Higham 2002, chapters 3 and 5).

use crate::approximation::shape::Net;
use crate::approximation::{Across, Along, Approximation, Numbers, Region, Shape};

/// Half a unit in the last place of a float.
const UNIT: f64 = 1.0 / 16_777_216.0;

/// Roundings of a coordinate from 0 to 1, in units of itself: a shift, its scale, a width, a
/// product, a quotient and a root, which halves those before it; shaders round quotients and roots
/// by up to 2.5 units more.
const COORDINATE: f64 = 12.0;

/// Roundings of the coordinate of a logarithm: of its argument, which are larger over ln 2, of the
/// logarithm itself, 3 units in its last place in WGSL or 2^-21 near an argument of 2, and of
/// products.
const LOGARITHM: f64 = 20.0;

/// Roundings of the weights of control points, and of the sums over them.
const NET: f64 = 32.0;

/// Roundings of the factors of channels in E(F0), and of their sum.
const FACTORS: f64 = 16.0;

/// The largest difference between E(F0) in floats and without rounding.
pub fn rounding(approximation: &Approximation) -> f64 {
    let Approximation { shape, numbers, region, .. } = approximation;
    let of = |numbers: &Numbers| {
        let sizes: Vec<f64> = (0..numbers.len()).map(|i| numbers.get(i).abs()).collect();
        let largest = sizes.iter().copied().fold(0.0, f64::max);
        match *shape {
            // 2 x - 1 has twice the error of x, and one of its own.
            Shape::Polynomial { x } => powers(&sizes, sizes.len().max(1), 2.0 * along(x) + 1.0),
            Shape::Surface { x, columns, .. } => powers(&sizes, columns, along(x)),
            Shape::Spline { .. } | Shape::Texture { .. } => {
                let Some(Net { size, degree }) = shape.net() else { return 0.0 };
                let spans = size.map(|count| (count - degree) as f64);
                let slope = |step: usize, is_inside: &dyn Fn(usize) -> bool| {
                    let pairs = (0..sizes.len().saturating_sub(step)).filter(|&i| is_inside(i));
                    pairs
                        .map(|i| (numbers.get(i + step) - numbers.get(i)).abs())
                        .fold(0.0, f64::max)
                };
                let by_x = slope(1, &|i| (i + 1) % size[0] != 0) * spans[0];
                let by_y = slope(size[0], &|_| true) * spans[1];
                let [x, y] = match *shape {
                    Shape::Spline { x, y, .. } => [along(x), across(y, region)],
                    _ => [COORDINATE; 2],
                };
                let shares = by_x * x + by_y * y;
                largest * (NET + FACTORS) + shares
            }
        }
    };
    UNIT * numbers.iter().map(of).sum::<f64>()
}

/// Horner's rule: number i takes part in 2 i + 1 operations, and its power of the coordinate has i
/// times the error of it.
fn powers(sizes: &[f64], columns: usize, coordinate: f64) -> f64 {
    let share = |(index, size): (usize, &f64)| {
        let degree = (index % columns + index / columns) as f64;
        size * (degree * (coordinate + 2.0) + 2.0 + FACTORS)
    };
    sizes.iter().enumerate().map(share).sum()
}

/// Roundings of a coordinate along n·v.
fn along(x: Along) -> f64 {
    if x == Along::Log { LOGARITHM } else { COORDINATE }
}

/// A difference from the smoothest end, and its scale.
fn across(y: Across, region: &Region) -> f64 {
    let [low, high] = region.roughness.map(|end| y.of::<f64>(end));
    COORDINATE * high / (high - low)
}
