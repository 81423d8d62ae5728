//! Where approximations are fitted and verified: points crowded as their shapes are.

use super::truth::{Albedo, Truth};
use crate::approximation::{Across, Along, Region, Shape};
use crate::table::axis::{Axis, Parameter};

/// A point and the truth there.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// n·v
    pub nov: f64,
    /// Perceptual roughness.
    pub roughness: f64,
    /// The truth.
    pub truth: Albedo,
}

/// Coordinates of samples.
pub type Coordinates = (Along, Across);

/// They follow the layer at grazing angles.
pub const ON_THE_LAYER: Coordinates = (Along::Layer(3.0), Across::Sqrt);

/// They do not, for lobes that have none.
pub const BESIDE_THE_LAYER: Coordinates = (Along::Sqrt, Across::Linear);

/// Row 0 of a region that begins at a mirror: so close to it that the integrals are functions of
/// n·v/α alone, to 1e-12. At roughness 0 itself they have no limit for n·v → 0.
const NEXT_TO_MIRROR: f64 = 1e-6;

/// Places in each span of an axis, from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spread {
    /// This many, with both ends, crowded there as the extrema of a Chebyshev polynomial are.
    Crowded(usize),
    /// This many intervals of the same width.
    Even(usize),
}

impl Spread {
    /// The places on an axis of `spans` spans, in order; ends of spans are listed once.
    fn places(self, spans: usize) -> Vec<f64> {
        let (count, at): (_, fn(f64) -> f64) = match self {
            Spread::Crowded(count) => {
                (count - 1, |share| 0.5 - 0.5 * libm::cos(std::f64::consts::PI * share))
            }
            Spread::Even(count) => (count, |share| share),
        };
        let within = |span: usize| {
            (0..count).map(move |i| (span as f64 + at(i as f64 / count as f64)) / spans as f64)
        };
        (0..spans).flat_map(within).chain([1.0]).collect()
    }
}

/// The samples of a shape in a region, row by row.
pub fn samples(truth: &Truth, region: &Region, shape: &Shape, spread: [Spread; 2]) -> Vec<Sample> {
    let [low, high] = region.roughness;
    match *shape {
        Shape::Spline { x, y, size, degree } => {
            on_grid(truth, region, (x, y), (spread, size.map(|count| count - degree)))
        }
        Shape::Texture { x, y, .. } => on_texels(truth, region, [&x, &y], spread),
        // A mirror has no layer.
        _ if low == high && low < NEXT_TO_MIRROR => {
            on_grid(truth, region, BESIDE_THE_LAYER, (spread, [1, 1]))
        }
        _ => on_grid(truth, region, ON_THE_LAYER, (spread, [1, 1])),
    }
}

/// Samples on a grid in these coordinates, with so many spans along each.
pub fn on_grid(
    truth: &Truth,
    region: &Region,
    (x, y): Coordinates,
    (spread, spans): ([Spread; 2], [usize; 2]),
) -> Vec<Sample> {
    let [low, high] = region.roughness;
    let least = region.least_nov;
    let along = spread[0].places(spans[0]);
    let across = if low == high { vec![0.0] } else { spread[1].places(spans[1]) };
    let row = |&place: &f64| {
        let roughness = match y.inverse(region, place) {
            roughness if low < high => roughness.max(NEXT_TO_MIRROR),
            roughness => roughness,
        };
        let novs = along.iter().map(|&place| x.inverse(least, place, roughness)).collect();
        (roughness, novs)
    };
    of_rows(truth, &across.iter().map(row).collect::<Vec<_>>())
}

/// Samples at these n·v of each roughness.
fn of_rows(truth: &Truth, rows: &[(f64, Vec<f64>)]) -> Vec<Sample> {
    let truths = truth.rows(rows);
    let points =
        rows.iter().flat_map(|(roughness, novs)| novs.iter().map(|nov| (*nov, *roughness)));
    points.zip(truths).map(|((nov, roughness), truth)| Sample { nov, roughness, truth }).collect()
}

/// Samples between the texels of a texture, and along the layer in every row.
fn on_texels(
    truth: &Truth,
    region: &Region,
    [x, y]: [&Axis; 2],
    spread: [Spread; 2],
) -> Vec<Sample> {
    let [low, high] = region.roughness;
    let (layer, least) = (ON_THE_LAYER.0, region.least_nov);
    let novs = between(x, [least, 1.0], spread[0]);
    let is_alpha = y.spec().parameter == Parameter::Alpha;
    let rows = match is_alpha {
        true => {
            let alphas = between(y, [low * low, high * high], spread[1]);
            alphas.into_iter().map(|alpha| alpha.sqrt().clamp(low, high)).collect()
        }
        false => between(y, [low, high], spread[1]),
    };
    let of_row = |roughness: f64| {
        let roughness = if low < high { roughness.max(NEXT_TO_MIRROR) } else { roughness };
        let place = |i: usize| layer.inverse(least, i as f64 / ALONG_THE_LAYER as f64, roughness);
        let mut all = novs.clone();
        all.extend((0..=ALONG_THE_LAYER).map(place));
        (roughness, all)
    };
    of_rows(truth, &rows.into_iter().map(of_row).collect::<Vec<_>>())
}

/// Places along the layer in each row of a texture's samples.
const ALONG_THE_LAYER: usize = 48;

/// Parameters in a range: both ends, and places between the texels of an axis and beyond its ends.
fn between(axis: &Axis, [low, high]: [f64; 2], spread: Spread) -> Vec<f64> {
    if low == high {
        return vec![low];
    }
    let ends = [axis.texel(low), axis.texel(high)];
    let (first, last) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
    let mut knots = vec![first];
    knots.extend((0..axis.size()).map(|i| i as f64).filter(|&i| first < i && i < last));
    knots.push(last);
    let within = spread.places(1);
    let mut places = vec![low, high];
    for pair in knots.windows(2) {
        let place = |share: &f64| axis.value_at(pair[0] + (pair[1] - pair[0]) * share);
        places.extend(within.iter().map(place).map(|value| value.clamp(low, high)));
    }
    places.sort_by(f64::total_cmp);
    places.dedup();
    places
}
