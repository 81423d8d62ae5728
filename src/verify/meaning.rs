//! What each channel of a texel is.

use super::sample::Quantity;
use super::truth::{Truth, Values};
use crate::integrate::Integrand;
use crate::lut::packing::{Content, Source};
use crate::lut::{Lut, Packing};
use crate::units::{roughness_of, short};

/// The meaning of a channel.
#[derive(Clone, Debug, PartialEq)]
pub enum Meaning {
    /// scale times a number of ours plus offset.
    Number {
        /// The table of ours.
        truth: Truth,
        /// The number.
        quantity: Quantity,
        /// Its factor.
        scale: f64,
        /// What is added.
        offset: f64,
    },
    /// n·v of the texel.
    Nov,
    /// Roughness of the texel.
    Roughness,
    /// The same number everywhere.
    Constant(f64),
    /// The channel with this number once more.
    Copy(usize),
    /// None that is known.
    Unknown,
}

impl Meaning {
    /// A number as it is.
    pub fn plain(truth: Truth, quantity: Quantity) -> Self {
        Meaning::Number { truth, quantity, scale: 1.0, offset: 0.0 }
    }

    /// The meanings of the channels of a packing, with what fills up a texel of so many components.
    pub fn of_packing(packing: &Packing, tolerance: f64, components: usize) -> Vec<Meaning> {
        let of = |component: usize| match packing.contents().get(component) {
            Some(&Content { source, scale, offset }) => match source {
                Source::Of { part, channel } => {
                    let truth = Truth { lut: packing.luts()[part], tolerance };
                    let quantity = Quantity::Channel(channel);
                    Meaning::Number { truth, quantity, scale, offset }
                }
                Source::Nov => Meaning::Nov,
                Source::Roughness => Meaning::Roughness,
                Source::Constant => Meaning::Constant(offset),
            },
            None => Meaning::Constant(if component == 3 { 1.0 } else { 0.0 }),
        };
        (0..components).map(of).collect()
    }

    /// The values at every pair of these n·v and α, n·v varying fastest; none of what is unknown or
    /// another channel's.
    pub fn on_grid(&self, mus: &[f64], alphas: &[f64]) -> Option<Vec<f64>> {
        let row = |&alpha: &f64| mus.iter().map(move |&mu| (mu, alpha));
        let points: Vec<(f64, f64)> = alphas.iter().flat_map(row).collect();
        self.values(&points, |truth| truth.on_grid(mus, alphas))
    }

    /// The values at these (n·v, α).
    pub fn at(&self, points: &[(f64, f64)]) -> Option<Vec<f64>> {
        self.values(points, |truth| truth.at(points))
    }

    fn values(
        &self,
        points: &[(f64, f64)],
        numbers: impl FnOnce(Truth) -> Vec<Values>,
    ) -> Option<Vec<f64>> {
        Some(match *self {
            Meaning::Number { truth, quantity, scale, offset } => {
                let of = |values| scale * quantity.value(values) + offset;
                numbers(truth).iter().map(of).collect()
            }
            Meaning::Nov => points.iter().map(|&(mu, _)| mu).collect(),
            Meaning::Roughness => points.iter().map(|&(_, alpha)| roughness_of(alpha)).collect(),
            Meaning::Constant(value) => vec![value; points.len()],
            Meaning::Copy(_) | Meaning::Unknown => return None,
        })
    }

    /// The same integrals within another error.
    pub fn within(self, tolerance: f64) -> Self {
        match self {
            Meaning::Number { truth, quantity, scale, offset } => {
                let truth = Truth { tolerance, ..truth };
                Meaning::Number { truth, quantity, scale, offset }
            }
            other => other,
        }
    }

    /// Whether it is a number that varies and is known.
    pub fn varies(&self) -> bool {
        matches!(self, Meaning::Number { .. } | Meaning::Nov | Meaning::Roughness)
    }

    /// Whether it is of a table that needs averages over all directions.
    pub fn needs_averages(&self) -> bool {
        matches!(self, Meaning::Number { truth, .. } if truth.lut.needs_averages())
    }

    /// Whether it is an albedo that nothing may lift above 1.
    pub fn is_at_most_one(&self) -> bool {
        match self {
            Meaning::Number { truth, scale, offset, .. } => {
                truth.lut.at_most_one() && *scale == 1.0 && *offset == 0.0
            }
            _ => false,
        }
    }

    /// It as a term of `--channels`, for a table of this lobe; none where there is no such term.
    pub fn term(&self, own: Integrand) -> Option<String> {
        match self {
            Meaning::Number { truth, quantity, scale, offset } => {
                let word = match (&truth.lut, quantity) {
                    (Lut::Diffuse(diffuse), _) => diffuse.to_string(),
                    // Their words are those of channels, and no terms of a list.
                    (lut @ (Lut::Glass(_) | Lut::Energy(_)), _) => {
                        super::decision::word(lut, *quantity)
                    }
                    (lut, Quantity::Complement(_)) if lobe(lut.integrand()) == lobe(own) => {
                        return Some("1-e".into());
                    }
                    (lut, Quantity::Channel(channel)) if lobe(lut.integrand()) == lobe(own) => {
                        lut.channels().get(*channel)?.name.to_lowercase()
                    }
                    // Another lobe has a word for its E alone, which is the last.
                    (lut, Quantity::Channel(channel)) if channel + 1 < lut.channels().len() => {
                        return None;
                    }
                    (lut, _) => match lut.integrand() {
                        Integrand::Specular(lobe, _)
                            if lobe.masking == lobe.ndf.default_masking() =>
                        {
                            lobe.ndf.to_string()
                        }
                        Integrand::Specular(lobe, _) => format!("{}/{}", lobe.ndf, lobe.masking),
                        Integrand::Glass(_) | Integrand::Diffuse(_) => return None,
                    },
                };
                Some(scaled(&word, *scale, *offset))
            }
            Meaning::Nov => Some("nov".into()),
            Meaning::Roughness => Some("roughness".into()),
            Meaning::Constant(value) => Some(short(*value)),
            Meaning::Copy(_) | Meaning::Unknown => None,
        }
    }
}

/// The lobe of a split sum, whatever its Fresnel model.
fn lobe(integrand: Integrand) -> Option<crate::brdf::Microfacet> {
    match integrand {
        Integrand::Specular(lobe, _) => Some(lobe),
        Integrand::Glass(_) | Integrand::Diffuse(_) => None,
    }
}

/// A term with its scale and its offset.
fn scaled(word: &str, scale: f64, offset: f64) -> String {
    let factor = if scale == 1.0 { String::new() } else { format!("*{}", short(scale)) };
    let sign = if offset > 0.0 { "+" } else { "" };
    let shift = if offset == 0.0 { String::new() } else { format!("{sign}{}", short(offset)) };
    format!("{word}{factor}{shift}")
}
