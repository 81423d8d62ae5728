//! How far from the truth the values are that a bilinear lookup reads from a table.

use super::channel::Texels;
use super::errors::{Convention, Errors, errors};
use super::layout::place;
use super::meaning::Meaning;
use crate::error::Result;
use crate::foreign::Foreign;
use crate::numeric::climb::{Climber, climb};
use crate::table::axis::{Axis, Parameter};
use crate::table::bilinear;
use crate::units::{PRACTICAL_NOV, PRACTICAL_ROUGHNESS, alpha_of};

/// Places along an axis at which lookups are searched at the most.
const PLACES: usize = 260;

/// Rows from whose worst places the search for the largest error climbs.
const CLIMBERS: usize = 24;

/// The same for tables with averages: each new row costs as many integrals as its averages need.
const CLIMBERS_BY_ROW: usize = 4;

/// Steps of a climb; each halves the distance between the places, which is half a texel at first,
/// or more where a side has many texels.
const STEPS: usize = 8;

/// A lookup of one channel.
struct Lookup<'a> {
    convention: &'a Convention<'a>,
    texels: Texels<'a>,
    channel: usize,
    axes: [Axis; 2],
}

impl Lookup<'_> {
    /// What a sampler reads at fractional texels, clamped to the edge.
    fn read(&self, u: f64, v: f64) -> f64 {
        let [x, y] = &self.axes;
        let columns = x.size();
        let at = |i: usize, j: usize| {
            self.convention.decoding.value(&self.texels[j * columns + i], self.channel)
        };
        bilinear(x, y, x.value_at(u), y.value_at(v)).read(at)
    }

    /// n·v, or α, at a fractional texel along x, and along y.
    fn place(&self, (u, v): (f64, f64)) -> (f64, f64) {
        let at =
            |axis: &Axis, texel| place(axis.spec().parameter, axis.value_at(texel).clamp(0.0, 1.0));
        (at(&self.axes[0], u), at(&self.axes[1], v))
    }

    /// Value and truth of a lookup at fractional texels.
    fn pairs(&self, meaning: &Meaning, places: &[(f64, f64)]) -> Vec<(f64, f64)> {
        let transposed = self.convention.layout.is_transposed();
        let point = |&place: &(f64, f64)| {
            let (x, y) = self.place(place);
            if transposed { (y, x) } else { (x, y) }
        };
        let truth = meaning.at(&places.iter().map(point).collect::<Vec<_>>()).unwrap_or_default();
        places.iter().zip(truth).map(|(&(u, v), truth)| (self.read(u, v), truth)).collect()
    }
}

impl Convention<'_> {
    /// The errors of a bilinear lookup of a channel over the practical domain: at texels, between
    /// them, at the ends of the domain; the largest by a climb from the worst of these.
    pub fn sampled(&self, table: &Foreign, slice: usize, channel: usize) -> Result<Option<Errors>> {
        let (x, y) = self.axes(table)?;
        let texels = Texels::new(table, slice);
        let lookup = Lookup { convention: self, texels, channel, axes: [x, y] };
        let (across, along) = (between(&x), between(&y));
        let xs: Vec<f64> = across.iter().map(|&u| lookup.place((u, 0.0)).0).collect();
        let ys: Vec<f64> = along.iter().map(|&v| lookup.place((0.0, v)).1).collect();
        let (Some(truth), Some(meaning)) = (self.truth(channel, &xs, &ys), self.meaning(channel))
        else {
            return Ok(None);
        };
        let columns = across.len();
        let texel = |index: usize| (across[index % columns], along[index / columns]);
        let read = |index: usize| {
            let (u, v) = texel(index);
            lookup.read(u, v)
        };
        let values: Vec<f64> = (0..truth.len()).map(read).collect();
        let differences: Vec<f64> =
            values.iter().zip(&truth).map(|(value, truth)| value - truth).collect();
        let at = |index: usize| {
            let point = (xs[index % columns], ys[index / columns]);
            self.place(texel(index), point, values[index], truth[index])
        };
        let mut errors = errors(&differences, at);
        let start = |(j, row): (usize, &[f64])| {
            let amounts = row.iter().map(|difference| difference.abs()).enumerate();
            let finite = amounts.filter(|(_, amount)| amount.is_finite());
            let (i, amount) = finite.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0));
            Climber::at([&across, &along], [i, j], [0, 0], amount)
        };
        let starts = differences.chunks(columns).enumerate().map(start).collect();
        let amounts = |places: &[(f64, f64)]| {
            let pairs = lookup.pairs(&meaning, places).into_iter();
            let amounts = pairs.map(|(value, truth)| (value - truth).abs());
            Ok(amounts.map(|amount| if amount.is_finite() { amount } else { 0.0 }).collect())
        };
        let count = if meaning.needs_averages() { CLIMBERS_BY_ROW } else { CLIMBERS };
        let climbers = climb(starts, count, STEPS, amounts)?;
        if let Some(top) = climbers.first().filter(|top| top.value > errors.largest) {
            let texel = (top.x[1], top.y[1]);
            let (value, truth) = lookup.pairs(&meaning, &[texel])[0];
            errors.largest = top.value;
            errors.worst = self.place(texel, lookup.place(texel), value, truth);
        }
        Ok(Some(errors))
    }
}

/// Fractional texels of an axis within the practical domain: every texel, the middle between two,
/// and the ends; of a large table every so many.
fn between(axis: &Axis) -> Vec<f64> {
    let parameter = axis.spec().parameter;
    let least = match parameter {
        Parameter::Nov => PRACTICAL_NOV,
        Parameter::Alpha => alpha_of(PRACTICAL_ROUGHNESS),
        _ => PRACTICAL_ROUGHNESS,
    };
    let (first, last) = (axis.texel(least), axis.texel(1.0));
    let (low, high) = (first.min(last), first.max(last));
    let halves = (2.0 * low).ceil() as i64..=(2.0 * high).floor() as i64;
    let count = (high - low) * 2.0;
    let step = (count / PLACES as f64).ceil().max(1.0) as usize;
    // An odd step meets texels and middles.
    let step = if step > 1 { step | 1 } else { 1 };
    let mut places: Vec<f64> = halves.step_by(step).map(|half| half as f64 * 0.5).collect();
    places.extend([low, high]);
    places.sort_by(f64::total_cmp);
    places.dedup();
    places
}
