//! A table of numbers over two axes: values, channels, lookup as a renderer does it, and how far two tables are apart.

use crate::axis::Axis;
use crate::certificate::Certificate;
use crate::stored::Stored;
use serde::Serialize;

/// A channel of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Channel {
    /// Its short name: `A`, `B`, `E`.
    pub name: &'static str,
    /// What it holds.
    pub meaning: &'static str,
}

/// Where a table's numbers come from and what they are worth, in words for the metadata.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Provenance {
    /// The family of tables.
    pub table: &'static str,
    /// What it is for.
    pub equation: &'static str,
    /// The lobe.
    pub model: String,
    /// The masking term of a specular lobe.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub masking: Option<String>,
    /// Fresnel of a specular lobe.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fresnel: Option<&'static str>,
    /// Reflectance at normal incidence, where the table is for one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub f0: Option<f64>,
    /// What roughness means.
    pub roughness: &'static str,
    /// What the values are worth.
    #[serde(flatten)]
    pub worth: Worth,
    /// The command that repeats the bake.
    pub command: String,
}

/// What the values of a table are worth.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Worth {
    /// Certified one by one.
    Certificate(Certificate),
    /// Not certified, but integrated by a rule whose error is bounded.
    Uncertified {
        /// The quadrature rule.
        rule: &'static str,
        /// The largest error of a value before it is stored; of values above 1 relative.
        error_bound: f64,
        /// The largest error found against the double-exponential reference, and over how many texels.
        measured_error: (f64, usize),
        /// Backend, arithmetic and device.
        computed_by: String,
    },
}

impl Default for Worth {
    fn default() -> Self {
        Worth::Certificate(Certificate::default())
    }
}

/// Values over two axes, row by row, the channels of a texel side by side.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Along a row.
    pub x: Axis,
    /// From row to row.
    pub y: Axis,
    /// What each value of a texel is.
    pub channels: Vec<Channel>,
    /// The values as they are stored, `channels.len()` for each texel.
    pub values: Stored,
    /// Where they come from.
    pub provenance: Provenance,
}

/// How far two sets of values are apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Difference {
    /// The largest absolute difference.
    pub max: f64,
    /// The root of the mean squared difference.
    pub rms: f64,
    /// How many values were compared.
    pub count: usize,
}

impl Table {
    /// The values of the texel in column `i` and row `j`.
    pub fn texel(&self, i: usize, j: usize) -> Vec<f64> {
        (0..self.channels.len()).map(|channel| self.value(i, j, channel)).collect()
    }

    /// One of them.
    #[inline]
    pub fn value(&self, i: usize, j: usize, channel: usize) -> f64 {
        self.values.get((j * self.x.size + i) * self.channels.len() + channel)
    }

    /// BLAKE3 of the values as they are stored: little-endian, row by row, the channels of a texel side by side.
    pub fn hash(&self) -> String {
        blake3::hash(self.values.bytes()).to_hex().to_string()
    }

    /// The values of a channel, row by row.
    pub fn plane(&self, channel: usize) -> Vec<f64> {
        self.values.iter().skip(channel).step_by(self.channels.len()).collect()
    }

    /// What a renderer reads at the parameters (`px`, `py`): bilinear between texels, clamped at the border.
    pub fn bilinear(&self, px: f64, py: f64) -> Vec<f64> {
        let ((i0, i1, u), (j0, j1, v)) = (self.x.neighbours(px), self.y.neighbours(py));
        (0..self.channels.len())
            .map(|c| {
                let low = self.value(i0, j0, c) * (1.0 - u) + self.value(i1, j0, c) * u;
                let high = self.value(i0, j1, c) * (1.0 - u) + self.value(i1, j1, c) * u;
                low * (1.0 - v) + high * v
            })
            .collect()
    }
}

impl Difference {
    /// Of two sequences of the same length; NaN anywhere makes it NaN.
    pub fn between(pairs: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let (mut max, mut squares, mut count) = (0.0f64, 0.0, 0);
        for (a, b) in pairs {
            let d = (a - b).abs();
            max = if d <= max { max } else { d };
            squares += d * d;
            count += 1;
        }
        Difference { max, rms: (squares / f64::from(count.max(1))).sqrt(), count: count as usize }
    }
}
