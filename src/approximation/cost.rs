//! What a lookup costs, by a model: operations on floats and reads of numbers, counted from the
//! code that [`super::code`] writes. A device runs some of them at once, and others twice.

use super::place::{Across, Along};
use super::{Channels, Region, Shape, Storage};
use crate::table::axis::{Axis, Mapping, Parameter};

/// A division or a root, where a sum, a product, a comparison or a conversion is 1.
const ROOT: usize = 4;

/// A power or a cube root.
const POWER: usize = 12;

/// A logarithm: half of a power.
const LOG: usize = 6;

/// A value kept between two numbers.
const CLAMP: usize = 2;

/// (1 - n·v)⁵
const GRAZING: usize = 4;

/// A product and a sum.
const STEP: usize = 2;

/// What is looked up, but for the numbers themselves.
#[derive(Clone, Copy, Debug)]
pub struct Lookup<'a> {
    /// Where.
    pub region: &'a Region,
    /// The channels.
    pub channels: Channels,
    /// The shape.
    pub shape: Shape,
    /// The numbers in each channel.
    pub counts: [usize; 2],
    /// Their storage.
    pub storage: Storage,
}

impl Lookup<'_> {
    /// Operations on floats of a lookup of the channels and of E(F0): a sum, a product, a minimum,
    /// a maximum or a conversion is 1, a division or a root 4, a logarithm 6, a power 12. The
    /// numbers of polynomials count as constants, whose codes a compiler decodes. A model, no
    /// measurement.
    pub fn operations(&self) -> usize {
        let channels = self.channels.count();
        let steps: usize =
            self.counts.iter().take(channels).map(|count| STEP * count.saturating_sub(1)).sum();
        let sums = match self.shape {
            Shape::Polynomial { x } => CLAMP + along(x, true) + STEP + steps,
            Shape::Surface { x, y, .. } => 2 * CLAMP + along(x, false) + power(y) + steps,
            // The place on each axis; the sampler does the rest.
            Shape::Texture { x, y, .. } => [x, y].iter().map(texel).sum(),
            Shape::Spline { x, y, size, degree } => {
                let least = if self.region.least_nov > 0.0 { 2 } else { 0 };
                let smoothest = y.of::<f64>(self.region.roughness[0]);
                // The shift to the region's end, and the scale.
                let across = power(y) + if smoothest == 0.0 { 1 } else { 3 };
                let places = 2 * CLAMP + least + along(x, false) + 1 + across;
                let axes: usize = size.map(|count| span(degree, count)).iter().sum();
                // Products and sums of each row, and of the rows.
                let taps = (degree + 2) * (2 * degree + 1);
                let coded = self.storage.last().map_or(0, |_| self.loads() + STEP);
                places + axes + channels * (taps + coded)
            }
        };
        let albedo = match self.channels {
            Channels::Albedo => 0,
            Channels::ScaleBias => STEP,
            Channels::BiasEnergy => 1 + 1 + STEP,
            // F has a complement, a product and a sum.
            Channels::Ratio => CLAMP + GRAZING + 3 + 1,
            Channels::EnergyRest => CLAMP + GRAZING + 3 + 1 + STEP,
        };
        sums + albedo
    }

    /// Numbers that a lookup reads where the place says, all channels of one counted once: none
    /// where all of them count at every place.
    pub fn loads(&self) -> usize {
        match self.shape {
            Shape::Polynomial { .. } | Shape::Surface { .. } => 0,
            // A sampler reads four texels at once.
            Shape::Texture { .. } => 1,
            Shape::Spline { degree, .. } => (degree + 1) * (degree + 1),
        }
    }
}

/// The place of a texel: the root of some mappings, a complement, and a product and a sum.
fn texel(axis: &Axis) -> usize {
    let root = match axis.spec().mapping {
        // Those of an index of refraction are no axis of an approximation.
        Mapping::Linear | Mapping::SqrtF0 | Mapping::Piecewise => 0,
        Mapping::Sqrt => ROOT,
        Mapping::Square => 1,
        Mapping::SqrtComplement => 1 + ROOT,
    };
    let alpha = if axis.spec().parameter == Parameter::Alpha { 1 } else { 0 };
    CLAMP + alpha + root + STEP
}

/// The coordinate along n·v; where the roughness is constant, so is what follows from it.
fn along(x: Along, constant: bool) -> usize {
    match x {
        Along::Nov => 0,
        Along::Sqrt => ROOT,
        Along::Cbrt => POWER,
        // A maximum, a quotient, a sum, a logarithm and two products.
        Along::Log => 1 + ROOT + 1 + LOG + 2,
        Along::Layer(_) if constant => 2 + 2 * ROOT,
        Along::Layer(_) => 2 + 2 + 2 + 2 * ROOT,
    }
}

/// The power of the roughness.
fn power(y: Across) -> usize {
    match y {
        Across::Linear => 0,
        Across::Sqrt => ROOT,
        Across::Power(_) => POWER,
    }
}

/// The span of a place, and the weights of its control points.
fn span(degree: usize, count: usize) -> usize {
    // A conversion to a whole number and back, a minimum, a difference.
    let fraction = if count - degree > 1 { 4 } else { 0 };
    let weights = match degree {
        1 => 1,
        2 => 1 + 2 + 2 + 2,
        _ => 1 + 3 + 3 + 5 + 3,
    };
    fraction + weights
}
