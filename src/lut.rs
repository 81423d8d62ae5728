//! What can be baked: each family of tables with its integrand, its channels and its citation.

pub mod dfg;
pub mod diffuse;
pub mod energy;
pub mod sheet;

pub use dfg::{Dfg, DfgChannels};
pub use energy::{Energy, EnergyChannels};

use crate::axis::{Axis, Parameter};
use crate::ball::Ball;
use crate::error::{Error, Result};
use crate::integrate::{Integrand, ScaleBias};
use crate::model::blinn_phong::alpha_of_exponent;
use crate::model::{Diffuse, Microfacet, Ndf};
use crate::precision::Precision;
use crate::stored::Stored;
use crate::table::{Channel, Provenance};
use crate::units::{Alpha, PerceptualRoughness, word};
use sheet::Sheet;

/// A family of tables with its choices made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lut {
    /// The split sum's scale and bias.
    Dfg(Dfg),
    /// What a specular lobe leaves and loses.
    Energy(Energy),
    /// The albedo of a diffuse lobe.
    Diffuse(Diffuse),
}

impl Lut {
    /// The name of the family.
    pub fn name(&self) -> &'static str {
        match self {
            Lut::Dfg(_) => "dfg",
            Lut::Energy(_) => "energy",
            Lut::Diffuse(_) => "diffuse",
        }
    }

    /// What is integrated.
    pub fn integrand(&self) -> Integrand {
        match self {
            Lut::Dfg(dfg) => dfg.lobe.into(),
            Lut::Energy(energy) => energy.lobe.into(),
            Lut::Diffuse(diffuse) => Integrand::Diffuse(*diffuse),
        }
    }

    /// The F0 that the table is for, where it is for one.
    pub fn f0(&self) -> Option<f64> {
        match self {
            Lut::Energy(energy) => Some(energy.f0.get()),
            _ => None,
        }
    }

    /// Whether a texel needs the average over all directions too.
    pub fn needs_averages(&self) -> bool {
        matches!(self, Lut::Energy(_))
    }

    /// The channels of a texel.
    pub fn channels(&self) -> &'static [Channel] {
        match self {
            Lut::Dfg(dfg) => dfg.channels.list(),
            Lut::Energy(energy) => energy.channels.list(),
            Lut::Diffuse(_) => &[diffuse::ALBEDO],
        }
    }

    /// The choices of the family as flags.
    pub fn flags(&self) -> String {
        let lobe = |Microfacet { ndf, masking }| format!("--model {} --masking {}", word(ndf), word(masking));
        match self {
            Lut::Dfg(dfg) => format!("{} --channels {}", lobe(dfg.lobe), word(dfg.channels)),
            Lut::Energy(energy) => {
                format!("{} --channels {} --f0 {}", lobe(energy.lobe), word(energy.channels), energy.f0.get())
            }
            Lut::Diffuse(diffuse) => format!("--model {}", word(diffuse)),
        }
    }

    /// What the metadata says of it, apart from how it was computed.
    pub fn provenance(&self) -> Provenance {
        let specular = |Microfacet { ndf, masking }| Provenance {
            table: self.name(),
            equation: "E(F0) = F0*A + B = integral of f(l,v) n.l over directions l, f = F D G / (4 n.l n.v)",
            model: word(ndf),
            masking: Some(word(masking)),
            fresnel: Some("Schlick: F = F0 + (1 - F0) (1 - v.h)^5"),
            roughness: match ndf {
                Ndf::BlinnPhong => "alpha = roughness^2, exponent n = 2/alpha^2 - 2",
                _ => "alpha = roughness^2",
            },
            ..Provenance::default()
        };
        match self {
            Lut::Dfg(dfg) => specular(dfg.lobe),
            Lut::Energy(energy) => Provenance { f0: self.f0(), ..specular(energy.lobe) },
            Lut::Diffuse(model) => Provenance {
                table: self.name(),
                equation: diffuse::source(*model),
                model: word(model),
                roughness: diffuse::roughness(*model),
                ..Provenance::default()
            },
        }
    }

    /// The values of the channels of a texel at n·v = `mu`, the first as many as there are channels, from its
    /// integral and its row's average: each with what it may be off, by the errors of both and by the formula's own
    /// arithmetic.
    pub fn values(&self, mu: f64, integral: ScaleBias<Ball>, average: ScaleBias<Ball>) -> [Ball; 3] {
        match self {
            Lut::Dfg(dfg) => dfg.channels.values(integral),
            Lut::Energy(energy) => energy.values(mu, integral, average),
            Lut::Diffuse(_) => [integral.a, Ball::default(), Ball::default()],
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

    /// Every pair of these n·v and these α.
    pub fn of(mus: Vec<f64>, alphas: Vec<f64>) -> Self {
        Grid { mus, alphas, transposed: false }
    }

    /// The number of texels.
    pub fn len(&self) -> usize {
        self.mus.len() * self.alphas.len()
    }

    /// Whether there is none; never so for a grid made of axes.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Other directions for the same α.
    pub fn at_directions(&self, mus: Vec<f64>) -> Grid {
        Grid { mus, ..self.clone() }
    }

    /// (n·v, α) of point `index`.
    pub fn point(&self, index: usize) -> (f64, f64) {
        (self.mus[index % self.mus.len()], self.alphas[index / self.mus.len()])
    }

    /// The α from row `first` on, so many at the most.
    pub fn band(&self, first: usize, rows: usize) -> Grid {
        let alphas = self.alphas.iter().skip(first).take(rows).copied().collect();
        Grid { mus: self.mus.clone(), alphas, transposed: self.transposed }
    }

    /// These values, as many for each point as there are channels and in the order of the points, as a table stores
    /// them.
    pub fn stored(&self, lut: &Lut, precision: Precision, values: &[f64]) -> Result<Stored> {
        let mut sheet = Sheet::new(lut, self, precision)?;
        sheet.put(0, &values.iter().map(|&value| precision.stored(value)).collect::<Vec<_>>());
        sheet.finish()
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
