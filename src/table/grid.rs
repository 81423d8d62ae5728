//! The parameters of a table's texels, apart from the order in which the table stores them: every
//! pair of an α and an n·v.

use super::axis::{Axis, Parameter};
use crate::error::{Error, Result};
use crate::units::{Alpha, PerceptualRoughness, alpha_of_exponent};

/// Every pair of these α and n·v.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// n·v, varying fastest.
    pub mus: Vec<f64>,
    /// α.
    pub alphas: Vec<f64>,
    /// Whether n·v runs along the table's y axis.
    pub(crate) transposed: bool,
}

impl Grid {
    /// The grid of two axes, of which one has to be n·v and the other a roughness.
    pub fn new(x: &Axis, y: &Axis) -> Result<Self> {
        Grid::about(x, y, None)
    }

    /// The same for glass with this cosine of the critical angle, about which n·v may be centred.
    pub fn about(x: &Axis, y: &Axis, critical: Option<f64>) -> Result<Self> {
        match (cosines(x, critical), cosines(y, critical), alphas(x), alphas(y)) {
            (Some(mus), _, _, Some(alphas)) => {
                Ok(Grid { mus: mus?, alphas: alphas?, transposed: false })
            }
            (_, Some(mus), Some(alphas), _) => {
                Ok(Grid { mus: mus?, alphas: alphas?, transposed: true })
            }
            _ => Err(Error::bad_input(
                "axes",
                "nov along one and roughness, alpha or exponent along the other",
                format!("x = {}, y = {}", x.spec().parameter, y.spec().parameter),
                "name one of each",
            )),
        }
    }

    /// Every pair of these n·v and these α.
    pub fn of(mus: Vec<f64>, alphas: Vec<f64>) -> Self {
        Grid { mus, alphas, transposed: false }
    }

    /// The number of points.
    pub fn len(&self) -> usize {
        self.mus.len() * self.alphas.len()
    }

    /// Whether it has no point.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The same α with other directions.
    pub fn at_directions(&self, mus: Vec<f64>) -> Grid {
        Grid { mus, ..self.clone() }
    }

    /// The smallest n·v.
    pub fn least_mu(&self) -> f64 {
        self.mus.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// (n·v, α) of point `index`.
    pub fn point(&self, index: usize) -> (f64, f64) {
        (self.mus[index % self.mus.len()], self.alphas[index / self.mus.len()])
    }

    /// At most `rows` α from row `first` on.
    pub fn band(&self, first: usize, rows: usize) -> Grid {
        let alphas = self.alphas.iter().skip(first).take(rows).copied().collect();
        Grid { mus: self.mus.clone(), alphas, transposed: self.transposed }
    }
}

/// n·v at every texel of an axis of it; none of another axis.
fn cosines(axis: &Axis, critical: Option<f64>) -> Option<Result<Vec<f64>>> {
    match (axis.spec().parameter, critical) {
        (Parameter::Nov, _) => Some(Ok(axis.values())),
        (Parameter::Critical, Some(c)) => {
            let cosine = |p: f64| {
                let off = 2.0 * p - 1.0;
                let mu = c + off * if off < 0.0 { c } else { 1.0 - c };
                mu.clamp(0.0, 1.0)
            };
            Some(Ok(axis.values().into_iter().map(cosine).collect()))
        }
        (Parameter::Critical, None) => {
            let (expected, cure) =
                ("glass seen from inside beside it", "add --lut glass --side inside");
            Some(Err(Error::bad_input("axis critical", expected, "none", cure)))
        }
        _ => None,
    }
}

/// α at every texel of an axis of roughness; none of another axis.
fn alphas(axis: &Axis) -> Option<Result<Vec<f64>>> {
    let alpha: fn(f64) -> Result<f64> = match axis.spec().parameter {
        Parameter::Roughness => |p| PerceptualRoughness::of_texel(p).map(|r| Alpha::from(r).get()),
        Parameter::Exponent => |p| Ok(alpha_of_exponent(libm::exp10(7.0 * p))),
        Parameter::Alpha => Ok,
        Parameter::Nov
        | Parameter::Critical
        | Parameter::F0
        | Parameter::Ior
        | Parameter::Control => return None,
    };
    Some(axis.values().into_iter().map(alpha).collect())
}
