//! The values of a slice as it fills, band by band: packed in the order of the file, and what the
//! storage cannot hold remembered.

use super::Lut;
use crate::choice::Choice;
use crate::error::{Error, Result};
use crate::table::grid::Grid;
use crate::table::precision::Precision;
use crate::units::roughness_of;
use rayon::prelude::*;

/// The bytes of a slice, of which some are still to be filled.
#[derive(Debug)]
pub struct Sheet<'a> {
    lut: &'a Lut,
    grid: &'a Grid,
    precision: Precision,
    /// Channels of a texel.
    channels: usize,
    bytes: &'a mut [u8],
    /// The value farthest outside of the storage's range, and its place in the order of the grid.
    excess: Option<(f64, usize)>,
}

impl<'a> Sheet<'a> {
    /// A sheet over the bytes of a slice.
    pub fn new(lut: &'a Lut, grid: &'a Grid, precision: Precision, bytes: &'a mut [u8]) -> Self {
        Sheet { lut, grid, precision, channels: lut.channels().len(), bytes, excess: None }
    }

    /// Takes the values of the α from row `first` of the grid on, in the order of the grid, each as
    /// the storage holds it or, where it does not, as it is ([`Precision::stored`]).
    pub fn put(&mut self, first: usize, values: &[f64]) {
        let (n, width, precision) = (self.channels, self.grid.mus.len(), self.precision);
        debug_assert_eq!(values.len() % (n * width), 0, "whole rows");
        let (size, alphas) = (precision.bytes(), self.grid.alphas.len());
        let fits = if self.grid.transposed {
            // The α of the band are a part of each row of the table.
            let column = |(mu, row): (usize, &mut [u8])| {
                let texels = values.chunks_exact(n).skip(mu).step_by(width);
                pack(precision, texels.flatten(), &mut row[first * n * size..])
            };
            self.bytes
                .par_chunks_mut(alphas * n * size)
                .enumerate()
                .map(column)
                .reduce(|| true, |a, b| a && b)
        } else {
            let rows = self.bytes[first * width * n * size..].par_chunks_mut(width * n * size);
            let rows = rows.zip(values.par_chunks(width * n));
            rows.map(|(bytes, values)| pack(precision, values, bytes))
                .reduce(|| true, |a, b| a && b)
        };
        if !fits {
            self.remember_excess(first * width * n, values);
        }
    }

    /// Checks, once all values are there, that the storage holds them; the error names the largest
    /// that it does not.
    pub fn finish(self) -> Result<()> {
        let Some((value, place)) = self.excess else { return Ok(()) };
        let (mu, alpha) = self.grid.point(place / self.channels);
        let channel = self.lut.channels()[place % self.channels].name;
        let at = format!("at n.v = {mu}, roughness = {}", roughness_of(alpha));
        if value.is_nan() {
            return Err(Error::Internal(format!("{channel} is no number {at}")));
        }
        let (low, high) = self.precision.range();
        let holds = |wider: &&Precision| wider.holds(wider.nearest(value));
        let wider: Vec<&str> = [Precision::F16, Precision::F32]
            .iter()
            .filter(holds)
            .map(|wider| wider.word())
            .collect();
        let cure = match wider.is_empty() {
            true => "raise the min of an axis, where the values grow beyond all bounds".into(),
            false => format!("store them in {}, in a file format of floats", wider.join(" or ")),
        };
        let which = if value < low { "smallest" } else { "largest" };
        let expected =
            format!("values from {low} to {high}, which is what {} holds", self.precision);
        let got = format!("{value:.5} as the {which}, channel {channel} {at}");
        Err(Error::bad_input("precision", expected, got, cure))
    }

    fn remember_excess(&mut self, first: usize, values: &[f64]) {
        let precision = self.precision;
        let (low, high) = precision.range();
        let beyond = |value: f64| {
            if value.is_nan() { f64::INFINITY } else { (value - high).max(low - value) }
        };
        let places =
            values.iter().copied().enumerate().filter(|(_, value)| !precision.holds(*value));
        let farthest = places.map(|(i, value)| (value, first + i)).chain(self.excess);
        self.excess = farthest.max_by(|a, b| beyond(a.0).total_cmp(&beyond(b.0)));
    }
}

/// Writes values side by side; tells whether the storage holds all of them.
fn pack<'a>(
    precision: Precision,
    values: impl IntoIterator<Item = &'a f64>,
    bytes: &mut [u8],
) -> bool {
    let mut fits = true;
    for (&value, bytes) in values.into_iter().zip(bytes.chunks_exact_mut(precision.bytes())) {
        fits &= precision.holds(value);
        precision.write(value, bytes);
    }
    fits
}
