//! What a renderer reads from a table: how far bilinear lookup is from the integral, by size, axes and storage.

use super::{Errors, Share, stored};
use crate::axis::{Axis, AxisSpec};
use crate::backend::cpu;
use crate::error::Result;
use crate::integrate::ScaleBias;
use crate::integrate::rule::{REFERENCE, Rule};
use crate::lut::{Dfg, DfgChannels, Grid, Lut};
use crate::model::Microfacet;
use crate::precision::Precision;
use crate::quadrature::point_set::PointSet;
use crate::table::Table;
use crate::units::word;
use serde::{Deserialize, Serialize};

/// Places at which a renderer looks: spread evenly over n·v and perceptual roughness (the points of R2).
pub const POINTS: usize = 4096;

/// Seconds of one thread that a table may take: those of dear lobes end with smaller ones.
const PATIENCE: f64 = 4.0;

/// The axes of n·v and of roughness as words.
pub type Axes = (&'static str, &'static str);

/// What most engines have.
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
    /// How values are stored.
    pub precision: Precision,
    /// Bytes of the values: two channels.
    pub bytes: usize,
    /// How far lookups are off.
    #[serde(flatten)]
    pub errors: Errors,
}

/// Places and what is true there.
pub struct Lookup {
    places: Vec<(f64, f64)>,
    truth: Vec<ScaleBias>,
}

impl Lookup {
    /// So many places.
    pub fn new(lobe: Microfacet, count: usize) -> Self {
        let places: Vec<(f64, f64)> = (0..count).map(|i| PointSet::R2.coordinates(i, count, 0)).collect();
        let points: Vec<(f64, f64)> = places.iter().map(|&(mu, r)| (mu, r * r)).collect();
        let truth = cpu::bake_points(lobe, &points, &REFERENCE);
        Lookup { places, truth }
    }

    /// How far a table with these values, n·v varying fastest, is off.
    pub fn of(&self, lobe: Microfacet, axes: Axes, size: usize, values: &[ScaleBias]) -> Result<Errors> {
        let (x, y) = axes_of(axes, size)?;
        let lut = Lut::Dfg(Dfg { lobe, channels: DfgChannels::Ab });
        let values: Vec<f64> = values.iter().flat_map(|v| [v.a, v.b]).collect();
        let values = Grid::new(&x, &y)?.stored(&lut, Precision::F64, &values)?;
        let table = Table { x, y, channels: lut.channels().to_vec(), values, provenance: lut.provenance() };
        let parameter = |r: f64| if axes.1.starts_with("alpha") { r * r } else { r };
        let read = |&(mu, r): &(f64, f64)| {
            let texel = table.bilinear(mu, parameter(r));
            ScaleBias { a: texel[0], b: texel[1] }
        };
        Ok(Errors::between(self.places.iter().map(read).zip(self.truth.iter().copied())))
    }
}

/// Every size up to `largest`, with all axes and storages.
pub fn measure(lobe: Microfacet, largest: usize, share: Share) -> Result<Vec<Reading>> {
    let lookup = Lookup::new(lobe, POINTS);
    let mut readings = Vec::new();
    for (done, axes) in AXES.into_iter().enumerate() {
        for size in std::iter::successors(Some(8), |size| Some(2 * size)).take_while(|&size| size <= largest) {
            let (x, y) = axes_of(axes, size)?;
            let grid = Grid::new(&x, &y)?;
            // Exact beside what lookups are off.
            let rule = Rule::for_cpu(lobe, 3e-6, grid.len()).unwrap_or(REFERENCE);
            if rule.seconds(lobe, grid.len()) > PATIENCE {
                break;
            }
            let exact = cpu::bake(lobe, &grid, &rule, &|_| ());
            for precision in [Precision::F32, Precision::F16, Precision::Unorm16, Precision::Unorm8] {
                let errors = lookup.of(lobe, axes, size, &stored(&exact, precision))?;
                let bytes = 2 * precision.bytes() * size * size;
                readings.push(Reading { x: axes.0.into(), y: axes.1.into(), size, precision, bytes, errors });
            }
        }
        share((done + 1) as f64 / AXES.len() as f64);
    }
    Ok(readings)
}

/// The smallest table with these axes whose lookups are at most `error` off.
pub fn smallest(readings: &[Reading], axes: Axes, error: f64) -> Option<&Reading> {
    let serves = |r: &&Reading| (r.x.as_str(), r.y.as_str()) == axes && r.errors.largest() <= error;
    readings.iter().filter(serves).min_by_key(|reading| reading.bytes)
}

/// The measurements as lines of CSV.
pub fn to_csv(readings: &[Reading]) -> String {
    let mut csv = String::from("x,y,size,precision,bytes,max_a,max_b,rms_a,rms_b\n");
    for Reading { x, y, size, precision, bytes, errors: Errors { max, rms } } in readings {
        let numbers = [max[0], max[1], rms[0], rms[1]].map(|number| format!("{number:.6e}")).join(",");
        csv += &format!("\"{x}\",\"{y}\",{size},{},{bytes},{numbers}\n", word(precision));
    }
    csv
}
