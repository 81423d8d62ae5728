//! Candidates: what can be stored for a lookup, before it has numbers.

use super::chebyshev::Chebyshev;
use super::fit::Fit;
use super::samples::Sample;
use super::truth::{Albedo, Truth};
use crate::approximation::shape::{Net, span};
use crate::approximation::{
    Across, Along, Approximation, Channels, Numbers, Region, Sampler, Shape, Storage, Texels,
};
use crate::brdf::Microfacet;
use crate::error::Result;
use crate::table::axis::Parameter;

/// A candidate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// The channels.
    pub channels: Channels,
    /// The shape.
    pub shape: Shape,
    /// The numbers in each channel.
    pub counts: [usize; 2],
    /// Their storage.
    pub storage: Storage,
}

/// k of [`Along::Layer`]: of 1 to 8, 3 and 4 are the best over the regions that were tried.
const LAYERS: [f64; 2] = [3.0, 4.0];

/// Coordinates of a polynomial in n·v.
const ALONG: [Along; 5] = [Along::Nov, Along::Sqrt, Along::Cbrt, Along::Log, Along::Layer(3.0)];

/// Control points along n·v, from the fewest to the most.
const COLUMNS: std::ops::RangeInclusive<usize> = 3..=28;

/// Rows of a spline: from one fewer than columns to half as many more.
fn rows(columns: usize) -> std::ops::RangeInclusive<usize> {
    columns - 1..=columns + columns.div_ceil(2)
}

/// Powers of the coordinates of a surface.
const POWERS: [std::ops::RangeInclusive<usize>; 2] = [3..=8, 2..=8];

impl Candidate {
    /// The approximation with the numbers of a fit.
    pub fn with(&self, fit: &Fit, lobe: Microfacet, region: Region) -> Approximation {
        let store = |numbers: &Vec<f64>| match self.shape {
            Shape::Spline { .. } => self.storage.store(numbers),
            Shape::Texture { .. } => self.storage.store_texels(numbers),
            shape => {
                let count = self.counts[0].max(self.counts[1]);
                let basis = Chebyshev::of(&shape, &region, count);
                self.storage.store(&basis.in_powers(numbers))
            }
        };
        let numbers = fit.numbers.iter().map(store).collect();
        Approximation { lobe, region, channels: self.channels, shape: self.shape, numbers }
    }

    /// The texture whose texels are integrals; none of other shapes.
    pub fn exact(&self, truth: &Truth, region: Region) -> Option<Approximation> {
        let Shape::Texture { texels: Texels::Exact, .. } = self.shape else { return None };
        let integrals = self.integrals(truth)?;
        Some(self.of_integrals(&integrals, truth.lobe(), region))
    }

    /// The texture with these integrals of each channel.
    pub fn of_integrals(
        &self,
        integrals: &[Vec<f64>],
        lobe: Microfacet,
        region: Region,
    ) -> Approximation {
        let numbers = integrals.iter().map(|texels| self.storage.store_texels(texels)).collect();
        let Candidate { channels, shape, .. } = *self;
        Approximation { lobe, region, channels, shape, numbers }
    }

    /// The integrals at the texels of a texture, for each channel; none of other shapes.
    pub fn integrals(&self, truth: &Truth) -> Option<Vec<Vec<f64>>> {
        let Shape::Texture { x, y, .. } = self.shape else { return None };
        let novs = x.values();
        let row = |&value: &f64| {
            let is_alpha = y.spec().parameter == Parameter::Alpha;
            (if is_alpha { value.sqrt() } else { value }, novs.clone())
        };
        let rows: Vec<(f64, Vec<f64>)> = y.values().iter().map(row).collect();
        let integrals = truth.rows(&rows);
        let numbers = |channel: usize| {
            let of = |albedo: &Albedo| match self.channels {
                Channels::BiasEnergy => [albedo.b, albedo.e][channel],
                _ => albedo.scale_bias()[channel],
            };
            integrals.iter().map(of).collect()
        };
        Some((0..self.channels.count()).map(numbers).collect())
    }

    /// Puts integrals into the texels of a fit that no sample sees: a sampler reads a little of
    /// them at the edges of a region.
    pub fn fill(&self, fit: &mut Fit, truth: &Truth, region: &Region, samples: &[Sample]) {
        let Some(Net { size: [columns, rows], degree }) = self.shape.net() else { return };
        let Some(integrals) = self.integrals(truth) else { return };
        let mut seen = vec![false; columns * rows];
        for sample in samples {
            let [x, y] = self.shape.coordinates(region, sample.nov, sample.roughness);
            let (along, across) = (span(degree, columns, x), span(degree, rows, y));
            for tap in 0..4 {
                let weight = along.weights[tap % 2] * across.weights[tap / 2];
                let texel = (across.first + tap / 2) * columns + along.first + tap % 2;
                seen[texel] |= weight > SEEN;
            }
        }
        for (numbers, integrals) in fit.numbers.iter_mut().zip(&integrals) {
            let unseen = numbers.iter_mut().zip(integrals).zip(&seen).filter(|(_, seen)| !**seen);
            unseen.for_each(|((number, integral), _)| *number = *integral);
        }
    }

    /// The candidate that an approximation was.
    pub fn of(approximation: &Approximation) -> Self {
        let Approximation { channels, shape, numbers, .. } = approximation;
        let count = |channel: usize| numbers.get(channel).map_or(0, Numbers::len);
        let storage = numbers.first().map_or(Storage::F32, Numbers::storage);
        Candidate { channels: *channels, shape: *shape, counts: [count(0), count(1)], storage }
    }

    /// Polynomials in n·v with these numbers in each channel, for one roughness, in each storage.
    pub fn polynomials(channels: Channels, x: Along, counts: [usize; 2]) -> [Self; 2] {
        let shape = Shape::Polynomial { x };
        [Storage::F16, Storage::F32].map(|storage| Candidate { channels, shape, counts, storage })
    }
}

/// A weight above which a sample sees a texel: those with less are nearly free.
const SEEN: f64 = 0.02;

/// Texels along either side of a texture.
const SIDES: [usize; 11] = [8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256];

/// Most texels that are fitted: the time of a fit grows as the number of texels times the square of
/// the shorter side.
const MOST_FITTED: usize = 48 * 64;

/// Every texture that a sampler could read.
pub fn textures(sampler: &Sampler) -> Result<Vec<Candidate>> {
    let Sampler { channels, axes, storage } = *sampler;
    let mut storages = vec![Storage::Unorm8, Storage::F16, Storage::Unorm16];
    storages.retain(|own| storage.is_none_or(|wish| wish == *own));
    let mut candidates = Vec::new();
    for [columns, rows] in SIDES.iter().flat_map(|&x| SIDES.map(|y| [x, y])) {
        let count = columns * rows;
        let is_fitted = count <= MOST_FITTED;
        let all = [Some(Texels::Exact), is_fitted.then_some(Texels::Fitted)];
        for texels in all.into_iter().flatten() {
            let shape = Shape::texture(axes, [columns, rows], texels)?;
            let counts = [count, count];
            let of = |&storage: &Storage| Candidate { channels, shape, counts, storage };
            candidates.extend(storages.iter().map(of));
        }
    }
    Ok(candidates)
}

/// The coordinates that a polynomial in n·v may have in a region.
pub fn along(region: &Region) -> Vec<Along> {
    let is_possible = |x: &Along| match x {
        // A mirror has no layer.
        Along::Layer(_) => region.roughness[0] > 0.0,
        // At n·v = 0 its derivatives have no bound.
        Along::Log => region.least_nov > 0.0,
        Along::Nov | Along::Sqrt | Along::Cbrt => true,
    };
    ALONG.into_iter().filter(is_possible).collect()
}

/// The channels for a range of F0.
pub fn channels(f0: [f64; 2]) -> [Channels; 2] {
    match f0[0] == f0[1] {
        true => [Channels::Ratio, Channels::Albedo],
        false => [Channels::EnergyRest, Channels::BiasEnergy],
    }
}

/// Every candidate over a range of roughness.
pub fn over_roughness(f0: [f64; 2]) -> Vec<Candidate> {
    let channels = channels(f0)[0];
    let mut candidates = Vec::new();
    let add = |candidates: &mut Vec<Candidate>, shape, count, storages: &[Storage]| {
        candidates.extend(storages.iter().map(|&storage| {
            let counts = [count, if channels.count() == 2 { count } else { 0 }];
            Candidate { channels, shape, counts, storage }
        }));
    };
    let across = [Across::Sqrt, Across::Linear];
    for degree in [3, 2, 1] {
        for columns in COLUMNS.filter(|columns| *columns > degree) {
            for rows in rows(columns).filter(|rows| *rows > degree) {
                for x in LAYERS.map(Along::Layer) {
                    for y in across {
                        let shape = Shape::Spline { x, y, size: [columns, rows], degree };
                        let storages = [Storage::Unorm8, Storage::Unorm16];
                        add(&mut candidates, shape, columns * rows, &storages);
                    }
                }
            }
        }
    }
    for columns in POWERS[0].clone() {
        for rows in POWERS[1].clone().filter(|rows| *rows <= columns + 1) {
            for x in [Along::Sqrt, Along::Layer(3.0)] {
                for y in across {
                    let shape = Shape::Surface { x, y, columns };
                    add(&mut candidates, shape, columns * rows, &[Storage::F32]);
                }
            }
        }
    }
    candidates
}
