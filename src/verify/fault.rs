//! Faults of tables, by stable names.

use super::channel::{Channel, Idle};
use super::decision::{Decision, is_decided, nodes};
use super::decoding::Decoding;
use super::errors::{Differences, Errors};
use super::layout::Layout;
use super::meaning::Meaning;
use crate::choice::choice;
use crate::foreign::{Curve, Foreign};
use crate::table::axis::{AxisSpec, Nodes};
use crate::table::precision::Precision;
use serde::Serialize;

/// What can be wrong with a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    InvalidContainer,
    NotFinite,
    Constant,
    Flipped,
    Transposed,
    ShiftedNodes,
    SrgbEncoded,
    WrongCurve,
    EightBit,
    Border,
    AboveOne,
    Biased,
    WrongMasking,
    WrongDistribution,
    WrongFresnel,
    WrongChannels,
    WrongMapping,
    WrongSize,
    NotOurs,
    BeyondBound,
}

choice!(Kind, "fault", {
    InvalidContainer = "invalid-container", "the container contradicts itself or its standard";
    NotFinite = "not-finite", "values are NaN or infinite";
    Constant = "constant", "no channel varies";
    Flipped = "flipped", "an axis runs the other way than the metadata or the engine say";
    Transposed = "transposed", "n.v and roughness have changed places";
    ShiftedNodes = "shifted-nodes", "texels lie where no lookup reads them";
    SrgbEncoded = "srgb-encoded", "values are on a curve of which the file says nothing";
    WrongCurve = "wrong-curve", "the file names a curve on which its values are not";
    EightBit = "8-bit", "steps of 8 bits are wider than the errors of lookups";
    Border = "border", "the first or the last row or column is far worse than the others";
    AboveOne = "above-one", "more light than arrives";
    Biased = "biased", "values are too large, or too small, nearly everywhere";
    WrongMasking = "wrong-masking", "the masking is not that of the engine";
    WrongDistribution = "wrong-distribution", "the distribution is not that of the engine";
    WrongFresnel = "wrong-fresnel", "Fresnel's reflectance is not that of the engine";
    WrongChannels = "wrong-channels", "channels are not those of the engine";
    WrongMapping = "wrong-mapping", "the mapping of an axis is not that of the engine";
    WrongSize = "wrong-size", "the engine reads a table of another size alone";
    NotOurs = "not-as-baked", "texels or metadata of splitsum's file are not those of its bake";
    BeyondBound = "beyond-bound", "an error is larger than --max-error";
});

/// A fault of a table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fault {
    /// Its name.
    pub name: Kind,
    /// What it is here, with figures.
    pub text: String,
}

impl Fault {
    /// A fault with its figures.
    pub fn new(name: Kind, text: impl Into<String>) -> Self {
        Fault { name, text: text.into() }
    }
}

/// The faults of the file itself.
pub fn of_file(table: &Foreign, channels: &[Channel]) -> Vec<Fault> {
    let container = table.faults.iter();
    let mut faults: Vec<Fault> =
        container.map(|text| Fault::new(Kind::InvalidContainer, text.clone())).collect();
    for channel in channels.iter().filter(|channel| channel.not_finite > 0) {
        let text = format!("{} texels of {} are NaN or infinite", channel.not_finite, channel.name);
        faults.push(Fault::new(Kind::NotFinite, text));
    }
    let others = table.values.len() / table.size[2];
    let wrong = table.values[others..].iter().filter(|value| !value.is_finite()).count();
    if wrong > 0 {
        let text = format!("{wrong} values of slices behind the first are NaN or infinite");
        faults.push(Fault::new(Kind::NotFinite, text));
    }
    let constant = |channel: &Channel| matches!(channel.idle, Some(Idle::Constant(_)));
    if channels.iter().all(constant) {
        faults.push(Fault::new(Kind::Constant, "every channel is constant"));
    }
    faults
}

/// The faults of what is stored, whatever reads it.
pub fn of_storage(table: &Foreign, numbers: Precision, decoding: Decoding) -> Vec<Fault> {
    let mut faults = Vec::new();
    let curve = decoding.curve();
    match table.curve {
        // A divisor is an engine's own storage, which it decodes itself.
        None if curve != Curve::Linear && !decoding.has_divisor() => {
            let text = format!("values are {decoding}, and the file does not say so");
            faults.push(Fault::new(Kind::SrgbEncoded, text));
        }
        Some(stated) if !agree(stated, curve) => {
            let text = format!("values are {decoding}, the file says {}", stated.name());
            faults.push(Fault::new(Kind::WrongCurve, text));
        }
        _ => (),
    }
    if numbers == Precision::Unorm8 {
        faults.push(Fault::new(Kind::EightBit, "a step of 8 bits is 0.004"));
    }
    faults
}

/// Whether two curves are the same but for a little: 1/0.45455 is 2.2.
fn agree(a: Curve, b: Curve) -> bool {
    match (a, b) {
        (Curve::Gamma(a), Curve::Gamma(b)) => (a - b).abs() < 0.05,
        (a, b) => a == b,
    }
}

/// The faults of a layout: nodes where no lookup reads.
pub fn of_layout(layout: &Layout, decisions: &[Decision]) -> Vec<Fault> {
    let mut faults = Vec::new();
    for (spec, dimension) in
        [(layout.nov(), "nodes of nov"), (layout.roughness(), "nodes of roughness")]
    {
        let off = match spec.nodes {
            Nodes::Offset(offset) if offset != 0.5 => offset - 0.5,
            _ => continue,
        };
        if is_decided(decisions, dimension) {
            let AxisSpec { parameter, .. } = spec;
            let text = format!(
                "{parameter} lies {off:+} texels from texel centres ({}); a sampler reads texel \
                 i of N at (i + 1/2)/N",
                nodes(spec)
            );
            faults.push(Fault::new(Kind::ShiftedNodes, text));
        }
    }
    faults
}

/// An error so many times that of the inner texels is a fault of the border.
const BORDER: f64 = 8.0;

/// Errors of a border below this are no fault: the noise of a thousand samples at grazing.
const BORDER_LEAST: f64 = 0.02;

/// The share of the mean error that a bias is.
const BIAS: f64 = 0.8;

/// The faults of a channel's values.
pub fn of_values(
    channel: &Channel,
    meaning: &Meaning,
    differences: &Differences,
    half_step: f64,
) -> Vec<Fault> {
    let mut faults = Vec::new();
    let Errors { mean, bias, .. } = differences.errors;
    let name = &channel.name;
    let above = channel.range.1 - 1.0;
    // A value may be rounded upwards.
    if meaning.is_at_most_one() && above > half_step + 1e-6 {
        let text = format!("{name} reaches {:.6}, and no albedo exceeds 1", channel.range.1);
        faults.push(Fault::new(Kind::AboveOne, text));
    }
    if bias.abs() > BIAS * mean && mean > half_step + 1e-5 {
        let which = if bias > 0.0 { "large" } else { "small" };
        let text = format!("{name} is too {which} by {:.1e} on the average", bias.abs());
        faults.push(Fault::new(Kind::Biased, text));
    }
    faults.extend(border(name, differences));
    faults
}

/// A row or column at an end that is far worse than the others.
fn border(name: &str, differences: &Differences) -> Option<Fault> {
    let [columns, rows] = differences.size;
    if columns < 4 || rows < 4 {
        return None;
    }
    let mean = |inside: &dyn Fn(usize, usize) -> bool| {
        let texels = differences.values.iter().enumerate();
        let chosen = texels.filter(|(k, d)| inside(k % columns, k / columns) && d.is_finite());
        let (sum, count) = chosen.fold((0.0, 0), |(sum, n), (_, d)| (sum + d.abs(), n + 1));
        sum / f64::from(count.max(1))
    };
    let within = |place: usize, size: usize| place > 0 && place + 1 < size;
    let inner = mean(&|i, j| within(i, columns) && within(j, rows));
    let ends = [
        ("first column", mean(&|i, _| i == 0)),
        ("last column", mean(&|i, _| i + 1 == columns)),
        ("first row", mean(&|_, j| j == 0)),
        ("last row", mean(&|_, j| j + 1 == rows)),
    ];
    let worse = |&&(_, mean): &&(&str, f64)| mean > BORDER * inner && mean > BORDER_LEAST;
    ends.iter().find(worse).map(|(which, mean)| {
        let text = format!("{name}: the {which} errs by {mean:.1e}, the inside by {inner:.1e}");
        Fault::new(Kind::Border, text)
    })
}
