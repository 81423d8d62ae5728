//! What can be baked: each family of tables with its integrand, its channels and its citation.

pub mod dfg;

pub use dfg::{Dfg, DfgChannels};

use crate::axis::{Axis, Parameter};
use crate::error::{Error, Result};
use crate::integrate::ScaleBias;
use crate::model::Ndf;
use crate::model::blinn_phong::alpha_of_exponent;
use crate::table::{Channel, Provenance, Table};
use crate::units::{Alpha, PerceptualRoughness, word};

/// A family of tables with its choices made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lut {
    /// The split sum's scale and bias.
    Dfg(Dfg),
}

impl Lut {
    /// The name of the family.
    pub fn name(&self) -> &'static str {
        match self {
            Lut::Dfg(_) => "dfg",
        }
    }

    /// The channels of a texel.
    pub fn channels(&self) -> Vec<Channel> {
        match self {
            Lut::Dfg(dfg) => dfg.channels.list().to_vec(),
        }
    }

    /// What the metadata says of it, apart from how it was computed.
    pub fn provenance(&self) -> Provenance {
        let Lut::Dfg(dfg) = self;
        Provenance {
            table: self.name(),
            equation: "E(F0) = F0*A + B = integral of f(l,v) n.l over directions l, f = F D G / (4 n.l n.v)",
            model: word(dfg.lobe.ndf),
            masking: word(dfg.lobe.masking),
            fresnel: "Schlick: F = F0 + (1 - F0) (1 - v.h)^5",
            roughness: if dfg.lobe.ndf == Ndf::BlinnPhong {
                "alpha = roughness^2, exponent n = 2/alpha^2 - 2"
            } else {
                "alpha = roughness^2"
            },
            ..Provenance::default()
        }
    }

    /// Appends the values of the channels of a texel.
    pub fn push_values(&self, integral: ScaleBias, values: &mut Vec<f64>) {
        match self {
            Lut::Dfg(dfg) => dfg.channels.push_values(integral, values),
        }
    }
}

/// The parameters of a table's texels, apart from how the table lays them out: every pair of an α and an n·v.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// n·v, varying fastest.
    pub mus: Vec<f64>,
    /// α.
    pub alphas: Vec<f64>,
    /// Whether n·v runs along the table's y axis.
    transposed: bool,
}

impl Grid {
    /// The grid of two axes, of which one has to be n·v and the other a roughness.
    pub fn new(x: &Axis, y: &Axis) -> Result<Self> {
        match (x.spec.parameter, y.spec.parameter) {
            (Parameter::Nov, Parameter::Roughness | Parameter::Alpha | Parameter::Exponent) => {
                Ok(Grid { mus: x.values(), alphas: alphas(y)?, transposed: false })
            }
            (Parameter::Roughness | Parameter::Alpha | Parameter::Exponent, Parameter::Nov) => {
                Ok(Grid { mus: y.values(), alphas: alphas(x)?, transposed: true })
            }
            (a, b) => Err(Error::bad_input(
                "axes",
                "nov along one and roughness, alpha or exponent along the other",
                format!("x = {a}, y = {b}"),
                "name one of each",
            )),
        }
    }

    /// The number of texels.
    pub fn len(&self) -> usize {
        self.mus.len() * self.alphas.len()
    }

    /// Whether there is none; never so for a grid made of axes.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// (n·v, α) of point `index`.
    pub fn point(&self, index: usize) -> (f64, f64) {
        (self.mus[index % self.mus.len()], self.alphas[index / self.mus.len()])
    }

    /// The table whose texels are `integrals`, given in the order of the grid.
    pub fn table(&self, lut: &Lut, (x, y): (Axis, Axis), integrals: &[ScaleBias], provenance: Provenance) -> Table {
        let channels = lut.channels();
        let mut values = Vec::with_capacity(channels.len() * self.len());
        for j in 0..y.size {
            for i in 0..x.size {
                let index = if self.transposed { i * self.mus.len() + j } else { j * self.mus.len() + i };
                lut.push_values(integrals[index], &mut values);
            }
        }
        Table { x, y, channels, values, provenance }
    }
}

fn alphas(axis: &Axis) -> Result<Vec<f64>> {
    let alpha = |p| match axis.spec.parameter {
        Parameter::Roughness => PerceptualRoughness::new(p).map(|r| Alpha::from(r).get()),
        Parameter::Exponent => Ok(alpha_of_exponent(libm::exp10(7.0 * p))),
        _ => Ok(p),
    };
    axis.values().into_iter().map(alpha).collect()
}
