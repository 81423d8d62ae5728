//! How far the values that a table stores are from the truth.

use super::channel::Texels;
use super::decoding::Decoding;
use super::layout::{Layout, place};
use super::meaning::Meaning;
use super::sample::spread;
use crate::error::Result;
use crate::foreign::Foreign;
use crate::table::axis::{Axis, AxisSpec, Parameter};
use crate::units::roughness_of;
use serde::Serialize;

/// The error of the truth itself.
pub const TOLERANCE: f64 = 1e-5;

/// Texels along each axis that are measured at the most; of a larger table as many, evenly spread,
/// both ends among them.
pub const SIDE: usize = 512;

/// The errors of a channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// The mean of their amounts.
    pub mean: f64,
    /// The largest but for the hundredth part.
    pub most: f64,
    /// The largest.
    pub largest: f64,
    /// Their mean with signs.
    pub bias: f64,
    /// The place of the largest.
    pub worst: Place,
    /// Values that are NaN or infinite, of so many.
    pub not_finite: (usize, usize),
}

/// A place of a table.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Place {
    /// Column and row, whole numbers at a texel.
    pub texel: (f64, f64),
    /// n·v
    pub nov: f64,
    /// Perceptual roughness.
    pub roughness: f64,
    /// The value of the table.
    pub value: f64,
    /// The true one.
    pub truth: f64,
}

/// A slice of a table read by a convention.
#[derive(Clone, Copy, Debug)]
pub struct Convention<'a> {
    /// How codes become values.
    pub decoding: Decoding,
    /// The axes.
    pub layout: Layout,
    /// The meaning of each channel.
    pub meanings: &'a [Meaning],
}

/// The differences of a channel from the truth at the texels that are measured, row by row.
#[derive(Clone)]
pub struct Differences {
    /// Columns and rows of them.
    pub size: [usize; 2],
    /// Value less truth.
    pub values: Vec<f64>,
    /// The errors.
    pub errors: Errors,
}

impl Convention<'_> {
    pub(super) fn axes(&self, table: &Foreign) -> Result<(Axis, Axis)> {
        let [columns, rows, _] = table.size;
        Ok((Axis::new(self.layout.x, columns)?, Axis::new(self.layout.y, rows)?))
    }

    /// The meaning of a channel over n·v and roughness, as exact as errors are; none where its
    /// meaning is not known.
    pub(super) fn meaning(&self, channel: usize) -> Option<Meaning> {
        // Of other axes the places are no n·v and no α.
        let known = |spec: AxisSpec| {
            matches!(spec.parameter, Parameter::Nov | Parameter::Roughness | Parameter::Alpha)
        };
        let meaning = self.meanings.get(channel)?.clone().within(TOLERANCE);
        (known(self.layout.x) && known(self.layout.y)).then_some(meaning)
    }

    /// The truth of a channel at these places along x and y, row by row; none where its meaning is
    /// not known.
    pub(super) fn truth(&self, channel: usize, xs: &[f64], ys: &[f64]) -> Option<Vec<f64>> {
        let meaning = self.meaning(channel)?;
        let transposed = self.layout.is_transposed();
        let (novs, widths) = if transposed { (ys, xs) } else { (xs, ys) };
        let grid = meaning.on_grid(novs, widths)?;
        if !transposed {
            return Some(grid);
        }
        // n·v varies fastest there, and from row to row here.
        let at = |texel: usize| grid[texel % xs.len() * ys.len() + texel / xs.len()];
        Some((0..grid.len()).map(at).collect())
    }

    /// The errors of the stored values of a channel.
    pub fn stored(
        &self,
        table: &Foreign,
        slice: usize,
        channel: usize,
    ) -> Result<Option<Differences>> {
        let (x, y) = self.axes(table)?;
        let (across, along) = (spread(x.size(), SIDE), spread(y.size(), SIDE));
        let places = |axis: &Axis, texels: &[usize]| -> Vec<f64> {
            let value = |&texel: &usize| place(axis.spec().parameter, axis.value(texel));
            texels.iter().map(value).collect()
        };
        let (xs, ys) = (places(&x, &across), places(&y, &along));
        let Some(truth) = self.truth(channel, &xs, &ys) else { return Ok(None) };
        let (texels, columns) = (Texels::new(table, slice), table.size[0]);
        let value =
            |(j, i): (&usize, &usize)| self.decoding.value(&texels[j * columns + i], channel);
        let pairs = along.iter().flat_map(|j| across.iter().map(move |i| (j, i)));
        let values: Vec<f64> = pairs.map(value).collect();
        let differences: Vec<f64> =
            values.iter().zip(&truth).map(|(value, truth)| value - truth).collect();
        let at = |index: usize| {
            let (i, j) = (index % xs.len(), index / xs.len());
            let texel = (across[i] as f64, along[j] as f64);
            self.place(texel, (xs[i], ys[j]), values[index], truth[index])
        };
        let errors = errors(&differences, at);
        let size = [across.len(), along.len()];
        Ok(Some(Differences { size, values: differences, errors }))
    }

    /// A place with its value and the truth.
    pub(super) fn place(
        &self,
        texel: (f64, f64),
        (x, y): (f64, f64),
        value: f64,
        truth: f64,
    ) -> Place {
        let (nov, alpha) = if self.layout.is_transposed() { (y, x) } else { (x, y) };
        Place { texel, nov, roughness: roughness_of(alpha), value, truth }
    }
}

/// The errors of these differences; `place`: where the one with this number lies.
pub(super) fn errors(differences: &[f64], place: impl Fn(usize) -> Place) -> Errors {
    let mut amounts: Vec<(f64, usize)> = differences
        .iter()
        .enumerate()
        .filter(|(_, difference)| difference.is_finite())
        .map(|(index, difference)| (difference.abs(), index))
        .collect();
    amounts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let count = amounts.len().max(1) as f64;
    let finite = differences.iter().filter(|difference| difference.is_finite());
    let (largest, worst) = amounts.last().copied().unwrap_or((0.0, 0));
    Errors {
        mean: amounts.iter().map(|amount| amount.0).sum::<f64>() / count,
        most: amounts.get(amounts.len() * 99 / 100).map_or(0.0, |amount| amount.0),
        largest,
        bias: finite.sum::<f64>() / count,
        worst: place(worst),
        not_finite: (differences.len() - amounts.len(), differences.len()),
    }
}
