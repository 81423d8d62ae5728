//! A net as a table, for files: its codes as they are, with what a reader has to know of them.

use super::{Across, Along, Approximation, Channels, Numbers, Shape, Storage, Texels};
use crate::choice::Choice;
use crate::error::{Error, Result};
use crate::table::axis::{Axis, AxisSpec, Nodes, Parameter};
use crate::table::claim::Claim;
use crate::table::packed::Packed;
use crate::table::precision::Precision;
use crate::table::{Channel, Layout, Part, Provenance, Table};

/// What a plan says of its approximation.
#[derive(Clone, Debug, PartialEq)]
pub struct Promise {
    /// The tolerance of E(F0).
    pub tolerance: String,
    /// The range of F0.
    pub f0: [f64; 2],
    /// The largest error of E(F0) found, and the number of places.
    pub measured_error: (f64, usize),
    /// The command that repeats the plan.
    pub command: String,
}

/// Names and meanings of the channels.
fn names(channels: Channels) -> [(&'static str, &'static str); 2] {
    match channels {
        Channels::Albedo => [("E", "albedo at the F0 of the plan"), ("", "")],
        Channels::Ratio => [("W", "E(F0) = F W at the F0 of the plan"), ("", "")],
        Channels::EnergyRest => {
            [("E", "albedo at F0 = 1"), ("R", "rest: E(F0) = F E + (1 - F0) R")]
        }
        Channels::ScaleBias => [("A", "scale: E(F0) = F0*A + B"), ("B", "bias: E(F0) = F0*A + B")],
        Channels::BiasEnergy => [("B", "bias: albedo at F0 = 0"), ("E", "albedo at F0 = 1")],
    }
}

impl Approximation {
    /// The control points of a net as a table of columns and rows, the codes unchanged: a channel
    /// is (number - offset) / (last · scale). A texture is itself.
    ///
    /// # Errors
    ///
    /// [`Error::BadInput`] for polynomials, which are no table.
    pub fn table(&self, promise: &Promise) -> Result<Table> {
        let control = |count: usize| {
            let spec = AxisSpec { nodes: Nodes::Edges, ..AxisSpec::of(Parameter::Control) };
            Axis::new(spec, count)
        };
        let (x, y, texels, filter) = match self.shape {
            Shape::Spline { x, y, size: [columns, rows], degree } => {
                let filter = self.filter((x, y), degree);
                (control(columns)?, control(rows)?, Texels::Fitted, filter)
            }
            Shape::Texture { x, y, texels } => (x, y, texels, "bilinear, clamped".to_owned()),
            Shape::Polynomial { .. } | Shape::Surface { .. } => {
                let cure = "write code instead, as in --code FILE.wgsl";
                let expected = "a net of control points";
                return Err(Error::bad_input("table", expected, "polynomials", cure));
            }
        };
        let storage = self.numbers.first().map_or(Storage::F32, Numbers::storage);
        let precision = match storage {
            Storage::F32 => Precision::F32,
            Storage::F16 => Precision::F16,
            Storage::Unorm16 => Precision::Unorm16,
            Storage::Unorm8 => Precision::Unorm8,
        };
        let layout = Layout { x, y, slices: None, channels: self.table_channels() };
        let part = Part {
            channels: (0..layout.channels.len()).collect(),
            provenance: self.provenance(promise),
            claim: Claim::Fitted {
                nodes: texels.word(),
                filter,
                domain: self.domain(promise),
                tolerance: promise.tolerance.clone(),
                measured_error: promise.measured_error,
                blake3: self.blake3(),
            },
        };
        let values = self.packed(precision)?;
        Table::new(layout, values, vec![vec![part]], 0.0, promise.command.clone())
    }

    fn table_channels(&self) -> Vec<Channel> {
        let named = self.numbers.iter().zip(names(self.channels));
        let channel = |(numbers, (name, meaning)): (&Numbers, (&str, &str))| {
            let mut channel = Channel::new(name, meaning);
            // A texture has the values themselves.
            let is_net = matches!(self.shape, Shape::Spline { .. });
            if let (true, Numbers::Codes { offset, scale, last, .. }) = (is_net, numbers) {
                let range = f64::from(*scale) * f64::from(*last);
                let range = if range > 0.0 { range } else { 1.0 };
                (channel.scale, channel.offset) = (1.0 / range, -f64::from(*offset) / range);
            }
            channel
        };
        named.map(channel).collect()
    }

    fn provenance(&self, promise: &Promise) -> Provenance {
        let [low, high] = promise.f0;
        Provenance {
            table: match self.shape {
                Shape::Texture { .. } => "planned texture",
                _ => "fitted net",
            },
            equation: format!("channels: {}", self.channels.about()),
            model: self.lobe.ndf.word(),
            masking: Some(self.lobe.masking.word()),
            interface: None,
            fresnel: Some("Schlick: F = F0 + (1 - F0) (1 - n.v)^5".into()),
            f0: (low == high).then_some(low),
            roughness: self.lobe.ndf.definition().roughness,
        }
    }

    /// How a lookup reads the net.
    fn filter(&self, (x, y): (Along, Across), degree: usize) -> String {
        let kind = ["bilinear", "uniform quadratic B-spline", "uniform cubic B-spline"][degree - 1];
        let [low, high] = self.region.roughness;
        let least = self.region.least_nov;
        format!(
            "{kind}; along x: {} of (n.v - {least})/(1 - {least}) from 0 to 1; along y: {} of \
             perceptual roughness, from 0 at {low} to 1 at {high}",
            x.word(),
            y.word()
        )
    }

    fn domain(&self, promise: &Promise) -> String {
        let [low, high] = self.region.roughness;
        let [first, last] = promise.f0;
        let least = self.region.least_nov;
        format!("n.v {least} to 1, perceptual roughness {low} to {high}, F0 {first} to {last}")
    }

    fn packed(&self, precision: Precision) -> Result<Packed> {
        let channels = self.numbers.len();
        let count = self.numbers.first().map_or(0, Numbers::len);
        let mut packed = Packed::zeros(precision, count * channels)?;
        let bytes = precision.bytes();
        for (c, numbers) in self.numbers.iter().enumerate() {
            for index in 0..count {
                let stored = match numbers {
                    Numbers::Floats(floats) | Numbers::Halves(floats) => floats[index].into(),
                    Numbers::Codes { last, codes, .. } => {
                        f64::from(codes[index]) / f64::from(*last)
                    }
                };
                let at = (index * channels + c) * bytes;
                precision.write(stored, &mut packed.bytes_mut()[at..at + bytes]);
            }
        }
        Ok(packed)
    }
}
