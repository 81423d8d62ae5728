//! Every convention of a table as one JSON text, for whichever field a format has for it.

use crate::error::{Error, Result};
use crate::table::axis::{Axis, Parameter};
use crate::table::claim::Claim;
use crate::table::precision::Precision;
use crate::table::{Provenance, Table};
use serde::Serialize;

/// The key under which files carry the text.
pub const KEY: &str = "splitsum";

/// The tool and its version.
pub const TOOL: &str = concat!("splitsum ", env!("CARGO_PKG_VERSION"));

#[derive(Serialize)]
struct Metadata<'a> {
    tool: &'static str,
    #[serde(flatten)]
    provenance: &'a Provenance,
    #[serde(flatten)]
    claim: &'a Claim,
    command: &'a str,
    channels: Vec<String>,
    x: AxisText,
    y: AxisText,
    #[serde(skip_serializing_if = "Option::is_none")]
    slice: Option<SliceText>,
    origin: &'static str,
    stored: Precision,
    rounding: &'static str,
    rounding_error: f64,
}

#[derive(Serialize)]
struct AxisText {
    parameter: Parameter,
    size: usize,
    axis: String,
    texel: String,
}

#[derive(Serialize)]
struct SliceText {
    parameter: Parameter,
    index: usize,
    count: usize,
    value: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    axis: Option<String>,
}

impl AxisText {
    fn new(axis: &Axis) -> Self {
        let spec = axis.spec();
        AxisText {
            parameter: spec.parameter,
            size: axis.size(),
            axis: spec.to_string(),
            texel: axis.formula(),
        }
    }
}

/// The text of a slice in ASCII, for a file that stores the channels under these names; names
/// without a channel are stored as 0.
pub fn metadata(table: &Table, slice: usize, names: &[&str]) -> Result<String> {
    let precision = table.precision();
    let channel = |(i, name): (usize, &&str)| match table.channels().get(i) {
        Some(channel) => format!("{name} = {} ({})", channel.name, channel.meaning),
        None => format!("{name} = 0 (unused)"),
    };
    let metadata = Metadata {
        tool: TOOL,
        provenance: table.provenance(slice),
        claim: table.claim(slice),
        command: table.command(),
        channels: names.iter().enumerate().map(channel).collect(),
        x: AxisText::new(table.x()),
        y: AxisText::new(table.y()),
        slice: table.layout().slices.as_ref().map(|slices| SliceText {
            parameter: slices.parameter(),
            index: slice,
            count: slices.count(),
            value: slices.values()[slice],
            axis: slices.spec().map(|spec| spec.to_string()),
        }),
        origin: "texel i = 0 is the left end of a row, row 0 is the first and topmost; values are \
                 linear",
        stored: precision,
        rounding: "to nearest, ties to even",
        rounding_error: precision.half_step(),
    };
    let json = serde_json::to_string(&metadata)
        .map_err(|error| Error::Internal(format!("metadata: {error}")))?;
    Ok(ascii(&json))
}

/// The same JSON in ASCII, which is all that some readers of text fields take.
fn ascii(json: &str) -> String {
    let escape = |unit: u16| match char::from_u32(unit.into()) {
        Some(c) if c.is_ascii() => c.to_string(),
        _ => format!("\\u{unit:04x}"),
    };
    json.encode_utf16().map(escape).collect()
}
