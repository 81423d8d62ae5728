//! The channels of a table before anything is known of them: their range, what is no number, what
//! is constant, and what is a copy.

use super::decoding::Decoding;
use crate::foreign::Foreign;
use serde::Serialize;

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

/// All channels of a slice.
pub fn channels(table: &Foreign, slice: usize, decoding: Decoding) -> Vec<Channel> {
    let mut channels: Vec<Channel> = Vec::new();
    let texels = texels(table, slice);
    let columns: Vec<Vec<f64>> = (0..decoding.components(table))
        .map(|component| texels.iter().map(|texel| decoding.value(texel, component)).collect())
        .collect();
    for (component, values) in columns.iter().enumerate() {
        let mut finite: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        finite.sort_by(f64::total_cmp);
        let not_finite = values.len() - finite.len();
        let at = |share: f64| finite.get((share * finite.len() as f64) as usize).copied();
        let ends = (at(0.0).unwrap_or(0.0), finite.last().copied().unwrap_or(0.0));
        let spread = at(0.95).zip(at(0.05)).map_or(0.0, |(high, low)| high - low);
        let copied = columns[..component].iter().position(|other| other == values);
        let idle = if not_finite * 5 > values.len() {
            Some(Idle::Broken)
        } else if ends.1 - ends.0 <= CONSTANT {
            Some(Idle::Constant(ends.0))
        } else {
            copied.map(Idle::Copy)
        };
        let name = table.names[component].clone();
        // A channel may be flat but for a corner.
        let spread = if spread > CONSTANT { spread } else { ends.1 - ends.0 };
        channels.push(Channel { name, range: ends, not_finite, spread, idle });
    }
    channels
}

/// The texels of a slice.
pub fn texels(table: &Foreign, slice: usize) -> Vec<&[f32]> {
    let [columns, rows, _] = table.size;
    let components = table.components();
    let length = columns * rows * components;
    table.values[slice * length..(slice + 1) * length].chunks_exact(components).collect()
}
