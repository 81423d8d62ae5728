//! The channels of a table before anything is known of them: their range, what is no number, what
//! is constant, and what is a copy.

use super::decoding::Decoding;
use crate::foreign::Foreign;
use serde::Serialize;
use std::ops::Index;

/// What a channel is by its values alone.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Channel {
    /// Its name in the file.
    pub name: String,
    /// The smallest and the largest of its numbers.
    pub range: (f64, f64),
    /// Texels whose value is NaN or infinite.
    pub not_finite: usize,
    /// The range between the smallest and the largest twentieth: the unit of errors.
    pub spread: f64,
    /// What makes it tell nothing.
    pub idle: Option<Idle>,
}

/// What makes a channel tell nothing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Idle {
    /// All texels have this value.
    Constant(f64),
    /// All texels have the value of the channel with this number.
    Copy(usize),
    /// More than a fifth of its texels are no numbers.
    Broken,
}

/// A channel whose values lie closer together than this is constant: a step of 16 bits.
const CONSTANT: f64 = 2e-5;

/// Texels by which the spread of a channel is told.
const ENOUGH: usize = 1 << 16;

/// All channels of a slice.
pub fn channels(table: &Foreign, slice: usize, decoding: Decoding) -> Vec<Channel> {
    let texels = Texels::new(table, slice);
    let components = decoding.components(table);
    (0..components).map(|component| channel(table, &texels, decoding, component)).collect()
}

fn channel(table: &Foreign, texels: &Texels, decoding: Decoding, component: usize) -> Channel {
    let value = |texel: usize| decoding.value(&texels[texel], component);
    let (mut ends, mut not_finite) = ((f64::INFINITY, f64::NEG_INFINITY), 0);
    for value in (0..texels.len()).map(value) {
        match value.is_finite() {
            true => ends = (ends.0.min(value), ends.1.max(value)),
            false => not_finite += 1,
        }
    }
    if not_finite == texels.len() {
        ends = (0.0, 0.0);
    }
    let step = texels.len().div_ceil(ENOUGH);
    let mut some: Vec<f64> =
        (0..texels.len()).step_by(step).map(value).filter(|value| value.is_finite()).collect();
    some.sort_by(f64::total_cmp);
    let at = |share: f64| some.get((share * some.len() as f64) as usize).copied();
    let spread = at(0.95).zip(at(0.05)).map_or(0.0, |(high, low)| high - low);
    // A channel may be flat but for a corner.
    let spread = if spread > CONSTANT { spread } else { ends.1 - ends.0 };
    let same = |other: &usize| {
        (0..texels.len()).all(|texel| value(texel) == decoding.value(&texels[texel], *other))
    };
    let idle = if not_finite * 5 > texels.len() {
        Some(Idle::Broken)
    } else if ends.1 - ends.0 <= CONSTANT {
        Some(Idle::Constant(ends.0))
    } else {
        (0..component).find(same).map(Idle::Copy)
    };
    Channel { name: table.names[component].clone(), range: ends, not_finite, spread, idle }
}

/// The texels of a slice, row by row.
#[derive(Clone, Copy)]
pub struct Texels<'a> {
    values: &'a [f32],
    components: usize,
}

impl<'a> Texels<'a> {
    /// Those of this slice.
    pub fn new(table: &'a Foreign, slice: usize) -> Self {
        let [columns, rows, _] = table.size;
        let components = table.components();
        let length = columns * rows * components;
        Texels { values: &table.values[slice * length..(slice + 1) * length], components }
    }

    /// Their number.
    pub fn len(&self) -> usize {
        self.values.len() / self.components
    }
}

impl Index<usize> for Texels<'_> {
    type Output = [f32];

    fn index(&self, texel: usize) -> &[f32] {
        &self.values[texel * self.components..][..self.components]
    }
}
