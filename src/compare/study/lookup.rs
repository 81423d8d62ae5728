//! The error of bilinear lookup, as a renderer reads a table: by size, axes and
//! storage.

pub mod layer;

use super::worst::{FULL, PRACTICAL, Read, Search, parameter, rule, seen};
use super::{Share, stored};
use crate::backend::cpu;
use crate::brdf::Microfacet;
use crate::compare::point_set::PointSet;
use crate::error::Result;
use crate::integrate::ScaleBias;
use crate::preview::curve::Samples;
use crate::table::axis::{Axis, AxisSpec};
use crate::table::grid::Grid;
use crate::table::precision::Precision;
use crate::units::{Alpha, PerceptualRoughness};
use layer::Judge;
use serde::{Deserialize, Serialize};

/// Places of the mean error: spread evenly over n·v and perceptual roughness (the points of R2).
const POINTS: usize = 4096;

/// Seconds of one thread that the search of a table may take: those of costly lobes end with
/// smaller ones.
const PATIENCE: f64 = 8.0;

/// The axes of n·v and of roughness as words.
pub type Axes = (&'static str, &'static str);

/// The axes of most engines.
pub const CENTRES: Axes = ("nov", "roughness");

/// The axes that are compared.
pub const AXES: [Axes; 5] = [
    CENTRES,
    ("nov,edges", "roughness,edges"),
    ("nov", "alpha"),
    ("nov,sqrt", "roughness"),
    ("nov,sqrt,edges", "roughness,edges"),
];

/// The axes of that many texels each.
pub fn axes_of(axes: Axes, size: usize) -> Result<(Axis, Axis)> {
    let axis = |words: &str| Axis::new(words.parse::<AxisSpec>()?, size);
    Ok((axis(axes.0)?, axis(axes.1)?))
}

/// A table of a size, with axes and a storage, as it was found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reading {
    /// The axis along a row.
    pub x: String,
    /// The axis from row to row.
    pub y: String,
    /// Texels along either.
    pub size: usize,
    /// The storage of its values.
    pub precision: Precision,
    /// Bytes of the values: two channels.
    pub bytes: usize,
    /// The largest error of the albedo that a renderer computes ([`seen`]), over all n·v and
    /// roughnesses.
    pub everywhere: f64,
    /// The same over [`PRACTICAL`].
    pub practical: f64,
    /// The root of its mean square over places that are spread evenly.
    pub rms: f64,
}

/// The lookups of a lobe, and what is true at the places of their mean error.
pub struct Lookups {
    lobe: Microfacet,
    /// (n·v, perceptual roughness)
    places: Vec<(f64, f64)>,
    truth: Vec<ScaleBias>,
}

impl Lookups {
    /// Those of a lobe.
    pub fn new(lobe: Microfacet) -> Result<Self> {
        let places: Vec<(f64, f64)> =
            (0..POINTS).map(|i| PointSet::R2.coordinates(i, POINTS, 0)).collect();
        let grid =
            |&(mu, r): &(f64, f64)| PerceptualRoughness::new(r).map(|r| (mu, Alpha::from(r).get()));
        let points = places.iter().map(grid).collect::<Result<Vec<_>>>()?;
        let truth = cpu::bake_points(lobe, &points, &rule(lobe, POINTS)).scale_bias();
        Ok(Lookups { lobe, places, truth })
    }

    /// A table of exact values with these axes and `size` texels along each, in these storages;
    /// none where the search would take too long.
    pub fn of(&self, axes: Axes, size: usize, precisions: &[Precision]) -> Result<Vec<Reading>> {
        let (x, y) = axes_of(axes, size)?;
        let Some(search) = Search::new(self.lobe, &x, &y, PATIENCE)? else { return Ok(Vec::new()) };
        let grid = Grid::new(&x, &y)?;
        let exact = cpu::bake(self.lobe, &grid, &rule(self.lobe, grid.len()), &|_| ()).scale_bias();
        let reading = |&precision: &Precision| {
            let table = samples((x, y), &stored(&exact, precision));
            let read = |mu: f64, row: f64| table.bilinear(mu, row).into();
            Ok(Reading {
                x: axes.0.into(),
                y: axes.1.into(),
                size,
                precision,
                bytes: 2 * precision.bytes() * size * size,
                everywhere: search.largest(FULL, &read)?,
                practical: search.largest(PRACTICAL, &read)?,
                rms: self.rms(&y, &read)?,
            })
        };
        precisions.iter().map(reading).collect()
    }

    /// The root of the mean square error of what is read at n·v and the parameter of an axis.
    fn rms(&self, y: &Axis, read: Read) -> Result<f64> {
        let mut squares = 0.0;
        for (&(mu, roughness), &truth) in self.places.iter().zip(&self.truth) {
            let error = seen(read(mu, parameter(y, roughness)?), truth);
            squares += error * error;
        }
        Ok((squares / POINTS as f64).sqrt())
    }
}

/// The largest error over [`PRACTICAL`] of lookups in a table with these values; none where the
/// search would take too long.
pub fn practical(
    lobe: Microfacet,
    axes: Axes,
    size: usize,
    values: &[ScaleBias],
) -> Result<Option<f64>> {
    let (x, y) = axes_of(axes, size)?;
    let Some(search) = Search::new(lobe, &x, &y, PATIENCE)? else { return Ok(None) };
    let table = samples((x, y), values);
    search.largest(PRACTICAL, &|mu, row| table.bilinear(mu, row).into()).map(Some)
}

fn samples((x, y): (Axis, Axis), values: &[ScaleBias]) -> Samples<2> {
    Samples { x, y, values: values.iter().map(|value| value.array()).collect() }
}

/// Storages that are compared.
const STORAGES: [Precision; 4] =
    [Precision::F32, Precision::F16, Precision::Unorm16, Precision::Unorm8];

/// Every size up to `largest`, with all axes and storages.
pub fn measure(lobe: Microfacet, largest: usize, share: Share) -> Result<Vec<Reading>> {
    let lookups = Lookups::new(lobe)?;
    let sizes = || {
        std::iter::successors(Some(8), |size| Some(2 * size)).take_while(|&size| size <= largest)
    };
    let mut readings = Vec::new();
    for (done, axes) in AXES.into_iter().enumerate() {
        for size in sizes() {
            readings.extend(lookups.of(axes, size, &STORAGES)?);
        }
        share((done + 1) as f64 / (AXES.len() + 1) as f64);
    }
    if let Some(judge) = Judge::new(lobe)? {
        for size in sizes() {
            readings.extend(layer::tables(&judge, size, &STORAGES)?);
        }
    }
    share(1.0);
    Ok(readings)
}

/// The smallest table with these axes whose lookups are at most `error` off over [`PRACTICAL`].
pub fn smallest(readings: &[Reading], axes: Axes, error: f64) -> Option<&Reading> {
    let serves = |r: &&Reading| r.has(axes) && r.practical <= error;
    readings.iter().filter(serves).min_by_key(|reading| reading.bytes)
}

impl Reading {
    /// Whether the table has these axes.
    pub fn has(&self, axes: Axes) -> bool {
        (self.x.as_str(), self.y.as_str()) == axes
    }
}

/// What no lookup that is continuous in n·v and roughness gets below, whatever its size: as both go
/// to 0, E becomes a function of n·v/α alone, so that every neighbourhood of that corner holds all
/// of its values. Half of their range stays. None where albedos exceed 1, of which errors are
/// relative.
pub fn corner(lobe: Microfacet) -> Option<f64> {
    // So small that E no longer depends on it: what is left is of the order of α.
    const ALPHA: f64 = 1e-8;
    // From n·v/α = 1e-5 to 1e5, and the ends.
    let ratios = (-100..=100).map(|k| libm::exp10(f64::from(k) / 20.0));
    let points: Vec<(f64, f64)> =
        std::iter::once(0.0).chain(ratios).map(|ratio| (ratio * ALPHA, ALPHA)).collect();
    let albedos: Vec<f64> = cpu::bake_points(lobe, &points, &rule(lobe, points.len()))
        .iter()
        .map(|point| point[0] + point[1])
        .collect();
    let (least, most) =
        albedos.iter().fold((f64::INFINITY, 0.0f64), |(l, m), &e| (l.min(e), m.max(e)));
    (most <= 1.0 + 1e-5).then_some(0.5 * (most - least))
}

/// The measurements as lines of CSV.
pub fn to_csv(readings: &[Reading]) -> String {
    let mut csv = String::from("x,y,size,precision,bytes,max_everywhere,max_practical,rms\n");
    for Reading { x, y, size, precision, bytes, everywhere, practical, rms } in readings {
        let numbers = [everywhere, practical, rms].map(|number| format!("{number:.6e}")).join(",");
        csv += &format!("\"{x}\",\"{y}\",{size},{precision},{bytes},{numbers}\n");
    }
    csv
}
