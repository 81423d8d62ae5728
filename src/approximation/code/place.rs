//! Where (n·v, roughness) lies in the coordinates of a shape, as lines of code: see
//! [`crate::approximation::place`], which computes the same.

use super::dialect::Dialect;
use crate::approximation::place::TINY;
use crate::approximation::{Across, Along, Region};
use std::f64::consts::LOG2_E;

/// The lines of n, which is n·v counted from `least`, and of what else the coordinate needs; and
/// the coordinate as an expression. `roughness` is there where it is a constant.
pub fn along(
    dialect: &Dialect,
    x: Along,
    least: f64,
    roughness: Option<f64>,
) -> (Vec<String>, String) {
    let words = &dialect.syntax.words;
    let float = dialect.syntax.float;
    let n = match least {
        0.0 => dialect.clamped("nov", 0.0, 1.0),
        _ => {
            let from_least =
                (words.max)(&format!("nov - {}", dialect.number(least)), &dialect.number(0.0));
            let scaled = dialect.affine(&from_least, 1.0 / (1.0 - least), 0.0);
            (dialect.min)(&scaled, &dialect.number(1.0))
        }
    };
    if x == Along::Nov {
        return (Vec::new(), n);
    }
    let mut lines = vec![dialect.local(float, "n", &n)];
    let coordinate = match x {
        Along::Nov => "n".into(),
        Along::Sqrt => (words.sqrt)("n"),
        Along::Cbrt => (dialect.cbrt)("n", &dialect.number(1.0 / 3.0)),
        Along::Log => {
            let least = (words.max)("n", &dialect.number(TINY));
            let inverse = format!("{} + {} / {least}", dialect.number(1.0), dialect.number(1.0));
            format!("n * {} * {}", (dialect.log)(&inverse), dialect.number(LOG2_E))
        }
        Along::Layer(k) => {
            let width = roughness.map(|r| r * r * k);
            let (factor, sum) = match width {
                Some(width) => (dialect.number(1.0 + width), dialect.affine("n", 1.0, width)),
                None => {
                    let width = dialect.affine("r * r", k, 0.0);
                    lines.push(dialect.local(float, "width", &width));
                    (format!("(width + {})", dialect.number(1.0)), "n + width".into())
                }
            };
            let divisor = match width {
                Some(width) if width >= TINY => format!("({sum})"),
                _ => (words.max)(&sum, &dialect.number(TINY)),
            };
            (words.sqrt)(&format!("n * {factor} / {divisor}"))
        }
    };
    (lines, coordinate)
}

/// The line of r, the roughness clamped to the region.
pub fn roughness(dialect: &Dialect, region: &Region) -> String {
    let [low, high] = region.roughness;
    dialect.local(dialect.syntax.float, "r", &dialect.clamped("roughness", low, high))
}

/// The bare power of r.
pub fn power(dialect: &Dialect, y: Across) -> String {
    match y {
        Across::Linear => "r".into(),
        Across::Sqrt => (dialect.syntax.words.sqrt)("r"),
        Across::Power(p) => (dialect.power)("r", &dialect.number(p)),
    }
}

/// The coordinate across the region, from 0 to `spans`.
pub fn across(dialect: &Dialect, y: Across, region: &Region, spans: usize) -> String {
    let [low, high] = region.roughness.map(|end| y.of::<f64>(end));
    let bare = power(dialect, y);
    let shifted = match low {
        0.0 => bare,
        _ => {
            // A root or a power that a device rounds down may lie below the smoothest one.
            let difference = format!("{bare} - {}", dialect.number(low));
            (dialect.syntax.words.max)(&difference, &dialect.number(0.0))
        }
    };
    dialect.affine(&shifted, spans as f64 / (high - low), 0.0)
}
