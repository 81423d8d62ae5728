//! A table: stored numbers over two axes, or over three in slices, with all that a reader has to
//! know of them.

pub mod axis;
pub mod claim;
pub mod grid;
pub mod packed;
pub mod precision;
pub mod rgbd;
pub mod slices;
pub mod srgb;

use crate::error::{Error, Result};
use axis::Axis;
use claim::Claim;
use packed::Packed;
use precision::Precision;
use slices::Slices;

/// A channel of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Its short name: `A`, `B`, `E`, `E_burley - 0.5`.
    pub name: String,
    /// Its meaning.
    pub meaning: String,
    /// The name of what is scaled and shifted: the channel is `scale` times it plus `offset`; none
    /// where it is a constant.
    pub base: Option<String>,
    /// The factor.
    pub scale: f64,
    /// What is added.
    pub offset: f64,
}

/// The axes and channels of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Along a row.
    pub x: Axis,
    /// From row to row.
    pub y: Axis,
    /// From slice to slice; none of a table over two axes.
    pub slices: Option<Slices>,
    /// The values of a texel.
    pub channels: Vec<Channel>,
}

/// The origin of a table's numbers, in words for the metadata.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Provenance {
    /// The family of tables.
    pub table: &'static str,
    /// The equation in which the table is used.
    pub equation: String,
    /// The lobe.
    pub model: &'static str,
    /// The masking term of a specular lobe.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub masking: Option<&'static str>,
    /// What else there is to know of a rough interface.
    #[cfg_attr(feature = "serde", serde(flatten))]
    pub interface: Option<InterfaceText>,
    /// Fresnel of a specular lobe.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub fresnel: Option<String>,
    /// Reflectance at normal incidence of a table for one F0.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub f0: Option<f64>,
    /// The meaning of roughness.
    pub roughness: &'static str,
}

/// A rough interface in words for the metadata.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct InterfaceText {
    /// Index of refraction of the medium.
    pub ior: f64,
    /// The side from which it is seen.
    pub side: &'static str,
    /// Masking of transmitted light.
    pub transmission_masking: &'static str,
    /// F over all directions on that side.
    pub average_fresnel: f64,
}

/// The origin and the claim of the channels that are integrated together.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The places of these channels in a texel.
    pub channels: Vec<usize>,
    /// The origin of their numbers.
    pub provenance: Provenance,
    /// How far they are from the truth.
    pub claim: Claim,
}

/// The numbers of a table as they are stored, with their layout, and the parts of each slice with
/// their origins and claims. Only a bake makes one, so that no claim can stand beside other numbers
/// than its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    layout: Layout,
    /// Slice by slice, row by row, the channels of a texel side by side.
    values: Packed,
    /// Slice by slice; each has at least one.
    parts: Vec<Vec<Part>>,
    rounding: f64,
    command: String,
}

impl Channel {
    /// A channel with this name and meaning.
    pub fn new(name: impl Into<String>, meaning: impl Into<String>) -> Self {
        let (name, meaning) = (name.into(), meaning.into());
        Channel { base: Some(name.clone()), name, meaning, scale: 1.0, offset: 0.0 }
    }
}

impl Layout {
    /// The number of slices.
    pub fn slice_count(&self) -> usize {
        self.slices.as_ref().map_or(1, Slices::count)
    }

    /// The number of values of a slice.
    pub fn values_of_slice(&self) -> usize {
        self.x.size() * self.y.size() * self.channels.len()
    }
}

impl Table {
    /// The table of these values; `parts` has one entry for each slice.
    pub(crate) fn new(
        layout: Layout,
        values: Packed,
        parts: Vec<Vec<Part>>,
        rounding: f64,
        command: String,
    ) -> Result<Self> {
        let slices = layout.slice_count();
        let whole = values.len() == slices * layout.values_of_slice();
        if !whole || parts.len() != slices || parts.iter().any(Vec::is_empty) {
            return Err(Error::Internal(
                "a table whose values and claims do not fit its layout".into(),
            ));
        }
        Ok(Table { layout, values, parts, rounding, command })
    }

    /// Axes, slices and channels.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// The axis along a row.
    pub fn x(&self) -> &Axis {
        &self.layout.x
    }

    /// The axis from row to row.
    pub fn y(&self) -> &Axis {
        &self.layout.y
    }

    /// The channels of a texel.
    pub fn channels(&self) -> &[Channel] {
        &self.layout.channels
    }

    /// The storage of its values.
    pub fn precision(&self) -> Precision {
        self.values.precision()
    }

    /// The parts of a slice, the main one first: most tables have no other. Channels that are the
    /// same for every lobe, such as a constant, are in none.
    pub fn parts(&self, slice: usize) -> &[Part] {
        &self.parts[slice]
    }

    /// How far the numbers of a slice's main part are from the truth.
    pub fn claim(&self, slice: usize) -> &Claim {
        &self.parts[slice][0].claim
    }

    /// The largest error of storing one of its values in [-1, 1].
    pub fn rounding(&self) -> f64 {
        self.rounding
    }

    /// The command that repeats the bake.
    pub fn command(&self) -> &str {
        &self.command
    }

    /// The bytes of a slice, little-endian, row by row, the channels of a texel side by side.
    pub fn bytes(&self, slice: usize) -> &[u8] {
        let size = self.layout.values_of_slice() * self.precision().bytes();
        &self.values.bytes()[slice * size..][..size]
    }

    /// The value of a channel of the texel in column `i` and row `j` of a slice.
    #[inline]
    pub fn value(&self, slice: usize, i: usize, j: usize, channel: usize) -> f64 {
        let texel = (slice * self.y().size() + j) * self.x().size() + i;
        self.values.get(texel * self.channels().len() + channel)
    }

    /// The values of the texel in column `i` and row `j` of a slice.
    pub fn texel(&self, slice: usize, i: usize, j: usize) -> Vec<f64> {
        (0..self.channels().len()).map(|channel| self.value(slice, i, j, channel)).collect()
    }

    /// The values of a channel of a slice, row by row.
    pub fn plane(&self, slice: usize, channel: usize) -> Vec<f64> {
        let (count, width) = (self.layout.values_of_slice(), self.channels().len());
        self.values.iter().skip(slice * count).take(count).skip(channel).step_by(width).collect()
    }

    /// The values that a renderer reads from a slice at the parameters (`px`, `py`): bilinear
    /// between texels, clamped at the border.
    pub fn bilinear(&self, slice: usize, px: f64, py: f64) -> Vec<f64> {
        let place = bilinear(self.x(), self.y(), px, py);
        (0..self.channels().len())
            .map(|channel| place.read(|i, j| self.value(slice, i, j, channel)))
            .collect()
    }
}

/// The four texels around a place, and the weights of the second of each pair.
#[derive(Clone, Copy, Debug)]
pub struct Bilinear {
    columns: [usize; 2],
    rows: [usize; 2],
    weights: [f64; 2],
}

/// The texels that bilinear lookup at the parameters (`px`, `py`) reads, clamped at the border.
pub fn bilinear(x: &Axis, y: &Axis, px: f64, py: f64) -> Bilinear {
    let ((i0, i1, u), (j0, j1, v)) = (x.neighbours(px), y.neighbours(py));
    Bilinear { columns: [i0, i1], rows: [j0, j1], weights: [u, v] }
}

impl Bilinear {
    /// The value between those of the four texels, given by column and row.
    pub fn read(&self, value: impl Fn(usize, usize) -> f64) -> f64 {
        let ([i0, i1], [j0, j1], [u, v]) = (self.columns, self.rows, self.weights);
        let low = value(i0, j0) * (1.0 - u) + value(i1, j0) * u;
        let high = value(i0, j1) * (1.0 - u) + value(i1, j1) * u;
        low * (1.0 - v) + high * v
    }
}
