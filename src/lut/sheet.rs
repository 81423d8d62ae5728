//! The values of a slice as it fills, band by band: packed in the order of the file, and what the
//! storage cannot hold remembered.

use super::packing::{Packing, Part};
use crate::choice::Choice;
use crate::error::{Error, Result};
use crate::table::grid::Grid;
use crate::table::precision::Precision;
use crate::table::rgbd;
use crate::units::roughness_of;
use rayon::prelude::*;
use std::iter::zip;

/// The bytes of a slice, of which some are still to be filled.
#[derive(Debug)]
pub struct Sheet<'a> {
    packing: &'a Packing,
    grid: &'a Grid,
    precision: Precision,
    /// Channels of a texel.
    channels: usize,
    bytes: &'a mut [u8],
    /// The value farthest outside of the storage's range, its texel in the order of the grid, and
    /// its channel.
    excess: Option<(f64, usize, usize)>,
}

impl<'a> Sheet<'a> {
    /// A sheet over the bytes of a slice.
    pub fn new(
        packing: &'a Packing,
        grid: &'a Grid,
        precision: Precision,
        bytes: &'a mut [u8],
    ) -> Self {
        let channels = packing.contents().len();
        Sheet { packing, grid, precision, channels, bytes, excess: None }
    }

    /// Takes a part's values of the α from row `first` of the grid on, in the order of the grid,
    /// each as the storage holds it or, where it does not, as it is ([`Precision::stored`]).
    pub fn put(&mut self, part: &Part, first: usize, values: &[f64]) {
        self.put_at(&part.places(), first, values);
    }

    /// Fills in the channels that need no integral.
    pub fn fill(&mut self) {
        let (grid, precision) = (self.grid, self.precision);
        for (place, value) in self.packing.fillers() {
            let at = |index| {
                let (mu, alpha) = grid.point(index);
                precision.stored(value(mu, alpha))
            };
            let values: Vec<f64> = (0..grid.len()).map(at).collect();
            self.put_at(&[place], 0, &values);
        }
    }

    fn put_at(&mut self, places: &[usize], first: usize, values: &[f64]) {
        let (n, width, precision) = (places.len(), self.grid.mus.len(), self.precision);
        debug_assert_eq!(values.len() % (n * width), 0, "whole rows");
        let (size, alphas) = (self.channels * precision.bytes(), self.grid.alphas.len());
        let pack = |texel: &[f64], bytes: &mut [u8]| pack(precision, places, texel, bytes);
        let fits = if self.grid.transposed {
            // The α of the band are a part of each row of the table.
            let column = |(mu, row): (usize, &mut [u8])| {
                let texels = values.chunks_exact(n).skip(mu).step_by(width);
                let bytes = row[first * size..].chunks_exact_mut(size);
                zip(texels, bytes).fold(true, |fits, (texel, bytes)| pack(texel, bytes) && fits)
            };
            self.bytes
                .par_chunks_mut(alphas * size)
                .enumerate()
                .map(column)
                .reduce(|| true, |a, b| a && b)
        } else {
            let row = |(bytes, values): (&mut [u8], &[f64])| {
                let texels = zip(values.chunks_exact(n), bytes.chunks_exact_mut(size));
                texels.fold(true, |fits, (texel, bytes)| pack(texel, bytes) && fits)
            };
            let rows = self.bytes[first * width * size..].par_chunks_mut(width * size);
            rows.zip(values.par_chunks(width * n)).map(row).reduce(|| true, |a, b| a && b)
        };
        if !fits {
            self.remember_excess(first * width, places, values);
        }
    }

    /// Checks, once all values are there, that the storage holds them; the error names the largest
    /// that it does not. Of RGBD it stores the values that the codes of each texel stand for, and
    /// returns by how much more than [`Precision::half_step`] a value in [0, 1] differs from them.
    pub fn finish(self) -> Result<f64> {
        let Some((value, texel, place)) = self.excess else {
            return Ok(match self.precision {
                Precision::Rgbd8 => self.round_rgbd(),
                _ => 0.0,
            });
        };
        let (mu, alpha) = self.grid.point(texel);
        let channel = self.packing.channels().swap_remove(place).name;
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

    fn round_rgbd(self) -> f64 {
        let precision = self.precision;
        let mut worst = precision.half_step();
        // The values are those of f32, before and after.
        let rounding = 2.0 * Precision::F32.half_step();
        let size = precision.bytes();
        for texel in self.bytes.chunks_exact_mut(self.channels * size) {
            let values: Vec<f64> =
                texel.chunks_exact(size).map(|bytes| precision.read(bytes)).collect();
            let mut stored = values.clone();
            rgbd::round(&mut stored);
            for ((bytes, value), stored) in zip(texel.chunks_exact_mut(size), values).zip(stored) {
                // Also where the truth may be 1 though neither of them is.
                if value.min(stored) <= 1.0 + 0.05 {
                    worst = worst.max((value - stored).abs() + rounding);
                }
                precision.write(stored, bytes);
            }
        }
        worst - precision.half_step()
    }

    /// Remembers the value that is farthest outside, `first` being the texel of the first ones.
    fn remember_excess(&mut self, first: usize, places: &[usize], values: &[f64]) {
        let precision = self.precision;
        let (low, high) = precision.range();
        let beyond = |value: f64| {
            if value.is_nan() { f64::INFINITY } else { (value - high).max(low - value) }
        };
        let n = places.len();
        let found = values
            .iter()
            .enumerate()
            .filter(|(_, value)| !precision.holds(**value))
            .map(|(i, &value)| (value, first + i / n, places[i % n]));
        self.excess = found.chain(self.excess).max_by(|a, b| beyond(a.0).total_cmp(&beyond(b.0)));
    }
}

/// Writes the values of a texel to their places; tells whether the storage holds all of them.
#[inline(always)]
fn pack(precision: Precision, places: &[usize], values: &[f64], bytes: &mut [u8]) -> bool {
    let (mut fits, size) = (true, precision.bytes());
    for (&place, &value) in zip(places, values) {
        fits &= precision.holds(value);
        precision.write(value, &mut bytes[place * size..][..size]);
    }
    fits
}
